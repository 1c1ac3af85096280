// A server without --mesh: the list of the meshes, each of them below its own address, and several meshes over one another.
import assert from "node:assert/strict";
import { test } from "node:test";
import { answer, browser, cell, choose, click, display, page, pictures, says, servers, setUp, take } from "./browser.js";
import { contrasts } from "./contrast.js";
import { connect, eventually, psql, serve } from "./support.js";

const odd = `o'Neil & "sons" / 50%?`; // a name that has to be encoded everywhere
const oddAddress = `/mesh/${encodeURIComponent("sites; --")}/${encodeURIComponent(odd)}`;
let client;
setUp(async () => {
    client = await connect();
    await client.query(`SET client_min_messages = error; DROP SCHEMA IF EXISTS "sites; --" CASCADE; DROP TABLE IF EXISTS later, mercator, utm, loaded, faulty, bare, cells, blocks CASCADE; CREATE SCHEMA "sites; --";
        SELECT abacus_triangulate('later', 'SELECT id, x, y, attributes[1] + 5 + (x - 400000) / 100 AS height FROM abacus_vertices(''terrain'')');
        SELECT abacus_triangulate('mercator', 'SELECT i * 100 + j, 1000000 + 100 * i + j % 3, 6000000 + 100 * j + i % 3, i * j AS depth FROM generate_series(0, 12) AS i, generate_series(0, 12) AS j'); SELECT abacus_set_srid('mercator', 3857);
        SELECT abacus_triangulate('utm', 'SELECT i * 100 + j, 500000 + 100 * i + j % 3, 5400000 + 100 * j + i % 3, i * j AS height FROM generate_series(0, 12) AS i, generate_series(0, 12) AS j'); SELECT abacus_set_srid('utm', 25832);
        SELECT abacus_load('loaded', 'VALUES (1, 0, 0, 5), (2, 4, 0, 6), (3, 8, 1, 7), (4, 4, 2, 8)', 'VALUES (1, 2, 3), (1, 3, 4)', attributes => '{z}');
        SELECT abacus_load('faulty', 'VALUES (1, 0, 0, 0), (2, 2, 0, 0), (4, 0, 2, 0), (5, 2, 2, 0), (12, 2, 0, 1), (3, 4, 0, 1), (6, 4, 2, 1), (15, 2, 2, 1)', 'VALUES (1, 2, 5), (1, 5, 4), (12, 3, 6), (12, 6, 15)', attributes => '{slip}', split_nodes => true);
        SELECT abacus_create('bare', 2);
        SELECT abacus_octree_create('cells', 2, '{0,0}', '{8,4}', attributes => '{vs}'); SELECT abacus_octree_refine('cells', 'SELECT 4, 3.0, 1.0'); SELECT abacus_octree_balance('cells');
        SELECT abacus_octree_update('cells', 'SELECT code, lower[1] FROM abacus_octants(''cells'')');
        SELECT abacus_octree_create('blocks', 3, '{0,0,-4}', '{8,8,0}', attributes => '{vs}'); SELECT abacus_octree_refine('blocks', 'SELECT 4, 3.0, 1.0, -1.0'); SELECT abacus_octree_balance('blocks');
        SELECT abacus_octree_update('blocks', 'SELECT code, level + lower[3] FROM abacus_octants(''blocks'')')`);
    await client.query(`SELECT abacus_create($1, 2, attributes => '{a}')`, [`"sites; --"."${odd.replaceAll('"', '""')}"`]);
    await client.query(`SELECT abacus_insert($1::text::regclass, 'VALUES (1, 0, 0, 1), (2, 1, 0, 2), (3, 0, 1, 3)')`, [`"sites; --"."${odd.replaceAll('"', '""')}"`]);
    await client.end();
    return { all: await serve(undefined, { edit: true }) };
});

const meshes = ["terrain", "globe", "rock", "shire", "later", "mercator", "utm", "loaded", "faulty", "bare", "cells", "blocks"];

