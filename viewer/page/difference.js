// The difference of two meshes as tiles of a map: of each pixel the heights that both have there. Heights of tiles are exact to
// 1/256.
import * as maplibre from "maplibre-gl";
import { side } from "./border.js";
import { heightsAt } from "./heights.js";
import { drawPalette } from "./palette.js";

let settings = null, colours = null;

/** `addresses`: a function of z, x and y for each of the two; `most`: the difference that has the last colour. */
export function setDifference(given) { settings = given; }

function palette() {
    if (!colours) {
        const canvas = Object.assign(document.createElement("canvas"), { width: 256, height: 1 });
        drawPalette(canvas, "diverging");
        colours = new Uint32Array(canvas.getContext("2d").getImageData(0, 0, 256, 1).data.buffer);
    }
    return colours;
}

/** The first less the second, NaN where one of them has nothing. */
async function differences(z, x, y) {
    const [a, b] = await Promise.all(settings.addresses.map((address) => heightsAt(address(z, x, y))));
    return a.map((height, i) => height - b[i]);
}

maplibre.addProtocol("difference", async ({ url }) => {
    const found = await differences(...url.match(/\d+\/\d+\/\d+/)[0].split("/").map(Number));
    const pixels = new ImageData(side, side), colours = new Uint32Array(pixels.data.buffer), all = palette();
    found.forEach((difference, i) => { if (!Number.isNaN(difference)) colours[i] = all[Math.min(Math.max(Math.round(127.5 + (127.5 * difference) / settings.most), 0), 255)]; });
    return { data: await createImageBitmap(pixels) };
});

const usual = 0.99; // of the pixels; the few beyond, as at cliffs, have the last colour

/** The difference, up or down, that hardly any place exceeds within a box of the map, [left, top, right, bottom] from 0 to 1; 0 if there is none. */
export async function usualDifference([left, top, right, bottom]) {
    const zoom = Math.max(0, Math.min(22, Math.ceil(Math.log2(2 / Math.max(right - left, bottom - top, 1e-9))))), count = 2 ** zoom;
    const tile = (share) => Math.min(Math.max(Math.floor(share * count), 0), count - 1), found = [];
    for (let y = tile(top); y <= tile(bottom); ++y)
        for (let x = tile(left); x <= tile(right); ++x)
            for (const difference of await differences(zoom, x, y)) if (!Number.isNaN(difference)) found.push(Math.abs(difference));
    const sorted = Float32Array.from(found).sort(), most = sorted.at(-1) ?? 0;
    return sorted[Math.floor(usual * (sorted.length - 1))] || most;
}
