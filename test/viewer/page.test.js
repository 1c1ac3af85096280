// The page in a headless browser: the effect of each click and key.
import assert from "node:assert/strict";
import { test } from "node:test";
import { answer, askAt, browser, canvas, cell, choose, click, corners, differs, display, open, page, refuses, says, servers, setUp, take } from "./browser.js";
import { drop, eventually, fragileWay, psql, serve } from "./support.js";

setUp();

const located = (place) => psql(`SELECT v0, v1, v2 FROM abacus_locate('terrain', ${place})`).replaceAll("|", " ");

for (const [name, paths] of [["terrain", ["info", "hull"]], ["rock", ["info"]]])
    test(`the page of ${name} says that the mesh is being read, and why it cannot be shown`, async () => {
        await page.route("**/api/info?", async (route) => {
            await new Promise((resolve) => setTimeout(resolve, 2500));
            return route.continue();
        });
        await page.goto(servers[name].origin);
        await says(/The mesh is being read/);
        await page.waitForSelector("#view[data-ready=true]");
        assert.doesNotMatch(await answer(), /being read/);
        refuses(/504|took too long/);
        await page.unroute("**/api/info?");
        for (const path of paths) {
            const address = `**/api/${path}?*`;
            await page.route(address, (route) => route.fulfill({ status: 504, contentType: "application/json", body: '{"error":"the query took too long"}' }));
            await page.goto(servers[name].origin);
            await says(/the query took too long\. Reload the page to try again\./);
            await page.unroute(address);
        }
    });

test("a click shows the triangle, its circle, neighbours and values", async () => {
    await open("terrain");
    for (let i = 0; i < 4; ++i) await page.getByRole("button", { name: "Zoom in" }).click();
    await page.waitForTimeout(700);
    await click(300, 320);
    const text = await says(/Value, nearest.*Circumcircle/);
    const place = cell(text, "Place");
    assert.equal(await corners(), located(place));
    assert.match(cell(text, "Circumcircle"), /^radius [\d.]+, centre/);
    for (const method of ["linear", "natural", "nearest"])
        assert.ok(Math.abs(Number(cell(text, `Value, ${method}`)) - Number(psql(`SELECT abacus_interpolate('terrain', ${place}, method => '${method}')`))) < 0.1);
    for (const facet of [0, 1, 2])
        assert.equal(cell(text, `Across facet ${facet}`), psql(`SELECT v0, v1, v2 FROM abacus_walk('terrain', abacus_locate('terrain', ${place}), ${facet})`).replaceAll("|", " "));
    await take("triangle");
});

test("arrows and buttons walk to neighbours, by the keyboard alone", async () => {
    await open("terrain");
    await canvas().focus();
    await page.keyboard.press("Enter");
    const first = await says(/Vertices of the triangle/);
    const neighbours = [0, 1, 2].map((facet) => cell(first, `Across facet ${facet}`));
    await page.keyboard.press("ArrowRight");
    await differs(first);
    const second = await answer();
    assert.ok(neighbours.includes(await corners()));
    assert.ok(Number(cell(second, "Place").split(",")[0]) > Number(cell(first, "Place").split(",")[0]));
    const across = cell(second, "Across facet 1");
    await page.getByRole("button", { name: "facet 1" }).press("Enter");
    await differs(second);
    assert.equal(await corners(), across);
    await canvas().focus();
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("#walk").isVisible(), false);
});

test("a line gives its profile, with a place at each crossing", async () => {
    await open("terrain");
    await choose(/Profile/);
    await askAt(400100, 5200100);
    await says(/Start of the line/);
    await askAt(401500, 5201200);
    const text = await says(/Profile of height: \d+ places/);
    const expected = Number(psql("SELECT count(value) FROM abacus_profile('terrain', '{400100,5200100,401500,5201200}')"));
    assert.equal(Number(/: (\d+) places/.exec(text)[1]), expected);
    assert.match(await page.locator("#chart").getAttribute("aria-label"), /Profile of height/);
    await page.getByLabel("Crossed edges").check();
    await page.mouse.move(500, 560);
    await page.waitForFunction(() => /slope/.test(document.getElementById("dock-cursor").textContent));
    await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
    await page.getByRole("button", { name: "Copy CSV" }).click();
    await says(/places copied/);
    const rows = (await page.evaluate(() => navigator.clipboard.readText())).trim().split("\n").map((row) => row.split(","));
    assert.deepEqual(rows[0], ["line", "distance", "x", "y", "height"]);
    assert.equal(rows.filter((row) => row[4] !== "").length, expected + 1);
    const [x, y, height] = rows[5].slice(2).map(Number);
    assert.ok(Math.abs(height - Number(psql(`SELECT abacus_interpolate('terrain', ${x}, ${y})`))) < 1e-6);
    await page.getByRole("button", { name: "Another line" }).click();
    await askAt(400200, 5201200);
    await askAt(401500, 5200200);
    await page.waitForFunction(() => document.getElementById("dock-title").textContent === "2 profiles");
    await take("profile");
});

