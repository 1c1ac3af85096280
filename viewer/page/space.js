// A mesh in space: its hull, a plane through it that can be dragged, a surface of one value, and
// what is at a place or along a ray.
import * as three from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { answering, centroid, counted, describe, element, made, number, offerWalk, say, setUpPanels, surround, table, tool } from "./common.js";
import { change, setUpEditing } from "./editing.js";
import { placeIcons } from "./icons.js";
import { drawLegend } from "./legend.js";
import { stops } from "./palette.js";
import { ask } from "./requests.js";

let mesh = await ask("info");

// ---- Coordinates: the mesh is moved and scaled to a box of side 2 around 0 --------------------

const middle = mesh.lower.map((x, i) => (x + mesh.upper[i]) / 2);
const scale = 2 / Math.max(...mesh.upper.map((x, i) => x - mesh.lower[i]));
const toScene = (p) => p.map((x, i) => (x - middle[i]) * scale);
const toMesh = (v) => [v.x, v.y, v.z].map((x, i) => x / scale + middle[i]);

// ---- The scene ---------------------------------------------------------------------------------

const view = element("view");
const renderer = new three.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
const canvas = renderer.domElement;
canvas.tabIndex = 0;
canvas.setAttribute("role", "application");
canvas.setAttribute("aria-label", "The mesh in space. Press Enter to use the tool at the middle of the plane, 1 to 4 to walk across the facets of a tetrahedron, Page Up or Page Down to move the plane.");
view.append(canvas);
const scene = new three.Scene();
const dark = matchMedia("(prefers-color-scheme: dark)");
/** Colours of what has none of its own, on a light ground and on a dark one. */
const theme = () => (dark.matches ? { ground: 0x12181a, outline: 0x5d6a6d } : { ground: 0xe8ecea, outline: 0x8a9799 });
scene.background = new three.Color(theme().ground);
const camera = new three.PerspectiveCamera(40, 1, 0.01, 100);
camera.up.set(0, 0, 1);
camera.position.set(1.8, -3.2, 2.2);
const controls = new OrbitControls(camera, canvas);
controls.listenToKeyEvents(canvas);
scene.add(new three.HemisphereLight(0xffffff, 0x8d8d8d, 3));
const render = () => renderer.render(scene, camera);
controls.addEventListener("change", render);
new ResizeObserver(() => {
    renderer.setSize(view.clientWidth, view.clientHeight);
    camera.aspect = view.clientWidth / view.clientHeight;
    camera.updateProjectionMatrix();
    render();
}).observe(view);

/** Puts an object in the place of the last one of its name. */
const objects = {};
function put(name, object) {
    if (objects[name]) {
        scene.remove(objects[name]);
        objects[name].traverse((one) => (one.geometry?.dispose(), one.material?.dispose()));
    }
    objects[name] = object;
    if (object) scene.add(object);
    render();
}
function geometry(positions, colours) {
    const made = new three.BufferGeometry();
    made.setAttribute("position", new three.Float32BufferAttribute(positions, 3));
    if (colours) made.setAttribute("color", new three.Float32BufferAttribute(colours, 3));
    made.computeVertexNormals();
    return made;
}
const lines = (corners, color) => new three.LineSegments(geometry(corners.flatMap(toScene)), new three.LineBasicMaterial({ color }));
const edges = (corners) => corners.flatMap((p, i) => corners.slice(i + 1).flatMap((q) => [p, q]));

// ---- Values as colours -------------------------------------------------------------------------

const palette = stops("space").map((rgb) => new three.Color(rgb));
const attribute = () => mesh.attributes.find((one) => one.name === element("attribute").value);
function colour(value) {
    const range = attribute();
    if (value === null || value === undefined || !range) return new three.Color(0xbab6ae);
    const t = Math.min(Math.max((value - range.least) / (range.greatest - range.least || 1), 0), 1) * (palette.length - 1);
    const i = Math.min(Math.floor(t), palette.length - 2);
    return palette[i].clone().lerp(palette[i + 1], t - i);
}
const named = (parameters) => ({ ...parameters, ...(attribute() && { attribute: attribute().name }) });

// ---- The hull, the plane, the surface ----------------------------------------------------------

/** The edges of the box around the mesh: of each pair of its corners that differ on one axis. */
function box() {
    const corners = Array.from({ length: 8 }, (_, i) => [0, 1, 2].map((k) => (i & (1 << k) ? mesh.upper : mesh.lower)[k]));
    return corners.flatMap((p, i) => [1, 2, 4].filter((k) => !(i & k)).flatMap((k) => [p, corners[i | k]]));
}
async function hull() {
    const corners = (await ask("hull"))?.map((row) => [row.x, row.y, row.z]);
    put("hull", lines(corners ? corners.flatMap((p, i) => [p, corners[i % 3 === 2 ? i - 2 : i + 1]]) : box(), theme().outline));
    view.dataset.outline = corners ? "hull" : "box";
}

const axis = () => Number(element("axis").value);
const share = () => Number(element("cut").value) / 1000;
const at = () => mesh.lower[axis()] + share() * (mesh.upper[axis()] - mesh.lower[axis()]);

