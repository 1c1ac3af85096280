// The page in a browser without a screen: what each click and key is answered, that nothing is asked
// of another host, and that no error is left in the console. Pictures go to the folder that
// VIEWER_PICTURES names.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { after, afterEach, before, beforeEach, test } from "node:test";
import { makeMeshes, packages, psql, serve } from "./support.js";

const { chromium } = packages("playwright-core");
const pictures = process.env.VIEWER_PICTURES ?? "build/test/viewer";

let browser, page, servers, asked, complaints;
before(async () => {
    makeMeshes();
    mkdirSync(pictures, { recursive: true });
    servers = { terrain: await serve("terrain", { edit: true }), globe: await serve("globe", { srid: 4326 }), rock: await serve("rock", { edit: true }) };
    browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", // a WebGL without a graphics card
        args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"] });
});
after(async () => {
    await browser?.close();
    for (const server of Object.values(servers)) await server.stop();
});
beforeEach(async () => {
    page = await browser.newPage({ viewport: { width: 1000, height: 640 } });
    asked = [];
    complaints = [];
    page.on("request", (request) => asked.push(request.url()));
    page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
    page.on("pageerror", (error) => complaints.push(error.message));
});
afterEach(async () => {
    const { origin } = new URL(page.url());
    assert.deepEqual(asked.filter((url) => !url.startsWith(origin) && !url.startsWith(`blob:${origin}`) && !url.startsWith("data:")), []);
    assert.deepEqual(complaints, []);
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
    await page.getByRole("button", { name: "Ask here" }).click();
};
/** A picture, when nothing is being loaded any more. */
const take = async (name) => {
    await page.waitForSelector("#view[data-ready=true]");
    await page.screenshot({ path: `${pictures}/viewer_${name}.jpg`, quality: 75 });
};
const located = (place) => psql(`SELECT v0, v1, v2 FROM abacus_locate('terrain', ${place})`).replaceAll("|", " ");

test("a click asks for the triangle, its circle, neighbours and values", async () => {
    await open("terrain");
    for (let i = 0; i < 4; ++i) await page.getByRole("button", { name: "Zoom in" }).click();
    await page.waitForTimeout(700);
    await click(300, 320);
    const text = await says(/circumcircle.*value, nearest/);
    const place = cell(text, "place");
    assert.equal(cell(text, "triangle, by ids"), located(place));
    assert.match(cell(text, "circumcircle"), /^radius [\d.]+ around/);
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
    const first = await says(/triangle, by ids/);
    const neighbours = [0, 1, 2].map((facet) => cell(first, `across facet ${facet}`));
    await page.keyboard.press("ArrowRight");
    await page.waitForFunction((text) => document.getElementById("answer").innerText !== text, first);
    const second = await answer(page);
    assert.ok(neighbours.includes(cell(second, "triangle, by ids")));
    assert.ok(Number(cell(second, "place").split(",")[0]) > Number(cell(first, "place").split(",")[0]));
    const across = cell(second, "across facet 1");
    await page.getByRole("button", { name: "facet 1" }).press("Enter");
    await page.waitForFunction((text) => document.getElementById("answer").innerText !== text, second);
    assert.equal(cell(await answer(page), "triangle, by ids"), across);
    await canvas().focus();
    await page.keyboard.press("Escape");
    assert.equal(await page.locator("#walk").isVisible(), false);
});

test("a line gives its profile, with a place at each crossing", async () => {
    await open("terrain");
    await choose(/profile/);
    await askAt(400100, 5200100);
    await says(/begins here/);
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
    await says(/begins here/);
    await askAt(401000, 5200000);
    await says(/: 200000 places over 199999, from 900 to 1399/);
    assert.equal(await page.locator("#chart circle").count(), 0);
    assert.equal(await page.locator("#chart table tr").count(), 1001);
});

test("two places: whether one sees the other, and what is between", async () => {
    await open("terrain");
    await choose(/sees another/);
    for (const [to, height] of [["401700,5200700", 0], ["401700,5200700", 900]]) {
        await page.getByLabel("Height of the target").fill(String(height));
        await askAt(400030, 5200700);
        await says(/observer is here/);
        await askAt(...to.split(","));
        const text = await says(/sight\s+the target/);
        const [visible, x] = psql(`SELECT visible, x FROM abacus_visible('terrain', '{400030,5200700}', '{${to}}', target_height => ${height})`).split("|");
        assert.equal(/is seen/.test(text), visible === "t");
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
    const [response] = await Promise.all([page.waitForResponse((one) => one.url().includes("/tiles/terrain/")), page.getByLabel("terrain in three dimensions").check()]);
    assert.equal(response.status(), 200);
    await take("terrain");
});

test("a mesh of longitude and latitude, without attributes, lies where it is", async () => {
    await open("globe");
    await click(300, 320);
    const text = await says(/triangle, by ids/);
    assert.equal(cell(text, "triangle, by ids"), psql(`SELECT v0, v1, v2 FROM abacus_locate('globe', ${cell(text, "place")})`).replaceAll("|", " "));
    assert.doesNotMatch(text, /value, linear/);
});

test("a point is added, moved and deleted; undo and save", async () => {
    const vertices = () => psql("SELECT value FROM abacus_stats('terrain') WHERE name = 'vertices'");
    await open("terrain");
    const before = vertices();
    for (let i = 0; i < 4; ++i) await page.getByRole("button", { name: "Zoom in" }).click();
    await page.waitForTimeout(700);
    await choose(/adds a point/);
    await page.getByLabel("Id of a new point").fill("4711");
    await askAt(400892.5, 5200741.5);
    assert.match(await says(/4711 is added/), /\d+ triangles are around it/);
    await take("edit");
    await choose(/moves a point/);
    await askAt(400892.5, 5200741.5);
    await says(/4711 is taken/);
    await askAt(400893.5, 5200740.5);
    await says(/4711 is moved/);
    await choose(/deletes the nearest/);
    await askAt(400893.5, 5200740.5);
    await says(/4711 is deleted/);
    assert.equal(await page.locator("#changes").innerText(), "3 not saved");
    assert.equal(vertices(), before); // for others
    await page.getByRole("button", { name: "Undo" }).click();
    await says(/Undone: 3 changes/);
    await choose(/adds a point/);
    await page.getByLabel("Id of a new point").fill("4712");
    await askAt(400892.5, 5200741.5);
    await says(/4712 is added/);
    await page.getByRole("button", { name: "Save" }).click();
    await says(/Saved: 1 change/);
    assert.equal(Number(vertices()), Number(before) + 1);
    psql("SELECT abacus_delete('terrain', 'SELECT 4712, 400892.5, 5200741.5')");
});

test("every control has a name, and what is wrong is said", async () => {
    await open("terrain");
    const nameless = await page.evaluate(() => [...document.querySelectorAll("input, select, button, canvas, svg")]
        .filter((one) => one.checkVisibility() && !one.labels?.length && !one.ariaLabel && !one.textContent.trim() && !one.title && !one.closest("[aria-label] svg")).map((one) => one.outerHTML));
    assert.deepEqual(nameless, []);
    assert.equal(await page.locator("#answer").getAttribute("aria-live"), "polite");
    await page.getByRole("button", { name: "Ask here" }).click();
    await says(/must be numbers/);
    await askAt(0, 0);
    await says(/the place is outside/);
});

// ---- Space -------------------------------------------------------------------------------------

const polygons = () => page.locator("#view").getAttribute("data-polygons");

test("in space a click on the plane asks for the tetrahedron; keys walk", async () => {
    await open("rock");
    assert.equal(await page.locator("#view").getAttribute("data-outline"), "hull");
    await click(340, 320);
    const text = await says(/tetrahedron, by ids.*value, nearest/);
    const place = cell(text, "place");
    assert.equal(cell(text, "tetrahedron, by ids"), psql(`SELECT v0, v1, v2, v3 FROM abacus_locate('rock', ${place})`).replaceAll("|", " "));
    assert.match(cell(text, "circumsphere"), /^radius/);
    const across = cell(text, "across facet 2");
    await page.keyboard.press("3");
    await page.waitForFunction((before) => document.getElementById("answer").innerText !== before, text);
    assert.equal(cell(await answer(page), "tetrahedron, by ids"), across);
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
    const text = await says(/surface of vs [\d.]+ has \d+ triangles/);
    const [, value, triangles] = /of vs ([\d.]+) has (\d+)/.exec(text);
    assert.equal(triangles, psql(`SELECT count(*) FROM abacus_isosurface('rock', ${value})`));
    await page.locator("#axis").selectOption("1");
    await page.waitForTimeout(500);
    await choose(/ray/);
    await askAt(5.5, 4.5, -3);
    assert.ok(Number(/meets (\d+) tetrahedra/.exec(await says(/meets \d+ tetrahedra/))[1]) > 5);
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
    await choose(/adds a point/);
    await page.getByLabel("Id of a new point").fill("4711");
    await askAt(5.25, 4.5, -3.1);
    assert.match(await says(/4711 is added/), /\d+ tetrahedra are around it/);
    await choose(/moves a point/);
    await askAt(5.25, 4.5, -3.1);
    await says(/4711 is taken/);
    await askAt(5.26, 4.51, -3.2);
    await says(/4711 is moved/);
    await choose(/deletes the nearest/);
    await askAt(5.26, 4.51, -3.2);
    await says(/4711 is deleted/);
    await page.getByRole("button", { name: "Undo" }).click();
    await says(/Undone: 3 changes/);
    assert.equal(psql("SELECT value FROM abacus_stats('rock') WHERE name = 'vertices'"), before);
});