test("a profile of very many places is a line without dots", async () => {
    await open("terrain");
    const rows = Array.from({ length: 200_000 }, (_, i) => ({ distance: i, x: 400000 + i / 200, y: 5200000, value: 900 + (i % 500) }));
    await page.route("**/api/profile?**", (route) => route.fulfill({ json: rows }));
    await choose(/Profile/);
    await askAt(400000, 5200000);
    await says(/Start of the line/);
    await askAt(401000, 5200000);
    await says(/: 200000 places, length 1,000, values 900 to 1399/);
    assert.equal(await page.locator("#chart canvas").count(), 1);
});

test("two places: whether one sees the other, and what is between", async () => {
    await open("terrain");
    await choose(/Line of sight/);
    for (const [to, height] of [["401700,5200700", 0], ["401700,5200700", 900]]) {
        await page.getByLabel("Height of the target").fill(String(height));
        await askAt(400030, 5200700);
        await says(/Observer set/);
        await askAt(...to.split(","));
        const text = await says(/Line of sight\s+the target/);
        const [visible, x] = psql(`SELECT visible, x FROM abacus_visible('terrain', '{400030,5200700}', '{${to}}', target_height => ${height})`).split("|");
        assert.equal(/is visible/.test(text), visible === "t");
        assert.equal(/Blocked at/.test(text), x !== "");
        // parts of the ground that are visible, against SQL at many places
        const share = Number(psql(`SELECT avg((SELECT visible FROM abacus_visible('terrain', '{400030,5200700}', ARRAY[400030 + i * 1670 / 400.0, 5200700], target_height => ${height}))::int) FROM generate_series(1, 400) AS i`));
        const [seen, hidden] = ["Visible", "Hidden"].map((head) => Number(cell(text, head).replaceAll(",", "")));
        assert.ok(Math.abs(seen + hidden - 1670) < 1, `${seen} ${hidden}`);
        assert.ok(Math.abs(seen / 1670 - share) < 0.02, `${seen / 1670} ${share}`);
    }
});

test("a mesh of longitude and latitude, without attributes, lies where it is", async () => {
    await open("globe");
    await click(500, 330);
    const text = await says(/Vertices of the triangle/);
    assert.equal(await corners(), psql(`SELECT v0, v1, v2 FROM abacus_locate('globe', ${cell(text, "Place")})`).replaceAll("|", " "));
    assert.doesNotMatch(text, /Value, linear/);
});

test("a point is added, moved and deleted; undo and save", async () => {
    const vertices = () => psql("SELECT value FROM abacus_stats('terrain') WHERE name = 'vertices'");
    await open("terrain");
    const before = vertices();
    for (let i = 0; i < 4; ++i) await page.getByRole("button", { name: "Zoom in" }).click();
    await page.waitForTimeout(700);
    await choose(/Add/);
    await page.getByLabel("Id for the next new point").fill("4711");
    await askAt(400892.5, 5200741.5);
    assert.match(await says(/4711 added/), /\d+ triangles surround it/);
    await take("edit");
    await choose(/Move/);
    await askAt(400892.5, 5200741.5);
    await says(/4711 selected/);
    await askAt(400893.5, 5200740.5);
    await says(/4711 moved/);
    await choose(/Delete/);
    await askAt(400893.5, 5200740.5);
    await says(/4711 deleted/);
    assert.equal(await page.locator("#changes").innerText(), "3 unsaved changes");
    assert.equal(vertices(), before); // for other pages
    await page.getByRole("button", { name: "Undo" }).click();
    await says(/3 changes undone/);
    await choose(/Add/);
    await page.getByLabel("Id for the next new point").fill("4712");
    await askAt(400892.5, 5200741.5);
    await says(/4712 added/);
    await page.getByRole("button", { name: "Save" }).click();
    await says(/1 change saved/);
    assert.equal(Number(vertices()), Number(before) + 1);
    psql("SELECT abacus_delete('terrain', 'SELECT 4712, 400892.5, 5200741.5')");
});

