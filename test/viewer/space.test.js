// Meshes in space, octrees and quadtrees in the browser: the body that is cut open, labels as colours, a series of attributes,
// sections as pictures, both sides of a fault.
import assert from "node:assert/strict";
import { test } from "node:test";
import { normalOf, rangeAlong, sheetOf } from "../../viewer/page/cut.js";
import { cell, click, differs, display, open, page, pictures, says, servers, setUp, take } from "./browser.js";
import { contrasts } from "./contrast.js";
import { connect, eventually, psql, serve } from "./support.js";

setUp(async () => {
    const client = await connect();
    await client.query(`SET client_min_messages = error; DROP TABLE IF EXISTS ore, split, dice, ground, soil, hollow CASCADE;
        SELECT abacus_triangulate('ore', 'SELECT 10000 * i + 100 * j + k AS id, i + sin(j * k) / 4 AS x, j + cos(i * k) / 4 AS y, -k + sin(i + j) / 4 AS z,
            300 + 40 * k + 30 * sin(i) AS vs_0, 300 + 40 * k + 30 * sin(i + 1) AS vs_5, 400 + 40 * k + 30 * sin(i + 2) AS vs_10, i * j AS other
            FROM generate_series(0, 12) AS i, generate_series(0, 10) AS j, generate_series(0, 6) AS k', dimension => 3);
        SELECT abacus_label('ore', 'SELECT code, v0, v1, v2, v3, 1 + floor((corners[1][1] + corners[1][2]) / 7) AS rock, corners[1][1] AS east FROM abacus_cells(''ore'')');
        SELECT abacus_load('split', 'VALUES (1, -1, 0, 0, 5), (2, 0, 0, 0, 6), (3, 0, 1, 0, 7), (4, 0, 0, 1, 8), (5, 1, 0, 0, 9), (6, 1, 1, 1, 10), (12, 0, 0, 0, 11), (13, 0, 1, 0, 12), (14, 0, 0, 1, 13)',
            'VALUES (1, 2, 3, 4), (12, 13, 14, 5), (13, 14, 5, 6)', attributes => '{vs}', split_nodes => true);
        SELECT abacus_triangulate('dice', 'SELECT row_number() OVER (), x, y, z, x AS a FROM generate_series(0, 20) AS x, generate_series(0, 20) AS y, generate_series(0, 20) AS z', dimension => 3);
        SELECT abacus_octree_create('ground', 3, '{0,0,-2000}', '{4000,4000,0}', attributes => '{vs}');
        SELECT abacus_octree_from_points('ground', 'SELECT i, 2000 + 15 * i * cos(i), 2000 + 15 * i * sin(i), -3.0 * i FROM generate_series(0, 130) AS i', 2); SELECT abacus_octree_balance('ground');
        SELECT abacus_octree_update('ground', 'SELECT code, 200 - lower[3] FROM abacus_octants(''ground'')');
        SELECT abacus_octree_create('soil', 2, '{0,0}', '{8000,4000}', attributes => '{vs}');
        SELECT abacus_octree_from_points('soil', 'SELECT i, 10 * i, i * i / 50.0 FROM generate_series(1, 300) AS i', 4); SELECT abacus_octree_balance('soil');
        SELECT abacus_octree_update('soil', 'SELECT code, lower[1] FROM abacus_octants(''soil'')');
        SELECT abacus_create('hollow', 3)`);
    await client.end();
    return { ore: await serve("ore"), split: await serve("split"), dice: await serve("dice"), ground: await serve("ground"), soil: await serve("soil"), hollow: await serve("hollow"), all: await serve(undefined) };
});

const data = (name) => page.locator("#view").getAttribute(`data-${name}`);
/** What has one of these colours, as a share of the picture: [r, g, b], to within 40 in each. */
const share = (colours) => page.evaluate((colours) => {
    const canvas = document.querySelector("#view canvas"), copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
    copy.drawImage(canvas, 0, 0);
    const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
    let found = 0;
    for (let i = 0; i < data.length; i += 4) found += colours.some((colour) => colour.every((c, k) => Math.abs(c - data[i + k]) < 40));
    return found / (data.length / 4);
}, colours);

