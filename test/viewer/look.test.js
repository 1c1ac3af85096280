// What the map shows: legend, scale, relief, contours, edges, lines; windows of several sizes, light and dark.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { filled, segments, side } from "../../viewer/page/border.js";
import { Intervals } from "../../viewer/page/contours.js";
import { outside } from "../../viewer/page/outside.js";
import { stops } from "../../viewer/page/palette.js";
import { asked, askAt, cell, choose, display, open, page, pictures, says, setUp, take } from "./browser.js";
import { contrasts } from "./contrast.js";
import { psql, serve } from "./support.js";

const asks = (pattern) => page.waitForResponse((response) => pattern.test(response.url()) && response.status() === 200);

/** The coordinates under the pointer, as the page shows them. */
const pointed = async () => (await page.locator("#pointer span").innerText()).split(/\s+/).map((text) => Number(text.replaceAll(",", "")));

setUp(async () => {
    psql(`SET client_min_messages = warning; DROP TABLE IF EXISTS valley, none CASCADE;
        SELECT abacus_triangulate('valley', 'SELECT i * 100 + j AS id, 10 * i + (j % 3) AS x, 10 * j + (i % 3) AS y, i * j AS height FROM generate_series(0, 20) AS i, generate_series(0, 20) AS j');
        SELECT abacus_set_srid('valley', 25832);
        SELECT abacus_constrain('valley', 'VALUES (7, 1, 305), (7, 2, 1010), (7, 3, 1715)');
        SELECT abacus_triangulate('none', 'SELECT 1, 1.0::float8, 2.0::float8, 3.0::float8 WHERE false')`);
    return { valley: await serve("valley"), none: await serve("none"), shire: await serve("shire") };
});

test("legend, scale, coordinates and value under the pointer; the range of the view", async () => {
    await open("terrain");
    assert.match(await page.locator("#legend").innerText(), /height[^]*1,000/);
    assert.match(await page.locator("#scale").innerText(), /^[125]0*$/);
    await page.mouse.move(500, 330);
    await page.waitForFunction(() => document.querySelector("#pointer strong"));
    const [x, y] = await pointed(), value = Number((await page.locator("#pointer strong").innerText()).replaceAll(",", ""));
    assert.ok(Math.abs(value - Number(psql(`SELECT abacus_interpolate('terrain', ${x}, ${y})`))) < 15, `${x} ${y} ${value}`);
    for (let i = 0; i < 2; ++i) await page.getByRole("button", { name: "Zoom in" }).click();
    await page.waitForTimeout(700);
    await page.waitForSelector("#view[data-ready]");
    await display();
    const [picture] = await Promise.all([asks(/picture.*low=/), page.getByRole("button", { name: "From the view" }).click()]);
    const { searchParams } = new URL(picture.url()), [low, high] = ["low", "high"].map((name) => Number(searchParams.get(name)));
    const [least, greatest] = psql("SELECT least, greatest FROM abacus_attributes('terrain')").split("|").map(Number);
    assert.ok(low >= least - 0.01 && high <= greatest + 0.01 && high - low < greatest - least, `${low} ${high}`);
    await page.locator("#unit").fill("m");
    assert.match(await page.locator("#legend").innerText(), /\(m\)/);
    await Promise.all([asks(/picture.*ramp=viridis/), page.locator("#ramp").selectOption("viridis")]);
    await page.getByRole("button", { name: "Fit to mesh" }).click();
    await take("legend");
});

test("contours are drawn once: in vector tiles, at an interval for the zoom or one that is chosen", async () => {
    await open("terrain");
    await display();
    const [first] = await Promise.all([asks(/vector.*contours=[\d.]+/), page.locator("#contours").check()]);
    const automatic = Number(new URL(first.url()).searchParams.get("contours"));
    assert.equal(await page.locator("#interval option").first().innerText(), `automatic: ${automatic}`);
    await Promise.all([asks(/vector.*contours=20$/), page.locator("#interval").selectOption("20")]);
    assert.deepEqual(asked.filter((url) => /picture.*contours/.test(url)), []);
    assert.deepEqual(asked.filter((url) => /picture/.test(url) && !/edges=no/.test(url)), []);
    await page.locator("#display .close").click();
    await take("contours");
});

