// What a browser may ask: each path with the parameters that it takes, checked before anything is
// sent to the database.
import { errorOfPixel, errorOfTile } from "./detail.js";
import { edits, kinds, plane, space } from "./queries.js";
import { Refused } from "./errors.js";

const mostRows = 200_000, mostPathPlaces = 1000;
const mostOfHull = 60_000;
const noData = -32768; // what a tile of heights has where there is no mesh, if it is asked to say so

const wrong = (message) => new Refused(400, message);

export class Parameters {
    constructor(search) { this.search = search; }
    text(name) {
        const value = this.search.get(name);
        return value === null || value === "" ? null : value;
    }
    number(name, otherwise) {
        const text = this.text(name);
        if (text === null && otherwise !== undefined) return otherwise;
        const value = Number(text);
        if (text === null || !/^[-+0-9.eE]+$/.test(text) || !Number.isFinite(value)) throw wrong(`${name} must be a number`);
        return value;
    }
    flag(name) {
        const text = this.text(name) ?? "no";
        if (text !== "yes" && text !== "no") throw wrong(`${name} must be yes or no`);
        return text === "yes";
    }
    numbers(name, least, most) {
        const parts = (this.text(name) ?? "").split(",");
        if (parts.length < least || parts.length > most) throw wrong(`${name} must have ${least === most ? least : `${least} to ${most}`} numbers`);
        return parts.map((part) => new Parameters(new URLSearchParams([[name, part]])).number(name));
    }
}

/** Rows of a query that asks for one more than there may be. */
async function bounded(query, values) {
    const rows = await query(values.text, [...values.values, mostRows + 1]);
    if (rows.length > mostRows) throw new Refused(413, `the result has more than ${mostRows} rows`, "Choose a smaller part of the mesh.");
    return rows;
}

const atMost = (rows) => (rows.length > mostOfHull ? null : rows);

/** A place, its simplex with corners and neighbours, and what the mesh says of values there. */
async function locate(query, mesh, sql, at, attribute) {
    const count = at.length + 1;
    const answer = { place: at, simplex: null, neighbours: [], values: {} };
    [answer.nearest] = await query(sql.nearest, at);
    for (const { method, value } of mesh.attributes.length ? await query(sql.values, [...at, attribute, mesh.delaunay === 1]) : [])
        answer.values[method] = value;
    const ids = (row) => [row.v0, row.v1, row.v2, row.v3].slice(0, count);
    const rows = await query(sql.located, at);
    if (rows.length) answer.neighbours = Array(count).fill(null);
    for (const row of rows) {
        if (row.facet < 0) answer.simplex = { code: row.code, ids: ids(row), corners: row.corners, values: row.values };
        else answer.neighbours[row.facet] = { ids: ids(row), corners: row.corners };
    }
    return answer;
}

const at = (p, dimension) => ["x", "y", "z"].slice(0, dimension).map((axis) => p.number(axis));
const attributeOf = (p, mesh) => p.text("attribute") ?? mesh.attributes[0]?.name ?? null;

const planeReads = {
    locate: async (p, query, mesh) => {
        const isOfRegions = p.flag("regions"), place = at(p, 2), answer = await locate(query, mesh, plane, place, attributeOf(p, mesh));
        return isOfRegions ? { ...answer, ...(await query(plane.region, place))[0] } : answer;
    },
    star: (p, query) => query(p.flag("regions") ? plane.cellsOfRegions : plane.cells, at(p, 2)),
    profile: async (p, query, mesh) => {
        const path = p.numbers("path", 4, 2 * mostPathPlaces);
        if (path.length % 2) throw wrong("path must have an x and a y for each place");
        return bounded(query, { text: plane.profile, values: [path, attributeOf(p, mesh)] });
    },
    /** The rings of the border with the attribute; null if they have very many places. */
    hull: async (p, query, mesh) => atMost(await query(plane.hull, [attributeOf(p, mesh), mostOfHull + 1, p.text("within")])),
    /** The regions of the mesh. */
    regions: (p, query) => bounded(query, { text: plane.regions, values: [] }),
    /** The lines that are fixed edges of the mesh, as they were given. */
    lines: (p, query) => bounded(query, { text: plane.lines, values: [] }),
    sight: async (p, query, mesh) =>
        (await query(plane.sight, [...p.numbers("from", 2, 2), ...p.numbers("to", 2, 2), attributeOf(p, mesh),
            p.number("observer", 0), p.number("target", 0)]))[0],
};