test("the surface of the mesh as SQL has it: vertices with their own values, labels of the tetrahedra behind it", async () => {
    const { body } = await servers.ore.get("/api/body?attribute=vs_5");
    assert.equal(body.triangles.length, Number(psql("SELECT count(*) FROM abacus_hull('ore')")));
    assert.equal(body.positions.length / 3, Number(psql("SELECT count(DISTINCT vertex) FROM abacus_hull('ore')")));
    const corner = (k) => body.positions.slice(3 * k, 3 * k + 3);
    for (const k of [0, 7, 100]) assert.equal(body.values[k], Number(psql(`SELECT attributes[2] FROM abacus_vertices('ore') WHERE (x, y, z) = (${corner(k).map((x) => `${x}::float8`)})`)));
    const labels = (await servers.ore.get("/api/body?label=rock")).body.labels;
    assert.equal(labels.length, body.triangles.length / 3);
    for (const i of [0, 50, 200]) {
        const [a, b, c] = [0, 1, 2].map((k) => `ARRAY[${corner(body.triangles[3 * i + k])}]::float8[]`), has = (at) => `ARRAY(SELECT unnest(corners[1:1])) = ${at} OR ARRAY(SELECT unnest(corners[2:2])) = ${at} OR ARRAY(SELECT unnest(corners[3:3])) = ${at} OR ARRAY(SELECT unnest(corners[4:4])) = ${at}`;
        assert.equal(labels[i], Number(psql(`SELECT labels[1] FROM abacus_cells('ore') WHERE (${has(a)}) AND (${has(b)}) AND (${has(c)})`)), String(i));
    }
    // a label of few values has a colour for each; of many values only the range counts
    assert.deepEqual((await servers.ore.get("/api/label?name=rock")).body, { least: 1, greatest: 4, values: [1, 2, 3, 4] });
    assert.deepEqual((await servers.ore.get("/api/label?name=east")).body.values, null);
    for (const path of ["label", "label?name=none", "body?label=none", `label?name=${encodeURIComponent("rock'); DROP TABLE ore; --")}`]) assert.equal((await servers.ore.get(`/api/${path}`)).status, 400, path);
    // at a fault two vertices at one place, each with the value of its side
    const split = (await servers.split.get("/api/body?attribute=vs")).body;
    assert.equal(split.positions.length / 3, 9);
    assert.deepEqual([...split.values].sort((a, b) => a - b), [5, 6, 7, 8, 9, 10, 11, 12, 13]);
    assert.deepEqual((await servers.dice.get("/api/body")).body, { isBox: true });
    assert.deepEqual((await servers.hollow.get("/api/body")).body, { positions: [], triangles: [] });
});

test("sections of octrees and of meshes are the pictures of SQL", async () => {
    for (const [name, path, sql] of [["ground", "through=1000,0,-2000&normal=1,0,0&shape=4000,2000&attribute=vs&low=200&high=2200&ramp=magma", "abacus_draw_section('ground', '{1000,0,-2000}', '{1,0,0}', 2048, 1024, attribute => 'vs', edges => false, lower => '{0,0,-2000}', upper => '{4000,4000,0}', range => '{200,2200}', ramp => 'magma', transparent => true)"],
        ["ground", "through=0,0,-3&normal=0,0,1&shape=1,1&edges=yes", "abacus_draw_section('ground', '{0,0,-3}', '{0,0,1}', 2048, 2048, attribute => 'vs', edges => true, lower => '{0,0,-2000}', upper => '{4000,4000,0}', range => (SELECT ARRAY[least, greatest] FROM abacus_attributes('ground')), transparent => true)"],
        ["ground", "through=2000,2000,-1000&normal=1,2,3&shape=3,2&attribute=vs", "abacus_draw_section('ground', '{2000,2000,-1000}', '{1,2,3}', 2048, 1365, attribute => 'vs', edges => false, lower => '{0,0,-2000}', upper => '{4000,4000,0}', range => (SELECT ARRAY[least, greatest] FROM abacus_attributes('ground')), transparent => true)"],
        ["soil", "window=1000,500,3000,1500", "abacus_draw('soil', 2048, 1024, attribute => 'vs', edges => false, lower => '{1000,500}', upper => '{3000,1500}', range => (SELECT ARRAY[least, greatest] FROM abacus_attributes('soil')), transparent => true)"]]) {
        const response = await fetch(`${servers[name].origin}/pictures/whole?${path}`);
        assert.equal(response.status, 200, path);
        assert.equal(Buffer.from(await response.arrayBuffer()).toString("hex"), psql(`SELECT encode(${sql}, 'hex')`), path);
        assert.equal((await fetch(`${servers[name].origin}/pictures/whole?${path}`, { headers: { "If-None-Match": response.headers.get("etag") } })).status, 304);
    }
});

