// What is drawn of a mesh in space: its body, cut open by a plane that faces the viewer, the section in that plane, and a
// surface of one value.
import * as three from "three";
import { answering, counted, element, number, say } from "./common.js";
import { attribute, colourOf, colourRange, label, labelAt, named, palette, place } from "./colouring.js";
import { normalOf, rangeAlong, sheetOf } from "./cut.js";
import { box, camera, corners, geometry, isEmpty, isFlat, lines, mesh, middle, objects, put, render, scales, smooth, theme, toScene } from "./scene.js";
import { ask, root, sessionHeaders } from "./requests.js";

const view = element("view");
const mostSimplices = 300_000; // of a mesh whose section is sent as polygons, and not as a picture
const mostLines = 20_000; // triangles of a hull whose edges are drawn; more would hide what is behind them
const isOctree = mesh.kind === "octree";

const free = 3; // the plane is across no axis
export const axis = () => Number(element("axis").value);
const share = () => Number(element("cut").value) / 1000;
export const normal = () => (axis() === free ? normalOf(Number(element("direction").value), Number(element("dip").value)) : [0, 1, 2].map((i) => Number(i === axis())));
/** The least and the greatest distance of the plane along its normal. */
const range = () => rangeAlong(normal(), corners.lower, corners.upper);
export const length = () => range()[1] - range()[0];
/** The coordinate of the plane, or its distance along its normal. */
export const at = () => range()[0] + share() * length();
export function placeOnPlane() {
    if (axis() !== free) return middle.map((x, i) => (i === axis() ? at() : x));
    const n = normal(), away = at() - n.reduce((sum, x, i) => sum + x * middle[i], 0);
    return middle.map((x, i) => x + away * n[i]);
}
const shows = (what) => element("body").value === what;
const hasEdges = () => element("mesh-edges").checked;

// ---- The plane that cuts ---------------------------------------------------------------------------

const clip = new three.Plane();
const clipping = () => (shows("cut") && !isFlat ? [clip] : []);
/** What is between the plane and the viewer is cut away. */
function face() {
    if (isFlat) return;
    const across = new three.Vector3(...normal().map((x, i) => x / scales()[i])).normalize(); // in the scene
    clip.setFromNormalAndCoplanarPoint(across, new three.Vector3(...toScene(placeOnPlane())));
    if (clip.distanceToPoint(camera.position) >= 0) clip.negate();
}
export const isCutAway = (point) => clipping().length > 0 && clip.distanceToPoint(point) < -1e-6;

// ---- Pictures ----------------------------------------------------------------------------------------

async function picture(parameters) {
    const [low, high] = colourRange();
    const search = new URLSearchParams({ ...named({}), ...(attribute() && { low, high, ramp: element("ramp").value }), ...(hasEdges() && { edges: "yes" }), ...parameters });
    const response = await fetch(`${root}pictures/whole?${search}`, { headers: sessionHeaders() });
    if (!response.ok) throw new Error((await response.json().catch(() => ({}))).error ?? "A picture could not be loaded.");
    const texture = new three.Texture(await createImageBitmap(await response.blob(), { imageOrientation: "flipY" }));
    return Object.assign(texture, { colorSpace: three.SRGBColorSpace, flipY: false, anisotropy: 8, needsUpdate: true });
}

/** A rectangle with a picture; its corners are those of the picture, counterclockwise from the one to the left below. */
function sheet(corners, map, { isLit, clippingPlanes = [] } = {}) {
    const made = geometry(corners.flatMap(toScene), [0, 0, 1, 0, 1, 1, 0, 1], [0, 1, 2, 0, 2, 3]);
    made.computeVertexNormals();
    return new three.Mesh(made, new (isLit ? three.MeshLambertMaterial : three.MeshBasicMaterial)({ map, side: three.DoubleSide, alphaTest: 0.5, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1, clippingPlanes }));
}
/** The section by a plane, as a picture in its place; null where it does not meet the box. */
async function sectionSheet(normal, distance, through, material) {
    const found = sheetOf(normal, distance, corners.lower, corners.upper);
    return found && sheet(found.corners, await picture({ through: through.join(","), normal: normal.join(","), shape: [found.width, found.height].join(",") }), material);
}

// ---- The body ----------------------------------------------------------------------------------------

async function outlineOf(triangles, positions) {
    const places = Array.from({ length: positions.length / 3 }, (_, i) => positions.slice(3 * i, 3 * i + 3));
    return triangles.flatMap((corner, i) => [places[corner], places[triangles[i % 3 === 2 ? i - 2 : i + 1]]]);
}

