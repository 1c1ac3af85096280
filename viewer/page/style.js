// The style of the map: what is drawn, of which source, in which colours. A function of the settings alone.
import { encoding } from "./heights.js";

const themes = {
    light: { ground: "#e8ecea", ink: "#1c2a2c", halo: "#ffffff", contour: "#3d2c17", fixed: "#b3261e", sky: "#a9c9dd", horizon: "#e8ecea" },
    dark: { ground: "#12181a", ink: "#0b0f10", halo: "#ffffff", contour: "#2a1e0f", fixed: "#d1352b", sky: "#1b2c3a", horizon: "#12181a" },
};
export const colours = { simplex: "#d6246e", neighbour: "#1c2a2c", circle: "#1c2a2c", star: "#7a3e9d", visible: "#0a7d4f", hidden: "#c62828", path: "#1558d6" };

const of = (...kinds) => ["in", ["get", "kind"], ["literal", kinds]];
const when = (isShown) => ({ visibility: isShown ? "visible" : "none" });
const empty = { type: "FeatureCollection", features: [] };

function sources({ tiles, scales, range, data, baseMap, hasHeights, above, difference }) {
    const heights = (name) => ({ type: "raster-dem", tileSize: 256, maxzoom: 20, tiles: [tiles[name]], ...encoding(range, scales[name]) });
    return {
        ...(baseMap && { base: { type: "raster", tiles: [baseMap], tileSize: 256 } }),
        picture: { type: "raster", tiles: [tiles.picture], tileSize: 256, maxzoom: 22 },
        ...Object.fromEntries(above.map(({ of, tiles }) => [`above ${of}`, { type: "raster", tiles: [tiles], tileSize: 256, maxzoom: 22 }])),
        ...(difference && { difference: { type: "raster", tiles: [difference], tileSize: 256, maxzoom: 20 } }),
        vector: { type: "vector", tiles: [tiles.vector], maxzoom: 22 },
        ...(hasHeights && { shade: heights("shade"), heights: heights("heights") }),
        ...Object.fromEntries(["mask", "lines", "under", "changes", "found"].map((name) => [name, { type: "geojson", data: data[name] ?? empty, tolerance: 0.1 }])),
    };
}

/** Lines twice: a light one below, so that the dark one can be seen on any colour. */
function cased(id, source, filter, colour, width, more = {}) {
    const line = { type: "line", source, filter, layout: { "line-cap": "round", "line-join": "round" } };
    return [{ ...line, id: `${id}-case`, paint: { "line-color": "#ffffff", "line-width": width + 3, "line-opacity": 0.9 } },
        { ...line, id, paint: { "line-color": colour, "line-width": width, ...more } }];
}

function ground(theme, { shown, shade, hasHeights, baseMap, above, difference, opacity }) {
    return [
        { id: "ground", type: "background", paint: { "background-color": theme.ground } },
        ...(baseMap ? [{ id: "base", type: "raster", source: "base", layout: when(shown.base) }] : []),
        { id: "picture", type: "raster", source: "picture", paint: { "raster-fade-duration": 0, "raster-opacity": baseMap && shown.base ? 0.75 : 1 } },
        ...(difference ? [{ id: "difference", type: "raster", source: "difference", paint: { "raster-fade-duration": 0 } }] : []),
        ...(hasHeights ? [{ id: "shade", type: "hillshade", source: "shade", layout: when(shown.shade), paint: { "hillshade-exaggeration": shade.strength,
            "hillshade-illumination-direction": shade.from, "hillshade-illumination-anchor": "map", "hillshade-method": "standard",
            "hillshade-shadow-color": "#0d1f2d", "hillshade-accent-color": "#14232b", "hillshade-highlight-color": "#fff6e0" } }] : []),
        // Beyond the border heights go on, but nothing of them is to be seen.
        ...(baseMap ? [] : [{ id: "mask", type: "fill", source: "mask", paint: { "fill-color": theme.ground, "fill-antialias": false } }]),
        ...above.map(({ of }) => ({ id: `above ${of}`, type: "raster", source: `above ${of}`, paint: { "raster-fade-duration": 0, "raster-opacity": opacity } })),
    ];
}

function contours(theme, { shown, intervals }) {
    if (!intervals) return [];
    const layer = { source: "vector", "source-layer": "contours", layout: when(shown.contours) };
    const isIndex = intervals.isIndex();
    return [
        { ...layer, id: "contours", type: "line", filter: ["!", isIndex], paint: { "line-color": theme.contour, "line-width": 0.7, "line-opacity": 0.5 } },
        { ...layer, id: "contours-index", type: "line", filter: isIndex, paint: { "line-color": theme.contour, "line-width": 1.4, "line-opacity": 0.7 } },
        { ...layer, id: "contours-height", type: "symbol", filter: isIndex, minzoom: 0, paint: { "text-color": theme.contour, "text-halo-color": "#ffffffd0", "text-halo-width": 1.6 },
            layout: { ...layer.layout, "symbol-placement": "line", "symbol-spacing": 220, "text-field": ["to-string", ["get", "value"]], "text-font": ["sans-serif"], "text-size": 11, "text-max-angle": 65, "text-padding": 6 } },
    ];
}

