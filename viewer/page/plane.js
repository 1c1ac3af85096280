// A mesh in the plane, on a map. Coordinates that are not longitude and latitude are put on a part
// of the map around 0, 0 by a shift and a scale: the square `world` is the map of the world.
import * as maplibre from "maplibre-gl";
import { chart } from "./chart.js";
import { answering, centroid, circumsphere, counted, describe, element, number, offerWalk, say, surround, table, tool } from "./common.js";
import { change, setUpEditing, stillThere } from "./editing.js";
import { ask, sessionHeaders } from "./requests.js";

maplibre.setWorkerUrl("/assets/maplibre-gl-worker.mjs");

let mesh = await ask("info");
const half = 20037508.342789244;
const world = mesh.world ?? (mesh.srid === 3857 ? [-half, -half, 2 * half] : null);

// ---- Coordinates -------------------------------------------------------------------------------

const toMap = ([x, y]) => {
    if (!world) return [x, y];
    const place = new maplibre.MercatorCoordinate((x - world[0]) / world[2], 1 - (y - world[1]) / world[2]).toLngLat();
    return [place.lng, place.lat];
};
const toMesh = ({ lng, lat }) => {
    if (!world) return [lng, lat];
    const place = maplibre.MercatorCoordinate.fromLngLat([lng, lat]);
    return [world[0] + place.x * world[2], world[1] + (1 - place.y) * world[2]];
};

// ---- The map -----------------------------------------------------------------------------------

const attribute = () => element("attribute").value || undefined;
const steps = [0];
/** 1, 2 or 5 times a power of ten, from a 200th of the range on. */
function setSteps() {
    const found = mesh.attributes.find((one) => one.name === attribute());
    const range = found ? found.greatest - found.least || 1 : 1;
    steps.length = 1;
    for (let power = Math.floor(Math.log10(range / 200)); steps.length < 13; ++power)
        for (const digit of [1, 2, 5]) if (digit * 10 ** power >= range / 200 && steps.length < 13) steps.push(Number((digit * 10 ** power).toPrecision(1)));
}
const interval = () => steps[Number(element("interval").value)] ?? 0;

function tiles(kind) {
    const parameters = new URLSearchParams({ v: mesh.etag });
    if (attribute()) parameters.set("attribute", attribute());
    if (kind !== "terrain" && interval()) parameters.set("contours", interval());
    if (kind === "picture" && attribute()) parameters.set("ramp", element("ramp").value);
    if (kind === "picture" && !element("edges").checked) parameters.set("edges", "no");
    return [`${location.origin}/tiles/${kind}/{z}/{x}/{y}?${parameters}`];
}

const empty = { type: "FeatureCollection", features: [] };
const shapes = ["circle", "star", "neighbour", "simplex", "path", "blocked"];
const colours = { circle: "#b3261e", star: "#7a3e9d", neighbour: "#146c2e", simplex: "#0b57d0", path: "#b3261e", blocked: "#b3261e" };
const of = (kind) => ["==", ["get", "kind"], kind];

const map = new maplibre.Map({
    container: "view",
    attributionControl: false,
    bounds: mesh.lower[0] === null ? undefined : [toMap(mesh.lower), toMap(mesh.upper)],
    fitBoundsOptions: { padding: 20 },
    maxPitch: 80,
    maxZoom: 23,
    transformRequest: (url) => ({ url, headers: sessionHeaders() }),
    style: {
        version: 8,
        sources: {
            picture: { type: "raster", tiles: tiles("picture"), tileSize: 256 },
            vector: { type: "vector", tiles: tiles("vector"), maxzoom: 22 },
            found: { type: "geojson", data: empty },
            ...(mesh.attributes.length && { heights: { type: "raster-dem", encoding: "terrarium", tiles: tiles("terrain"), tileSize: 256 } }),
        },
        layers: [
            { id: "ground", type: "background", paint: { "background-color": "#dfe6e6" } },
            { id: "picture", type: "raster", source: "picture", paint: { "raster-fade-duration": 0 } },
            { id: "edges", type: "line", source: "vector", "source-layer": "triangles", paint: { "line-color": "#1c2a2c", "line-width": 0.6, "line-opacity": 0.6 } },
            { id: "contours", type: "line", source: "vector", "source-layer": "contours", paint: { "line-color": "#5c3b12", "line-width": 1.2 } },
            { id: "hull", type: "line", source: "vector", "source-layer": "hull", paint: { "line-color": "#1c2a2c", "line-width": 1.5 } },
            { id: "vertices", type: "circle", source: "vector", "source-layer": "vertices", paint: { "circle-radius": 1.6, "circle-color": "#1c2a2c" } },
            { id: "fill", type: "fill", source: "found", filter: of("simplex"), paint: { "fill-color": colours.simplex, "fill-opacity": 0.25 } },
            ...shapes.map((kind) => ({ id: `found-${kind}`, type: "line", source: "found", filter: of(kind), paint: { "line-color": colours[kind], "line-width": kind === "simplex" ? 3 : 2 } })),
            { id: "places", type: "circle", source: "found", filter: of("place"), paint: { "circle-radius": 4, "circle-color": "#b3261e", "circle-stroke-width": 1, "circle-stroke-color": "#fff" } },
        ],
    },
});
map.addControl(new maplibre.NavigationControl({ visualizePitch: true }));
map.getCanvas().setAttribute("aria-label", "Map of the mesh. Press Enter to use the tool at the middle of the map. Once a triangle is shown, the arrow keys walk to its neighbours. Press Escape to start again.");
map.on("error", ({ error }) => (error?.status === 410 ? stillThere() : say(error?.message ?? "A tile could not be loaded.", "error")));