test("the list has every mesh that the role may read, and its facts", async () => {
    const { body } = await servers.all.get("/api/meshes"), of = (name) => body.find((one) => one.name === name);
    for (const name of meshes) assert.ok(of(name), name);
    assert.equal(body.filter(({ name }) => /_vertices$|_lines$/.test(name)).length, 0); // tables that belong to a mesh are none
    assert.equal(of("terrain").simplices, Number(psql("SELECT value FROM abacus_stats('terrain') WHERE name = 'simplices'")));
    assert.equal(of("terrain").bytes, Number(psql("SELECT pg_total_relation_size('terrain') + pg_total_relation_size('terrain_vertices')")));
    assert.deepEqual([of("cells").kind, of("cells").leaves, of("utm").srid, of("bare").simplices], ["octree", Number(psql("SELECT count(*) FROM abacus_octants('cells')")), 25832, 0]);
    assert.ok(Math.abs(Date.now() - Date.parse(of("terrain").changed)) < 3_600_000);
    psql("SET client_min_messages = warning; DROP ROLE IF EXISTS regress_list; CREATE ROLE regress_list LOGIN; GRANT SELECT ON globe, globe_vertices TO regress_list");
    const other = await serve(undefined, { dbname: "user=regress_list" });
    try {
        const { body } = await other.get("/api/meshes");
        assert.deepEqual(body.map(({ name }) => name), ["globe"]);
        assert.equal(body[0].changed, null); // that is not for everybody
        assert.equal((await other.get("/mesh/public/terrain/api/info")).status, 404);
        assert.equal((await other.get("/mesh/public/globe/api/info?of=public/terrain")).status, 404);
        assert.equal((await other.get("/mesh/public/globe/api/info")).status, 200);
    } finally {
        await other.stop();
        psql("DROP OWNED BY regress_list; DROP ROLE regress_list");
    }
});

test("names in addresses are names, whatever is in them; with --mesh there is no other mesh", async () => {
    const { body } = await servers.all.get(`${oddAddress}/api/info`);
    assert.equal(body.simplices, 1);
    assert.equal((await fetch(`${servers.all.origin}${oddAddress}/pictures/brief`)).status, 200);
    for (const [path, status] of [["/mesh/public/nothing/", 404], ["/mesh/public/pg_class/api/info", 404], ["/mesh/pg_catalog/pg_class/api/info", 404], ["/mesh/public/terrain_vertices/api/info", 404], ["/mesh/public/terrain", 404],
        [`/mesh/public/${encodeURIComponent("terrain'; DROP TABLE terrain; --")}/`, 404], ["/mesh/public/%E0%A4%A/", 400], ["/mesh/%00/terrain/", 400], ["/mesh//terrain/", 404], ["/mesh/public/terrain/api/", 404], ["/mesh/public/terrain/api/volume", 404],
        ["/mesh/public/terrain/api/locate?x=1&y=2&of=", 400], ["/mesh/public/terrain/api/locate?x=1&y=2&of=public", 400], ["/mesh/public/terrain/api/info?of=public/pg_class", 404], [`/mesh/public/terrain/api/info?of=${encodeURIComponent("public/x' OR true; --")}`, 404],
        ["/mesh/public/terrain/tiles/picture/9/256/255?of=public/utm", 400], ["/mesh/public/terrain/tiles/picture/9/256/255?of=public/rock", 404], ["/mesh/public/terrain/pictures/whole", 404], ["/mesh/public/terrain/pictures/sql", 404],
        ["/mesh/public/blocks/pictures/whole?through=1,1,1&normal=0,0,0&shape=1,1", 400], ["/mesh/public/blocks/pictures/whole?through=1,1,1&normal=0,0,1", 400], ["/mesh/public/blocks/pictures/whole?through=1,1,1&normal=0,0,1&shape=1,-1", 400], ["/mesh/public/cells/pictures/whole?window=1,1,0,0", 400], ["/mesh/public/cells/pictures/whole?ramp=pink", 400], ["/mesh/public/bare/pictures/brief", 404],
        ["/mesh/public/rock/api/body?attribute=none", 400], ["/mesh/public/rock/api/body?label=none", 400], ["/tiles/picture/9/256/255", 404], ["/api/info", 404], ["/api/locate?x=1&y=2", 404]])
        assert.equal((await servers.all.get(path)).status, status, path);
    assert.equal((await servers.all.post("begin")).status, 404); // that is of a mesh
    for (const path of ["/mesh/public/globe/", "/mesh/public/globe/api/info", "/mesh/public/terrain/api/info", "/api/meshes", "/api/info?of=public/globe", "/tiles/picture/9/256/255?of=public/globe", "/api/volume?of=public/later"])
        assert.equal((await servers.terrain.get(path)).status, 404, path);
    assert.equal((await servers.terrain.get("/api/info")).body.isOneOfMany, undefined);
    assert.equal(psql("SELECT count(*) FROM terrain LIMIT 1") === "", false);
});

