// The scene of a mesh in space: camera, light, the box around the mesh with its axes, and objects by name.
import * as three from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { mergeVertices } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import { element, essential, made } from "./common.js";
import { plain } from "./numbers.js";
import { ask } from "./requests.js";

export let mesh = await essential(() => ask("info"));
export const reread = async () => { mesh = await ask("info"); };
export const isEmpty = mesh.lower[0] === null;
export const isFlat = mesh.dimension === 2;

// ---- Coordinates: the mesh is moved and scaled to a box of side 2 around 0 --------------------

const [lower, upper] = [mesh.lower, mesh.upper].map((place, i) => (isEmpty ? [i, i, i] : isFlat ? [...place, 0] : place));
export const corners = { lower, upper };
export const middle = lower.map((x, i) => (x + upper[i]) / 2);
export const extent = lower.map((x, i) => upper[i] - x);
const scale = 2 / Math.max(...extent);
const least = 0.2; // of the width: a mesh that is flatter is shown higher than it is, unless that is changed
const flatness = extent[2] / Math.max(extent[0], extent[1]);
let height = !isFlat && flatness > 0 && flatness < least ? Number(((least * 1.5) / flatness).toPrecision(2)) : 1;
export const exaggeration = () => height;
export const exaggerate = (factor) => { height = factor; };
/** Whether a cut from west to east shows more than a map. */
export const isLow = flatness * height < 0.45;

export const scales = () => [scale, scale, scale * height];
export const toScene = (p) => p.map((x, i) => (x - middle[i]) * scales()[i]);
export const toMesh = (v) => [v.x, v.y, v.z].map((x, i) => x / scales()[i] + middle[i]);

// ---- The scene ---------------------------------------------------------------------------------

const view = element("view");
const renderer = new three.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
renderer.localClippingEnabled = true;
export const canvas = renderer.domElement;
canvas.tabIndex = 0;
canvas.setAttribute("role", "application");
canvas.setAttribute("aria-label", isFlat ? "The quadtree. Press Enter to use the tool in the middle."
    : "The mesh in space. Press Enter to use the tool at the middle of the plane, 1 to 4 to walk across the facets of a tetrahedron, Page Up or Page Down to move the plane.");
view.append(canvas);
const scene = new three.Scene();
export const dark = matchMedia("(prefers-color-scheme: dark)");
/** Colours of what has none of its own, on a light ground and on a dark one. */
export const theme = () => (dark.matches ? { ground: [0x1b2426, 0x0c1112], outline: 0x5d6a6d, body: 0x7d898c } : { ground: [0xf4f6f5, 0xd5dddb], outline: 0x93a0a1, body: 0xbab6ae });

/** The ground: lighter above. */
export function paintGround() {
    const picture = document.createElement("canvas"), context = picture.getContext("2d");
    [picture.width, picture.height] = [2, 256];
    const gradient = context.createLinearGradient(0, 0, 0, 256);
    theme().ground.forEach((colour, i) => gradient.addColorStop(i, `#${colour.toString(16).padStart(6, "0")}`));
    context.fillStyle = gradient;
    context.fillRect(0, 0, 2, 256);
    scene.background?.dispose?.();
    scene.background = Object.assign(new three.CanvasTexture(picture), { colorSpace: three.SRGBColorSpace });
    render();
}

export const camera = new three.PerspectiveCamera(34, 1, 0.01, 100);
export const controls = new OrbitControls(camera, canvas);
const home = isFlat ? new three.Vector3(0, 0, 3) : new three.Vector3(1.5, -3.3, 2.1);
camera.up.set(0, isFlat ? 1 : 0, isFlat ? 0 : 1);
if (isFlat) Object.assign(controls, { enableRotate: false, mouseButtons: { LEFT: three.MOUSE.PAN, MIDDLE: three.MOUSE.DOLLY, RIGHT: three.MOUSE.PAN }, touches: { ONE: three.TOUCH.PAN, TWO: three.TOUCH.DOLLY_PAN } });
scene.add(new three.AmbientLight(0xffffff, 2.1));
const sun = new three.DirectionalLight(0xffffff, 1.4);
sun.position.set(-1.2, 1.6, 2);
camera.add(sun);
scene.add(camera);

/** The whole mesh from the place where the page begins; in a narrow window from farther away. */
export function fit() {
    const size = extent.map((x, i) => x * scales()[i]), radius = Math.hypot(...size) / 2 || 1;
    const half = Math.tan((camera.fov * Math.PI) / 360) * Math.min(camera.aspect * 0.92, 0.92);
    const far = isFlat ? Math.max(size[0] / 2 / camera.aspect, size[1] / 2) / Math.tan((camera.fov * Math.PI) / 360) * 1.25 : (radius / half) * (camera.aspect < 1 ? 1.04 : 0.88);
    camera.position.copy(home).setLength(far);
    controls.target.set(0, 0, 0);
    controls.update();
    render();
}

