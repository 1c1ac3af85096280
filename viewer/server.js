// The server of the viewer: files of the page, what the page asks about one mesh, and its tiles.
// It listens on this machine only, unless --host says otherwise. docs/viewer.md tells what it does
// to be safe.
import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { parseArgs } from "node:util";
import { connection } from "./conninfo.js";
import { Database } from "./database.js";
import { explain, Refused } from "./errors.js";
import { change, Parameters, planeReads, spaceReads, tile } from "./requests.js";
import { plane, space } from "./queries.js";

const usage = `usage: viewer/serve --mesh NAME [-d CONNINFO] [options]

  --mesh NAME        the mesh, as in SQL: terrain, gis.terrain, '"TIN North"'
  -d, --dbname TEXT  a database or connection string, as for psql; default: PGHOST and so on
  --srid N           SRID of the coordinates: 4326 (longitude and latitude) or 3857 (Web Mercator);
                     default: that of the mesh. With another SRID or none it has a map of its own
  --base-map URL     a map below the mesh, of tiles at this address with {z}, {x} and {y}
  --credit TEXT      whose map that is, as its makers want it to be said
  --edit             allow points to be added, moved and deleted
  --timeout SECONDS  longest time for a statement (30)
  --idle SECONDS     undo unsaved changes when nobody uses their page for this long (600)
  --port N           port to listen on (8080; 0: any free port)
  --host NAME        address to listen on (127.0.0.1)
`;

const types = { html: "text/html; charset=utf-8", css: "text/css; charset=utf-8", js: "text/javascript", mjs: "text/javascript" };
/** Headers of all answers. Of other servers the page may ask the one with the base map alone. */
const headersFor = (baseMap) => ({
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; worker-src 'self' blob:; style-src 'self'; " +
        `img-src 'self' blob: data:; connect-src ${["'self'", ...(baseMap ? [new URL(baseMap).origin] : [])].join(" ")}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'`,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
});
const mostBody = 100_000;
const mapped = [3857, 4326]; // what tiles are of

/** What is known of the mesh; anew when it has changed. */
class Mesh {
    constructor(database, options) { Object.assign(this, { database, options }); }

    static async open(database, options) {
        const mesh = new Mesh(database, options);
        mesh.oid = await database.resolve(options.mesh);
        mesh.dimension = await mesh.read(null, async (query) => {
            await query(plane.etag); // an error, with what the table is, if it is not a mesh
            return (await query("SELECT value FROM abacus_stats($1::oid::regclass) WHERE name = 'dimension'"))[0].value;
        });
        return mesh;
    }

    /** Runs task(query), all of it in one state of the mesh. */
    read(token, task, signal) {
        return this.database.read(token, (query) => task(this.about(query)), signal);
    }

    /** Queries of which the first parameter is the mesh. */
    about(query) {
        return (text, values = []) => query(text, [this.oid, ...values]);
    }