test("a plane in any direction: the sheet that just holds its part in the box", () => {
    const lower = [1, 2, 3], upper = [5, 8, 4], near = (a, b) => assert.ok(a.flat().every((x, i) => Math.abs(x - b.flat()[i]) < 1e-12), `${a} ${b}`);
    near(sheetOf([0, 1, 0], 5, lower, upper).corners, [[1, 5, 3], [5, 5, 3], [5, 5, 4], [1, 5, 4]]);
    near(sheetOf([0, 0, 1], 3, lower, upper).corners, [[1, 2, 3], [5, 2, 3], [5, 8, 3], [1, 8, 3]]); // a side of the box
    near(sheetOf([2, 0, 0], 4, lower, upper).corners, [[2, 2, 3], [2, 8, 3], [2, 8, 4], [2, 2, 4]]); // a normal of another length
    assert.equal(sheetOf([1, 0, 0], 9, lower, upper), null);
    near([normalOf(0, 90), normalOf(90, 90), normalOf(45, 0)], [[0, 1, 0], [1, 0, 0], [0, 0, 1]]);
    for (const [direction, dip, share] of [[150, 60, 0.5], [20, 35, 0.3], [275, 80, 0.9]]) {
        const normal = normalOf(direction, dip), [low, high] = rangeAlong(normal, lower, upper), distance = low + share * (high - low);
        const { corners, width, height } = sheetOf(normal, distance, lower, upper), minus = (a, b) => a.map((x, i) => x - b[i]), dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
        for (const corner of corners) assert.ok(Math.abs(dot(normal, corner) - distance) < 1e-12);
        const [right, up] = [minus(corners[1], corners[0]), minus(corners[3], corners[0])];
        assert.ok(Math.abs(dot(right, up)) < 1e-12 && right[0] >= 0 && Math.abs(Math.hypot(...right) - width) < 1e-12 && Math.abs(Math.hypot(...up) - height) < 1e-12);
    }
});

test("a mesh is cut open; labels are colours; a series of attributes is run through", async () => {
    await open("ore");
    assert.equal(await data("outline"), "hull");
    // coordinates and value under the pointer
    await page.mouse.move(500, 330);
    await page.waitForFunction(() => document.querySelector("#pointer strong"));
    const [place, value] = await Promise.all(["span", "strong"].map((name) => page.locator(`#pointer ${name}`).innerText()));
    assert.ok(Math.abs(Number(value) - Number(psql(`SELECT abacus_interpolate('ore', ${place.split(/\s+/).join(", ")}, 'vs_0')`))) < 2, `${place}: ${value}`);
    await display();
    assert.deepEqual(await page.locator("#attribute option").allInnerTexts(), ["vs_0", "vs_5", "vs_10", "other", "rock (label)", "east (label)"]);
    const legend = () => page.locator("#legend").innerText(), range = await legend();
    assert.match(range, /vs_0[^]*1 of 3/);
    // the whole series has one range of colours
    await page.locator("#step").fill("2");
    await page.waitForFunction(() => document.getElementById("attribute").value === "vs_10");
    assert.equal((await legend()).replace("vs_10", "vs_0").replace("3 of 3", "1 of 3"), range);
    await page.getByRole("button", { name: "Play the series" }).click();
    for (const name of ["vs_0", "vs_5", "vs_10"]) await page.waitForFunction((name) => document.getElementById("attribute").value === name, name);
    await page.getByRole("button", { name: "Pause" }).click();
    await page.locator("#attribute").selectOption({ label: "other" });
    assert.equal(await page.locator("#series").isVisible(), false);
    // a label: its values, each in its own colour
    await page.locator("#attribute").selectOption({ label: "rock (label)" });
    await eventually(async () => (await page.locator("#legend-values li").allInnerTexts()).join(" ") === psql("SELECT string_agg(DISTINCT labels[1]::text, ' ') FROM abacus_cells('ore')"), "the values of the label");
    await page.locator("#display .close").click();
    assert.ok(await share([[0, 114, 178], [230, 159, 0], [0, 158, 115], [204, 121, 167]]) > 0.08);
    await take("labels");
    await display();
    await page.locator("#attribute").selectOption({ label: "east (label)" });
    await page.waitForFunction(() => document.getElementById("legend-ramp").checkVisibility() && document.getElementById("legend-name").textContent === "east");
    await page.locator("#axis").selectOption("3"); // a plane in any direction
    const isTurned = (response) => Math.abs(Number(new URL(response.url()).searchParams.get("normal")?.split(",")[2]) - normalOf(0, 35)[2]) < 1e-9;
    const [answer] = await Promise.all([page.waitForResponse((response) => /section\?/.test(response.url()) && isTurned(response)), page.locator("#dip").fill("35")]);
    const { through, normal } = Object.fromEntries(new URL(answer.url()).searchParams);
    await page.waitForFunction((count) => document.getElementById("view").dataset.polygons === count, psql(`SELECT count(*) FROM abacus_section('ore', '{${through}}', '{${normal}}', 'vs_0')`));
    await page.locator("#axis").selectOption("2");
    await page.locator("#body").selectOption("whole");
    await page.waitForFunction(() => document.getElementById("view").ariaBusy !== "true");
    await page.locator("#display .close").click();
    await click(500, 300); // on the surface: just within the mesh
    assert.equal(psql(`SELECT (abacus_locate('ore', ${cell(await says(/Vertices of the tetrahedron/), "Place")})).code IS NOT NULL`), "t");
    assert.deepEqual(await page.evaluate(contrasts, ".card *"), []);
});

