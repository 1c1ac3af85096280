// The map of a mesh in the plane, and what of it the other parts of the page use.
import * as maplibre from "maplibre-gl";
import { element, essential, mention } from "./common.js";
import { comparison } from "./comparison.js";
import { Intervals } from "./contours.js";
import { Coordinates } from "./coordinates.js";
import { stillThere } from "./editing.js";
import { greatest, least, setHeights } from "./heights.js";
import { outside } from "./outside.js";
import { ask, root, sessionHeaders } from "./requests.js";
import { avoidSeams } from "./seams.js";
import { rangeOf } from "./series.js";
import { styleOf } from "./style.js";

maplibre.setWorkerUrl("/assets/maplibre-gl-worker.mjs");

export let mesh = await essential(() => ask("info"));
export const coordinates = new Coordinates(mesh);
export const isEmpty = () => mesh.lower[0] === null;

// ---- Settings of the page ------------------------------------------------------------------------

const dark = matchMedia("(prefers-color-scheme: dark)");
const checked = (id) => element(id).checked;
export const attribute = () => mesh.attributes.find((one) => one.name === element("attribute").value) ?? null;
export const named = (parameters) => ({ ...parameters, ...(attribute() && { attribute: attribute().name }) });

/** The range of the colours: what was entered, or that of the whole mesh. */
export function colourRange() {
    const [low, high] = rangeOf(attribute(), mesh.attributes), given = ["low", "high"].map((id) => element(id).valueAsNumber);
    if (low === null) return [0, 1]; // no vertex has a value
    return given.some(Number.isNaN) || given[0] >= given[1] ? [low, high > low ? high : low + 1] : given;
}

const bounds = () => [mesh.lower, mesh.upper].map((place) => coordinates.toMap(place));
const padding = () => ({ top: 84, right: 40, bottom: 28, left: 40 });

/** The zoom at which the whole mesh fills a window of a usual size. */
function meshZoom() {
    if (isEmpty()) return 0;
    const [a, b] = bounds().map((place) => maplibre.MercatorCoordinate.fromLngLat(place));
    return Math.max(0, Math.log2(800 / 512 / Math.max(Math.abs(b.x - a.x), Math.abs(b.y - a.y), 1e-9)));
}
/** The zoom from which a usual edge is 16 pixels long. */
function edgeZoom() {
    if (isEmpty() || !mesh.simplices) return 0;
    const [a, b] = bounds().map((place) => maplibre.MercatorCoordinate.fromLngLat(place));
    const area = Math.abs(b.x - a.x) * Math.abs(b.y - a.y);
    return Math.min(21, Math.max(0, Math.log2((16 / 512) * Math.sqrt(mesh.simplices / 2 / area))));
}

/** How much heights are raised so that the relief of the whole mesh is a ninth of its width, or as it is if it is more. */
function usualExaggeration() {
    if (!attribute() || isEmpty()) return 1;
    const { least: low, greatest: high } = attribute(), factor = coordinates.extent(mesh) / 9 / (high - low || 1);
    return coordinates.unit ? Math.max(1, factor) : factor;
}
/** The slider goes from a thirtieth to thirty times the usual, in steps of the same share. */
export const exaggeration = () => Number((usualExaggeration() * 10 ** (Number(element("exaggeration").value) / 20)).toPrecision(2));

export const intervals = () => (attribute() && attribute().least !== null && !isEmpty() ? new Intervals(attribute(), meshZoom(), Number(element("interval").value)) : null);

/** The region that is shown alone, if one is. */
const within = () => (element("within").value ? { within: element("within").value } : {});

/** The address of tiles of a kind, also of another mesh. */
export const tileAddress = (kind, more) => `${location.origin}${root}tiles/${kind}/{z}/{x}/{y}?${new URLSearchParams({ v: mesh.etag, ...named({}), ...more })}`;

