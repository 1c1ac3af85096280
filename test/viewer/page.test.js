// The page in a headless browser: the effect of each click and key; no request to another host; and no error left in
// the console. Pictures go to the folder that VIEWER_PICTURES names.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { after, afterEach, before, beforeEach, test } from "node:test";
import { eventually, fragileWay, makeMeshes, packages, psql, serve } from "./support.js";

const { chromium } = packages("playwright-core");
const pictures = process.env.VIEWER_PICTURES ?? "build/test/viewer";

let browser, page, servers, asked, complaints, refusals;
before(async () => {
    makeMeshes();
    mkdirSync(pictures, { recursive: true });
    servers = { terrain: await serve("terrain", { edit: true }), globe: await serve("globe", { srid: 4326 }), rock: await serve("rock", { edit: true }) };
    browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", // WebGL without a graphics card
        args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"] });
});
after(async () => {
    await browser?.close();
    for (const server of Object.values(servers)) await server.stop();
});
beforeEach(async () => {
    page = await browser.newPage({ viewport: { width: 1000, height: 640 } });
    page.setDefaultTimeout(120_000); // in case the machine is busy
    asked = [];
    complaints = [];
    refusals = /^$/; // requests that the server must refuse; the browser reports them in the console
    page.on("request", (request) => asked.push(request.url()));
    page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
    page.on("pageerror", (error) => complaints.push(error.message));
});
afterEach(async () => {
    const { origin } = new URL(page.url());
    assert.deepEqual(asked.filter((url) => !url.startsWith(origin) && !url.startsWith(`blob:${origin}`) && !url.startsWith("data:")), []);
    assert.deepEqual(complaints.filter((text) => !refusals.test(text)), []);
    await page.close();
});

const open = async (name) => {
    await page.goto(servers[name].origin);
    await page.waitForSelector("#view[data-ready=true]");
};
const canvas = () => page.locator("#view canvas");
const answer = page => page.locator("#answer").innerText();
/** What the page says once it says something of this kind. */
async function says(pattern) {
    await page.waitForFunction(([source]) => new RegExp(source, "s").test(document.getElementById("answer").innerText), [pattern.source]);
    return answer(page);
}
/** A row of the answer. */
const cell = (text, head) => text.split("\n").find((line) => line.startsWith(head))?.slice(head.length).trim();
const click = (x, y) => canvas().click({ position: { x, y } });
const choose = (name) => page.getByRole("radio", { name }).check();
const askAt = async (...place) => {
    for (const [i, name] of [..."xyz"].slice(0, place.length).entries()) await page.locator(`#${name}`).fill(String(place[i]));
    await page.getByRole("button", { name: "Go", exact: true }).click();
};
/** A picture, when nothing is being loaded any more. */
const take = async (name) => {
    await page.waitForSelector("#view[data-ready=true]");
    await page.screenshot({ path: `${pictures}/viewer_${name}.jpg`, quality: 75 });
};
const located = (place) => psql(`SELECT v0, v1, v2 FROM abacus_locate('terrain', ${place})`).replaceAll("|", " ");

test("a click shows the triangle, its circle, neighbours and values", async () => {
    await open("terrain");
    for (let i = 0; i < 4; ++i) await page.getByRole("button", { name: "Zoom in" }).click();
    await page.waitForTimeout(700);
    await click(300, 320);
    const text = await says(/circumcircle.*value, nearest/);
    const place = cell(text, "place");
    assert.equal(cell(text, "vertices of the triangle"), located(place));
    assert.match(cell(text, "circumcircle"), /^radius [\d.]+, centre/);
    for (const method of ["linear", "natural", "nearest"])
        assert.ok(Math.abs(Number(cell(text, `value, ${method}`)) - Number(psql(`SELECT abacus_interpolate('terrain', ${place}, method => '${method}')`))) < 0.1);
    for (const facet of [0, 1, 2])
        assert.equal(cell(text, `across facet ${facet}`), psql(`SELECT v0, v1, v2 FROM abacus_walk('terrain', abacus_locate('terrain', ${place}), ${facet})`).replaceAll("|", " "));
    await take("triangle");
});

