// The server of the viewer: files of the pages, the list of meshes, what a page asks about its mesh, and pictures of it.
// It listens on this machine only, unless --host says otherwise. docs/viewer.md tells what it does
// to be safe.
import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { parseArgs } from "node:util";
import { connection } from "./conninfo.js";
import { Database } from "./database.js";
import { explain, Refused } from "./errors.js";
import { layer, nothing, terrain } from "./globe.js";
import { knowing, mapped, Mesh, Meshes } from "./mesh.js";
import { betweenReads, change, Parameters, picture, placeOfTile, readsOf, tile } from "./requests.js";

const usage = `usage: viewer/serve [--mesh NAME] [-d CONNINFO] [options]     (or abacus-viewer, of Debian's package)

  --mesh NAME        the mesh, as in SQL: terrain, gis.terrain, '"TIN North"'; no other can be reached.
                     Without it, all meshes of the database that the role may read, in a list
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

const types = { json: "application/json", jpg: "image/jpeg", png: "image/png", xml: "application/xml", html: "text/html; charset=utf-8", css: "text/css; charset=utf-8", js: "text/javascript", mjs: "text/javascript" };
/** What a page may load: from here alone, but for the base map. Cesium compiles WebAssembly, and has styles in its elements. */
const policy = (baseMap, isGlobe = false) => `default-src 'none'; script-src 'self'${isGlobe ? " 'wasm-unsafe-eval'" : ""}; worker-src 'self' blob:; style-src 'self'${isGlobe ? " 'unsafe-inline'" : ""}; ` +
    `img-src 'self' blob: data:; connect-src ${["'self'", ...(baseMap ? [new URL(baseMap).origin] : [])].join(" ")}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'`;
/** Headers of all answers. Of other servers the page may ask the one with the base map alone. */
const headersFor = (baseMap) => ({
    "Content-Security-Policy": policy(baseMap),
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
});
const mostBody = 100_000;

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

/** A picture or a tile whose statement is `make(known)`, or `otherwise` where that is NULL; 304 if the client has it. Of another mesh it is drawn on the map of `onto`. */
async function sendPicture(request, response, url, { mesh, onto }, reading, make, { type = "image/png", otherwise } = {}) {
    const { etag, bytes } = await reading(async (query, all) => {
        const known = onto ? placed(await mesh.describe(query), await onto.describe(onto.about(all, query.learns))) : await mesh.describe(query);
        const drawn = JSON.stringify([known.srid, known.world, url.search]);
        const etag = `"${known.etag}-${Buffer.from(drawn).toString("base64url")}"`;
        if (request.headers["if-none-match"] === etag) return { etag };
        const { text, values } = make(known), [row] = await query(text, values);
        return { etag, bytes: Object.values(row)[0] };
    });
    if (bytes === undefined) return send(response, 304, type, undefined, { ETag: etag });
    send(response, 200, type, bytes ?? otherwise, { ETag: etag });
}

/** A mesh as described, on the map of another one. */
function placed(known, { srid, world, system }) {
    if (known.system !== system) throw new Refused(400, "the two meshes have different spatial reference systems");
    return { ...known, srid, world };
}

function sendTile(request, response, url, path, what, reading) {
    const { mesh } = what;
    const [, kind, z, x, y] = path.match(/^\/tiles\/(picture|vector|terrain)\/(\d+)\/(\d+)\/(\d+)$/) ?? [];
    if (!kind || mesh.page !== "plane") throw new Refused(404, "not found");
    return sendPicture(request, response, url, what, reading, (known) => tile(kind, z, x, y, new Parameters(url.searchParams), known), { type: kind === "vector" ? "application/x-protobuf" : "image/png" });
}