async function section() {
    const normal = [0, 0, 0], through = [...middle];
    normal[axis()] = 1;
    through[axis()] = at();
    const polygons = await ask("section", named({ through: through.join(","), normal: normal.join(",") }));
    const positions = [], colours = [], outlines = [];
    for (const { polygon, values } of polygons) {
        const corners = Array.from({ length: polygon.length / 3 }, (_, i) => polygon.slice(3 * i, 3 * i + 3));
        for (let i = 1; i + 1 < corners.length; ++i)
            for (const k of [0, i, i + 1]) {
                positions.push(...toScene(corners[k]));
                colours.push(...colour(values?.[k]).toArray());
            }
        corners.forEach((p, i) => outlines.push(p, corners[(i + 1) % corners.length]));
    }
    const plane = new three.Group();
    plane.add(new three.Mesh(geometry(positions, colours), new three.MeshBasicMaterial({ vertexColors: true, side: three.DoubleSide })));
    if (polygons.length < 50_000) plane.add(lines(outlines, 0x4a4f50));
    put("section", plane);
    view.dataset.polygons = polygons.length;
    return polygons.length;
}

async function surface() {
    const range = attribute(), step = Number(element("level").value);
    if (!range || step === 0) {
        element("level-value").textContent = "off";
        return put("surface", null);
    }
    const value = range.least + (step / 1000) * (range.greatest - range.least);
    element("level-value").textContent = number(value);
    const triangles = await ask("isosurface", named({ value }));
    put("surface", new three.Mesh(geometry(triangles.flatMap((row) => row.corners.flatMap(toScene))),
        new three.MeshLambertMaterial({ color: colour(value), side: three.DoubleSide })));
    view.dataset.triangles = triangles.length;
    say(`The surface at ${range.name} = ${number(value)} has ${counted(triangles.length, "triangle")}.`);
}

/** One request at a time; of those that come meanwhile the last. */
function latest(task) {
    let isBusy = false, isAsked = false;
    return async () => {
        isAsked = true;
        if (isBusy) return;
        isBusy = true;
        while (isAsked) {
            isAsked = false;
            await answering(task);
        }
        isBusy = false;
    };
}
const cutAgain = latest(section), surfaceAgain = latest(surface);
function moveTo(value) {
    element("cut").value = Math.min(Math.max(Math.round(value), 0), 1000);
    element("cut-value").textContent = `${"xyz"[axis()]} = ${number(at())}`;
    cutAgain();
}

// ---- Tools -------------------------------------------------------------------------------------

let found = null, moved = null;

async function locate(place) {
    found = await ask("locate", named({ x: place[0], y: place[1], z: place[2] }));
    const group = new three.Group();
    for (const one of found.neighbours) if (one) group.add(lines(edges(one.corners), 0x146c2e));
    if (found.simplex) group.add(lines(edges(found.simplex.corners), 0x0b57d0));
    put("found", group);
    say(describe(found, "tetrahedron", mesh.attributes.map((one) => one.name), element("unit").value));
    offerWalk(found, walk);
}
const walk = (facet) => answering(async () => {
    const next = found?.neighbours[facet];
    if (!next) return say("There is no tetrahedron beyond this facet: it is on the boundary of the mesh or on a fault.");
    await locate(centroid(next.corners));
});

async function ray(place, from) {
    const direction = place.map((x, i) => x - from[i]);
    const rows = await ask("ray", { origin: from.join(","), direction: direction.join(",") });
    const end = (t) => from.map((x, i) => x + t * direction[i]);
    const inside = rows.reduce((sum, row) => sum + row.leaves - row.enters, 0) * Math.hypot(...direction);
    put("found", rows.length ? lines(rows.flatMap((row) => [end(row.enters), end(row.leaves)]), 0xb3261e) : null);
    offerWalk(null);
    say([made("p", {}, `The ray crosses ${counted(rows.length, "tetrahedron", "tetrahedra")}; its length inside the mesh is ${number(inside)}.`),
        ...(rows.length ? [table(rows.slice(0, 12).map((row) => [row.enters.toPrecision(5), row.leaves.toPrecision(5), [row.v0, row.v1, row.v2, row.v3].join(" ")]), ["enters", "leaves", "tetrahedron"])] : [])]);
}

async function nearest([x, y, z]) {
    const { nearest: vertex } = await ask("locate", named({ x, y, z }));
    if (!vertex) throw new Error("the mesh has no vertices");
    return { ...vertex, at: [vertex.x, vertex.y, vertex.z] };
}

