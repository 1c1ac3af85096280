// The page of a mesh in space, an octree or a quadtree: its tools and settings.
import * as three from "three";
import { answering, centroid, counted, describe, element, made, number, offerWalk, openPanel, say, setUpPanels, surround, table, tool } from "./common.js";
import { label, legend, named, readLabel } from "./colouring.js";
import { change, setUpEditing } from "./editing.js";
import { placeIcons } from "./icons.js";
import { plain } from "./numbers.js";
import { locateLeaf } from "./octant.js";
import { point } from "./pointer.js";
import { camera, canvas, controls, dark, dots, edges, exaggerate, exaggeration, fit, isEmpty, isFlat, isLow, marks, mesh, objects, paintGround, put, reread, scales, toMesh } from "./scene.js";
import { setUpSeries } from "./series.js";
import { at, axis, body, isCutAway, latest, length, lookCloser, normal, pickable, placeOnPlane, section, surface, turn } from "./solid.js";
import { ask } from "./requests.js";

const view = element("view");
const colours = { simplex: 0xd6246e, neighbour: 0x1c2a2c, ray: 0xb3261e, star: 0x7a3e9d };
const isOctree = mesh.kind === "octree";
const first = isEmpty ? "The mesh has no tetrahedra yet." : "Click a place.";

const bodyAgain = latest(body), cutAgain = latest(section), surfaceAgain = latest(surface);
const all = () => Promise.all([bodyAgain(), cutAgain(), surfaceAgain()]);

function writeCut() {
    element("cut-value").textContent = `${axis() < 3 ? `${"xyz"[axis()]} = ` : ""}${plain(at(), length())}`;
    for (const id of ["direction", "dip"]) {
        element(id).parentElement.hidden = axis() < 3;
        element(`${id}-value`).textContent = `${element(id).value}°`;
    }
}
function moveTo(value) {
    element("cut").value = Math.min(Math.max(Math.round(value), 0), 1000);
    writeCut();
    return cutAgain();
}

// ---- Tools -------------------------------------------------------------------------------------

let found = null, moved = null;

async function locate(place) {
    if (isOctree) return locateLeaf(place);
    found = await ask("locate", named({ x: place[0], y: place[1], z: place[2] }));
    const group = new three.Group();
    for (const one of found.neighbours) if (one) group.add(marks(edges(one.corners), colours.neighbour));
    if (found.simplex) group.add(marks(edges(found.simplex.corners), colours.simplex));
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
    put("found", rows.length ? marks(rows.flatMap((row) => [end(row.enters), end(row.leaves)]), colours.ray) : null);
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
    await reread();
    await Promise.all([section(), body()]);
    put("found", marks(star.flatMap((one) => edges(one.corners)), colours.star));
    say(`${words} ${surround(counted(star.length, "tetrahedron", "tetrahedra"), star.length, what)}`);
}
const editors = {
    async insert(place) {
        const id = element("id").value;
        const words = `Point ${id} added.`;
        await change("insert", { id, at: place }, words);
        await showStar(place, words);
    },
    async remove(place) {
        const vertex = await nearest(place);
        const words = `Point ${vertex.vertex} deleted.`;
        await change("remove", { id: vertex.vertex, at: vertex.at }, words);
        await showStar(vertex.at, words, "its place");
    },
    async move(place) {
        if (!moved) {
            moved = await nearest(place);
            return say(`Point ${moved.vertex} selected. Click its new place.`);
        }
        const vertex = moved, words = `Point ${vertex.vertex} moved.`;
        moved = null;
        await change("move", { id: vertex.vertex, at: vertex.at, to: place, values: vertex.attributes ?? undefined }, words);
        await showStar(place, words);
    },
};
const use = (place, from = toMesh(camera.position)) => answering(() => ({ locate, ray, ...editors })[tool()](place, from));

/** All unsaved changes: dots at points that were added or moved, and at the places of those that were deleted. */
function markChanges(steps) {
    const group = new three.Group();
    for (const [colour, places] of [[0x0a7d4f, steps.filter(({ name }) => name !== "remove").map(({ at, to }) => to ?? at)], [0xc62828, steps.filter(({ name }) => name !== "insert").map(({ at }) => at)]])
        if (places.length) group.add(dots(places, colour));
    put("changes", group);
    view.dataset.changed = steps.length;
}

/** Forgets what has been asked. */
function forget() {
    found = moved = null;
    put("found", null);
    offerWalk(null);
    openPanel("panel", false);
}

// ---- The pointer -------------------------------------------------------------------------------

const caster = new three.Raycaster(), inside = 1e-3;
/** What is under the pointer and not cut away: a place on the plane, or just behind the surface. */
function hit(event) {
    const box = canvas.getBoundingClientRect();
    caster.setFromCamera(new three.Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2), camera);
    const nearest = caster.intersectObjects(pickable()).find(({ object, point }) => object.isMesh && (object.parent === objects.section || !isCutAway(point)));
    if (!nearest) return null;
    const isOnPlane = nearest.object.parent === objects.section;
    return { isOnPlane, point: isOnPlane || isFlat ? nearest.point : nearest.point.clone().addScaledVector(caster.ray.direction, inside) };
}

