// Heights of the mesh for relief and terrain. The server's tiles say where there is no mesh; there the page puts the height
// of the nearest place of the border, so that the ground goes on evenly and has neither a wall nor steps at seams.
import * as maplibre from "maplibre-gl";
import { filled, segments, side } from "./border.js";
import { sessionHeaders } from "./requests.js";

const noData = 0; // what the server writes for -32768
export const least = -32768, greatest = 32768 - 1 / 256;
const kept = 96; // tiles

const cache = new Map(); // by address: a promise of Float32Array with NaN outside the mesh
let settings = { address: () => "", border: null, range: [0, 1] };

/** `address(z, x, y)` of a tile; `border`: rings of [x, y, height] on the map, which is 1 wide; `range`: of the heights. */
export function setHeights({ border, ...given }) {
    settings = { ...given, border: border && segments(border) };
}

async function load(address) {
    const response = await fetch(address, { headers: sessionHeaders() });
    if (!response.ok) throw Object.assign(new Error((await response.json().catch(() => ({}))).error ?? "A tile could not be loaded."), { status: response.status });
    const bitmap = await createImageBitmap(await response.blob(), { colorSpaceConversion: "none", premultiplyAlpha: "none" });
    const context = new OffscreenCanvas(side, side).getContext("2d", { willReadFrequently: true });
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, side, side), heights = new Float32Array(side * side);
    for (let i = 0; i < heights.length; ++i) {
        const steps = 65536 * data[4 * i] + 256 * data[4 * i + 1] + data[4 * i + 2];
        heights[i] = steps === noData ? NaN : steps / 256 + least;
    }
    return heights;
}

/** Heights of a tile, NaN outside the mesh. */
const heightsOf = (z, x, y) => heightsAt(settings.address(z, x, y));

/** The same of a tile at an address. */
export function heightsAt(address) {
    let tile = cache.get(address);
    if (!tile) {
        tile = load(address);
        tile.catch(() => cache.delete(address));
    }
    cache.delete(address);
    cache.set(address, tile);
    if (cache.size > kept) cache.delete(cache.keys().next().value);
    return tile;
}

/** How a source of MapLibre reads the pixels that encode() writes: 2^24 steps over the range of heights. */
export function encoding([low, high], scale) {
    const step = ((high - low || 1) * scale) / 0xffffff;
    return { encoding: "custom", redFactor: 65536 * step, greenFactor: 256 * step, blueFactor: step, baseShift: -low * scale };
}
function encode(heights, [low, high]) {
    const pixels = new ImageData(side, side), colours = new Uint32Array(pixels.data.buffer), factor = 0xffffff / (high - low || 1);
    for (let i = 0; i < heights.length; ++i) {
        const steps = Math.round(Math.min(Math.max((heights[i] - low) * factor || 0, 0), 0xffffff));
        colours[i] = 0xff000000 | ((steps & 255) << 16) | (steps & 0xff00) | (steps >> 16); // bytes red, green, blue, alpha
    }
    return createImageBitmap(pixels, { colorSpaceConversion: "none", premultiplyAlpha: "none" });
}

maplibre.addProtocol("heights", async ({ url }) => {
    const [z, x, y] = url.match(/\d+\/\d+\/\d+/)[0].split("/").map(Number);
    const { border, range } = settings;
    return { data: await encode(filled(await heightsOf(z, x, y), z, x, y, border), range) };
});

/** Least and greatest height within a box of the map, [left, top, right, bottom] from 0 to 1; null if it has none. */
export async function rangeWithin([left, top, right, bottom], greatestZoom) {
    const zoom = Math.max(0, Math.min(greatestZoom, Math.ceil(Math.log2(2 / Math.max(right - left, bottom - top)))));
    const count = 2 ** zoom, tile = (share) => Math.min(Math.max(Math.floor(share * count), 0), count - 1);
    let low = Infinity, high = -Infinity;
    for (let y = tile(top); y <= tile(bottom); ++y)
        for (let x = tile(left); x <= tile(right); ++x)
            (await heightsOf(zoom, x, y)).forEach((height, i) => {
                const across = (x + ((i % side) + 0.5) / side) / count, down = (y + (Math.floor(i / side) + 0.5) / side) / count;
                if (height === height && across >= left && across <= right && down >= top && down <= bottom) [low, high] = [Math.min(low, height), Math.max(high, height)];
            });
    return low <= high ? [low, high] : null;
}