const addAt = async (id, ...place) => {
    await choose(/Add/);
    await page.getByLabel("Id for the next new point").fill(id);
    await askAt(...place);
};
const changes = () => page.locator("#changes").innerText();

test("beyond a fault there is no neighbour, and natural neighbours are left out", async () => {
    psql(`SET client_min_messages = error; SELECT abacus_load('fault', 'VALUES (1, 0, 0, 0), (2, 2, 0, 0), (4, 0, 2, 0), (5, 2, 2, 0), (12, 2, 0, 1), (3, 4, 0, 1), (6, 4, 2, 1), (15, 2, 2, 1)',
        'VALUES (1, 2, 5), (1, 5, 4), (12, 3, 6), (12, 6, 15)', attributes => '{slip}', split_nodes => true)`);
    servers.fault ??= await serve("fault");
    await open("fault");
    await askAt(1.9, 1.5);
    const text = await says(/Nearest vertex.*Vertices of the triangle/);
    assert.equal(await corners(), "1 2 5");
    assert.deepEqual([0, 1, 2].map((facet) => cell(text, `Across facet ${facet}`)), ["none: the mesh ends here", "1 5 4", "none: the mesh ends here"]);
    assert.deepEqual(["linear", "nearest"].map((method) => cell(text, `Value, ${method}`)), ["0", "0"]);
    assert.doesNotMatch(text, /Value, natural/);
    assert.equal(await page.getByRole("button", { name: "facet 0" }).isDisabled(), true);
    await page.getByRole("button", { name: "facet 1" }).press("Enter");
    await eventually(async () => (await corners()) === "1 5 4", "the neighbour");
    await page.close(); // it must not ask for tiles of a mesh that is gone
    await drop("fault");
});

test("ids beyond 53 bits are shown and changed as they are", async () => {
    psql("SET client_min_messages = warning; SELECT abacus_triangulate('great', 'SELECT 9007199254740992 + i, i % 3, i / 3, i FROM generate_series(0, 8) AS i')");
    servers.great ??= await serve("great", { edit: true });
    await open("great");
    await askAt(0.9, 0.05);
    const text = await says(/Nearest vertex.*Vertices of the triangle/);
    assert.equal(await corners(), psql("SELECT v0, v1, v2 FROM abacus_locate('great', 0.9, 0.05)").replaceAll("|", " "));
    assert.match(cell(text, "Nearest vertex"), /^9007199254740993,/);
    await addAt("9007199254741993", 0.5, 0.25);
    await says(/Point 9007199254741993 added/);
    assert.equal(await page.getByLabel("Id for the next new point").inputValue(), "9007199254741994");
    await choose(/Delete/);
    await askAt(1.01, 1.01);
    await says(/Point 9007199254740996 deleted/);
    await page.getByRole("button", { name: "Save" }).click();
    await says(/2 changes saved/);
    assert.equal(psql("SELECT string_agg(id::text, ' ' ORDER BY id) FROM abacus_vertices('great') WHERE id IN (9007199254740996, 9007199254740995, 9007199254740997, 9007199254741993)"), "9007199254740995 9007199254740997 9007199254741993");
    await page.close(); // it must not ask for tiles of a mesh that is gone
    await drop("great");
});