    async describe(query) {
        const [{ etag }] = await query(plane.etag);
        if (this.known?.etag === etag) return this.known;
        const [{ name, stats, attributes, extent, srid: own }] = await query(this.dimension === 2 ? plane.info : space.info);
        const lower = extent.slice(0, this.dimension), upper = extent.slice(3, 3 + this.dimension);
        const map = this.map ?? this.place(own, lower, upper);
        if (lower[0] !== null) this.map = map; // a mesh without a simplex has no place yet
        this.known = { etag, name, dimension: this.dimension, ...stats, attributes, lower, upper, ...map, system: own,
            ...(map.srid && this.options.baseMap && { baseMap: this.options.baseMap, credit: this.options.credit }),
            edit: Boolean(this.options.edit && stats.changeable) };
        return this.known;
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

/** The object that a request sends as JSON. */
async function body(request) {
    if (!/^application\/json *(;|$)/i.test(request.headers["content-type"] ?? "")) throw new Refused(415, "the content type must be application/json");
    let text = "", given;
    request.setEncoding("utf8");
    for await (const part of request) if (text.length <= mostBody) text += part; // all is read, or the client does not read the answer
    if (text.length > mostBody) throw new Refused(413, "the request is too large");
    try {
        given = JSON.parse(text || "{}");
    } catch {
        throw new Refused(400, "the body is not valid JSON");
    }
    if (typeof given !== "object" || given === null || Array.isArray(given)) throw new Refused(400, "the body must be a JSON object");
    return given;
}

/** The path and the parameters that a request names. */
function address(request) {
    if (!request.url.startsWith("/")) throw new Refused(400, "the address must be a path");
    return new URL(`http://viewer${request.url}`); // so that `//` is a path, no name of a host
}

function send(response, status, type, content, more = {}) {
    response.writeHead(status, { "Content-Type": type, "Cache-Control": "no-cache", ...more });
    response.end(content);
}
const json = (response, value, status = 200) => send(response, status, "application/json", JSON.stringify(value));

async function sendTile(request, response, url, mesh, reading) {
    const [, kind, z, x, y] = url.pathname.match(/^\/tiles\/(picture|vector|terrain)\/(\d+)\/(\d+)\/(\d+)$/) ?? [];
    if (!kind || mesh.dimension !== 2) throw new Refused(404, "not found");
    const { etag, bytes } = await reading(async (query) => {
        const known = await mesh.describe(query);
        const drawn = JSON.stringify([known.srid, known.world, url.search]);
        const etag = `"${known.etag}-${Buffer.from(drawn).toString("base64url")}"`;
        if (request.headers["if-none-match"] === etag) return { etag };
        const { text, values } = tile(kind, z, x, y, new Parameters(url.searchParams), known);
        return { etag, bytes: (await query(text, values))[0].tile };
    });
    if (bytes === undefined) return send(response, 304, "image/png", undefined, { ETag: etag });
    send(response, 200, kind === "vector" ? "application/x-protobuf" : "image/png", bytes, { ETag: etag });
}

async function read(response, url, mesh, reading) {
    const name = url.pathname.slice("/api/".length);
    const reads = { info: (_, query, known) => known, ...(mesh.dimension === 2 ? planeReads : spaceReads) };
    if (!Object.hasOwn(reads, name)) throw new Refused(404, "not found");
    json(response, await reading(async (query) => reads[name](new Parameters(url.searchParams), query, await mesh.describe(query))));
}

/** The session of a page that edits, and what it asks of it. */
async function edit(request, response, url, mesh, token) {
    const { database } = mesh, name = url.pathname.slice("/edit/".length);
    const given = await body(request); // JSON, which no form of another site can send
    if (!database.edit) throw new Refused(403, "the viewer was started without --edit");
    if (name === "begin") return json(response, { session: await database.open(request.socket.remoteAddress), beat: database.sessions.absent / 6 });
    const session = database.sessions.get(token ?? given.session); // a page that closes cannot send headers
    if (name === "alive") return json(response, { changes: session.changes });
    session.used = Date.now();
    try {
        if (name === "save" || name === "undo") return json(response, { changes: await session[name]() });
        if (name === "end") return json(response, (await session.close(), {}));
        const task = change(name, given, await mesh.read(session.token, (query) => mesh.describe(query)));
        json(response, { changes: await session.change((query) => task(mesh.about(query))) });
    } catch (error) {
        throw Object.assign(error, { changes: session.changes });
    }
}

async function sendFile(response, url, mesh) {
    const name = url.pathname === "/" ? "index.html" : url.pathname.slice("/assets/".length);
    const known = /^[a-z-]+\.(html|css|js|mjs)$/.exec(name);
    if (!known || (url.pathname !== "/" && !url.pathname.startsWith("/assets/"))) throw new Refused(404, "not found");
    const content = await readFile(new URL(`dist/${name}`, import.meta.url)).catch(() => { throw new Refused(404, "not found"); });
    send(response, 200, types[known[1]], name === "index.html" ? String(content).replaceAll("DIMENSION", mesh.dimension === 2 ? "plane" : "space") : content);
}

function handler(mesh, hosts) {
    const headers = Object.entries(headersFor(mesh.options.baseMap));
    return async (request, response) => {
        for (const [name, value] of headers) response.setHeader(name, value);
        const gone = new AbortController();
        response.on("close", () => { if (!response.writableEnded) gone.abort(); });
        try {
            // Another host name that leads here is refused.
            if (!hosts.has((request.headers.host ?? "").replace(/:\d+$/, ""))) throw new Refused(421, "this server does not answer to that host name");
            const url = address(request);
            const token = request.headers["x-session"] || null;
            const reading = (task) => mesh.read(token, task, gone.signal);
            if (url.pathname.startsWith("/edit/")) {
                if (request.method !== "POST") throw new Refused(405, "only POST is allowed here");
                return await edit(request, response, url, mesh, token);
            }
            if (request.method !== "GET") throw new Refused(405, "only GET is allowed here");
            if (url.pathname.startsWith("/tiles/")) return await sendTile(request, response, url, mesh, reading);
            if (url.pathname.startsWith("/api/")) return await read(response, url, mesh, reading);
            await sendFile(response, url, mesh);
        } catch (error) {
            if (response.writableEnded || gone.signal.aborted) return;
            const { status, message, hint } = explain(error);
            json(response, { error: message, hint, changes: error.changes, lost: error.lost }, status);
        }
    };
}

export async function start(options) {
    const milliseconds = (name) => options[name] && options[name] * 1000;
    const database = new Database(connection(options.dbname), { edit: options.edit, ...Object.fromEntries(["timeout", "idle", "absent"].map((name) => [name, milliseconds(name)])) });
    const mesh = await Mesh.open(database, options).catch(async (error) => {
        await database.end();
        throw error;
    });
    const server = createServer(handler(mesh, new Set(["localhost", "127.0.0.1", "[::1]", options.host])));
    await new Promise((resolve, reject) => server.once("error", reject).listen(options.port, options.host, resolve));
    return { port: server.address().port, stop: async () => {
        server.closeAllConnections();
        await new Promise((resolve) => server.close(resolve));
        await database.end();
    } };
}

function commandLine() {
    const { values } = parseArgs({ options: {
        mesh: { type: "string" }, dbname: { type: "string", short: "d" }, srid: { type: "string", default: "0" },
        edit: { type: "boolean", default: false }, "base-map": { type: "string" }, credit: { type: "string" }, timeout: { type: "string", default: "30" },
        idle: { type: "string", default: "600" }, port: { type: "string", default: "8080" }, host: { type: "string", default: "127.0.0.1" }, help: { type: "boolean" } } });
    const number = (name, least, most) => {
        const value = Number(values[name]);
        if (!Number.isInteger(value) || value < least || value > most) throw new Error(`--${name} must be a whole number from ${least} to ${most}`);
        return value;
    };
    if (values.help) return null;
    if (!values.mesh) throw new Error("--mesh is missing");
    const srid = number("srid", 0, 99999);
    if (srid && !mapped.includes(srid)) throw new Error("--srid must be 4326 or 3857; without it the viewer uses the SRID of the mesh, or a map of its own");
    const baseMap = values["base-map"];
    if (baseMap !== undefined && !(/^https?:\/\/[\w.:[\]-]+\//.test(baseMap) && ["{z}", "{x}", "{y}"].every((part) => baseMap.includes(part))))
        throw new Error("--base-map must be an address of http or https with {z}, {x} and {y}, for example https://maps.example/{z}/{x}/{y}.png");
    return { ...values, baseMap, srid, timeout: number("timeout", 1, 86400), idle: number("idle", 10, 86400), port: number("port", 0, 65535) };
}

if (process.argv[1] === new URL(import.meta.url).pathname) {
    try {
        const options = commandLine();
        if (!options) console.log(usage);
        else {
            const { port, stop } = await start(options);
            console.log(`Mesh ${options.mesh} is at http://localhost:${port}/  (press Ctrl+C to stop)`);
            for (const signal of ["SIGINT", "SIGTERM"]) process.once(signal, () => stop().then(() => process.exit(0)));
        }
    } catch (error) {
        console.error(`viewer: ${error.message}${error.code?.startsWith?.("ERR_PARSE") ? `\n${usage}` : ""}`);
        process.exit(1);
    }
}
