// What Debian's package has: the server with its driver in one file, and what the browser gets. It must need nothing beside it.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { cpSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { test } from "node:test";
import { makeMeshes, psql } from "./support.js";

const viewer = new URL("../../viewer/", import.meta.url).pathname;

test("the package runs where there is no package of npm, and has their licences", async () => {
    makeMeshes();
    execFileSync(process.execPath, [`${viewer}build.js`, "--package"]);
    const folder = mkdtempSync(join(tmpdir(), "viewer-"));
    cpSync(`${viewer}package`, folder, { recursive: true });
    const server = spawn(process.execPath, [join(folder, "server.js"), "--port", "0"], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
    try {
        const line = await new Promise((resolve, reject) => {
            createInterface({ input: server.stdout }).once("line", resolve);
            server.once("exit", (code) => reject(new Error(`it ended with ${code}`)));
        });
        const [, origin] = /The list of meshes is at (http:\/\/localhost:\d+)\//.exec(line);
        const { simplices } = await (await fetch(`${origin}/mesh/public/terrain/api/info`)).json();
        assert.equal(simplices, Number(psql("SELECT value FROM abacus_stats('terrain') WHERE name = 'simplices'")));
        for (const path of ["/", "/mesh/public/terrain/", "/mesh/public/rock/", "/assets/plane.js", "/assets/space.js", "/assets/list.js", "/assets/maplibre-gl-worker.mjs", "/assets/style.css"]) assert.equal((await fetch(origin + path)).status, 200, path);
        assert.match(execFileSync(process.execPath, [join(folder, "server.js"), "--help"], { encoding: "utf8" }), /usage/);
    } finally {
        server.removeAllListeners("exit");
        server.kill();
        rmSync(folder, { recursive: true, force: true });
    }
    const licences = readFileSync(`${viewer}package/LICENSES`, "utf8");
    for (const name of ["maplibre-gl", "three", "uplot", "lucide-static", "pg", "pg-protocol"]) assert.match(licences, new RegExp(`^${name} [\\d.]+ \\(`, "m"), name);
});