test("terrain rises from tiles of heights", async () => {
    await open("terrain");
    assert.ok(asked.some((url) => url.includes("/tiles/terrain/") && url.includes("outside=none")));
    await page.getByRole("button", { name: "Terrain in 3D" }).click();
    await page.waitForTimeout(1500);
    await page.locator("#view canvas").hover({ position: { x: 500, y: 400 } });
    await take("terrain");
    await page.getByRole("button", { name: "Fit to mesh" }).click();
});

test("lengths and areas", async () => {
    await open("valley");
    await choose(/Measure/);
    for (const place of [[10, 10], [110, 10], [110, 60]]) await askAt(...place);
    const text = await says(/Area/);
    assert.equal(cell(text, "Length"), "150 m");
    assert.equal(cell(text, "Area"), "2,500 m²");
    assert.match(await page.locator("#scale").innerText(), / m$/);
});

test("fixed edges are drawn, and the triangle under the pointer is outlined", async () => {
    await open("valley");
    assert.equal(await page.locator("#view").getAttribute("data-lines"), "1");
    await page.locator("#view canvas").hover({ position: { x: 480, y: 300 } });
    await page.waitForFunction(() => document.getElementById("view").dataset.under);
    const ids = await page.locator("#view").getAttribute("data-under");
    const [x, y] = await pointed();
    assert.equal(ids, psql(`SELECT v0, v1, v2 FROM abacus_locate('valley', ${x}, ${y})`).replaceAll("|", " "));
    await display();
    assert.match(await page.locator("#lines-row").innerText(), /Fixed edges of 1 line/);
    await take("lines");
});

test("regions are tinted, named under the pointer and in the panel, and shown alone", async () => {
    const lake = `O'Hara & "lake"`, over = (x, y) => page.locator("#view canvas").hover({ position: { x, y } });
    await open("shire");
    assert.equal(await page.locator("#view").getAttribute("data-regions"), "2");
    for (const [x, y, region] of [[490, 340, lake], [500, 150, "farm"]]) {
        await over(x, y);
        await page.waitForFunction((name) => document.querySelector("#pointer em")?.textContent === name, region);
        assert.equal(psql(`SELECT abacus_region_at('shire', ${await pointed()})`), region);
    }
    await page.locator("#view canvas").click({ position: { x: 490, y: 340 } });
    assert.equal(cell(await says(/Region/), "Region"), lake);
    await display();
    assert.match(await page.locator("#regions-row").innerText(), /Tints of 2 regions/);
    await Promise.all([asks(/picture.*regions=yes/), page.locator("#regions").check()]);
    await take("regions");
    assert.deepEqual(await page.locator("#within option").allInnerTexts(), ["whole mesh", lake, "farm"]);
    const tile = (kind) => (response) => response.url().includes(`/tiles/${kind}/`) && new URL(response.url()).searchParams.get("within") === "farm" && response.status() === 200;
    await Promise.all([...["picture", "vector", "terrain"].map((kind) => page.waitForResponse(tile(kind))), page.locator("#within").selectOption("farm")]);
    await take("region");
    // the region that is shown alone goes: the whole mesh is shown again
    psql("SELECT abacus_unregion('shire', 'farm')");
    await page.locator("#attribute").dispatchEvent("change");
    await page.waitForFunction(() => document.getElementById("view").dataset.regions === "1" && document.getElementById("within").value === "");
    await page.waitForSelector("#view[data-ready=true]");
});

test("a mesh without regions offers none", async () => {
    await open("valley");
    await display();
    for (const id of ["regions-row", "within-row"]) assert.equal(await page.locator(`#${id}`).isVisible(), false);
    assert.deepEqual(asked.filter((url) => /regions=|within=/.test(url)), []);
});

test("an empty mesh is said to be empty", async () => {
    await open("none");
    await says(/no triangles yet/);
    assert.equal(await page.locator("#legend").isVisible(), false);
});