test("another mesh is drawn on the map of the page's own; volumes are those of SQL", async () => {
    const { body: { world } } = await servers.all.get("/mesh/public/terrain/api/info");
    const bytes = Buffer.from(await (await fetch(`${servers.all.origin}/mesh/public/terrain/tiles/terrain/9/256/255?of=public/later&attribute=height&outside=none`)).arrayBuffer()).toString("hex");
    assert.equal(bytes, psql(`SELECT encode(abacus_tile_terrain('later', 9, 256, 255, world => '{${world}}', attribute => 'height', fill => -32768), 'hex')`));
    const { body } = await servers.all.get("/mesh/public/terrain/api/volume?of=public/later&own=height&attribute=height");
    assert.deepEqual([body.area, body.cut, body.fill, body.net], psql("SELECT area, cut, fill, net FROM abacus_volume('terrain', 'later'::regclass, 'height')").split("|").map(Number));
});

test("changes are taken back one by one", async () => {
    const at = (path, body, session) => servers.all.get(`/mesh/public/terrain/edit/${path}`, { method: "POST", body: JSON.stringify(body ?? {}), headers: { "Content-Type": "application/json", ...(session && { "X-Session": session }) } });
    const { body: { session } } = await at("begin"), vertices = async () => (await servers.all.get("/mesh/public/terrain/api/info", { headers: { "X-Session": session } })).body.vertices;
    const before = await vertices(), places = [[400817.5, 5200740.5], [400917.5, 5200740.5], [400917.5, 5200840.5]];
    assert.deepEqual((await at("back", {}, session)).body, { changes: 0 });
    for (const [i, place] of places.entries()) assert.deepEqual((await at("insert", { id: String(70 + i), at: place }, session)).body, { changes: i + 1 });
    assert.equal((await at("remove", { id: "999", at: places[0] }, session)).status, 409); // fails, and is no step
    await servers.all.get("/mesh/public/terrain/api/locate?x=400817&y=5200740", { headers: { "X-Session": session } }); // nor is a question
    for (const left of [2, 1]) {
        assert.deepEqual((await at("back", {}, session)).body, { changes: left });
        assert.equal(await vertices(), before + left);
    }
    assert.deepEqual((await at("insert", { id: "75", at: places[2] }, session)).body, { changes: 2 });
    assert.deepEqual((await at("back", {}, session)).body, { changes: 1 });
    assert.deepEqual((await at("back", {}, session)).body, { changes: 0 }); // the mesh is free
    assert.equal(psql("SELECT count(*) FROM pg_stat_activity WHERE application_name = 'abacus viewer' AND state LIKE 'idle in transaction%'"), "0");
    assert.equal(await vertices(), before);
});