test("arrows and buttons walk to neighbours, by the keyboard alone", async () => {
    await open("terrain");
    await canvas().focus();
    await page.keyboard.press("Enter");
    const first = await says(/vertices of the triangle/);
    const neighbours = [0, 1, 2].map((facet) => cell(first, `across facet ${facet}`));
    await page.keyboard.press("ArrowRight");
    await page.waitForFunction((text) => document.getElementById("answer").innerText !== text, first);
    const second = await answer(page);
    assert.ok(neighbours.includes(cell(second, "vertices of the triangle")));
    assert.ok(Number(cell(second, "place").split(",")[0]) > Number(cell(first, "place").split(",")[0]));
    const across = cell(second, "across facet 1");
    await page.getByRole("button", { name: "facet 1" }).press("Enter");
    await page.waitForFunction((text) => document.getElementById("answer").innerText !== text, second);
    assert.equal(cell(await answer(page), "vertices of the triangle"), across);
    await canvas().focus();
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("#walk").isVisible(), false);
});

test("a line gives its profile, with a place at each crossing", async () => {
    await open("terrain");
    await choose(/profile/);
    await askAt(400100, 5200100);
    await says(/Start of the line/);
    await askAt(401500, 5201200);
    const text = await says(/Profile of height: \d+ places/);
    const expected = Number(psql("SELECT count(value) FROM abacus_profile('terrain', '{400100,5200100,401500,5201200}')"));
    assert.equal(Number(/: (\d+) places/.exec(text)[1]), expected);
    assert.equal(await page.locator("#chart circle").count(), expected);
    assert.match(await page.locator("#chart svg").getAttribute("aria-label"), /Profile of height/);
    await page.locator("#chart summary").click();
    assert.equal(await page.locator("#chart table tr").count(), expected + 1);
    await page.locator("#chart summary").click();
    await take("profile");
});

test("a profile of very many places is a line without dots", async () => {
    await open("terrain");
    const rows = Array.from({ length: 200_000 }, (_, i) => ({ distance: i, x: 400000 + i / 200, y: 5200000, value: 900 + (i % 500) }));
    await page.route("**/api/profile?**", (route) => route.fulfill({ json: rows }));
    await choose(/profile/);
    await askAt(400000, 5200000);
    await says(/Start of the line/);
    await askAt(401000, 5200000);
    await says(/: 200000 places, length 199999, values 900 to 1399/);
    assert.equal(await page.locator("#chart circle").count(), 0);
    assert.equal(await page.locator("#chart table tr").count(), 1001);
});

test("two places: whether one sees the other, and what is between", async () => {
    await open("terrain");
    await choose(/line of sight/);
    for (const [to, height] of [["401700,5200700", 0], ["401700,5200700", 900]]) {
        await page.getByLabel("Height of the target").fill(String(height));
        await askAt(400030, 5200700);
        await says(/Observer set/);
        await askAt(...to.split(","));
        const text = await says(/line of sight\s+the target/);
        const [visible, x] = psql(`SELECT visible, x FROM abacus_visible('terrain', '{400030,5200700}', '{${to}}', target_height => ${height})`).split("|");
        assert.equal(/is visible/.test(text), visible === "t");
        assert.equal(/blocked at/.test(text), x !== "");
    }
});

test("the slider sets the interval of contours", async () => {
    await open("terrain");
    const slider = page.locator("#interval");
    await slider.focus();
    for (let i = 0; i < 5; ++i) await page.keyboard.press("ArrowRight");
    const interval = await page.locator("#interval-value").innerText();
    assert.ok(Number(interval) > 0);
    await page.waitForResponse((response) => response.url().includes(`contours=${interval}`) && response.status() === 200);
    await page.locator("#ramp").selectOption("viridis");
    await page.waitForResponse((response) => /picture.*ramp=viridis/.test(response.url()) && response.status() === 200);
    await take("contours");
});

test("terrain rises from tiles of heights", async () => {
    await open("terrain");
    const [response] = await Promise.all([page.waitForResponse((one) => one.url().includes("/tiles/terrain/")), page.getByLabel("Terrain in three dimensions").check()]);
    assert.equal(response.status(), 200);
    await take("terrain");
});

test("a mesh of longitude and latitude, without attributes, lies where it is", async () => {
    await open("globe");
    await click(300, 320);
    const text = await says(/vertices of the triangle/);
    assert.equal(cell(text, "vertices of the triangle"), psql(`SELECT v0, v1, v2 FROM abacus_locate('globe', ${cell(text, "place")})`).replaceAll("|", " "));
    assert.doesNotMatch(text, /value, linear/);
});