const feature = (kind, type, coordinates) => ({ type: "Feature", properties: { kind }, geometry: { type, coordinates } });
const ring = (kind, corners) => feature(kind, "Polygon", [[...corners, corners[0]].map(toMap)]);
const places = (points) => points.map((p) => feature("place", "Point", toMap(p)));
const show = (features) => map.getSource("found").setData({ type: "FeatureCollection", features });

async function refresh() {
    mesh = await ask("info");
    for (const [name, kind] of [["picture", "picture"], ["vector", "vector"], ["heights", "terrain"]]) map.getSource(name)?.setTiles(tiles(kind));
    element("interval-value").textContent = interval() || "off";
    element("summary").textContent = `${counted(mesh.simplices, "triangle")}, ${counted(mesh.vertices, "vertex", "vertices")}`;
}

// ---- Tools -------------------------------------------------------------------------------------

let found = null, path = [], moved = null;

function clear() {
    found = moved = null;
    path = [];
    element("chart").hidden = true;
    offerWalk(null);
    show([]);
}

function draw() {
    const features = places([found.place]);
    if (found.simplex) {
        const { center, radius } = circumsphere(found.simplex.corners);
        const circle = Array.from({ length: 96 }, (_, i) => [center[0] + radius * Math.cos((i * Math.PI) / 48), center[1] + radius * Math.sin((i * Math.PI) / 48)]);
        features.push(ring("circle", circle), ...found.neighbours.filter(Boolean).map((one) => ring("neighbour", one.corners)), ring("simplex", found.simplex.corners));
    }
    show(features);
}

async function locate([x, y]) {
    found = await ask("locate", { x, y, ...(attribute() && { attribute: attribute() }) });
    draw();
    say(describe(found, "triangle"));
    offerWalk(found, walk);
}

const walk = (facet) => answering(async () => {
    const next = found?.neighbours[facet];
    if (!next) return say("There is no triangle beyond this edge: it is on the boundary of the mesh or on a fault.");
    await locate(centroid(next.corners));
    if (!map.getBounds().contains(toMap(found.place))) map.panTo(toMap(found.place));
});

async function profile(place) {
    path.push(place);
    show([...places(path), ...(path.length > 1 ? [feature("path", "LineString", path.map(toMap))] : [])]);
    if (path.length < 2) return say("Start of the line. Click the next point.");
    const rows = await ask("profile", { path: path.flat().join(","), ...(attribute() && { attribute: attribute() }) });
    const { picture, details, words } = chart(rows, attribute());
    element("chart").replaceChildren(picture, details);
    element("chart").hidden = false;
    show([feature("path", "LineString", path.map(toMap)), ...places(rows.filter((row) => row.value !== null).map((row) => [row.x, row.y]))]);
    say(`${words}. Click to extend the line; press Escape to start again.`);
}

async function sight(place) {
    if (path.length === 2) path = [];
    path.push(place);
    show(places(path));
    if (path.length < 2) return say("Observer set. Now click the target.");
    const seen = await ask("sight", { from: path[0].join(","), to: path[1].join(","), observer: element("observer").value || 0, target: element("target").value || 0,
        ...(attribute() && { attribute: attribute() }) });
    const block = seen?.x === null || seen?.x === undefined ? [] : [[seen.x, seen.y]];
    show([...places([...path, ...block]), feature(seen?.visible ? "path" : "blocked", "LineString", path.map(toMap))]);
    say(table([["observer", path[0].map(number).join(", ")], ["target", path[1].map(number).join(", ")],
        ["line of sight", seen?.visible === true ? "the target is visible" : seen?.visible === false ? "the target is not visible" : "unknown: a place is outside the mesh"],
        ...(block.length ? [["blocked at", `${block[0].map(number).join(", ")}, height ${number(seen.z)}`]] : [])]));
}

