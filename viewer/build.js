// Puts together what the browser gets, in dist/: all of it from packages and this folder.
import { build } from "esbuild";
import { copyFileSync, mkdirSync, rmSync } from "node:fs";

const folder = (name) => new URL(name, import.meta.url).pathname;
const maplibre = folder("node_modules/maplibre-gl/dist/");

rmSync(folder("dist"), { recursive: true, force: true });
mkdirSync(folder("dist"));
await build({
    entryPoints: [folder("page/plane.js"), folder("page/space.js"), folder("page/list.js")],
    bundle: true,
    minify: true,
    format: "esm",
    target: "es2022",
    outdir: folder("dist"),
    alias: { "maplibre-gl": "./maplibre-gl.mjs" },
    external: ["./maplibre-gl.mjs"], // it loads a worker beside it
    loader: { ".svg": "text" },
    logLevel: "warning",
});
for (const name of ["maplibre-gl.mjs", "maplibre-gl-shared.mjs", "maplibre-gl-worker.mjs", "maplibre-gl.css"])
    copyFileSync(maplibre + name, folder(`dist/${name}`));
copyFileSync(folder("node_modules/uplot/dist/uPlot.min.css"), folder("dist/uplot.css"));
for (const name of ["index.html", "list.html", "style.css", "list.css"]) copyFileSync(folder(`page/${name}`), folder(`dist/${name}`));