test("a point is added, moved and deleted; undo and save", async () => {
    const vertices = () => psql("SELECT value FROM abacus_stats('terrain') WHERE name = 'vertices'");
    await open("terrain");
    const before = vertices();
    for (let i = 0; i < 4; ++i) await page.getByRole("button", { name: "Zoom in" }).click();
    await page.waitForTimeout(700);
    await choose(/add a point/);
    await page.getByLabel("Id for the next new point").fill("4711");
    await askAt(400892.5, 5200741.5);
    assert.match(await says(/4711 added/), /\d+ triangles surround it/);
    await take("edit");
    await choose(/move a point/);
    await askAt(400892.5, 5200741.5);
    await says(/4711 selected/);
    await askAt(400893.5, 5200740.5);
    await says(/4711 moved/);
    await choose(/delete the nearest/);
    await askAt(400893.5, 5200740.5);
    await says(/4711 deleted/);
    assert.equal(await page.locator("#changes").innerText(), "3 unsaved changes");
    assert.equal(vertices(), before); // for other pages
    await page.getByRole("button", { name: "Undo" }).click();
    await says(/3 changes undone/);
    await choose(/add a point/);
    await page.getByLabel("Id for the next new point").fill("4712");
    await askAt(400892.5, 5200741.5);
    await says(/4712 added/);
    await page.getByRole("button", { name: "Save" }).click();
    await says(/1 change saved/);
    assert.equal(Number(vertices()), Number(before) + 1);
    psql("SELECT abacus_delete('terrain', 'SELECT 4712, 400892.5, 5200741.5')");
});

const addAt = async (id, ...place) => {
    await choose(/add a point/);
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
    const text = await says(/vertices of the triangle.*nearest vertex/);
    assert.equal(cell(text, "vertices of the triangle"), "1 2 5");
    assert.deepEqual([0, 1, 2].map((facet) => cell(text, `across facet ${facet}`)), ["none: the mesh ends here", "1 5 4", "none: the mesh ends here"]);
    assert.deepEqual(["linear", "nearest"].map((method) => cell(text, `value, ${method}`)), ["0", "0"]);
    assert.doesNotMatch(text, /value, natural/);
    assert.equal(await page.getByRole("button", { name: "facet 0" }).isDisabled(), true);
    await page.getByRole("button", { name: "facet 1" }).press("Enter");
    await says(/vertices of the triangle\s+1 5 4/);
    psql("DROP TABLE fault CASCADE");
});

test("ids beyond 53 bits are shown and changed as they are", async () => {
    psql("SET client_min_messages = warning; SELECT abacus_triangulate('great', 'SELECT 9007199254740992 + i, i % 3, i / 3, i FROM generate_series(0, 8) AS i')");
    servers.great ??= await serve("great", { edit: true });
    await open("great");
    await askAt(0.9, 0.05);
    const text = await says(/vertices of the triangle.*nearest vertex/);
    assert.equal(cell(text, "vertices of the triangle"), psql("SELECT v0, v1, v2 FROM abacus_locate('great', 0.9, 0.05)").replaceAll("|", " "));
    assert.match(cell(text, "nearest vertex"), /^9007199254740993,/);
    await addAt("9007199254741993", 0.5, 0.25);
    await says(/Point 9007199254741993 added/);
    assert.equal(await page.getByLabel("Id for the next new point").inputValue(), "9007199254741994");
    await choose(/delete the nearest/);
    await askAt(1.01, 1.01);
    await says(/Point 9007199254740996 deleted/);
    await page.getByRole("button", { name: "Save" }).click();
    await says(/2 changes saved/);
    assert.equal(psql("SELECT string_agg(id::text, ' ' ORDER BY id) FROM abacus_vertices('great') WHERE id IN (9007199254740996, 9007199254740995, 9007199254740997, 9007199254741993)"), "9007199254740995 9007199254740997 9007199254741993");
    psql("DROP TABLE great CASCADE");
});