/** The page of a globe, and its terrain. */
async function sendGlobe(request, response, url, path, mesh, reading) {
    const [, z, x, y] = path.match(/^\/globe\/(\d+)\/(\d+)\/(\d+)\.terrain$/) ?? [], p = new Parameters(url.searchParams);
    if (mesh.page !== "plane" || !(z || path === "/globe/" || path === "/globe/layer.json")) throw new Refused(404, "not found");
    if (path === "/globe/") {
        response.setHeader("Content-Security-Policy", policy(null, true));
        return sendFile(response, "/assets/globe.html", mesh.page);
    }
    if (!z) return json(response, await reading(async (query) => layer(p, await mesh.describe(query))));
    return sendPicture(request, response, url, { mesh }, reading, (known) => terrain(placeOfTile([z, x, y]), p, known), { type: "application/vnd.quantized-mesh", otherwise: nothing });
}

function sendDrawing(request, response, url, path, mesh, reading) {
    const [, kind] = path.match(/^\/pictures\/(brief|whole)$/) ?? [];
    if (!kind) throw new Refused(404, "not found");
    return sendPicture(request, response, url, { mesh }, reading, (known) => picture(kind, new Parameters(url.searchParams), mesh, known));
}

async function read(response, url, path, { mesh, onto }, reading) {
    const name = path.slice("/api/".length);
    const reads = { info: (_, query, known) => known, ...readsOf(mesh), ...(onto?.page === "plane" && mesh.page === "plane" && betweenReads) };
    if (!Object.hasOwn(reads, name)) throw new Refused(404, "not found");
    json(response, await reading(async (query) => reads[name](new Parameters(url.searchParams), query, await mesh.describe(query), onto?.oid)));
}

/** What task(query, learns) reads of the state that the session sees: its own, or the saved one, of which more may have to be learnt. */
function readState({ database }, token, task, signal) {
    const attempt = (learns) => database.read(token, (query) => task(query, learns), signal);
    return database.isEditing(token) ? attempt() : knowing(attempt, signal);
}

/** The session of a page that edits, and what it asks of it. */
async function edit(request, response, path, mesh, token, signal) {
    const { database } = mesh, name = path.slice("/edit/".length);
    const given = await body(request); // JSON, which no form of another site can send
    if (!database.edit) throw new Refused(403, "the viewer was started without --edit");
    if (name === "begin") return json(response, { session: await database.open(request.socket.remoteAddress), beat: database.sessions.absent / 6 });
    const session = database.sessions.get(token ?? given.session); // a page that closes cannot send headers
    if (name === "alive") return json(response, { changes: session.changes });
    session.used = Date.now();
    try {
        if (name === "save" || name === "undo" || name === "back") return json(response, { changes: await session[name]() });
        if (name === "end") return json(response, (await session.close(), {}));
        const task = change(name, given, await readState(mesh, session.token, (query, learns) => mesh.describe(mesh.about(query, learns)), signal));
        json(response, { changes: await session.change((query) => task(mesh.about(query))) });
    } catch (error) {
        throw Object.assign(error, { changes: session.changes });
    }
}

async function sendFile(response, path, page) {
    const name = path === "/" ? "index.html" : path.slice("/assets/".length);
    const known = /^(?:cesium\/(?:[A-Za-z0-9_]+\/)*[A-Za-z0-9_-]+|[a-z-]+)\.(html|css|js|mjs|json|jpg|png|xml)$/.exec(name);
    if (!known || (path !== "/" && !path.startsWith("/assets/"))) throw new Refused(404, "not found");
    const content = await readFile(new URL(`dist/${page === "list" && path === "/" ? "list.html" : name}`, import.meta.url)).catch(() => { throw new Refused(404, "not found"); });
    send(response, 200, types[known[1]], name === "index.html" ? String(content).replaceAll("DIMENSION", page) : content);
}

/** What the server shows: one mesh, at the root, or a list at the root and each mesh below /mesh/SCHEMA/NAME. */
class Places {
    constructor(mesh, meshes) { Object.assign(this, { mesh, meshes }); }