test("while another page has changes this is said at once, and when that page goes it has them no more", async () => {
    refuses(/status of 423/);
    const other = await browser.newPage();
    other.setDefaultTimeout(120_000);
    other.on("dialog", (dialog) => dialog.accept());
    await other.goto(servers.terrain.origin);
    await other.waitForSelector("#view[data-ready=true]");
    await other.getByRole("radio", { name: /Add/ }).check();
    await other.locator("#go-open").click();
    for (const [name, value] of [["x", 400892.5], ["y", 5200741.5]]) await other.locator(`#${name}`).fill(String(value));
    await other.getByRole("button", { name: "Go", exact: true }).click();
    await other.waitForFunction(() => document.getElementById("changes").textContent === "1 unsaved change");
    await open("terrain");
    await addAt("4713", 400892.5, 5200741.5);
    await says(/another page has unsaved changes. Save or undo them there/);
    assert.equal(await changes(), "No unsaved changes");
    await other.goto("about:blank");
    await eventually(() => psql("SELECT count(*) FROM pg_stat_activity WHERE application_name = 'abacus viewer' AND state LIKE 'idle in transaction%'") === "0", "the changes are undone");
    await addAt("4713", 400892.5, 5200741.5);
    await says(/4713 added/);
    await page.getByRole("button", { name: "Undo" }).click();
    await says(/1 change undone/);
    await other.close();
});

test("when the connection to the database breaks the page says by itself what is lost", async (t) => {
    refuses(/status of (410|503)/);
    t.mock.method(console, "error", () => {});
    const way = await fragileWay();
    t.after(way.close); // a way that stays open would keep this process running
    const server = servers.fragile = await serve("terrain", { edit: true, dbname: way.dbname, absent: 30 }); // so it checks every five seconds
    await open("fragile");
    await addAt("4714", 400892.5, 5200741.5);
    await says(/4714 added/);
    assert.equal(await changes(), "1 unsaved change");
    const before = psql("SELECT value FROM abacus_stats('terrain') WHERE name = 'vertices'");
    assert.match(await page.locator("#summary").innerText(), new RegExp(`${(Number(before) + 1).toLocaleString("en")} vertices`));
    way.open = false;
    way.break();
    await canvas().hover({ position: { x: 480, y: 300 } }); // what is under the pointer is asked before the page reports again
    await says(/the connection to the database broke; 1 unsaved change was lost/);
    assert.equal(await changes(), "No unsaved changes");
    way.open = true;
    await page.waitForFunction((words) => document.getElementById("summary").textContent.includes(words), `, ${Number(before).toLocaleString("en")} vertices`); // the present mesh
    await eventually(async () => {
        await addAt("4714", 400892.5, 5200741.5);
        return /4714 added/.test(await says(/4714 added|be reached|another transaction/));
    }, "the page goes on", 120_000);
    await server.stop();
    delete servers.fragile;
    await eventually(async () => { // what the page still has to do comes first
        await page.getByRole("button", { name: "Undo" }).click({ timeout: 5000 }).catch(() => {});
        return /server cannot be reached/.test(await answer());
    }, "the page says that the server is gone", 120_000);
    refuses(/./); // connections that are refused
});

test("a Save that is refused says why, and what is undone", async () => {
    refuses(/status of 400/);
    await open("terrain");
    await addAt("4715", 400892.5, 5200741.5);
    await says(/4715 added/);
    await page.route("**/edit/save", async (route) => {
        await route.fetch({ url: route.request().url().replace("save", "undo") });
        await route.fulfill({ status: 400, json: { error: "the mesh follows a table", hint: "Change the table.", changes: 0, lost: 1 } });
    });
    await page.getByRole("button", { name: "Save" }).click();
    await says(/the mesh follows a table. Change the table. 1 unsaved change was undone./);
    assert.equal(await changes(), "No unsaved changes");
    assert.equal(await page.getByRole("button", { name: "Save" }).isDisabled(), true);
});

test("every control has a name, and what is wrong is said", async () => {
    await open("terrain");
    const nameless = await page.evaluate(() => [...document.querySelectorAll("input, select, button, canvas, svg:not([aria-hidden=true])")]
        .filter((one) => one.checkVisibility() && !one.labels?.length && !one.ariaLabel && !one.textContent.trim() && !one.title && !one.closest("[aria-label] svg")).map((one) => one.outerHTML));
    assert.deepEqual(nameless, []);
    assert.equal(await page.locator("#answer").getAttribute("aria-live"), "polite");
    await page.locator("#go-open").click();
    await page.getByRole("button", { name: "Go", exact: true }).click();
    await says(/must be numbers/);
    await askAt(0, 0);
    await says(/the place is outside/);
});

// ---- Space -------------------------------------------------------------------------------------

const polygons = () => page.locator("#view").getAttribute("data-polygons");

