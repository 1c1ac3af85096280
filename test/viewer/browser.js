// The page in a headless browser, for tests: no request goes to another host, and no error is left in the console. Pictures
// go to the folder that VIEWER_PICTURES names.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { after, afterEach, before, beforeEach } from "node:test";
import { eventually, makeMeshes, packages, serve } from "./support.js";

const { chromium } = packages("playwright-core");
export const pictures = process.env.VIEWER_PICTURES ?? "build/test/viewer";

export let browser, page, servers, asked;
let unanswered;
let complaints, refusals;
/** Complaints of the browser in its console that the test expects: requests that the server must refuse. */
export const refuses = (pattern) => { refusals = pattern; };
/** Before all tests of a file: the meshes, a server for each, and those that `prepare` returns. */
export function setUp(prepare = async () => ({})) {
    before(async () => {
        makeMeshes();
        mkdirSync(pictures, { recursive: true });
        servers = { terrain: await serve("terrain", { edit: true }), globe: await serve("globe", { srid: 4326 }), rock: await serve("rock", { edit: true }), ...(await prepare()) };
        browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", // WebGL without a graphics card
            args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"] });
    });
    after(async () => {
        await browser?.close();
        for (const server of Object.values(servers)) await server.stop();
    });
    beforeEach(async () => {
        page = await browser.newPage({ viewport: { width: 1000, height: 640 } });
        page.setDefaultTimeout(Number(process.env.WAIT ?? 120_000)); // in case the machine is busy
        asked = [];
        complaints = [];
        refusals = /^$/;
        unanswered = new Set();
        page.on("request", (request) => (asked.push(request.url()), unanswered.add(request)));
        for (const end of ["requestfinished", "requestfailed"]) page.on(end, (request) => unanswered.delete(request));
        page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
        page.on("pageerror", (error) => complaints.push(error.message));
    });
    afterEach(async () => {
        const { origin } = new URL(page.url());
        assert.deepEqual(asked.filter((url) => !url.startsWith(origin) && !url.startsWith(`blob:${origin}`) && !url.startsWith("data:")), []);
        assert.deepEqual(complaints.filter((text) => !refusals.test(text)), []);
        await page.close();
    });
}

export const open = async (name) => {
    await page.goto(servers[name].origin);
    await page.waitForSelector("#view[data-ready=true]").catch(async (error) => {
        const waiting = [...unanswered].map((request) => request.url()).join(" ") || "no answer";
        throw new Error(`${error.message}\nThe page waits for ${waiting} and says: ${await answer()}\n${complaints.join("\n")}`);
    });
};
export const canvas = () => page.locator("#view canvas");
const said = () => {
    const panel = document.getElementById("panel").hidden ? "" : document.getElementById("answer").innerText;
    return `${document.getElementById("hint-text").textContent}\n${panel}`;
};
/** The message of the page, and its panel. */
export const answer = () => page.evaluate(said);
/** What the page says once it says something of this kind. */
export async function says(pattern) {
    await eventually(async () => pattern.test((await answer()).replaceAll("\n", " ")), String(pattern), 120_000);
    return answer();
}
export const differs = (text) => eventually(async () => (await answer()) !== text, "another answer");
/** The ids of the simplex in the panel. */
export const corners = async () => (await page.locator("#answer h3:has-text('Vertices of') + table td:first-child").allInnerTexts()).join(" ");
export const display = async () => { if (await page.locator("#display").isHidden()) await page.locator("#display-open").click(); };
/** A row of the answer. */
export const cell = (text, head) => text.split("\n").find((line) => line.startsWith(head))?.slice(head.length).trim();
export const click = (x, y) => canvas().click({ position: { x, y } });
export const choose = (name) => page.getByRole("radio", { name }).check();
export const askAt = async (...place) => {
    if (await page.locator("#go").isHidden()) await page.locator("#go-open").click();
    for (const [i, name] of [..."xyz"].slice(0, place.length).entries()) await page.locator(`#${name}`).fill(String(place[i]));
    await page.getByRole("button", { name: "Go", exact: true }).click();
};
/** A picture, when nothing is being loaded any more. */
export const take = async (name) => {
    await page.waitForSelector("#view[data-ready=true]");
    await page.screenshot({ path: `${pictures}/viewer_${name}.jpg`, quality: 75 });
};
