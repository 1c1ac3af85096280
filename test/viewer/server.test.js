// The server of the viewer: answers equal those of SQL; bad input, missing rights, other names, clients that go away,
// and undone changes.
import assert from "node:assert/strict";
import { execFile, spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import http from "node:http";
import net from "node:net";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { connection, folderOfSocket } from "../../viewer/conninfo.js";
import { Database } from "../../viewer/database.js";
import { connect, eventually, makeMeshes, psql, serve } from "./support.js";

let plane, space, editing;
before(async () => {
    makeMeshes();
    plane = await serve("terrain");
    space = await serve("rock");
    editing = await serve("public.terrain", { edit: true });
});
after(async () => {
    for (const server of [plane, space, editing]) await server?.stop();
});

const count = () => Number(psql("SELECT value FROM abacus_stats('terrain') WHERE name = 'vertices'"));

test("what it says of a place is what SQL says", async () => {
    const { status, body } = await plane.get("/api/locate?x=400817.5&y=5200740.25");
    assert.equal(status, 200);
    assert.equal(body.simplex.ids.join("|"), psql("SELECT v0, v1, v2 FROM abacus_locate('terrain', 400817.5, 5200740.25)"));
    for (const method of ["linear", "natural", "nearest"])
        assert.equal(body.values[method], Number(psql(`SELECT abacus_interpolate('terrain', 400817.5, 5200740.25, method => '${method}')`)));
    body.neighbours.forEach((one, facet) => assert.equal(one.ids.join("|"), psql(`SELECT v0, v1, v2 FROM abacus_walk('terrain', abacus_locate('terrain', 400817.5, 5200740.25), ${facet})`)));
    assert.equal(String(body.nearest.vertex), psql("SELECT vertex FROM abacus_nearest('terrain', 400817.5, 5200740.25)"));
    const outside = await plane.get("/api/locate?x=0&y=0");
    assert.equal(outside.body.simplex, null);
});

test("tetrahedra, sections, surfaces and rays are those of SQL", async () => {
    const { body } = await space.get("/api/locate?x=5.3&y=4.6&z=-3");
    assert.equal(body.simplex.ids.join("|"), psql("SELECT v0, v1, v2, v3 FROM abacus_locate('rock', 5.3, 4.6, -3)"));
    assert.equal(body.neighbours.length, 4);
    body.neighbours.forEach((one, facet) => assert.equal(one.ids.join("|"), psql(`SELECT v0, v1, v2, v3 FROM abacus_walk('rock', abacus_locate('rock', 5.3, 4.6, -3), ${facet})`)));
    const length = async (path, sql) => assert.equal((await space.get(path)).body.length, Number(psql(`SELECT count(*) FROM ${sql}`)));
    await length("/api/section?through=5,5,-3&normal=0,0,1", "abacus_section('rock', '{5,5,-3}', '{0,0,1}')");
    await length("/api/isosurface?value=450", "abacus_isosurface('rock', 450)");
    await length("/api/ray?origin=-5,5,-3&direction=1,0,0.01", "abacus_ray('rock', '{-5,5,-3}', '{1,0,0.01}')");
    await length("/api/hull", "abacus_hull('rock')");
});

test("lines are those of SQL", async () => {
    const { body } = await plane.get("/api/profile?path=400100,5200100,401000,5200900,401500,5200200");
    assert.equal(body.length, Number(psql("SELECT count(*) FROM abacus_profile('terrain', '{400100,5200100,401000,5200900,401500,5200200}')")));
    const { body: seen } = await plane.get("/api/sight?from=400100,5200100&to=401500,5201000&observer=2");
    assert.equal(String(seen.visible)[0], psql("SELECT visible FROM abacus_visible('terrain', '{400100,5200100}', '{401500,5201000}', observer_height => 2)"));
});

test("tiles have an ETag, and are sent again only when the mesh has changed", async () => {
    for (const [kind, type] of [["picture", "image/png"], ["vector", "application/x-protobuf"], ["terrain", "image/png"]]) {
        const url = `${editing.origin}/tiles/${kind}/10/512/511?contours=100`;
        const first = await fetch(url);
        assert.equal(first.status, 200);
        assert.equal(first.headers.get("content-type"), type);
        assert.ok((await first.arrayBuffer()).byteLength > 0);
        const known = { headers: { "If-None-Match": first.headers.get("etag") } };
        assert.equal((await fetch(url, known)).status, 304);
        psql("SELECT abacus_insert('terrain', 'SELECT 1, 400815.5, 5200741.5, 900')");
        assert.equal((await fetch(url, known)).status, 200);
        psql("SELECT abacus_delete('terrain', 'SELECT 1, 400815.5, 5200741.5')");
    }
});

test("bad input is an error that says what is wrong", async () => {
    const before = count();
    for (const path of ["locate", "locate?x=1", "locate?x=1&y=NaN", "locate?x=Infinity&y=0", "locate?x=1&y=0x10", "locate?x=1&y=1e999", "locate?x=1;2&y=2",
        "locate?x=1&y=2&attribute=depth", "profile", "profile?path=1,2", "profile?path=1,2,3,4,5", "profile?path=1,2,a,b", `profile?path=${"1,".repeat(5000)}1`,
        "sight?from=1,2", "sight?from=1,2&to=3", "sight?from=1,2&to=3,4&observer=high"]) {
        const { status, body } = await plane.get(`/api/${path}`);
        assert.equal(status, 400, path);
        assert.ok(body.error.length > 5, path);
    }
    for (const path of ["section?through=1,2,3", "section?through=1,2,3&normal=0,0,0", "isosurface", "isosurface?value=x", "ray?origin=1,2&direction=1,2,3"])
        assert.equal((await space.get(`/api/${path}`)).status, 400, path);
    for (const path of ["picture/3/8/0", "vector/31/0/0", "terrain/3/0/99999999999", "picture/3/0/0?ramp=pink", "vector/3/0/0?contours=-1", "vector/3/0/0?contours=many"])
        assert.equal((await plane.get(`/tiles/${path}`)).status, 400, path);
    for (const path of ["/api/", "/api/drop", "/api/__proto__", "/api/constructor", "/tiles/picture/a/b/c", "/tiles/sql/0/0/0", "/assets/../server.js", "/assets/..%2fserver.js",
        "/server.js", "/assets/node_modules", "/.git/config", "/assets/nothing.js"])
        assert.equal((await plane.get(path)).status, 404, path);
    assert.equal((await space.get("/tiles/picture/0/0/0")).status, 404);
    assert.equal((await plane.get("/api/info", { method: "POST" })).status, 405);
    assert.equal(count(), before);
});

/** What is answered to bytes that no client of HTTP would send. */
const raw = (server, line) => new Promise((resolve, reject) => {
    const socket = net.connect(new URL(server.origin).port, "127.0.0.1", () => socket.write(`${line} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n`));
    let text = "";
    socket.setEncoding("utf8").on("data", (part) => (text += part)).on("end", () => resolve({ status: Number(text.split(" ")[1]), text })).on("error", reject);
});

test("odd addresses and bodies are the client's fault", async (t) => {
    const said = t.mock.method(console, "error", () => {});
    for (const [line, status] of [["GET //", 404], ["GET ///api/info", 404], ["GET //evil.example/", 404], ["GET http://evil.example/", 400], ["GET *", 400], ["GET /%", 404], ["GET /%00", 404],
        ["GET /\\", 404], ["GET /api/locate?x=1&y=2&attribute=%00", 400], ["GET /tiles/picture/3/4/3?ramp=%00", 400], ["POST //", 405], ["POST /edit//", 415]])
        assert.equal((await raw(editing, line)).status, status, line);
    const session = (await editing.post("begin")).body.session;
    const send = (name, body, type = "application/json") => editing.get(`/edit/${name}`, { method: "POST", body, headers: { "Content-Type": type, "X-Session": session } });
    for (const name of ["begin", "alive", "insert", "save", "end", "nothing"])
        for (const body of ["null", "[]", "[1]", "7", '"x"', "true", "nul", "{}}"]) assert.equal((await send(name, body)).status, 400, `${name} ${body}`);
    const at = [400817.5, 5200740.5];
    for (const body of [{ id: { toString: 1, valueOf: 1 }, at }, { id: ["1"], at }, { id: null, at }, { id: true, at }, { id: 1.5, at }, { id: 2 ** 53, at }, { at }, { id: "1", at: null }, { id: "1", at: { length: 2 } },
        { id: "1", at, values: false }, { id: "1", at, values: { length: 1 } }, { id: "1", at, values: "x" }])
        assert.equal((await send("insert", JSON.stringify(body))).status, 400, JSON.stringify(body));
    assert.equal((await send("alive", `"${"x".repeat(1_000_000)}"`)).status, 413);
    assert.equal((await send("alive", "{}", "text/plain")).status, 415);
    assert.equal((await send("alive", "{}", "application/json; charset=utf-8")).status, 200);
    await editing.post("end", {}, session);
    assert.equal(said.mock.callCount(), 0); // none of this deserves a line in the log
});

test("SQL in parameters is text", async () => {
    const before = count();
    const attack = "height'); DROP TABLE terrain; --";
    for (const path of [`/api/locate?x=400817&y=5200740&attribute=${encodeURIComponent(attack)}`, `/tiles/picture/3/4/3?ramp=${encodeURIComponent(attack)}`,
        `/api/profile?path=1,2,3,4&attribute=${encodeURIComponent(attack)}`, `/api/locate?x=${encodeURIComponent("1); DROP TABLE terrain; --")}&y=1`])
        assert.equal((await plane.get(path)).status, 400, path);
    await assert.rejects(serve("terrain; DROP TABLE terrain"), /invalid name syntax|does not exist/);
    await assert.rejects(serve("pg_class"), /not a mesh/);
    assert.equal(count(), before);
});

test("it reads only, and says which pages may do what", async () => {
    assert.equal((await plane.post("begin")).status, 403);
    assert.equal((await plane.post("insert", { id: 1, at: [1, 2] })).status, 403);
    assert.equal((await plane.get("/edit/begin")).status, 405);
    const { headers } = await fetch(plane.origin);
    assert.match(headers.get("content-security-policy"), /default-src 'none'/);
    assert.doesNotMatch(headers.get("content-security-policy"), /unsafe|https?:|\*/);
    assert.equal(headers.get("x-content-type-options"), "nosniff");
    const database = new Database({}, { timeout: 5000, edit: false });
    try {
        await assert.rejects(database.rows(null, "CREATE TABLE written ()", []), { code: "25006" });
        await assert.rejects(database.open(), { status: 403 });
    } finally {
        await database.end();
    }
});

test("a base map widens the policy by its server alone, and is named only where the mesh lies on the earth", async () => {
    const baseMap = "https://maps.example:8443/tiles/{z}/{x}/{y}.png?key=1";
    for (const srid of [4326, 0]) {
        const server = await serve("globe", { srid, baseMap, credit: "Example" });
        try {
            assert.match((await fetch(server.origin)).headers.get("content-security-policy"), /connect-src 'self' https:\/\/maps\.example:8443; base-uri/);
            const { body } = await server.get("/api/info");
            assert.deepEqual([body.baseMap, body.credit], srid ? [baseMap, "Example"] : [undefined, undefined]);
        } finally {
            await server.stop();
        }
    }
    for (const address of ["javascript:alert(1)", "https://maps.example/{z}/{x}.png", "https://maps.example/{z}/{x}/{y}.png; script-src *".replace("https", "ftp"), "https://evil'self'/{z}/{x}/{y}"]) {
        await assert.rejects(promisify(execFile)(process.execPath, ["viewer/server.js", "--mesh", "globe", "--base-map", address]), { code: 1, stderr: /--base-map must be an address/ });
    }
});

test("the border has the values of SQL; tiles say where the mesh is not, and take a range of colours", async () => {
    const { status, body } = await plane.get("/api/hull");
    assert.equal(status, 200);
    assert.equal(body.length, Number(psql("SELECT count(*) FROM abacus_hull('terrain')")));
    for (const { x, y, value } of body.slice(0, 5)) assert.equal(value, Number(psql(`SELECT abacus_interpolate('terrain', ${x}, ${y})`)));
    assert.deepEqual((await plane.get("/api/lines")).body, []);
    const bytes = async (path) => Buffer.from(await (await fetch(plane.origin + path)).arrayBuffer());
    const sql = (call) => Buffer.from(psql(`SELECT encode(${call}, 'hex')`), "hex");
    const { world } = (await plane.get("/api/info")).body, own = `world => '{${world}}', attribute => 'height'`;
    assert.ok((await bytes("/tiles/terrain/9/256/255?outside=none")).equals(sql(`abacus_tile_terrain('terrain', 9, 256, 255, ${own}, fill => -32768)`)));
    assert.ok((await bytes("/tiles/picture/9/256/255?low=700&high=900&size=512&edges=no")).equals(sql(`abacus_tile_picture('terrain', 9, 256, 255, ${own}, range => '{700,900}', edges => false, size => 512)`)));
    for (const wrong of ["low=x", "size=5000", "size=1.5"]) assert.equal((await plane.get(`/tiles/picture/9/256/255?${wrong}`)).status, 400, wrong);
    assert.equal((await plane.get("/api/hull?attribute=depth")).status, 400);
});

test("levels of detail: pictures and heights of small zooms come from them, unless the mesh has changed or exact ones are wanted", async () => {
    psql(`SET client_min_messages = warning; DROP TABLE IF EXISTS detailed CASCADE;
        SELECT abacus_triangulate('detailed', 'SELECT 1000 * i + j AS id, 10 * i + (j % 3) AS x, 10 * j + (i % 3) AS y, 100 * sin(i / 9.0) * cos(j / 11.0) + (i * j) % 7 / 9.0 AS height, i::float8 AS other FROM generate_series(0, 79) AS i, generate_series(0, 79) AS j');
        SELECT abacus_levels('detailed', '{0.6,5}', 'height')`);
    const server = await serve("detailed"), role = "regress_levels";
    try {
        const { body: info } = await server.get("/api/info"), { least, greatest } = info.attributes[0], error = (greatest - least) / 256, own = `world => '{${info.world}}', attribute => 'height'`;
        assert.equal(info.levels, "height");
        const same = async (path, call, where = server) => assert.ok(Buffer.from(await (await fetch(where.origin + path)).arrayBuffer()).equals(Buffer.from(psql(`SELECT encode(${call}, 'hex')`), "hex")), path);
        const place = (z) => [z, 2 ** (z - 1), 2 ** (z - 1) - 1], picture = (z, more = "") => `abacus_tile_picture('detailed', ${place(z)}, ${own}, range => '{0,50}', edges => false${more})`;
        const heights = (z, more = "") => `abacus_tile_terrain('detailed', ${place(z)}, ${own}, fill => -32768${more})`, ask = "attribute=height&low=0&high=50&edges=no", within = `, max_error => ${error}`;
        assert.equal(psql(`SELECT abacus_level('detailed', ${error})`), "detailed_level_1"); // or nothing would be seen of it
        assert.notEqual(psql(`SELECT md5(${picture(8)})`), psql(`SELECT md5(${picture(8, within)})`));
        await same(`/tiles/picture/${place(8).join("/")}?${ask}`, picture(8, within));
        await same(`/tiles/picture/${place(12).join("/")}?${ask}`, picture(12));
        await same(`/tiles/terrain/${place(8).join("/")}?attribute=height&outside=none`, heights(8, within));
        await same(`/tiles/terrain/${place(8).join("/")}?attribute=height&outside=none&exact=yes`, heights(8));
        await same(`/tiles/terrain/${place(12).join("/")}?attribute=height&outside=none`, heights(12));
        await same(`/tiles/picture/${place(8).join("/")}?attribute=other&low=0&high=50&edges=no`, picture(8).replace("'height'", "'other'")); // the levels are those of another attribute
        // a role that may not read the levels
        psql(`SET client_min_messages = warning; DROP ROLE IF EXISTS ${role}; CREATE ROLE ${role} LOGIN; GRANT SELECT ON detailed, detailed_vertices, detailed_levels TO ${role}`);
        const other = await serve("detailed", { dbname: `user=${role}` });
        try {
            assert.equal((await other.get("/api/info")).body.levels, null);
            await same(`/tiles/picture/${place(8).join("/")}?${ask}`, picture(8), other);
        } finally {
            await other.stop();
        }
        psql("SELECT abacus_insert('detailed', 'SELECT -1, 401.5, 402.5, 90.0, 0.0')"); // the levels are older now
        assert.equal((await server.get("/api/info")).body.levels, null);
        await same(`/tiles/picture/${place(8).join("/")}?${ask}`, picture(8));
        psql("SELECT abacus_levels_refresh('detailed')");
        await same(`/tiles/picture/${place(8).join("/")}?${ask}`, picture(8, `, max_error => ${error}`));
    } finally {
        await server.stop();
        psql(`SET client_min_messages = warning; DROP TABLE IF EXISTS detailed CASCADE; DROP ROLE IF EXISTS ${role}`);
    }
});

test("regions: their list, the one at a place, and tiles and borders of one alone, as SQL has them", async () => {
    const shire = await serve("shire"), lake = `O'Hara & "lake"`, named = encodeURIComponent(lake), quoted = "$$" + lake + "$$";
    try {
        const { body } = await shire.get("/api/regions");
        assert.deepEqual(body.map(({ region, number, triangles, area }) => [region, number, String(triangles), area]),
            psql("SELECT region, number, triangles, area FROM abacus_regions('shire')").split("\n").map((row) => row.split("|")).map(([region, number, triangles, area]) => [region, Number(number), triangles, Number(area)]));
        assert.deepEqual(body.map(({ region }) => region), [lake, "farm"]);
        assert.deepEqual((await plane.get("/api/regions")).body, []);
        for (const [x, y, region] of [[91, 92, lake], [41, 92, "farm"], [3, 92, null]]) {
            assert.equal((await shire.get(`/api/locate?x=${x}&y=${y}&regions=yes`)).body.region, region);
            assert.equal((await shire.get(`/api/star?x=${x}&y=${y}&regions=yes`)).body[0].region, region);
        }
        for (const kind of ["locate", "star"]) assert.ok(!JSON.stringify((await shire.get(`/api/${kind}?x=91&y=92`)).body).includes("region"));
        assert.equal((await shire.get(`/api/hull?within=${named}`)).body.length, Number(psql(`SELECT count(*) FROM abacus_hull('shire', within => ${quoted})`)));
        const bytes = async (path) => Buffer.from(await (await fetch(shire.origin + path)).arrayBuffer());
        const sql = (call) => Buffer.from(psql(`SELECT encode(${call}, 'hex')`), "hex");
        const { world } = (await shire.get("/api/info")).body, own = `'shire', 9, 255, 256, world => '{${world}}', attribute => 'height'`, path = (kind, more) => `/tiles/${kind}/9/255/256?${more}`;
        const colours = "low=0&high=400", range = "range => '{0,400}'";
        assert.ok((await bytes(path("picture", `${colours}&within=${named}`))).equals(sql(`abacus_tile_picture(${own}, ${range}, within => ${quoted})`)));
        assert.ok((await bytes(path("picture", `${colours}&regions=yes`))).equals(sql(`abacus_tile_picture(${own}, ${range}, regions => true)`)));
        assert.ok(!(await bytes(path("picture", colours))).equals(await bytes(path("picture", `${colours}&regions=yes`))));
        assert.ok((await bytes(path("vector", `within=${named}`))).equals(sql(`abacus_tile_vector(${own}, within => ${quoted})`)));
        assert.ok((await bytes(path("terrain", `outside=none&within=${named}`))).equals(sql(`abacus_tile_terrain(${own}, fill => -32768, within => ${quoted})`)));
        const attack = encodeURIComponent("x'); DROP TABLE shire; --");
        for (const wrong of [path("picture", "regions=1"), path("picture", "regions=true"), path("picture", `regions=${attack}`), path("vector", "within=heath"), path("picture", `within=${attack}`),
            path("terrain", "within=%00"), "/api/hull?within=heath", `/api/hull?within=${attack}`, "/api/star?x=1&y=1&regions=all", "/api/locate?x=1&y=1&regions=YES"])
            assert.equal((await shire.get(wrong)).status, 400, wrong);
        assert.equal((await space.get("/api/regions")).status, 404);
        // a role that may read the mesh, but not its regions
        psql("SET client_min_messages = warning; DROP ROLE IF EXISTS regress_regions; CREATE ROLE regress_regions LOGIN; GRANT SELECT ON shire, shire_vertices TO regress_regions");
        const other = await serve("shire", { dbname: "user=regress_regions" });
        try {
            for (const [path, status] of [["/api/regions", 403], ["/api/star?x=91&y=92&regions=yes", 403], [`/api/hull?within=${named}`, 403], ["/api/star?x=91&y=92", 200], ["/api/info", 200]])
                assert.equal((await other.get(path)).status, status, path);
            for (const tile of [path("vector", ""), path("picture", "regions=yes"), path("terrain", "")]) assert.equal((await fetch(other.origin + tile)).status, 200, tile);
        } finally {
            await other.stop();
            psql("DROP OWNED BY regress_regions; DROP ROLE regress_regions");
        }
        psql(`SELECT abacus_unregion('shire', ${quoted})`);
        assert.equal((await shire.get(path("vector", `within=${named}`))).status, 400);
        assert.equal((await shire.get("/api/star?x=91&y=92&regions=yes")).body[0].region, null);
    } finally {
        await shire.stop();
    }
});

test("functions are those of the extension, whatever else is called so", async () => {
    psql("SET client_min_messages = warning; CREATE SCHEMA nearer; CREATE FUNCTION nearer.abacus_stats(regclass) RETURNS TABLE (name text, value float8) LANGUAGE sql AS $$ SELECT 'dimension', 7 $$");
    const before = process.env.PGOPTIONS;
    process.env.PGOPTIONS = "-c search_path=nearer,public";
    try {
        const server = await serve("terrain");
        const { body } = await server.get("/api/info");
        await server.stop();
        assert.equal(body.dimension, 2);
        assert.equal(body.simplices, 5968);
    } finally {
        if (before === undefined) delete process.env.PGOPTIONS;
        else process.env.PGOPTIONS = before;
        psql("SET client_min_messages = warning; DROP SCHEMA nearer CASCADE");
    }
});

test("another name that leads here is refused", async () => {
    const { port } = new URL(plane.origin);
    const status = await new Promise((resolve) => http.get({ host: "127.0.0.1", port, path: "/api/info", headers: { Host: "evil.example" } }, (response) => resolve(response.resume().statusCode)));
    assert.equal(status, 421);
});

test("a role without SELECT sees nothing", async () => {
    psql("SET client_min_messages = warning; DROP ROLE IF EXISTS regress_viewer; CREATE ROLE regress_viewer LOGIN");
    await assert.rejects(serve("terrain", { dbname: "user=regress_viewer" }), /permission denied/);
    psql("GRANT SELECT ON terrain, terrain_vertices TO regress_viewer");
    const server = await serve("terrain", { dbname: "user=regress_viewer", edit: true });
    try {
        assert.equal((await server.get("/api/locate?x=400817&y=5200740")).status, 200);
        const { body: { session } } = await server.post("begin");
        const refused = await server.post("insert", { id: 1, at: [400817.5, 5200740.5] }, session);
        assert.equal(refused.status, 403);
        psql("REVOKE SELECT ON terrain, terrain_vertices FROM regress_viewer");
        for (const path of ["/api/info", "/api/locate?x=400817&y=5200740", "/tiles/picture/3/4/3"]) {
            const { status, body } = await server.get(path);
            assert.equal(status, 403, path);
            assert.deepEqual(Object.keys(body), ["error"]);
        }
    } finally {
        await server.stop();
        psql("DROP ROLE regress_viewer");
    }
});

test("a client that goes away cancels what it asked", async () => {
    const locker = await connect(), watcher = await connect();
    const waiting = async () => (await watcher.query("SELECT count(*)::int AS n FROM pg_stat_activity WHERE application_name = 'abacus viewer' AND wait_event_type = 'Lock'")).rows[0].n;
    try {
        await locker.query("BEGIN; LOCK TABLE terrain IN ACCESS EXCLUSIVE MODE");
        const gone = new AbortController();
        const asked = fetch(`${plane.origin}/api/locate?x=400817&y=5200740`, { signal: gone.signal }).catch((error) => error.name);
        await eventually(async () => (await waiting()) === 1, "a request waits");
        gone.abort();
        assert.equal(await asked, "AbortError");
        await eventually(async () => (await waiting()) === 0, "nothing waits any more");
    } finally {
        await locker.query("ROLLBACK");
        await locker.end();
        await watcher.end();
    }
    assert.equal((await plane.get("/api/locate?x=400817&y=5200740")).status, 200);
});

test("a statement has a limit on its time", async () => {
    const server = await serve("terrain", { timeout: 1 });
    const locker = await connect();
    try {
        await locker.query("BEGIN; LOCK TABLE terrain IN ACCESS EXCLUSIVE MODE");
        assert.deepEqual(await server.get("/api/info"), { status: 504, body: { error: "the query took too long" } });
    } finally {
        await locker.query("ROLLBACK");
        await locker.end();
        await server.stop();
    }
});

test("a mesh whose points take longer to read than a statement may is read once, for all who ask", async (t) => {
    psql("SELECT abacus_triangulate('fields', 'SELECT i * 1000 + j, i + sin(j) / 4, j + cos(i) / 4, i * j AS height FROM generate_series(0, 499) AS i, generate_series(0, 499) AS j')");
    const took = (statement) => {
        const from = performance.now();
        psql(statement);
        return performance.now() - from;
    };
    const server = await serve("fields", { timeout: took("SELECT abacus_attributes('fields')") / 2000 });
    const read = t.mock.method(Database.prototype, "alone");
    try {
        const answers = await Promise.all(Array.from({ length: 6 }, () => server.get("/api/info")));
        for (const { status, body } of answers) assert.deepEqual([status, body.attributes], [200, [{ name: "height", least: 0, greatest: 499 * 499 }]]);
        assert.equal(read.mock.callCount(), 1);
    } finally {
        await server.stop();
        psql("DROP TABLE fields CASCADE");
    }
});

test("connections that are gone are replaced", async () => {
    psql("SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE application_name = 'abacus viewer'");
    await eventually(async () => (await plane.get("/api/locate?x=400817&y=5200740")).status === 200, "an answer");
});

test("changes are seen by their session alone until they are saved", async () => {
    const before = count(), at = [400817.5, 5200740.5];
    const { body: { session } } = await editing.post("begin");
    const seen = async (headers) => (await editing.get(`/api/star?x=${at[0]}&y=${at[1]}`, { headers })).body.length;
    assert.deepEqual((await editing.post("insert", { id: "77", at }, session)).body, { changes: 1 });
    assert.ok((await seen({ "X-Session": session })) > 2);
    assert.equal(await seen({}), 1);
    assert.equal((await editing.post("insert", { id: "78", at }, session)).status, 409);
    assert.deepEqual((await editing.post("move", { id: "77", at, to: [400818.5, 5200741.5] }, session)).body, { changes: 2 });
    assert.deepEqual((await editing.post("undo", {}, session)).body, { changes: 2 });
    assert.equal(count(), before);
    assert.equal(await seen({ "X-Session": session }), 1);

    await editing.post("insert", { id: "77", at, values: [1234.5] }, session);
    assert.deepEqual((await editing.post("save", {}, session)).body, { changes: 1 });
    assert.equal(psql(`SELECT vertex, attributes FROM abacus_nearest('terrain', ${at})`), "77|{1234.5}");
    assert.equal((await editing.post("remove", { id: "78", at }, session)).status, 409);
    await editing.post("remove", { id: "77", at }, session);
    await editing.post("save", {}, session);
    assert.equal(count(), before);
});

test("changes that make no sense change nothing", async () => {
    const { body: { session } } = await editing.post("begin");
    await editing.post("insert", { id: "77", at: [400817.5, 5200740.5] }, session);
    for (const [name, body] of [["insert", {}], ["insert", { id: "x", at: [1, 2] }], ["insert", { id: "1", at: [1] }], ["insert", { id: "1", at: ["1", "2"] }],
        ["insert", { id: "1", at: [1, null] }], ["insert", { id: "1", at: [1, 2], values: [1, 2] }], ["insert", { id: "1', 0, 0); DROP TABLE terrain; --", at: [1, 2] }],
        ["insert", { id: "1", at: [1, 2], values: ["1); DROP TABLE terrain"] }], ["move", { id: "77", at: [400817.5, 5200740.5] }]])
        assert.equal((await editing.post(name, body, session)).status, 400, JSON.stringify(body));
    assert.equal((await editing.post("drop", { id: "1", at: [1, 2] }, session)).status, 404);
    assert.equal((await editing.post("insert", { id: "1", at: [1, 2] }, "no such session")).status, 410);
    assert.equal((await editing.get("/edit/begin", { method: "POST", body: "id=1" })).status, 415);
    assert.equal((await editing.get("/edit/begin", { method: "POST", body: "{", headers: { "Content-Type": "application/json" } })).status, 400);
    assert.deepEqual((await editing.post("undo", {}, session)).body, { changes: 1 }); // earlier changes can still be undone
});

test("what a session has not saved is undone when it ends", async () => {
    const before = count();
    const { body: { session } } = await editing.post("begin");
    await editing.post("insert", { id: "77", at: [400817.5, 5200740.5] }, session);
    await editing.post("end", {}, session);
    assert.equal((await editing.post("save", {}, session)).status, 410);
    const { body: { session: other } } = await editing.post("begin");
    await editing.post("insert", { id: "77", at: [400817.5, 5200740.5] }, other);
    psql("SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE application_name = 'abacus viewer' AND state = 'idle in transaction'");
    await eventually(async () => (await editing.post("save", {}, other)).status === 410, "the session has ended");
    assert.equal(count(), before);
});

test("a mesh is where its SRID says, or an option, or on a map of its own", async () => {
    const maps = async (mesh, options) => {
        const server = await serve(mesh, options);
        const { body: { srid, world } } = await server.get("/api/info");
        assert.equal((await fetch(`${server.origin}/tiles/picture/10/512/511`)).status, 200);
        await server.stop();
        return [srid, world?.length ?? null];
    };
    assert.deepEqual(await maps("globe"), [null, 3]);
    assert.deepEqual(await maps("globe", { srid: 4326 }), [4326, null]);
    psql("SELECT abacus_set_srid('globe', 4326)");
    assert.deepEqual(await maps("globe"), [4326, null]);
    psql("SELECT abacus_set_srid('globe', 25832)");
    assert.deepEqual(await maps("globe"), [null, 3]);
    psql("SELECT abacus_set_srid('globe', 0)");
});

test("an ETag is that of one map", async () => {
    const etags = [];
    for (const options of [{}, { srid: 4326 }, { srid: 3857 }]) {
        const server = await serve("globe", options);
        const ask = (etag) => fetch(`${server.origin}/tiles/picture/10/532/358`, { headers: { "If-None-Match": etag } });
        for (const etag of etags) assert.equal((await ask(etag)).status, 200);
        const own = (await ask('"none"')).headers.get("etag");
        assert.equal((await ask(own)).status, 304);
        etags.push(own);
        await server.stop();
    }
});

test("a mesh that was empty gets its map with its first points", async () => {
    psql("SELECT abacus_create('empty', 2)");
    const server = await serve("empty");
    try {
        const { body: before } = await server.get("/api/info");
        assert.equal(before.lower[0], null);
        psql("SELECT abacus_insert('empty', 'SELECT i, 5000 + 100 * (i % 3), 7000 + 100 * (i / 3) FROM generate_series(0, 8) AS i')");
        const { body: after } = await server.get("/api/info");
        assert.deepEqual(after.world, [5100 - 102400, 7100 - 102400, 204800]);
    } finally {
        await server.stop();
        psql("DROP TABLE empty");
    }
});

test("the map stays when the mesh grows", async () => {
    const { body: before } = await editing.get("/api/info");
    const { body: { session } } = await editing.post("begin");
    await editing.post("insert", { id: "77", at: [before.upper[0] + 5000, before.upper[1]] }, session);
    const { body: after } = await editing.get("/api/info", { headers: { "X-Session": session } });
    assert.notEqual(after.upper[0], before.upper[0]);
    assert.deepEqual(after.world, before.world);
    await editing.post("undo", {}, session);
    await editing.post("end", {}, session);
});

test("terrain goes on beyond the mesh as low as the mesh gets", async () => {
    const { body: { attributes, world } } = await plane.get("/api/info");
    const bytes = Buffer.from(await (await fetch(`${plane.origin}/tiles/terrain/3/0/0`)).arrayBuffer()).toString("hex");
    assert.ok(attributes[0].least > 500);
    assert.equal(bytes, psql(`SELECT encode(abacus_tile_terrain('terrain', 3, 0, 0, world => '{${world}}', fill => ${attributes[0].least}), 'hex')`));
});

test("ids of points are of 64 bits", async () => {
    const { body: { session } } = await editing.post("begin");
    for (const id of ["9223372036854775807", "-9223372036854775808"]) {
        const at = [400817.5, 5200740.5];
        assert.equal((await editing.post("insert", { id, at }, session)).status, 200, id);
        assert.equal((await editing.post("remove", { id, at }, session)).status, 200, id);
    }
    for (const id of ["9223372036854775808", "-9223372036854775809", "99999999999999999999"])
        assert.equal((await editing.post("insert", { id, at: [400817.5, 5200740.5] }, session)).status, 400, id);
    await editing.post("end", {}, session);
});

test("ids beyond 53 bits stay what they are", async () => {
    const of = (dimension) => Array.from({ length: dimension === 2 ? 4 : 5 }, (_, i) => String(2n ** 53n + BigInt(i)));
    psql(`SELECT abacus_triangulate('great', 'SELECT 9007199254740992 + i, i % 2, i / 2, i FROM generate_series(0, 3) AS i');
          SELECT abacus_triangulate('greater', 'SELECT 9007199254740992 + i, i % 2, i / 2 % 2, i / 4, i FROM generate_series(0, 4) AS i', dimension => 3)`);
    for (const [name, dimension, places] of [["great", 2, ["x=0.1&y=0.2", "x=0.9&y=0.8"]], ["greater", 3, ["x=0.1&y=0.2&z=0.1", "x=0.3&y=0.6&z=0.05"]]]) {
        const server = await serve(name, { edit: true });
        try {
            const found = new Set();
            for (const place of places) {
                const { body: { simplex, neighbours, nearest } } = await server.get(`/api/locate?${place}`);
                for (const id of [...simplex.ids, ...neighbours.flatMap((one) => one?.ids ?? []), nearest.vertex]) found.add(id);
                assert.equal(simplex.code, psql(`SELECT code FROM abacus_locate('${name}', ${place.replaceAll(/[xyz]=/g, "").replaceAll("&", ",")})`));
            }
            assert.deepEqual([...found].sort(), of(dimension));
            const rows = (await server.get(dimension === 2 ? "/api/star?x=0&y=0" : "/api/ray?origin=-1,0.2,0.1&direction=1,0,0")).body;
            for (const row of rows) for (const id of [row.v0, row.v1, row.v2]) assert.ok(of(dimension).includes(id), id);
            const { body: { session } } = await server.post("begin");
            const at = dimension === 2 ? [1, 0] : [1, 0, 0];
            for (const [id, status] of [["9007199254740992", 409], [9007199254740992, 400], ["9007199254740993", 200]]) // the number is also 9007199254740993
                assert.equal((await server.post("remove", { id, at }, session)).status, status, id);
            await server.post("end", {}, session);
        } finally {
            await server.stop();
            psql(`DROP TABLE ${name} CASCADE`);
        }
    }
});

test("connection strings are read as libpq does", () => {
    assert.deepEqual(connection("host=/tmp dbname='my db' user=o\\'neil password='it''s'".replace("''s", "\\'s")), { host: "/tmp", database: "my db", user: "o'neil", password: "it's" });
    assert.deepEqual(connection("gis"), { database: "gis" });
    assert.deepEqual(connection("postgresql://localhost/gis"), { connectionString: "postgresql://localhost/gis" });
    assert.deepEqual(connection(undefined), {});
    assert.throws(() => connection("host=a colour=b"), /does not know/);
    assert.throws(() => connection("host=a b"), /cannot read/);
});

test("without a host the server is this machine's", () => {
    assert.equal(folderOfSocket(["/nowhere", "/usr", process.env.PGHOST]), process.env.PGHOST);
    assert.equal(folderOfSocket(["/nowhere", "/usr"]), undefined);
});

test("packages have fixed versions and a hash, and come from npm's registry", () => {
    const { packages } = JSON.parse(readFileSync(new URL("../../viewer/package-lock.json", import.meta.url)));
    const { dependencies, devDependencies } = packages[""];
    for (const version of Object.values({ ...dependencies, ...devDependencies })) assert.match(version, /^\d+\.\d+\.\d+(-[\w.]+)?$/); // exact, also of one before a release
    for (const [name, one] of Object.entries(packages).filter(([name]) => name !== "")) {
        assert.match(one.resolved ?? "https://registry.npmjs.org/", /^https:\/\/registry\.npmjs\.org\//, name);
        assert.match(one.integrity, /^sha512-/, name);
    }
});

test("the command says what is wrong", () => {
    const run = (...words) => spawnSync(process.execPath, [new URL("../../viewer/server.js", import.meta.url).pathname, ...words], { encoding: "utf8" });
    for (const [words, message] of [[["--mesh", ""], /--mesh has no name/], [["--mesh", "terrain", "--srid", "25832"], /--srid must be/], [["--mesh", "terrain", "--port", "x"], /--port must be/], [["--mesh", "terrain", "--idle", "0"], /--idle must be/],
        [["--mesh", "nothing", "--port", "0"], /relation "nothing" does not exist/], [["--mesh", "terrain", "-d", "dbname=nothing"], /database "nothing" does not exist/], [["--wrong"], /Unknown option/]]) {
        const { status, stderr } = run(...words);
        assert.equal(status, 1, String(words));
        assert.match(stderr, message);
    }
    assert.match(run("--help").stdout, /usage/);
});