test("in space a click on the plane shows the tetrahedron; keys walk", async () => {
    await open("rock");
    assert.equal(await page.locator("#view").getAttribute("data-outline"), "hull");
    await click(520, 320);
    const text = await says(/Vertices of the tetrahedron.*/);
    const place = cell(text, "Place");
    assert.equal(await corners(), psql(`SELECT v0, v1, v2, v3 FROM abacus_locate('rock', ${place})`).replaceAll("|", " "));
    assert.match(cell(text, "Circumsphere"), /^radius/);
    const across = cell(text, "Across facet 2");
    await page.keyboard.press("3");
    await differs(text);
    assert.equal(await corners(), across);
});

test("the plane is dragged, and moved by keys", async () => {
    await open("rock");
    await display();
    const before = await page.locator("#cut-value").innerText(), cut = await polygons();
    await page.mouse.move(520, 320);
    await page.mouse.down();
    await page.mouse.move(520, 290, { steps: 5 });
    await page.mouse.up();
    assert.notEqual(await page.locator("#cut-value").innerText(), before);
    await page.waitForFunction((n) => document.getElementById("view").dataset.polygons !== n, cut);
    const z = Number(/= (.*)/.exec(await page.locator("#cut-value").innerText())[1]);
    const bottom = Number(/= (.*)/.exec(before)[1]);
    assert.ok(z > bottom);
    await page.waitForTimeout(500);
    const [low, high] = psql("SELECT min(z), max(z) FROM abacus_hull('rock')").split("|").map(Number);
    const at = low + (Number(await page.locator("#cut").inputValue()) / 1000) * (high - low);
    assert.equal(await polygons(), psql(`SELECT count(*) FROM abacus_section('rock', '{1,1,${at}}', '{0,0,1}')`));
    await canvas().focus();
    await page.keyboard.press("PageDown");
    assert.notEqual(Number(/= (.*)/.exec(await page.locator("#cut-value").innerText())[1]), z);
});

test("a surface of one value, and a ray", async () => {
    await open("rock");
    await display();
    await page.locator("#level").fill("500");
    const text = await says(/surface at vs = [\d.]+ has \d+ triangles/);
    const [, value, triangles] = /at vs = ([\d.]+) has (\d+)/.exec(text);
    assert.equal(triangles, psql(`SELECT count(*) FROM abacus_isosurface('rock', ${value})`));
    await page.locator("#axis").selectOption("1");
    await page.waitForTimeout(500);
    await choose(/Ray/);
    await askAt(5.5, 4.5, -3);
    assert.ok(Number(/crosses (\d+) tetrahedra/.exec(await says(/crosses \d+ tetrahedra/))[1]) > 5);
    await take("space");
});

test("around a mesh whose hull has very many triangles is its box", async () => {
    // a cube with a grid of points on each side
    psql(`SELECT abacus_triangulate('cube', 'SELECT row_number() OVER (), x, y, z, x FROM generate_series(0, 45) AS x, generate_series(0, 45) AS y, generate_series(0, 45) AS z
              WHERE x IN (0, 45) OR y IN (0, 45) OR z IN (0, 45)', dimension => 3)`);
    servers.cube ??= await serve("cube");
    await open("cube");
    assert.equal(await page.locator("#view").getAttribute("data-outline"), "box");
    assert.match(await answer(), /Click a place/);
    await page.close(); // it must not ask for tiles of a mesh that is gone
    await drop("cube");
});

test("a point in space is added, moved and deleted; undo", async () => {
    await open("rock");
    const before = psql("SELECT value FROM abacus_stats('rock') WHERE name = 'vertices'");
    await choose(/Add/);
    await page.getByLabel("Id for the next new point").fill("4711");
    await askAt(5.25, 4.5, -3.1);
    assert.match(await says(/4711 added/), /\d+ tetrahedra surround it/);
    await choose(/Move/);
    await askAt(5.25, 4.5, -3.1);
    await says(/4711 selected/);
    await askAt(5.26, 4.51, -3.2);
    await says(/4711 moved/);
    await choose(/Delete/);
    await askAt(5.26, 4.51, -3.2);
    await says(/4711 deleted/);
    await page.getByRole("button", { name: "Undo" }).click();
    await says(/3 changes undone/);
    assert.equal(psql("SELECT value FROM abacus_stats('rock') WHERE name = 'vertices'"), before);
});