/** The box around the mesh, always; the body in front of the plane is cut away. */
export async function body() {
    if (isEmpty) return;
    put("box", lines(box(corners.lower, corners.upper), theme().outline, { transparent: true, opacity: 0.7 }));
    const group = new three.Group();
    let outline = "box";
    if (isFlat) group.add(await quadtree());
    else {
        const found = isOctree ? { isBox: true } : await ask("body", { ...(attribute() && named({})), ...(label() && { label: label() }) });
        if (found?.isBox && !shows("outline")) {
            const sides = [0, 1, 2].flatMap((axis) => [corners.lower, corners.upper].map((place) => [[0, 1, 2].map((i) => Number(i === axis)), place[axis], place]));
            group.add(...(await Promise.all(sides.map((side) => sectionSheet(...side, { isLit: true, clippingPlanes: clipping() })))).filter(Boolean));
        } else if (found?.triangles) {
            const { triangles } = found, positions = [];
            for (let i = 0; i < found.positions.length; i += 3) positions.push(...toScene(found.positions.slice(i, i + 3)));
            if (!shows("outline")) {
                // Labels belong to triangles, which then share no corner.
                const shape = found.labels ? geometry(triangles.flatMap((corner) => positions.slice(3 * corner, 3 * corner + 3)), triangles.flatMap((_, i) => place(found.labels[Math.floor(i / 3)])))
                    : geometry(positions, Array.from({ length: positions.length / 3 }, (_, i) => place(found.values?.[i])).flat(), triangles);
                group.add(new three.Mesh(shape, new three.MeshLambertMaterial({ map: palette(), side: three.DoubleSide, flatShading: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1, clippingPlanes: clipping() })));
            }
            if (triangles.length <= 3 * mostLines) {
                outline = "hull";
                if (hasEdges() || shows("outline")) group.add(lines(await outlineOf(triangles, found.positions), shows("outline") ? theme().outline : 0x1c2a2c, { transparent: true, opacity: shows("outline") ? 1 : 0.3, clippingPlanes: clipping() }));
            }
        }
    }
    put("body", group);
    view.dataset.outline = outline;
}

// ---- A quadtree, in a picture that is as sharp as the screen -------------------------------------------

let window = null;
async function quadtree() {
    const [lower, upper] = window ?? [corners.lower, corners.upper];
    const [[left, bottom], [right, top]] = [lower, upper];
    return sheet([[left, bottom, 0], [right, bottom, 0], [right, top, 0], [left, top, 0]], await picture({ window: [left, bottom, right, top].join(",") }));
}
/** Reads the part that is on the screen. */
export function lookCloser() {
    const half = Math.tan((camera.fov * Math.PI) / 360) * camera.position.z, size = [half * camera.aspect, half];
    const bounds = [-1, 1].map((side) => [0, 1].map((i) => {
        const x = (camera.position.getComponent(i) + side * size[i]) / scales()[i] + middle[i];
        return Math.min(Math.max(x, corners.lower[i]), corners.upper[i]);
    }));
    const isSeen = bounds[0].every((x, i) => x < bounds[1][i]);
    window = isSeen ? bounds.map((place) => [...place, 0]) : null;
    return body();
}

// ---- The section ---------------------------------------------------------------------------------------

async function polygons() {
    const rows = await ask("section", named({ through: placeOnPlane().join(","), normal: normal().join(",") }));
    const positions = [], uvs = [], outlines = [], ofLabel = labelAt();
    for (const { polygon, values, labels } of rows) {
        const count = polygon.length / 3, at = Array.from({ length: count }, (_, i) => polygon.slice(3 * i, 3 * i + 3)), places = at.map(toScene);
        for (let i = 1; i + 1 < count; ++i)
            for (const k of [0, i, i + 1]) {
                positions.push(...places[k]);
                uvs.push(...place(ofLabel >= 0 ? labels?.[ofLabel] : values?.[k]));
            }
        if (hasEdges()) at.forEach((p, i) => outlines.push(p, at[(i + 1) % count]));
    }
    const group = new three.Group();
    group.add(new three.Mesh(geometry(positions, uvs), new three.MeshBasicMaterial({ map: palette(), side: three.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 })));
    if (outlines.length > 0 && rows.length < 50_000) group.add(lines(outlines, 0x1c2a2c, { transparent: true, opacity: 0.35 }));
    view.dataset.polygons = rows.length;
    return group;
}

/** Of a large mesh and of an octree the section is a picture; polygons of labels have colours that no palette has. */
export async function section() {
    if (isFlat || isEmpty) return;
    if (shows("whole")) {
        put("section", null);
        return;
    }
    const isPicture = isOctree || (mesh.simplices > mostSimplices && !label());
    const made = isPicture ? new three.Group().add(...[await sectionSheet(normal(), at(), placeOnPlane())].filter(Boolean)) : await polygons();
    view.dataset.section = isPicture ? "picture" : "polygons";
    put("section", made);
    turn();
}

/** After each move of the camera or the plane. */
export function turn() {
    face();
    render();
}

// ---- A surface of one value ------------------------------------------------------------------------------

export async function surface() {
    const chosen = attribute(), step = Number(element("level").value);
    if (!chosen || step === 0 || isOctree) {
        element("level-value").textContent = "off";
        return put("surface", null);
    }
    const value = chosen.least + (step / 1000) * (chosen.greatest - chosen.least);
    element("level-value").textContent = number(value);
    const triangles = await ask("isosurface", named({ value }));
    const positions = triangles.flatMap((row) => row.corners.flatMap(toScene));
    put("surface", positions.length ? new three.Mesh(smooth(positions), new three.MeshPhongMaterial({ color: colourOf(value), specular: 0x333333, shininess: 24, side: three.DoubleSide })) : null);
    view.dataset.triangles = triangles.length;
    say(`The surface at ${chosen.name} = ${number(value)} has ${counted(triangles.length, "triangle")}.`);
}

/** One request at a time; of those that come meanwhile the last. */
export function latest(task) {
    let isAsked = false, running = null;
    return () => {
        isAsked = true;
        running ??= (async () => {
            while (isAsked) {
                isAsked = false;
                await answering(task);
            }
            running = null;
        })();
        return running;
    };
}
export const pickable = () => [objects.section, objects.body].filter(Boolean);