test("an octree: its leaves in sections, a leaf and those beside it", async () => {
    await open("ground");
    assert.match(await page.locator("#summary").innerText(), new RegExp(`^Octree of ${Number(psql("SELECT count(*) FROM abacus_octants('ground')")).toLocaleString("en")} leaves$`));
    assert.equal(await data("section"), "picture");
    assert.equal(await page.getByRole("radio", { name: "Ray" }).isVisible(), false);
    await page.keyboard.press("Tab");
    await click(500, 330);
    const text = await says(/Leaves beside it/), place = cell(text, "Place");
    const [code, level, neighbours] = psql(`SELECT l.code, l.level, (SELECT count(*) FROM abacus_octree_neighbours('ground', l.code)) FROM abacus_octree_locate('ground', ${place}) AS l`).split("|");
    assert.deepEqual([cell(text, "Code"), cell(text, "Level"), cell(text, "Leaves beside it:")], [code, level, neighbours]);
    await page.locator("#view canvas").focus();
    await page.keyboard.press("PageDown");
    await page.waitForFunction(() => document.getElementById("view").ariaBusy !== "true");
    await take("octree");
});

test("a quadtree is drawn as sharp as the screen is", async () => {
    await open("soil");
    await click(500, 330);
    const text = await says(/Leaves beside it/);
    assert.equal(cell(text, "Code"), psql(`SELECT (abacus_octree_locate('soil', ${cell(text, "Place")})).code`));
    const [answer] = await Promise.all([page.waitForResponse((response) => /pictures\/whole\?.*window=/.test(response.url())), page.mouse.wheel(0, -600)]);
    const [left, bottom, right, top] = new URL(answer.url()).searchParams.get("window").split(",").map(Number);
    assert.ok(right - left < 8000 && top - bottom <= 4000 && left >= 0, answer.url());
    await page.getByRole("button", { name: "Fit to mesh" }).click();
    await differs("");
    await take("quadtree");
});

test("an empty mesh in space is said to be empty; a fault has both of its sides", async () => {
    const go = async (name) => {
        await page.goto(`${servers.all.origin}/mesh/public/${name}/`);
        await page.waitForSelector("#view[data-ready=true]");
    };
    await go("hollow");
    await says(/no tetrahedra yet/);
    assert.equal(await page.locator("#legend").isVisible(), false);
    await go("split");
    assert.equal(await data("outline"), "hull");
    await page.setViewportSize({ width: 820, height: 1100 });
    await page.emulateMedia({ colorScheme: "dark" });
    await display();
    assert.deepEqual(await page.evaluate(contrasts, ".card *"), []);
    await page.locator("#axis").selectOption("1");
    await page.locator("#display .close").click();
    for (const [width, height] of [[390, 780], [820, 1100]]) {
        await page.setViewportSize({ width, height });
        assert.deepEqual(await page.evaluate(() => [...document.querySelectorAll(".card")].filter((one) => one.checkVisibility()).map((one) => [one.id || one.className, one.getBoundingClientRect()])
            .filter(([, box]) => box.left < -1 || box.top < -1 || box.right > innerWidth + 1 || box.bottom > innerHeight + 1).map(([id]) => id)), []);
    }
    await page.screenshot({ path: `${pictures}/viewer_fault.jpg`, quality: 75 });
});
