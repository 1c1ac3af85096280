// Puts together what the browser gets, in dist/: all of it from packages and this folder. With --package also what Debian's package
// gets, in package/: the server in one file with its driver, what the browser gets, and the licences of all packages.
import { build } from "esbuild";
import { copyFileSync, cpSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";

const folder = (name) => new URL(name, import.meta.url).pathname;
const maplibre = folder("node_modules/maplibre-gl/dist/");

rmSync(folder("dist"), { recursive: true, force: true });
mkdirSync(folder("dist"));
const page = await build({
    entryPoints: [folder("page/plane.js"), folder("page/space.js"), folder("page/list.js"), folder("page/globe.js")],
    bundle: true,
    minify: true,
    format: "esm",
    target: "es2022",
    outdir: folder("dist"),
    alias: { "maplibre-gl": "./maplibre-gl.mjs" },
    external: ["./maplibre-gl.mjs"], // it loads a worker beside it
    loader: { ".svg": "text" },
    logLevel: "warning",
    metafile: true,
});
for (const name of ["maplibre-gl.mjs", "maplibre-gl-shared.mjs", "maplibre-gl-worker.mjs", "maplibre-gl.css"])
    copyFileSync(maplibre + name, folder(`dist/${name}`));
copyFileSync(folder("node_modules/uplot/dist/uPlot.min.css"), folder("dist/uplot.css"));
// What Cesium loads by itself: its workers, and some of its tables and pictures.
const cesium = folder("node_modules/@cesium/engine/");
cpSync(`${cesium}Build/Workers`, folder("dist/cesium/Workers"), { recursive: true });
for (const name of ["approximateTerrainHeights.json", "IAU2006_XYS", "Images/ion-credit.png"]) cpSync(`${cesium}Source/Assets/${name}`, folder(`dist/cesium/Assets/${name}`), { recursive: true });
for (const name of ["index.html", "list.html", "globe.html", "style.css", "list.css", "globe.css"]) copyFileSync(folder(`page/${name}`), folder(`dist/${name}`));

if (process.argv[2] === "--package") {
    rmSync(folder("package"), { recursive: true, force: true });
    const server = await build({
        entryPoints: [folder("server.js")],
        bundle: true,
        platform: "node",
        format: "esm",
        target: "node18",
        outfile: folder("package/server.js"),
        external: ["pg-native"], // the driver does without
        banner: { js: 'import { createRequire } from "node:module"; const require = createRequire(import.meta.url);' }, // for the driver's own modules
        logLevel: "warning",
        metafile: true,
    });
    cpSync(folder("dist"), folder("package/dist"), { recursive: true });
    writeFileSync(folder("package/package.json"), '{ "type": "module" }\n');
    const names = new Set([page, server].flatMap(({ metafile }) => Object.keys(metafile.inputs)).map((path) => /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(path)?.[1]).filter(Boolean));
    writeFileSync(folder("package/LICENSES"), [...names, "maplibre-gl"].sort().map((name) => {
        const own = folder(`node_modules/${name}/`), { version, license } = JSON.parse(readFileSync(`${own}package.json`));
        const file = existsSync(own) && readdirSync(own).find((one) => /^licen[cs]e/i.test(one));
        return `${name} ${version} (${license})\n\n${file ? readFileSync(own + file, "utf8").trim() : "Its package has no text of its licence."}\n`;
    }).join(`\n${"-".repeat(78)}\n\n`));
}