function tiles() {
    const common = { v: mesh.etag, ...named({}), ...within() };
    const address = (kind, more) => tileAddress(kind, { ...within(), ...more });
    const [low, high] = attribute() ? colourRange() : [], heights = new URLSearchParams(common);
    return {
        picture: address("picture", { edges: "no", ...(checked("regions") && { regions: "yes" }), ...(devicePixelRatio > 1 && { size: 512 }), ...(attribute() && { ramp: element("ramp").value, low, high }) }),
        vector: address("vector", { ...(checked("contours") && intervals() && { contours: element("interval").value || "auto" }) }),
        terrain: address("terrain", { outside: "none" }),
        shade: `heights://shade/{z}/{x}/{y}?${heights}`,
        heights: `heights://heights/{z}/{x}/{y}?${heights}`,
    };
}

/** Shading exaggerates by itself at low zooms (the shader of MapLibre: 0.3 for each zoom below 15). */
const shadeScale = () => (coordinates.heightScale * usualExaggeration()) / 2 ** (0.3 * Math.max(0, 15 - meshZoom()));

const hasHeights = () => attribute() !== null && attribute().least !== null && !isEmpty();
const data = {};
let isReady = false; // heights need the border
function settings() {
    return {
        theme: dark.matches ? "dark" : "light", tiles: tiles(), data, baseMap: mesh.baseMap ?? null, hasHeights: isReady && hasHeights(),
        range: heightRange(), scales: { shade: shadeScale(), heights: coordinates.heightScale },
        terrain: isReady && hasHeights() && checked("relief") ? exaggeration() : 0,
        shown: Object.fromEntries(["shade", "contours", "edges", "vertices", "lines", "base"].map((id) => [id, checked(id)])),
        shade: { strength: Number(element("shade-strength").value) / 100, from: Number(element("shade-from").value) },
        above: comparison.above.map((of) => ({ of, tiles: `${location.origin}${root}tiles/picture/{z}/{x}/{y}?${new URLSearchParams({ of, edges: "no", ramp: element("ramp").value, ...(devicePixelRatio > 1 && { size: 512 }) })}` })),
        difference: comparison.with && `difference://difference/{z}/{x}/{y}?${new URLSearchParams({ v: mesh.etag, of: comparison.with, most: comparison.most, ...named({}) })}`,
        opacity: Number(element("opacity").value) / 100,
        isPart: element("within").value !== "", intervals: intervals(), edgeZoom: edgeZoom(),
    };
}
const heightRange = () => (attribute() ? [Math.max(attribute().least, least), Math.min(attribute().greatest, greatest)] : [0, 1]);

// ---- The map -------------------------------------------------------------------------------------

element("attribute").append(...mesh.attributes.map((one) => new Option(one.name)));

/** Requests to the server carry the session, and those of vector tiles the interval for their zoom. */
function transformRequest(url) {
    if (!url.startsWith(`${location.origin}/`)) return { url };
    const [, zoom] = /\/tiles\/vector\/(\d+)\//.exec(url) ?? [];
    return { url: zoom === undefined ? url : url.replace("contours=auto", () => `contours=${intervals()?.at(Number(zoom)) ?? 0}`), headers: sessionHeaders() };
}

export const map = new maplibre.Map({
    container: "view",
    attributionControl: mesh.credit ? { customAttribution: mesh.credit.replace(/[<>&]/g, (sign) => `&#${sign.charCodeAt()};`) } : false,
    bounds: isEmpty() ? undefined : bounds(),
    fitBoundsOptions: { padding: padding() },
    maxPitch: 80,
    renderWorldCopies: false, // the mesh is there once
    maxZoom: 23,
    transformRequest,
    style: styleOf(settings()),
});
avoidSeams(map);
map.getCanvas().setAttribute("aria-label", "Map of the mesh. Press Enter to use the tool at the middle of the map. Once a triangle is shown, the arrow keys walk to its neighbours. Press Escape to start again.");
map.on("error", ({ error }) => (error?.status === 410 ? stillThere() : mention(error?.message ?? "A tile could not be loaded.")));

export const fit = () => isEmpty() || map.fitBounds(bounds(), { padding: padding(), pitch: map.getPitch(), bearing: 0 });

