// The page with a mesh of 14 million points: all is drawn, asked and changed as with a small one.
import assert from "node:assert/strict";
import { test } from "node:test";
import { askAt, cell, choose, click, corners, display, open, page, says, setUp, take } from "../browser.js";
import { psql, serve } from "../support.js";

const columns = 3800, rows = 3700; // 10 apart
setUp(async () => {
    psql(`SET client_min_messages = warning; DROP TABLE IF EXISTS millions CASCADE;
        SELECT abacus_triangulate('millions', 'SELECT i::bigint * ${rows} + j AS id, 400000 + 10 * i + (i * 7919 + j * 104729) % 7 AS x, 5200000 + 10 * j + (i * 31 + j * 17) % 7 AS y,
            900 + 300 * sin(i / 90.0) * cos(j / 110.0) + 20 * sin(i / 7.0) AS height FROM generate_series(0, ${columns - 1}) AS i, generate_series(0, ${rows - 1}) AS j')`, 1_200_000);
    return { millions: await serve("millions", { edit: true, timeout: 300 }) };
});

test("14 million points: the whole, a part, a triangle, a profile, a change", async () => {
    assert.equal(psql("SELECT value FROM abacus_stats('millions') WHERE name = 'vertices'"), String(columns * rows));
    page.setDefaultTimeout(400_000); // beside other suites its first tiles take a while
    await open("millions");
    assert.match(await page.locator("#legend").innerText(), /height/);
    await display();
    await page.locator("#contours").check();
    await take("millions");
    await page.locator("#display .close").click();
    for (let i = 0; i < 8; ++i) {
        await page.getByRole("button", { name: "Zoom in" }).click();
        await page.waitForTimeout(400);
        await page.waitForSelector("#view[data-ready=true]");
    }
    await click(500, 330);
    const text = await says(/Value, linear/);
    assert.equal(await corners(), psql(`SELECT v0, v1, v2 FROM abacus_locate('millions', ${cell(text, "Place")})`).replaceAll("|", " "));
    await take("millions_near");
    await page.getByRole("button", { name: "Fit to mesh" }).click();
    await page.waitForSelector("#view[data-ready=true]");
    await choose(/Profile/);
    await askAt(401000, 5201000);
    await says(/Start of the line/);
    await askAt(403000, 5202500);
    const [, places] = /Profile of height: ([\d,]+) places/.exec(await says(/Profile of height/));
    assert.equal(Number(places.replaceAll(",", "")), Number(psql("SELECT count(value) FROM abacus_profile('millions', '{401000,5201000,403000,5202500}')")));
    await choose(/Add/);
    await askAt(419005.5, 5218505.5);
    await says(/added/);
    await page.getByRole("button", { name: "Undo" }).click();
    await says(/1 change undone/);
});