/** The triangles around a place: all of a vertex. */
async function showStar([x, y], words, what = "it") {
    const star = await ask("star", { x, y });
    await refresh();
    show([...star.map((one) => ring("star", one.corners)), ...places([[x, y]])]);
    say(`${words} ${surround(counted(star.length, "triangle"), star.length, what)}`);
}

const nearest = async ([x, y]) => {
    const answer = await ask("locate", { x, y, ...(attribute() && { attribute: attribute() }) });
    if (!answer.nearest) throw new Error("the mesh has no vertices");
    return answer.nearest;
};
const editors = {
    async insert(place) {
        const id = element("id").value;
        await change("insert", { id, at: place });
        await showStar(place, `Point ${id} added.`);
    },
    async remove(place) {
        const vertex = await nearest(place);
        await change("remove", { id: vertex.vertex, at: [vertex.x, vertex.y] });
        await showStar([vertex.x, vertex.y], `Point ${vertex.vertex} deleted.`, "its place");
    },
    async move(place) {
        if (!moved) {
            moved = await nearest(place);
            show(places([[moved.x, moved.y]]));
            return say(`Point ${moved.vertex} selected. Click its new place.`);
        }
        const vertex = moved;
        moved = null;
        await change("move", { id: vertex.vertex, at: [vertex.x, vertex.y], to: place, values: vertex.attributes ?? undefined });
        await showStar(place, `Point ${vertex.vertex} moved.`);
    },
};
const tools = { locate, profile, sight, ...editors };
const use = (place) => answering(() => tools[tool()](place));

// ---- Events ------------------------------------------------------------------------------------

map.on("click", ({ lngLat }) => use(toMesh(lngLat)));
element("tools").addEventListener("submit", (event) => {
    event.preventDefault();
    const place = [element("x"), element("y")].map((input) => input.valueAsNumber);
    if (place.some(Number.isNaN)) return say("x and y must be numbers.", "error");
    use(place);
});
element("tools").addEventListener("change", ({ target }) => {
    if (target.name === "tool") answering(async () => (clear(), say("Click a place.")));
});
const arrows = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
map.getCanvas().addEventListener("keydown", (event) => {
    if (event.key === "Enter") use(toMesh(map.getCenter()));
    else if (event.key === "Escape") clear();
    else if (arrows[event.key] && found?.simplex && !event.shiftKey) {
        // To the neighbour that lies most in this direction.
        const from = centroid(found.simplex.corners), [dx, dy] = arrows[event.key];
        const turns = found.neighbours.map((one) => {
            if (!one) return -2;
            const to = centroid(one.corners), x = to[0] - from[0], y = to[1] - from[1];
            return (x * dx + y * dy) / Math.hypot(x, y);
        });
        walk(turns.indexOf(Math.max(...turns)));
    } else return;
    event.preventDefault();
    event.stopImmediatePropagation();
}, { capture: true });
for (const id of ["attribute", "ramp", "edges", "interval"])
    element(id).addEventListener("change", () => answering(async () => {
        if (id === "attribute") setSteps();
        await refresh();
    }));
element("interval").addEventListener("input", () => { element("interval-value").textContent = interval() || "off"; });
element("relief").addEventListener("change", ({ target }) => {
    // Heights are in units of the mesh; the map counts metres of the earth.
    const scale = world ? (2 * half) / world[2] : 1;
    map.setTerrain(target.checked && map.getSource("heights") ? { source: "heights", exaggeration: scale } : null);
    map.easeTo({ pitch: target.checked ? 60 : 0 });
});

element("name").textContent = `Mesh ${mesh.name}`;
document.title = `${mesh.name} – Abacus`;
element("attribute").append(...mesh.attributes.map((one) => new Option(one.name)));
setSteps();
if (mesh.edit) setUpEditing(async () => (clear(), refresh()));
if (!map.isStyleLoaded()) await map.once("style.load");
await refresh();
map.on("idle", () => element("view").setAttribute("data-ready", "true"));
map.on("dataloading", () => element("view").removeAttribute("data-ready"));