test("the list shows a picture of each mesh, finds one by its name, and leads there and back", async () => {
    await page.setViewportSize({ width: 1280, height: 800 });
    await page.goto(servers.all.origin);
    await page.waitForSelector("#meshes[data-ready]");
    for (const [name, width, colorScheme] of [["wide", 1280, "dark"], ["phone", 390, "light"]]) {
        await page.setViewportSize({ width, height: 800 });
        await page.emulateMedia({ colorScheme });
        assert.deepEqual(await page.evaluate(contrasts, ".list *"), []);
        assert.equal(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), true);
        for (const picture of await page.locator(".mesh img").all()) await picture.scrollIntoViewIfNeeded(); // those that are far below are loaded late
        await page.waitForFunction(() => [...document.querySelectorAll(".mesh img")].every((one) => one.complete && one.naturalWidth > 0));
        await page.evaluate(() => scrollTo(0, 0));
        await page.screenshot({ path: `${pictures}/viewer_list_${name}.jpg`, quality: 75 });
    }
    assert.equal(await page.locator(".mesh img").count(), (await page.locator(".mesh p:first-of-type").allInnerTexts()).filter((text) => text !== "Empty").length);
    await page.getByLabel("Find a mesh").fill("O'NEIL");
    assert.deepEqual(await page.locator(".mesh:visible h2").allInnerTexts(), [`sites; --.${odd}`]);
    await page.locator(".mesh:visible").click();
    await page.waitForSelector("#view[data-ready=true]");
    await page.locator("#all").click();
    await page.waitForSelector("#meshes[data-ready]");
});

test("meshes of every kind open without an error: systems, loaded ones, faults, in space, empty", async () => {
    await page.setViewportSize({ width: 640, height: 420 }); // few tiles are enough
    for (const name of ["globe", "mercator", "utm", "terrain", "loaded", "faulty", "bare", "rock"]) {
        await page.goto(`${servers.all.origin}/mesh/public/${name}/`);
        await page.waitForSelector("#view[data-ready=true]");
        assert.equal(await page.locator("#name").innerText(), name);
        assert.equal(await page.locator("#legend").isVisible(), !["globe", "bare"].includes(name), name);
        assert.equal(await page.locator("#scale").isVisible(), name !== "rock", name);
    }
});

test("the difference of two meshes: its colours, its legend, values at a place, volumes", async () => {
    await page.goto(`${servers.all.origin}/mesh/public/terrain/`);
    await page.waitForSelector("#view[data-ready=true]");
    await display();
    const same = (await servers.all.get("/api/meshes")).body.filter(({ name, kind, dimension, simplices, srid }) => name !== "terrain" && kind === "mesh" && dimension === 2 && simplices > 0 && srid === 0)
        .map(({ schema, name }) => (schema === "public" ? name : `${schema}.${name}`));
    assert.ok(same.includes("later") && same.includes(`sites; --.${odd}`) && !same.includes("utm"));
    assert.deepEqual(await page.locator("#other option").allInnerTexts(), ["none", ...same]);
    await page.locator("#other").selectOption({ label: "later" });
    await page.waitForFunction(() => /later/.test(document.getElementById("legend-name").textContent));
    await take("difference");
    await page.getByRole("button", { name: "Volumes between them" }).click();
    assert.ok(Math.abs(Number(cell(await says(/Net volume/), "Net volume").replaceAll(",", "")) / Number(psql("SELECT net FROM abacus_volume('terrain', 'later'::regclass, 'height')")) - 1) < 1e-6);
    await page.locator("#display .close").click();
    await choose(/Inspect/);
    await click(500, 330);
    const text = await says(/Difference/), place = cell(text, "Place");
    const [own, other] = ["terrain", "later"].map((name) => Number(psql(`SELECT abacus_interpolate('${name}', ${place})`)));
    assert.ok(Math.abs(Number(cell(text, "Difference")) - (own - other)) < 0.01);
    await display();
    await page.locator("#above").getByLabel("later", { exact: true }).check();
    await page.waitForResponse((response) => /picture.*of=public%2Flater/.test(response.url()) && response.ok());
    await take("above");
});