let drag = null;
canvas.addEventListener("pointerdown", (event) => {
    const found = event.button === 0 ? hit(event) : null;
    drag = { x: event.clientX, y: event.clientY, share: Number(element("cut").value), point: found?.point, isOfPlane: Boolean(found?.isOnPlane), isMove: false };
    if (!drag.isOfPlane) return;
    controls.enabled = false; // the plane is taken, not the view
    canvas.setPointerCapture(event.pointerId);
    // What a tenth of the way of the plane looks like on the screen.
    const across = normal().map((x, i) => x * scales()[i] * length() * 0.1), step = found.point.clone().add(new three.Vector3(...across));
    const a = found.point.clone().project(camera), b = step.project(camera);
    drag.way = new three.Vector2((b.x - a.x) * canvas.clientWidth, (a.y - b.y) * canvas.clientHeight).multiplyScalar(5);
}, { capture: true });
canvas.addEventListener("pointermove", (event) => {
    if (!drag) return;
    const moved = new three.Vector2(event.clientX - drag.x, event.clientY - drag.y);
    drag.isMove ||= moved.length() > 4;
    if (!drag.isOfPlane || !drag.isMove || drag.way.lengthSq() === 0) return;
    moveTo(drag.share + (moved.dot(drag.way) / drag.way.lengthSq()) * 1000);
});
addEventListener("pointerup", () => {
    if (drag?.point && !drag.isMove) use(toMesh(drag.point).slice(0, mesh.dimension));
    drag = null;
    controls.enabled = true;
});
canvas.addEventListener("pointermove", (event) => {
    const found = event.buttons === 0 ? hit(event)?.point : null;
    point(found ? toMesh(found).slice(0, mesh.dimension) : null);
});
canvas.addEventListener("pointerleave", () => point(null));
canvas.addEventListener("keydown", (event) => {
    if (event.key === "Enter") use(placeOnPlane().slice(0, mesh.dimension));
    else if (event.key === "Escape") forget();
    else if (/^[1-4]$/.test(event.key)) walk(Number(event.key) - 1);
    else if (event.key === "PageUp" || event.key === "PageDown") moveTo(Number(element("cut").value) + (event.key === "PageUp" ? 20 : -20));
    else return;
    event.preventDefault();
});
controls.listenToKeyEvents(canvas);
controls.addEventListener("change", turn);
const closer = latest(lookCloser);
if (isFlat) controls.addEventListener("end", closer);

// ---- Settings ------------------------------------------------------------------------------------

element("tools").addEventListener("submit", (event) => event.preventDefault());
element("go").addEventListener("submit", (event) => {
    event.preventDefault();
    const place = ["x", "y", "z"].slice(0, mesh.dimension).map((id) => element(id).valueAsNumber);
    if (place.some(Number.isNaN)) return say(`${isFlat ? "x and y" : "x, y and z"} must be numbers.`, "error");
    use(place);
});
element("tools").addEventListener("change", ({ target }) => {
    if (target.name !== "tool") return;
    moved = null;
    say(first);
});
element("cut").addEventListener("input", () => moveTo(Number(element("cut").value)));
element("axis").addEventListener("change", () => { moveTo(500); turn(); });
for (const id of ["direction", "dip"]) element(id).addEventListener("input", () => { moveTo(Number(element("cut").value)); turn(); });
element("level").addEventListener("input", surfaceAgain);
for (const id of ["body", "ramp", "mesh-edges"]) element(id).addEventListener("change", all);
const recolour = latest(async () => {
    element("level").disabled = Boolean(label());
    await readLabel();
    legend();
    await all();
});
element("attribute").addEventListener("change", recolour);
element("unit").addEventListener("input", legend);
element("height").addEventListener("input", () => {
    exaggerate(Number((10 ** (Number(element("height").value) / 100)).toPrecision(2)));
    writeHeight();
    put("found", null);
    all();
});
const writeHeight = () => { element("height-value").textContent = `× ${exaggeration().toLocaleString("en")}`; };
element("fit-space").addEventListener("click", () => {
    fit();
    turn();
    if (isFlat) closer();
});
dark.addEventListener("change", () => {
    paintGround();
    answering(all);
});

placeIcons();
setUpPanels();
document.body.classList.toggle("octree", isOctree);
document.body.classList.toggle("flat", isFlat);
document.body.classList.toggle("many", Boolean(mesh.isOneOfMany));
element("name").textContent = mesh.name;
document.title = `${mesh.name} – Abacus`;
element("summary").textContent = isOctree ? `${isFlat ? "Quadtree" : "Octree"} of ${counted(mesh.leaves.toLocaleString("en"), "leaf", "leaves")}`
    : `${counted(mesh.simplices.toLocaleString("en"), "tetrahedron", "tetrahedra")}, ${counted(mesh.vertices.toLocaleString("en"), "vertex", "vertices")}`;
element("attribute").append(...mesh.attributes.map((one) => new Option(one.name)), ...mesh.labels.map((name, i) => new Option(`${name} (label)`, `label ${i}`)));
element("ramp").value = "strata";
element("mesh-edges").checked = isOctree || mesh.simplices < 300_000;
if (isLow && !isFlat) [element("axis").value, element("cut").value] = ["1", "350"];
element("height").value = String(Math.round(100 * Math.log10(exaggeration())));
writeHeight();
setUpSeries(() => mesh.attributes, recolour);
if (mesh.edit) setUpEditing(async () => { await reread(); put("found", null); await all(); }, markChanges);
say(first);
writeCut();
await recolour();
turn();
view.dataset.ready = "true";