async function showStar(place, words, what = "it") {
    const star = await ask("star", { x: place[0], y: place[1], z: place[2] });
    mesh = await ask("info");
    await Promise.all([section(), hull()]);
    put("found", lines(star.flatMap((one) => edges(one.corners)), 0x7a3e9d));
    say(`${words} ${surround(counted(star.length, "tetrahedron", "tetrahedra"), star.length, what)}`);
}
const editors = {
    async insert(place) {
        const id = element("id").value;
        await change("insert", { id, at: place });
        await showStar(place, `Point ${id} added.`);
    },
    async remove(place) {
        const vertex = await nearest(place);
        await change("remove", { id: vertex.vertex, at: vertex.at });
        await showStar(vertex.at, `Point ${vertex.vertex} deleted.`, "its place");
    },
    async move(place) {
        if (!moved) {
            moved = await nearest(place);
            return say(`Point ${moved.vertex} selected. Click its new place.`);
        }
        const vertex = moved;
        moved = null;
        await change("move", { id: vertex.vertex, at: vertex.at, to: place, values: vertex.attributes ?? undefined });
        await showStar(place, `Point ${vertex.vertex} moved.`);
    },
};
const use = (place, from = toMesh(camera.position)) => answering(() => ({ locate, ray, ...editors })[tool()](place, from));

// ---- Events ------------------------------------------------------------------------------------

const caster = new three.Raycaster();
/** Where the pointer is on the plane, in the scene. */
function hit(event) {
    const box = canvas.getBoundingClientRect();
    caster.setFromCamera(new three.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2), camera);
    return objects.section && caster.intersectObject(objects.section.children[0])[0]?.point;
}

let drag = null;
canvas.addEventListener("pointerdown", (event) => {
    const point = event.button === 0 ? hit(event) : null;
    drag = { x: event.clientX, y: event.clientY, share: Number(element("cut").value), point, isMove: false };
    if (!point) return;
    controls.enabled = false; // the plane is taken, not the view
    canvas.setPointerCapture(event.pointerId);
    // What a step of the plane looks like on the screen.
    const step = point.clone();
    step.setComponent(axis(), step.getComponent(axis()) + 0.1);
    const a = point.clone().project(camera), b = step.project(camera);
    drag.way = new three.Vector2((b.x - a.x) * canvas.clientWidth, (a.y - b.y) * canvas.clientHeight).multiplyScalar(5);
}, { capture: true });
canvas.addEventListener("pointermove", (event) => {
    if (!drag) return;
    const moved = new three.Vector2(event.clientX - drag.x, event.clientY - drag.y);
    drag.isMove ||= moved.length() > 4;
    if (!drag.point || !drag.isMove || drag.way.lengthSq() === 0) return;
    const extent = (mesh.upper[axis()] - mesh.lower[axis()]) * scale;
    moveTo(drag.share + ((moved.dot(drag.way) / drag.way.lengthSq()) / extent) * 1000);
});
addEventListener("pointerup", () => {
    if (drag?.point && !drag.isMove) use(toMesh(drag.point));
    drag = null;
    controls.enabled = true;
});
canvas.addEventListener("keydown", (event) => {
    const middleOfPlane = [...middle];
    middleOfPlane[axis()] = at();
    if (event.key === "Enter") use(middleOfPlane);
    else if (/^[1-4]$/.test(event.key)) walk(Number(event.key) - 1);
    else if (event.key === "PageUp" || event.key === "PageDown") moveTo(Number(element("cut").value) + (event.key === "PageUp" ? 20 : -20));
    else return;
    event.preventDefault();
});
element("tools").addEventListener("submit", (event) => event.preventDefault());
element("go").addEventListener("submit", (event) => {
    event.preventDefault();
    const place = ["x", "y", "z"].map((id) => element(id).valueAsNumber);
    if (place.some(Number.isNaN)) return say("x, y and z must be numbers.", "error");
    use(place);
});
element("tools").addEventListener("change", ({ target }) => {
    if (target.name !== "tool") return;
    moved = null;
    say("Click a place on the plane.");
});
element("cut").addEventListener("input", () => moveTo(Number(element("cut").value)));
element("axis").addEventListener("change", () => moveTo(500));
element("level").addEventListener("input", surfaceAgain);
element("attribute").addEventListener("change", () => (legend(), cutAgain(), surfaceAgain()));
element("unit").addEventListener("input", legend);
dark.addEventListener("change", () => {
    scene.background = new three.Color(theme().ground);
    answering(hull);
});

function legend() {
    const range = attribute();
    document.body.classList.toggle("bare", !range);
    if (range) drawLegend({ name: range.name, unit: element("unit").value, palette: "space", range: [range.least, range.greatest > range.least ? range.greatest : range.least + 1] });
}

placeIcons();
setUpPanels();
element("name").textContent = mesh.name;
document.title = `${mesh.name} – Abacus`;
element("summary").textContent = `${counted(mesh.simplices.toLocaleString("en"), "tetrahedron", "tetrahedra")}, ${counted(mesh.vertices.toLocaleString("en"), "vertex", "vertices")}`;
element("attribute").append(...mesh.attributes.map((one) => new Option(one.name)));
legend();
if (mesh.edit) setUpEditing(async () => { mesh = await ask("info"); put("found", null); await Promise.all([section(), hull()]); });
say("Click a place on the plane.");
await answering(hull);
element("cut-value").textContent = `${"xyz"[axis()]} = ${number(at())}`;
await answering(section);
view.dataset.ready = "true";