/** What may be asked about another mesh and that of the page: `own` is its oid. */
export const betweenReads = {
    volume: async (p, query, mesh, own) => (await query(plane.volume, [own, p.text("own"), attributeOf(p, mesh)]))[0],
};

/** Where a name is in a list, from 1; 0 if none is given. */
function position(names, name, what) {
    if (name !== null && !names.includes(name)) throw wrong(`the mesh has no ${what} "${name}"`);
    return names.indexOf(name) + 1;
}

const mostOfBody = 200_000; // triangles
const fewOfBody = 2000; // as few are sent even where six pictures would do

/** The surface of a mesh in space, to be drawn: vertices, each once, with triangles of their numbers and values of the vertices or
    labels of the triangles. Only "isBox" where six sections are the same, and null of a hull with too many triangles. */
async function body(p, query, mesh) {
    if (mesh.lower[0] === null) return { positions: [], triangles: [] };
    const [{ triangles: count, isBox }] = await query(space.shape, [...mesh.lower, ...mesh.upper]);
    const ofLabel = position(mesh.labels, p.text("label"), "label"), ofAttribute = position(mesh.attributes.map((one) => one.name), p.text("attribute"), "attribute");
    if (isBox && count > fewOfBody && !ofLabel) return { isBox };
    if (count > mostOfBody) return null;
    const numbers = new Map(), positions = [], values = [], triangles = [];
    for (const { vertex, x, y, z, value } of await query(space.body, [ofAttribute])) {
        const key = `${vertex} ${x} ${y} ${z}`;
        if (!numbers.has(key)) {
            numbers.set(key, numbers.size);
            positions.push(x, y, z);
            values.push(value);
        }
        triangles.push(numbers.get(key));
    }
    return { positions, triangles, ...(ofAttribute && { values }), ...(ofLabel && { labels: (await query(space.bodyLabels, [ofLabel])).map((row) => row.label) }) };
}

const mostLabelColours = 16;

const spaceReads = {
    locate: (p, query, mesh) => locate(query, mesh, space, at(p, 3), attributeOf(p, mesh)),
    star: (p, query) => query(space.cells, at(p, 3)),
    body,
    /** The values of a label that are to be told apart, or only their range if there are too many. */
    label: async (p, query, mesh) => (await query(space.labelValues, [position(mesh.labels, p.text("name") ?? "", "label"), mostLabelColours]))[0],
    section: (p, query, mesh) => bounded(query, { text: space.section,
        values: [p.numbers("through", 3, 3), p.numbers("normal", 3, 3), attributeOf(p, mesh)] }),
    isosurface: (p, query, mesh) => bounded(query, { text: space.isosurface, values: [p.number("value"), attributeOf(p, mesh)] }),
    ray: (p, query) => bounded(query, { text: space.ray, values: [p.numbers("origin", 3, 3), p.numbers("direction", 3, 3)] }),
    /** null if it has so many triangles that their lines would hide all behind them. */
    hull: async (p, query) => atMost(await query(space.hull, [mostOfHull + 1])),
};

const mostNeighbours = 2000;
/** The leaf at a place, and those beside it; the codes are text. */
const octreeReads = {
    locate: async (p, query, mesh) => {
        const place = at(p, mesh.dimension), [leaf = null] = await query(octreeQueries(mesh).located, place);
        return { place, leaf, neighbours: leaf ? await query(octreeQueries(mesh).neighbours, [leaf.code, mostNeighbours]) : [] };
    },
};
const octreeQueries = ({ dimension }) => kinds[`octree${dimension}`];