for (const [name, width, height] of [["wide", 1600, 900], ["tablet", 820, 1100], ["phone", 390, 780]])
    for (const colorScheme of ["light", "dark"])
        test(`a window of ${width} by ${height}, ${colorScheme}: all is within it, and legible`, async () => {
            await page.setViewportSize({ width, height });
            await page.emulateMedia({ colorScheme });
            await open("terrain");
            await page.keyboard.press("Tab");
            await page.locator("#view canvas").click({ position: { x: width / 2, y: height / 2 } });
            await says(/Value, linear/);
            const wrong = await page.evaluate(() => [...document.querySelectorAll(".card, #scale")].filter((one) => one.checkVisibility()).map((one) => [one.id || one.className, one.getBoundingClientRect()])
                .filter(([, box]) => box.left < -1 || box.top < -1 || box.right > innerWidth + 1 || box.bottom > innerHeight + 1).map(([id]) => id));
            assert.deepEqual(wrong, []);
            assert.deepEqual(await page.evaluate(contrasts, ".card *"), []);
            await page.screenshot({ path: `${pictures}/viewer_${name}_${colorScheme}.jpg`, quality: 75 });
        });

test("beyond the border neighbouring tiles of heights agree along their seam", () => {
    const border = segments([[[0.3, 0.3, 10], [0.62, 0.34, 50], [0.7, 0.7, 20], [0.35, 0.6, 90]]]);
    const tile = (x, y) => filled(new Float32Array(side * side).fill(NaN), 2, x, y, border);
    let most = 0, within = 0;
    for (const [left, right] of [[[0, 0], [1, 0]], [[1, 0], [2, 0]], [[2, 3], [3, 3]]]) {
        const [a, b] = [tile(...left), tile(...right)];
        for (let y = 0; y < side; ++y) {
            const at = y * side;
            most = Math.max(most, Math.abs(b[at] - a[at + side - 1]));
            for (let x = 1; x < side; ++x) within = Math.max(within, Math.abs(a[at + x] - a[at + x - 1]), Math.abs(b[at + x] - b[at + x - 1]));
        }
    }
    assert.ok(within > 0 && most <= within * 1.0001, `${most} at seams, ${within} within`);
    const known = new Float32Array(side * side).fill(7);
    assert.deepEqual(filled(known, 2, 1, 1, border), known);
});

test("outside are the holes of the mesh, too, but not the parts in them", () => {
    const box = (from, to) => [[from, from], [to, from], [to, to], [from, to], [from, from]], hole = (from, to) => box(from, to).reverse(), world = box(-100, 100);
    assert.deepEqual(outside(world, [box(0, 10)]), [[world, box(0, 10)]]);
    // two holes, an island in one of them, with a pond, and another part of the mesh
    assert.deepEqual(outside(world, [hole(1, 5), box(0, 10), box(2, 4), hole(2.5, 3.5), hole(6, 7), box(20, 30)]),
        [[world, box(0, 10), box(20, 30)], [hole(2.5, 3.5)], [hole(6, 7)], [hole(1, 5), box(2, 4)]]);
    // an island that touches the shore in a corner
    assert.deepEqual(outside(world, [box(0, 10), hole(1, 5), box(1, 3)]), [[world, box(0, 10)], [hole(1, 5), box(1, 3)]]);
});

test("the palettes of the legend are those of the pictures", () => {
    const source = readFileSync(new URL("../../src/draw/palette.cpp", import.meta.url), "utf8");
    for (const name of ["terrain", "strata", "viridis", "magma", "cividis", "grey", "diverging"]) {
        const [, list] = new RegExp(`Palette Palette::${name}\\(\\) \\{\\s*return \\{([^}]*)\\}`).exec(source);
        assert.deepEqual(stops(name), list.match(/[0-9a-f]{6}/g).map((colour) => `#${colour}`), name);
    }
});

test("the interval of contours gets finer with the zoom, and each fifth is an index contour", () => {
    const intervals = new Intervals({ least: 236, greatest: 1076 }, 9.2, 0), steps = Array.from({ length: 12 }, (_, i) => intervals.at(8 + i));
    assert.ok(steps.every((step, i) => i === 0 || step <= steps[i - 1]) && steps.at(-1) < steps[0] / 50, steps.join(" "));
    assert.ok(steps.every((step) => /^[125]$/.test(Number(step.toExponential().split("e")[0]))));
    assert.equal(new Intervals({ least: 0, greatest: 1 }, 9, 0.25).at(14), 0.25);
});