/** Leaves room for a chart below, and shows all of the places. */
export function makeRoom(height, shown) {
    map.easeTo({ padding: { bottom: height }, duration: 0 });
    const box = shown.map(toMap).reduce((box, place) => box.extend(place), new maplibre.LngLatBounds());
    if (height > 0 && !box.isEmpty()) map.fitBounds(box, { padding: { top: 84, right: 70, bottom: 28, left: 40 }, maxZoom: map.getZoom(), pitch: map.getPitch(), bearing: map.getBearing(), duration: 300 });
}

/** Draws the map as the settings now are. Tiles that are on the screen stay until the new ones have come: sources get their new
    addresses after the layers have changed, since a change of both at once would leave the old tiles. */
export function restyle() {
    const now = settings(), sources = tiledSources.map((name) => [name, map.getSource(name)]).filter(([, source]) => source);
    map.setStyle(styleOf({ ...now, tiles: { ...now.tiles, ...Object.fromEntries(sources.map(([name, source]) => [name, source.serialize().tiles[0]])) } }));
    map.once("render", () => {
        const { tiles } = settings();
        for (const name of tiledSources) {
            const source = map.getSource(name);
            if (source && source.serialize().tiles[0] !== tiles[name]) source.setTiles([tiles[name]]);
        }
    });
    map.triggerRepaint(); // also if no layer has changed
}
const tiledSources = ["picture", "vector", "shade", "heights"];
dark.addEventListener("change", restyle);

// ---- Shapes --------------------------------------------------------------------------------------

export const feature = (kind, type, coordinates, more = {}) => ({ type: "Feature", properties: { kind, ...more }, geometry: { type, coordinates } });
const toMap = (place) => coordinates.toMap(place);
export const ring = (kind, corners) => feature(kind, "Polygon", [[...corners, corners[0]].map(toMap)]);
export const line = (kind, places, more) => feature(kind, "LineString", places.map(toMap), more);
export const places = (points, kind = "place") => points.map((p) => feature(kind, "Point", toMap(p)));
export function put(source, features) {
    data[source] = { type: "FeatureCollection", features };
    map.getSource(source)?.setData(data[source]);
}
export const show = (features) => put("found", features);

// ---- The mesh, as it now is ------------------------------------------------------------------------

const world = [[-180, -85.05], [180, -85.05], [180, 85.05], [-180, 85.05], [-180, -85.05]];

/** Everything outside the border, to be covered; and the heights of the border, which go on outside. */
async function readBorder() {
    const rows = isEmpty() ? [] : (await ask("hull", { ...named({}), ...within() })) ?? [], rings = new Map();
    for (const { ring, x, y, value } of rows) {
        if (!rings.has(ring)) rings.set(ring, []);
        rings.get(ring).push([...toMap([x, y]), value]);
    }
    const onMap = [...rings.values()];
    data.mask = onMap.length ? { type: "FeatureCollection", features: [feature("mask", "MultiPolygon", outside(world, onMap.map((ring) => [...ring, ring[0]].map(([lng, lat]) => [lng, lat]))))] } : undefined;
    const hasHeights = attribute() && onMap.every((ring) => ring.every(([, , height]) => height !== null));
    const border = onMap.length && hasHeights ? onMap.map((ring) => ring.map(([lng, lat, height]) => {
        const { x, y } = maplibre.MercatorCoordinate.fromLngLat([lng, lat]);
        return [x, y, height];
    })) : null;
    const { terrain } = tiles();
    isReady = true;
    setHeights({ border, range: heightRange(), address: (z, x, y) => terrain.replace("{z}", z).replace("{x}", x).replace("{y}", y) });
}

/** The region that was shown alone may have gone. */
async function keepRegion() {
    const select = element("within");
    if (select.value && !(await ask("regions")).some(({ region }) => region === select.value)) select.value = "";
}

/** Reads the mesh again, and draws it. */
export async function refresh() {
    mesh = await ask("info");
    await keepRegion();
    await readBorder();
    restyle();
    map.fire("refreshed");
}