test("while another page has changes this is said at once, and when that page goes it has them no more", async () => {
    refusals = /status of 423/;
    const other = await browser.newPage();
    other.setDefaultTimeout(120_000);
    other.on("dialog", (dialog) => dialog.accept());
    await other.goto(servers.terrain.origin);
    await other.waitForSelector("#view[data-ready=true]");
    await other.getByRole("radio", { name: /add a point/ }).check();
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
    refusals = /status of (410|503)/;
    t.mock.method(console, "error", () => {});
    const way = await fragileWay();
    const server = servers.fragile = await serve("terrain", { edit: true, dbname: way.dbname, absent: 30 }); // so it checks every five seconds
    await open("fragile");
    await addAt("4714", 400892.5, 5200741.5);
    await says(/4714 added/);
    assert.equal(await changes(), "1 unsaved change");
    const before = psql("SELECT value FROM abacus_stats('terrain') WHERE name = 'vertices'");
    assert.match(await page.locator("#summary").innerText(), new RegExp(`${Number(before) + 1} vertices`));
    way.open = false;
    way.break();
    await says(/the connection to the database broke; 1 unsaved change was lost/);
    assert.equal(await changes(), "No unsaved changes");
    way.open = true;
    await page.waitForFunction((words) => document.getElementById("summary").textContent.includes(words), `, ${before} vertices`); // the present mesh
    await eventually(async () => {
        await addAt("4714", 400892.5, 5200741.5);
        return /4714 added/.test(await says(/4714 added|be reached|another transaction/));
    }, "the page goes on");
    await server.stop();
    servers.fragile = { stop: () => way.close() };
    await page.getByRole("button", { name: "Undo" }).click();
    await says(/server cannot be reached/);
    refusals = /./; // connections that are refused
});

test("a Save that is refused says why, and what is undone", async () => {
    refusals = /status of 400/;
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
    const nameless = await page.evaluate(() => [...document.querySelectorAll("input, select, button, canvas, svg")]
        .filter((one) => one.checkVisibility() && !one.labels?.length && !one.ariaLabel && !one.textContent.trim() && !one.title && !one.closest("[aria-label] svg")).map((one) => one.outerHTML));
    assert.deepEqual(nameless, []);
    assert.equal(await page.locator("#answer").getAttribute("aria-live"), "polite");
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
    await click(340, 320);
    const text = await says(/vertices of the tetrahedron.*value, nearest/);
    const place = cell(text, "place");
    assert.equal(cell(text, "vertices of the tetrahedron"), psql(`SELECT v0, v1, v2, v3 FROM abacus_locate('rock', ${place})`).replaceAll("|", " "));
    assert.match(cell(text, "circumsphere"), /^radius/);
    const across = cell(text, "across facet 2");
    await page.keyboard.press("3");
    await page.waitForFunction((before) => document.getElementById("answer").innerText !== before, text);
    assert.equal(cell(await answer(page), "vertices of the tetrahedron"), across);
});

test("the plane is dragged, and moved by keys", async () => {
    await open("rock");
    const before = await page.locator("#cut-value").innerText(), cut = await polygons();
    await page.mouse.move(340, 320);
    await page.mouse.down();
    await page.mouse.move(340, 290, { steps: 5 });
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
    await page.locator("#level").fill("500");
    const text = await says(/surface at vs = [\d.]+ has \d+ triangles/);
    const [, value, triangles] = /at vs = ([\d.]+) has (\d+)/.exec(text);
    assert.equal(triangles, psql(`SELECT count(*) FROM abacus_isosurface('rock', ${value})`));
    await page.locator("#axis").selectOption("1");
    await page.waitForTimeout(500);
    await choose(/ray/);
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
    assert.equal(await answer(page), "Click a place.");
    psql("DROP TABLE cube CASCADE");
});

test("a point in space is added, moved and deleted; undo", async () => {
    await open("rock");
    const before = psql("SELECT value FROM abacus_stats('rock') WHERE name = 'vertices'");
    await choose(/add a point/);
    await page.getByLabel("Id for the next new point").fill("4711");
    await askAt(5.25, 4.5, -3.1);
    assert.match(await says(/4711 added/), /\d+ tetrahedra surround it/);
    await choose(/move a point/);
    await askAt(5.25, 4.5, -3.1);
    await says(/4711 selected/);
    await askAt(5.26, 4.51, -3.2);
    await says(/4711 moved/);
    await choose(/delete the nearest/);
    await askAt(5.26, 4.51, -3.2);
    await says(/4711 deleted/);
    await page.getByRole("button", { name: "Undo" }).click();
    await says(/3 changes undone/);
    assert.equal(psql("SELECT value FROM abacus_stats('rock') WHERE name = 'vertices'"), before);
});