/** What may be asked about a mesh of a kind and dimension. */
export const readsOf = ({ kind, dimension }) => (kind === "octree" ? octreeReads : dimension === 2 ? planeReads : spaceReads);

/** Zoom, x and y of a tile, from its address. */
export const placeOfTile = (texts) => texts.map((text) => {
    if (!/^\d{1,10}$/.test(text) || Number(text) > 2 ** 31 - 1) throw wrong("there is no such tile");
    return Number(text);
});

/** A tile: its statement and parameters. */
export function tile(kind, z, x, y, p, mesh) {
    const place = placeOfTile([z, x, y]);
    const attribute = attributeOf(p, mesh);
    const values = [...place, mesh.srid, mesh.world, attribute];
    const found = mesh.attributes.find((one) => one.name === attribute);
    const contours = attribute === null ? null : p.number("contours", 0) || null;
    const within = p.text("within"), regions = p.flag("regions");
    const error = within === null && !regions && !p.flag("exact") ? errorOfTile(mesh, found, place[0]) : null; // levels have no regions
    if (kind === "terrain") return { text: plane.terrain, values: [...values, p.text("outside") === "none" ? noData : found?.least ?? 0, within, error] };
    if (kind === "vector") return { text: plane.vector, values: [...values, contours, within] };
    const low = p.number("low", found?.least ?? null), high = p.number("high", found?.greatest ?? null);
    const range = low === null ? null : [low, high > low ? high : low + 1];
    return { text: plane.picture, values: [...values, range, attribute === null ? null : p.text("ramp"), contours,
        attribute === null ? 0 : p.number("exaggeration", 0), p.text("edges") !== "no", p.number("size", 256), within, regions, error] };
}

// ---- Pictures of meshes in space, octrees and quadtrees -------------------------------------------

const sideOfBrief = [360, 220], mostSide = 2048;

/** A colour for each value: the attribute or label, the range, and the palette; without any the picture shows the mesh itself. */
function coloured(p, mesh) {
    const name = attributeOf(p, mesh), found = mesh.attributes.find((one) => one.name === name);
    const low = p.number("low", found?.least ?? null), high = p.number("high", found?.greatest ?? null);
    return { name, range: low === null || high === null ? null : [low, high > low ? high : low + 1], ramp: name === null ? null : p.text("ramp") };
}

/** Width and height in pixels of a picture of a rectangle of this shape. */
function pixels(width, height, most) {
    const scale = most / Math.max(width, height);
    return [width, height].map((side) => Math.min(Math.max(Math.round(side * scale), 16), most));
}

/** The section by a plane, within the box around the mesh; `shape` is that of the rectangle. */
function sectionPicture(p, { lower, upper, ...mesh }, most) {
    const [width, height] = p.numbers("shape", 2, 2), { name, range, ramp } = coloured(p, mesh);
    if (!(width > 0 && height > 0)) throw wrong("shape must be a width and a height");
    return [p.numbers("through", 3, 3), p.numbers("normal", 3, 3), ...pixels(width, height, most), name, p.flag("edges"), lower, upper, 1, range, ramp];
}

/** The section from west to east through the middle, stretched to the small picture. */
function briefSection(p, { lower, upper, ...mesh }) {
    const through = lower.map((x, i) => (x + upper[i]) / 2), [width, height] = sideOfBrief, { name, range } = coloured(p, mesh);
    return [through, [0, 1, 0], width, height, name, false, lower, upper, ((upper[0] - lower[0]) * height) / ((upper[2] - lower[2]) * width) || 1, range, "strata"];
}

/** A quadtree, or a window of it. */
function wholePicture(p, mesh, most, isBrief = false) {
    const { lower, upper } = mesh, window = isBrief || p.text("window") === null ? [...lower, ...upper] : p.numbers("window", 4, 4);
    const [width, height] = [window[2] - window[0], window[3] - window[1]];
    if (!(width > 0 && height > 0)) throw wrong("window must be the lower corner and then the upper one");
    const size = pixels(width, height, isBrief ? sideOfBrief[0] : most), { name, range, ramp } = coloured(p, mesh);
    return [...size, name, isBrief || p.flag("edges"), window.slice(0, 2), window.slice(2), range, isBrief ? "strata" : ramp];
}

