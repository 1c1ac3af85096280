// A mesh or an octree as the viewer knows it: what it is, where it lies on the map, and the meshes of the database that may
// be shown.
import { levelsOf } from "./detail.js";
import { explain, Refused } from "./errors.js";
import { catalogue, kinds } from "./queries.js";

export const mapped = [3857, 4326]; // what tiles are of
const mostKnown = 200; // meshes of which the server keeps what it knows
const mostStates = 4; // of a mesh: the saved one, and those of pages with changes

/** What a request needs of a mesh is not known yet: learn() finds it, and then the request can be answered. */
class Unknown extends Error {
    constructor(mesh) {
        super("not known yet");
        this.mesh = mesh;
    }
}

/** What attempt(learns) returns. It is made again once what it needed is known: to find that may take longer than a request
    should hold one of the few connections. At last it finds it by itself, in case the mesh changes all the time. */
export async function knowing(attempt, signal) {
    for (let left = 3; left > 0; --left) {
        try {
            return await attempt(true);
        } catch (error) {
            if (!(error instanceof Unknown)) throw error;
            await error.mesh.learn(signal);
        }
    }
    return attempt(false);
}

/** What is known of the mesh; anew when it has changed. */
export class Mesh {
    constructor(database, options, oid) { Object.assign(this, { database, options, oid, states: new Map(), learning: null }); }

    static async open(database, options, oid, signal) {
        const mesh = new Mesh(database, options, oid);
        await mesh.read(null, async (query) => {
            const stats = Object.fromEntries((await query(catalogue.stats)).map(({ name, value }) => [name, value])); // an error, with what the table is, if it is neither
            mesh.dimension = stats.dimension;
            mesh.kind = "leaves" in stats ? "octree" : "mesh";
        }, signal);
        mesh.queries = kinds[`${mesh.kind}${mesh.dimension}`];
        return mesh;
    }

    /** The page that shows it. */
    get page() { return this.kind === "mesh" && this.dimension === 2 ? "plane" : "space"; }

    /** Runs task(query), all of it in one state of the mesh. */
    read(token, task, signal) {
        return this.database.read(token, (query) => task(this.about(query)), signal);
    }

    /** Queries of which the first parameter is the mesh. With `learns` describe() does not read what is not known. */
    about(query, learns = false) {
        return Object.assign((text, values = [], more = {}) => query(text, [this.oid, ...values], more), { learns });
    }

    /** What pages need to know of the mesh. The ranges of attributes are in all of its points, so each state of it is read once. */
    async describe(query) {
        const [{ etag }] = await query(this.queries.etag);
        if (this.states.has(etag)) return this.keep(etag, this.states.get(etag));
        if (query.learns) throw new Unknown(this);
        const [{ name, stats, attributes, labels, extent, srid: own }] = await query(this.queries.info, [], { isLong: true });
        const lower = extent.slice(0, this.dimension), upper = extent.slice(3, 3 + this.dimension);
        const map = this.map ?? this.place(own, lower, upper);
        const levels = this.page === "plane" ? await levelsOf(query) : null;
        if (lower[0] !== null) this.map = map; // a mesh without a simplex has no place yet
        const known = { etag, name, kind: this.kind, dimension: this.dimension, ...stats, attributes, labels: labels ?? [], levels, lower, upper, ...map, system: own,
            ...(map.srid && this.options.baseMap && { baseMap: this.options.baseMap, credit: this.options.credit }),
            ...(!this.options.mesh && { isOneOfMany: true }),
            edit: Boolean(this.options.edit && stats.changeable) };
        return this.keep(etag, known);
    }

    /** Keeps a state, and forgets the one that nobody has asked about for longest. */
    keep(etag, known) {
        this.states.delete(etag);
        this.states.set(etag, known);
        if (this.states.size > mostStates) this.states.delete(this.states.keys().next().value);
        return known;
    }

    /** Reads what describe() needs of the state that is saved: once, however many wait, and to the end even if they leave. */
    async learn(signal) {
        this.learning ??= this.database.alone((query) => this.describe(this.about(query))).finally(() => { this.learning = null; });
        this.learning.catch(() => {}); // all may have left
        await Promise.race([this.learning, left(signal)]);
    }

    /** Where the mesh is on the map. It stays there when the mesh grows: pages that are open know of no other map.
        Another server, which may listen at the same port later, may draw the same mesh on another one. */
    place(own, lower, upper) {
        const srid = this.options.srid || (mapped.includes(own) ? own : null);
        // A map of its own: the mesh is in the middle, and takes a thousandth of it.
        const extent = lower[0] === null ? 1 : Math.max(1e-300, ...upper.map((x, i) => x - lower[i])), side = 1024 * extent;
        return { srid, world: srid ? null : [(lower[0] + upper[0] - side) / 2, (lower[1] + upper[1] - side) / 2, side] };
    }
}

/** Fails when the client of a request goes away. */
const left = (signal) => new Promise((_, reject) => {
    const leave = () => reject(new Refused(499, "the client went away"));
    if (signal.aborted) leave();
    signal.addEventListener("abort", leave, { once: true });
});

/** The meshes that a server may show: all that the role may read. */
export class Meshes {
    constructor(database, options) { Object.assign(this, { database, options, known: new Map() }); }

    /** The mesh of a schema and a name, as the catalogue has it. */
    async find(schema, name, signal) {
        const [found] = await this.database.rows(null, catalogue.mesh, [schema, name], signal);
        if (!found) throw new Refused(404, "there is no such mesh");
        return this.open(found.oid, signal);
    }

    async open(oid, signal) {
        const opened = this.known.get(oid) ?? await Mesh.open(this.database, this.options, oid, signal), mesh = this.known.get(oid) ?? opened;
        this.known.delete(oid);
        this.known.set(oid, mesh);
        if (this.known.size > mostKnown) this.known.delete(this.known.keys().next().value);
        return mesh;
    }

    /** What the list says of each mesh. One that cannot be read does not hide the others. */
    async list(signal) {
        const [rows, written] = await this.database.read(null, async (query) => {
            const rows = await query(catalogue.meshes), [{ may }] = await query(catalogue.maySeeFiles);
            return [rows, may ? await query(catalogue.written, [rows.map(({ oid }) => oid)]) : []];
        }, signal);
        const changed = new Map(written.map((row) => [row.oid, row.changed])), found = [];
        for (const { oid, schema, name, bytes } of rows) {
            const row = { schema, name, bytes: Number(bytes), changed: changed.get(oid) ?? null };
            try {
                const mesh = await this.open(oid, signal);
                const [{ stats, srid }] = await mesh.read(null, (query) => query(catalogue.brief), signal);
                found.push({ ...row, kind: mesh.kind, dimension: mesh.dimension, ...stats, srid });
            } catch (error) {
                if (error instanceof Refused) throw error; // the database is away, or the client
                if (error.code !== "42P01") found.push({ ...row, error: explain(error).message }); // it may have been dropped meanwhile
            }
        }
        return found;
    }
}