let isWaiting = false;
/** Draws the scene with the next frame of the browser, however often it is called. */
export function render() {
    if (isWaiting) return;
    isWaiting = true;
    requestAnimationFrame(() => {
        isWaiting = false;
        renderer.render(scene, camera);
        placeNames();
    });
}
controls.addEventListener("change", render);
let hasSize = false;
new ResizeObserver(() => {
    renderer.setSize(view.clientWidth, view.clientHeight);
    camera.aspect = view.clientWidth / Math.max(view.clientHeight, 1);
    camera.updateProjectionMatrix();
    if (!hasSize) fit();
    hasSize = true;
    render();
}).observe(view);

// ---- Objects -----------------------------------------------------------------------------------

export const objects = {};
/** Puts an object in the place of the last one of its name. */
export function put(name, object) {
    if (objects[name]) {
        scene.remove(objects[name]);
        objects[name].traverse((one) => (one.geometry?.dispose(), one.material?.map?.dispose(), one.material?.dispose()));
    }
    objects[name] = object;
    if (object) scene.add(object);
    render();
}

/** Triangles of places of the scene; `uvs` are their colours, places on a palette. */
export function geometry(positions, uvs, triangles) {
    const made = new three.BufferGeometry();
    made.setAttribute("position", new three.Float32BufferAttribute(positions, 3));
    if (uvs) made.setAttribute("uv", new three.Float32BufferAttribute(uvs, 2));
    if (triangles) made.setIndex(triangles);
    return made;
}
/** The same with a normal for each place that triangles share, so that a surface looks smooth. */
export function smooth(positions) {
    const joined = mergeVertices(geometry(positions), 1e-7);
    joined.computeVertexNormals();
    return joined;
}
export const lines = (corners, color, more = {}) => new three.LineSegments(geometry(corners.flatMap(toScene)), new three.LineBasicMaterial({ color, ...more }));
/** Lines of an answer, which are seen through everything. */
export function marks(corners, color) {
    const made = lines(corners, color, { depthTest: false, transparent: true });
    made.renderOrder = 10;
    return made;
}
export function dots(places, color) {
    const made = new three.Points(geometry(places.flatMap(toScene)), new three.PointsMaterial({ color, size: 9, sizeAttenuation: false, depthTest: false, transparent: true }));
    made.renderOrder = 11;
    return made;
}
export const edges = (corners) => corners.flatMap((p, i) => corners.slice(i + 1).flatMap((q) => [p, q]));
/** The edges of a box: of each pair of its corners that differ on one axis. */
export function box(lower, upper) {
    const all = Array.from({ length: 8 }, (_, i) => [0, 1, 2].map((k) => (i & (1 << k) ? upper : lower)[k]));
    return all.flatMap((p, i) => [1, 2, 4].filter((k) => !(i & k)).flatMap((k) => [p, all[i | k]]));
}

// ---- Names of the axes, at three edges of the box ------------------------------------------------

/** Names at the ends stand a little inwards, since two edges meet there. */
const inset = (share) => 0.04 + share * 0.92;
/** Of each axis its least and greatest coordinate, and its name between. */
const names = isEmpty ? [] : [0, 1, 2].slice(0, isFlat ? 2 : 3).flatMap((axis) => [0, 0.5, 1].map((share) => {
    const place = [axis === 2 ? lower[0] : upper[0], lower[1], lower[2]]; // the edges in front and to the right below, and to the left
    place[axis] = lower[axis] + inset(share) * extent[axis];
    const text = share === 0.5 ? "xyz"[axis] : plain(lower[axis] + share * extent[axis], extent[axis]).toLocaleString("en", { maximumFractionDigits: 12 });
    const node = made("span", { class: share === 0.5 ? "axis" : "axis end", "aria-hidden": "true" }, text);
    view.append(node);
    return { node, place, axis };
}));
function placeNames() {
    const { clientWidth: width, clientHeight: height } = view, centre = new three.Vector3(0, 0, 0).project(camera);
    for (const { node, place, axis } of names) {
        const at = new three.Vector3(...toScene(place)).project(camera);
        // a little away from the edge, outwards
        const side = new three.Vector3(...toScene(middle.map((x, i) => (i === axis ? x : place[i])))).project(camera);
        const away = new three.Vector2((side.x - centre.x) * width, (centre.y - side.y) * height).normalize().multiplyScalar(20);
        node.style.transform = `translate(${(at.x + 1) * width / 2 + away.x}px, ${(1 - at.y) * height / 2 + away.y}px) translate(-50%, -50%)`;
        node.hidden = at.z > 1;
    }
}
paintGround();