    /** The mesh that a path names, if it names one, and the rest of the path. */
    async find(path, signal) {
        if (this.mesh) return { mesh: this.mesh, path };
        const [, schema, name, rest] = /^\/mesh\/([^/]+)\/([^/]+)(\/.*)$/.exec(path) ?? [];
        if (!name) return { mesh: null, path };
        try {
            return { mesh: await this.meshes.find(decodeURIComponent(schema), decodeURIComponent(name), signal), path: rest };
        } catch (error) {
            throw error instanceof URIError ? new Refused(400, "the address is not valid") : error;
        }
    }

    /** The mesh that the page of another one asks about, as SCHEMA/NAME, each encoded. */
    async other(text, signal) {
        if (!this.meshes) throw new Refused(404, "this server shows no other mesh");
        const { mesh } = await this.find(`/mesh/${text}/`, signal);
        if (!mesh) throw new Refused(400, "of must be a schema and a name");
        return mesh;
    }
}

function handler(places, options, hosts) {
    const headers = Object.entries(headersFor(options.baseMap));
    return async (request, response) => {
        for (const [name, value] of headers) response.setHeader(name, value);
        const gone = new AbortController();
        response.on("close", () => { if (!response.writableEnded) gone.abort(); });
        try {
            // Another host name that leads here is refused.
            if (!hosts.has((request.headers.host ?? "").replace(/:\d+$/, ""))) throw new Refused(421, "this server does not answer to that host name");
            const url = address(request);
            const token = request.headers["x-session"] || null;
            const { mesh, path } = await places.find(url.pathname, gone.signal);
            if (path.startsWith("/edit/")) {
                if (request.method !== "POST") throw new Refused(405, "only POST is allowed here");
                if (!mesh) throw new Refused(404, "not found");
                return await edit(request, response, path, mesh, token, gone.signal);
            }
            if (request.method !== "GET") throw new Refused(405, "only GET is allowed here");
            if (!mesh && path === "/api/meshes") return json(response, await places.meshes.list(gone.signal));
            if (!mesh) return await sendFile(response, path, "list");
            const of = url.searchParams.get("of"), what = of === null ? { mesh } : { mesh: await places.other(of, gone.signal), onto: mesh };
            const reading = (task) => readState(mesh, token, (query, learns) => task(what.mesh.about(query, learns), query), gone.signal);
            if (path.startsWith("/tiles/")) return await sendTile(request, response, url, path, what, reading);
            if (path.startsWith("/globe/")) return await sendGlobe(request, response, url, path, mesh, reading);
            if (path.startsWith("/pictures/")) return await sendDrawing(request, response, url, path, what.mesh, reading);
            if (path.startsWith("/api/")) return await read(response, url, path, what, reading);
            await sendFile(response, path, mesh.page);
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
    const open = async () => {
        if (options.mesh) return new Places(await Mesh.open(database, options, await database.resolve(options.mesh)));
        await database.rows(null, "SELECT abacus_version()"); // an error if the extension is missing
        return new Places(null, new Meshes(database, options));
    };
    const places = await open().catch(async (error) => {
        await database.end();
        throw error;
    });
    const server = createServer(handler(places, options, new Set(["localhost", "127.0.0.1", "[::1]", options.host])));
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
    if (values.mesh === "") throw new Error("--mesh has no name");
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
            console.log(`${options.mesh === undefined ? "The list of meshes" : `Mesh ${options.mesh}`} is at http://localhost:${port}/  (press Ctrl+C to stop)`);
            for (const signal of ["SIGINT", "SIGTERM"]) process.once(signal, () => stop().then(() => process.exit(0)));
        }
    } catch (error) {
        const cause = error.cause?.message || error.cause?.code;
        console.error(`viewer: ${error.message}${cause ? `: ${cause}` : ""}${error.code?.startsWith?.("ERR_PARSE") ? `\n${usage}` : ""}`);
        process.exit(1);
    }
}