function meshLayers(theme, { shown, isPart, edgeZoom }) {
    const fading = (most) => ["interpolate", ["linear"], ["zoom"], edgeZoom - 0.6, 0, edgeZoom + 0.6, most];
    return [
        { id: "edges", type: "line", source: "vector", "source-layer": "triangles", minzoom: Math.max(0, edgeZoom - 0.6), layout: when(shown.edges), paint: { "line-color": theme.ink, "line-width": 0.7, "line-opacity": fading(0.5) } },
        { id: "hull", type: "line", source: "vector", "source-layer": "hull", paint: { "line-color": theme.ink, "line-width": 1, "line-opacity": 0.55 } },
        ...cased("fixed", "lines", true, theme.fixed, 2).map((layer) => ({ ...layer, layout: { ...layer.layout, ...when(shown.lines && !isPart) } })),
        // Of a region alone: tiles leave out those outside.
        ...cased("fixed-part", "vector", true, theme.fixed, 2).map((layer) => ({ ...layer, "source-layer": "fixed", layout: { ...layer.layout, ...when(shown.lines && isPart) } })),
        { id: "vertices", type: "circle", source: "vector", "source-layer": "vertices", minzoom: Math.max(0, edgeZoom - 0.6), layout: when(shown.vertices), paint: { "circle-radius": 2.2, "circle-color": theme.ink, "circle-stroke-width": 1, "circle-stroke-color": theme.halo } },
    ];
}

const answers = () => [
    ...cased("moved", "changes", of("moved"), colours.star, 1.6, { "line-dasharray": [2, 2] }),
    { id: "changes", type: "circle", source: "changes", filter: of("insert", "remove"), paint: { "circle-radius": 5, "circle-color": ["match", ["get", "kind"], "insert", colours.visible, colours.hidden],
        "circle-opacity": ["match", ["get", "kind"], "insert", 1, 0.35], "circle-stroke-width": 2, "circle-stroke-color": ["match", ["get", "kind"], "insert", "#ffffff", colours.hidden] } },
    { id: "under", type: "line", source: "under", paint: { "line-color": "#ffffff", "line-width": 3, "line-opacity": 0.9 } },
    { id: "under-ink", type: "line", source: "under", paint: { "line-color": colours.neighbour, "line-width": 1.2 } },
    { id: "fill", type: "fill", source: "found", filter: of("simplex", "area"), paint: { "fill-color": ["match", ["get", "kind"], "area", colours.path, colours.simplex], "fill-opacity": 0.2 } },
    { id: "neighbours", type: "line", source: "found", filter: of("neighbour"), paint: { "line-color": colours.neighbour, "line-width": 1.4 } },
    { id: "circle", type: "line", source: "found", filter: of("circle"), paint: { "line-color": colours.circle, "line-width": 1.2, "line-dasharray": [3, 2] } },
    ...cased("star", "found", of("star"), colours.star, 1.6),
    ...cased("simplex", "found", of("simplex"), colours.simplex, 2.6),
    ...cased("lines-drawn", "found", of("path", "visible", "hidden"), ["coalesce", ["get", "colour"], ["match", ["get", "kind"], "visible", colours.visible, "hidden", colours.hidden, colours.path]], 3),
    { id: "crossings", type: "circle", source: "found", filter: of("crossing"), paint: { "circle-radius": 2.4, "circle-color": "#ffffff", "circle-stroke-width": 1.2, "circle-stroke-color": colours.path } },
    { id: "places", type: "circle", source: "found", filter: of("place", "cursor"), paint: { "circle-radius": 5, "circle-color": ["match", ["get", "kind"], "cursor", "#ffffff", colours.simplex], "circle-stroke-width": 2, "circle-stroke-color": ["match", ["get", "kind"], "cursor", colours.path, "#ffffff"] } },
    { id: "place-names", type: "symbol", source: "found", filter: ["all", of("place"), ["has", "name"]], paint: { "text-color": "#17211f", "text-halo-color": "#ffffff", "text-halo-width": 2 },
        layout: { "text-field": ["get", "name"], "text-font": ["sans-serif"], "text-size": 12, "text-anchor": "left", "text-offset": [0.8, 0], "text-allow-overlap": true } },
];

/** `settings`: tiles and scales by source, range of the heights, data of the page's own sources, what is shown … */
export function styleOf(settings) {
    const theme = themes[settings.theme];
    return {
        version: 8,
        sources: sources(settings),
        sky: { "sky-color": theme.sky, "horizon-color": theme.horizon, "fog-color": theme.ground, "sky-horizon-blend": 0.7, "horizon-fog-blend": 0.6, "fog-ground-blend": 0.95 },
        ...(settings.terrain && { terrain: { source: "heights", exaggeration: settings.terrain } }),
        layers: [...ground(theme, settings), ...contours(theme, settings), ...meshLayers(theme, settings), ...answers()],
    };
}