test("a base map is below the mesh, and the page asks its server alone", async () => {
    const baseMap = "http://maps.example/{z}/{x}/{y}.png", server = await serve("mercator", { baseMap, credit: "A <b>cartographer</b>" });
    const other = await browser.newPage(), asked = [], complaints = [];
    try {
        other.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
        other.on("pageerror", (error) => complaints.push(error.message));
        await other.route("http://maps.example/**", (route) => {
            asked.push([route.request().url(), route.request().headers()["x-session"]]);
            route.fulfill({ contentType: "image/svg+xml", headers: { "Access-Control-Allow-Origin": "*" }, body: "<svg xmlns='http://www.w3.org/2000/svg' width='256' height='256'><rect width='256' height='256' fill='#36c'/></svg>" });
        });
        await other.goto(server.origin);
        await other.waitForSelector("#view[data-ready=true]", { timeout: 120_000 });
        assert.ok(asked.length > 0);
        for (const [url, session] of asked) assert.ok(/^http:\/\/maps\.example\/\d+\/\d+\/\d+\.png$/.test(url) && session === undefined, url);
        assert.match(await other.locator(".maplibregl-ctrl-attrib").innerText(), /A <b>cartographer<\/b>/); // text, not HTML
        assert.deepEqual(complaints, []);
        await other.screenshot({ path: `${pictures}/viewer_base.jpg`, quality: 75 });
    } finally {
        await other.close();
        await server.stop();
    }
});

test("tiles have no seam: four tiles are, pixel by pixel, the one above them in twice the size", async () => {
    await page.goto(servers.all.origin);
    const { body: { attributes: [{ least, greatest }] } } = await servers.all.get("/mesh/public/terrain/api/info");
    const unequal = await page.evaluate(async ({ least, greatest }) => {
        const pixels = async (z, x, y, size) => {
            const response = await fetch(`/mesh/public/terrain/tiles/picture/${z}/${x}/${y}?size=${size}&edges=no&low=${least}&high=${greatest}`);
            const context = new OffscreenCanvas(size, size).getContext("2d");
            context.drawImage(await createImageBitmap(await response.blob()), 0, 0);
            return context;
        };
        let unequal = 0, drawn = 0;
        for (const [z, x, y] of [[10, 511, 511], [10, 512, 511], [11, 1023, 1023]]) {
            const whole = await pixels(z, x, y, 512);
            for (const [dx, dy] of [[0, 0], [1, 0], [0, 1], [1, 1]]) {
                const part = (await pixels(z + 1, 2 * x + dx, 2 * y + dy, 256)).getImageData(0, 0, 256, 256).data, same = whole.getImageData(256 * dx, 256 * dy, 256, 256).data;
                part.forEach((value, i) => { unequal += Number(value !== same[i]); drawn += Number(value !== 0); });
            }
        }
        return [unequal, drawn > 100_000];
    }, { least, greatest });
    assert.deepEqual(unequal, [0, true]);
});

test("a step back in the page; what has been changed is marked until it is saved or undone", async () => {
    await page.goto(`${servers.all.origin}/mesh/public/terrain/`);
    await page.waitForSelector("#view[data-ready=true]");
    const changed = () => page.locator("#view").getAttribute("data-changed");
    /** A part of the map that nothing covers, when all tiles are there. */
    const ground = async () => {
        await page.mouse.move(20, 20);
        await page.waitForFunction(() => document.getElementById("view").dataset.ready === "true" && document.getElementById("pointer").childElementCount === 0);
        return page.screenshot({ clip: { x: 320, y: 150, width: 420, height: 330 } });
    };
    const before = await ground();
    await page.getByRole("radio", { name: /Add/ }).check();
    for (const [i, x] of [[1, 480], [2, 560]]) {
        await page.getByLabel("Id for the next new point").fill(String(4720 + i));
        await click(x, 360);
        await says(new RegExp(`${4720 + i} added`));
        assert.equal(await changed(), String(i));
    }
    await take("changes");
    await page.getByRole("button", { name: "Step back" }).click();
    await says(/Taken back: Point 4722 added/);
    assert.equal(await changed(), "1");
    await page.keyboard.press("Control+z");
    await says(/Taken back: Point 4721 added/);
    assert.equal(await page.locator("#changes").innerText(), "No unsaved changes");
    assert.equal(await page.getByRole("button", { name: "Step back" }).isDisabled(), true);
    await eventually(async () => before.equals(await ground()), "the ground looks as before, pixel by pixel: tiles that were read again have no seam", 120_000);
    await eventually(() => psql("SELECT count(*) FROM pg_stat_activity WHERE application_name = 'abacus viewer' AND state LIKE 'idle in transaction%'") === "0", "the mesh is free");
    assert.doesNotMatch(await answer(), /error/);
});
