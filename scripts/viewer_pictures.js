#!/usr/bin/env node
// Takes the pictures of the viewer that README and docs/viewer.md show: docs/images/viewer_*.jpg. The database that the environment
// names must have the meshes of scripts/demo.sh, terrain, shorelines and quake. CHROMIUM names the browser.
//
//   PGDATABASE=gis scripts/viewer_pictures.js [NAME...]     all pictures, or some: terrain, contours, …
import { createRequire } from "node:module";
import { start } from "../viewer/server.js";

const { chromium } = createRequire(new URL("../viewer/package.json", import.meta.url))("playwright-core");
const folder = new URL("../docs/images/", import.meta.url).pathname;

const ask = async (page, ...place) => {
    if (await page.locator("#go").isHidden()) await page.locator("#go-open").click();
    for (const [i, x] of place.entries()) await page.locator(`#${"xyz"[i]}`).fill(String(x));
    await page.getByRole("button", { name: "Go", exact: true }).click();
    await ready(page);
};
const ready = async (page) => {
    await page.waitForFunction(() => document.getElementById("view")?.ariaBusy !== "true");
    await page.waitForTimeout(1200); // tiles that are asked for now
    await page.waitForSelector("[data-ready=true]");
};
const display = async (page, ...tasks) => {
    await page.locator("#display-open").click();
    for (const task of tasks) await task();
    await page.locator("#display .close").click();
};

/** Each picture: its mesh, or the list, and what is done before it is taken. */
const pictures = {
    terrain: ["terrain", async (page) => {
        await page.locator("#three").click();
        await ready(page);
        await page.mouse.move(600, 500);
        for (let i = 0; i < 2; ++i) await page.mouse.wheel(0, -240);
    }],
    contours: ["terrain", async (page) => {
        await display(page, () => page.locator("#contours").check(), () => page.locator("#unit").fill("m"));
        for (let i = 0; i < 2; ++i) await page.getByRole("button", { name: "Zoom in" }).click();
    }],
    triangle: ["terrain", async (page) => {
        for (let i = 0; i < 6; ++i) await page.getByRole("button", { name: "Zoom in" }).click();
        await ready(page);
        await page.locator("#view canvas").click({ position: { x: 720, y: 400 } });
    }],
    profile: ["terrain", async (page) => {
        await page.getByRole("radio", { name: /Profile/ }).check();
        await ask(page, 6000, 9000);
        await ask(page, 26000, 24000);
        await page.locator("#go-open").click();
        await page.mouse.move(700, 680);
    }],
    sight: ["terrain", async (page) => {
        await page.getByRole("radio", { name: /Line of sight/ }).check();
        await page.getByLabel("Height of the observer").fill("30");
        await ask(page, 9000, 20000);
        await ask(page, 24000, 12000);
        await page.locator("#go-open").click();
    }],
    shorelines: ["shorelines", async () => {}],
    surface: ["quake", async (page) => {
        await display(page, () => page.locator("#unit").fill("m/s"), () => page.locator("#axis").selectOption("0"), () => page.locator("#level").fill("330"));
    }],
    list: [null, async () => {}],
};

const wanted = process.argv.slice(2), server = await start({ srid: 0, edit: false, timeout: 60, port: 0, host: "127.0.0.1" });
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"] });
try {
    for (const [name, [mesh, prepare]] of Object.entries(pictures)) {
        if (wanted.length && !wanted.includes(name)) continue;
        const page = await browser.newPage({ viewport: { width: 1200, height: 760 } });
        page.setDefaultTimeout(120_000);
        await page.goto(`http://127.0.0.1:${server.port}/${mesh ? `mesh/public/${mesh}/` : ""}`);
        await ready(page);
        await prepare(page);
        await ready(page);
        await page.evaluate(() => document.querySelector("#hint .close")?.click()); // it only asks for a click
        await page.screenshot({ path: `${folder}viewer_${name}.jpg`, quality: 80 });
        console.log(`docs/images/viewer_${name}.jpg`);
        await page.close();
    }
} finally {
    await browser.close();
    await server.stop();
}