const sideOfBriefTile = 360;

/** A small picture of a mesh in the plane: a tile of a map on which it takes all of one tile. */
function briefOfPlane(mesh) {
    const { lower, upper } = mesh, side = Math.max(...upper.map((x, i) => x - lower[i])) * 1.06 || 1;
    const found = mesh.attributes[0], world = [(lower[0] + upper[0] - side) / 2, (lower[1] + upper[1] - side) / 2, side];
    const isSurface = found !== undefined && found.least !== null;
    return { text: plane.picture, values: [0, 0, 0, null, world, isSurface ? found.name : null, isSurface ? [found.least, Math.max(found.greatest, found.least + 1e-300)] : null, isSurface ? "terrain" : null, null,
        isSurface ? side / 9 / (found.greatest - found.least || 1) : 0, !isSurface || mesh.simplices < 2000, sideOfBriefTile, null, false, errorOfPixel(mesh, found, side / sideOfBriefTile)] };
}

/** A picture that is not a tile, of the mesh as described: its statement and parameters. */
export function picture(kind, p, { queries, dimension, kind: what }, mesh) {
    if (mesh.lower[0] === null) throw new Refused(404, "the mesh is empty");
    if (kind === "brief" && what === "mesh" && dimension === 2) return briefOfPlane(mesh);
    if (kind !== "brief" && (what === "mesh" && dimension === 2)) throw new Refused(404, "not found");
    if (dimension === 2) return { text: queries.picture, values: wholePicture(p, mesh, mostSide, kind === "brief") };
    return { text: queries.picture, values: kind === "brief" ? briefSection(p, mesh) : sectionPicture(p, mesh, mostSide) };
}

// ---- Changes ------------------------------------------------------------------------------------

/** An id, as text: numbers of JSON beyond 53 bits are others than were sent. */
const id = (value) => {
    const text = typeof value === "string" || Number.isSafeInteger(value) ? String(value) : "";
    if (!/^-?\d{1,19}$/.test(text) || BigInt.asIntN(64, BigInt(text)) !== BigInt(text)) throw wrong("id must be a whole number of 64 bits, sent as text if it has more than 53");
    return String(BigInt(text));
};
const place = (value, dimension) => {
    if (!Array.isArray(value) || value.length !== dimension || !value.every((x) => typeof x === "number" && Number.isFinite(x)))
        throw wrong(`a place must have ${dimension} numbers`);
    return value;
};
const numbersOrNull = (value, count) => {
    if (!Array.isArray(value) || value.length !== count || !value.every((x) => x === null || (typeof x === "number" && Number.isFinite(x))))
        throw wrong("values must be a list of numbers or nulls, one for each attribute");
    return value;
};

/** Changes of the mesh, each with its body; they answer with the triangles around the place. */
export function change(name, body, mesh) {
    const { dimension, attributes } = mesh;
    const sql = edits(dimension, attributes.length > 0);
    const at = place(body.at, dimension), number = id(body.id);
    const insert = async (query, where, given) => {
        const values = !attributes.length ? [] : [given != null ? numbersOrNull(given, attributes.length)
            : (await query(sql.interpolate, where))[0]?.values ?? attributes.map(() => null)];
        await query(sql.insert, [number, ...where, ...values]);
    };
    const remove = async (query) => {
        const [vertex] = await query((dimension === 2 ? plane : space).nearest, at);
        if (vertex?.vertex !== number || vertex.distance !== 0) throw new Refused(409, `there is no vertex with the id ${number} at this place`);
        await query(sql.remove, [number, ...at]);
    };
    const actions = {
        insert: (query) => insert(query, at, body.values),
        remove,
        move: async (query) => {
            const to = place(body.to, dimension);
            await remove(query);
            await insert(query, to, body.values);
        },
    };
    if (!Object.hasOwn(actions, name)) throw new Refused(404, "no such change");
    return actions[name];
}
