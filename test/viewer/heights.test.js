// Tiles of heights as MapLibre's own decoder reads them: at pixels, at seams, where there is no mesh, and beyond what the encoding holds.
import assert from "node:assert/strict";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { inflateSync } from "node:zlib";
import { connect, packages, psql } from "./support.js";

const size = 64, border = 2; // MapLibre keeps two pixels of neighbours
let client, DEMData, RGBAImage, notices = [];

before(async () => {
    const folder = join(dirname(packages.resolve("maplibre-gl/package.json")), "src"), { build } = packages("esbuild");
    const { outputFiles: [{ text }] } = await build({ bundle: true, write: false, format: "esm", platform: "node", logLevel: "error",
        stdin: { contents: `export { DEMData } from "${folder}/data/dem_data.ts"; export { RGBAImage } from "${folder}/util/image.ts";`, resolveDir: folder } });
    ({ DEMData, RGBAImage } = await import(`data:text/javascript;base64,${Buffer.from(text).toString("base64")}`));
    // A slope with a hole, over a map of its own that is 16 wide; and heights beyond the encoding
    psql(`SET client_min_messages = warning; DROP TABLE IF EXISTS ramp, abyss CASCADE;
        SELECT abacus_triangulate('ramp', 'SELECT 100 * x + y, x / 2.0, y / 2.0, CASE WHEN x BETWEEN 4 AND 6 AND y BETWEEN 4 AND 6 THEN NULL ELSE 100 * x + 40 * y END FROM generate_series(0, 20) AS x, generate_series(0, 20) AS y', '{height}');
        SELECT abacus_triangulate('abyss', 'SELECT 100 * x + y, x, y, CASE WHEN x < 8 THEN -50000 + 10 * y ELSE 50000 END FROM generate_series(0, 16) AS x, generate_series(0, 16) AS y', '{height}')`);
    client = await connect();
    client.on("notice", (notice) => notices.push(notice));
});
after(() => client?.end());

/** The pixels of a PNG of eight bits a channel without interlacing, as red, green, blue and alpha. */
function pixels(png) {
    const parts = [];
    let width, height, channels;
    for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at)) {
        const length = png.readUInt32BE(at), kind = png.toString("latin1", at + 4, at + 8), data = png.subarray(at + 8, at + 8 + length);
        if (kind === "IHDR") {
            [width, height] = [data.readUInt32BE(0), data.readUInt32BE(4)];
            channels = { 2: 3, 6: 4 }[data[9]];
            assert.deepEqual([data[8], data[12]], [8, 0]);
        }
        if (kind === "IDAT") parts.push(data);
    }
    const raw = inflateSync(Buffer.concat(parts)), stride = width * channels, found = new Uint8Array(4 * width * height), rows = new Uint8Array(stride * height);
    for (let y = 0; y < height; ++y)
        for (let i = 0; i < stride; ++i) {
            const left = i < channels ? 0 : rows[y * stride + i - channels], up = y === 0 ? 0 : rows[(y - 1) * stride + i], corner = y === 0 || i < channels ? 0 : rows[(y - 1) * stride + i - channels];
            const estimate = left + up - corner, [a, b, c] = [left, up, corner].map((x) => Math.abs(estimate - x)), paeth = a <= b && a <= c ? left : b <= c ? up : corner;
            rows[y * stride + i] = raw[y * (stride + 1) + 1 + i] + [0, left, up, (left + up) >> 1, paeth][raw[y * (stride + 1)]];
        }
    for (let i = 0; i < width * height; ++i) found.set(channels === 4 ? rows.subarray(4 * i, 4 * i + 4) : [...rows.subarray(3 * i, 3 * i + 3), 255], 4 * i);
    return { width, height, data: found, isOpaque: channels === 3 };
}

/** A tile as MapLibre has it in memory. */
async function read(mesh, z, x, y, more = "") {
    notices = [];
    const { rows: [{ tile }] } = await client.query(`SELECT abacus_tile_terrain($1, $2, $3, $4, world => '{0,0,16}', size => ${size}${more}) AS tile`, [mesh, z, x, y]);
    const { width, data, isOpaque } = pixels(tile), wide = width + 2 * border, padded = new Uint8Array(4 * wide * wide);
    for (let row = 0; row < width; ++row) padded.set(data.subarray(4 * row * width, 4 * (row + 1) * width), 4 * ((row + border) * wide + border));
    return { dem: new DEMData(`${z}/${x}/${y}`, new RGBAImage({ width: wide, height: wide }, padded), "terrarium"), isOpaque };
}

/** Where pixel (i, k) of a tile of zoom 2 is. */
const place = (x, y, i, k) => [(x + (i + 0.5) / size) * 4, 16 - (y + (k + 0.5) / size) * 4];
const slope = ([x, y]) => 200 * x + 80 * y;

test("a pixel is the height of the mesh at its centre, to 1/256", async () => {
    const { dem, isOpaque } = await read("ramp", 2, 1, 2);
    assert.ok(isOpaque);
    for (const [i, k] of [[0, 0], [63, 63], [17, 40], [0, 63]]) assert.ok(Math.abs(dem.get(i, k) - slope(place(1, 2, i, k))) <= 1 / 512 + 1e-9);
    const { rows: [{ value }] } = await client.query("SELECT abacus_interpolate('ramp', $1::float8, $2::float8) AS value", place(1, 2, 17, 40));
    assert.ok(Math.abs(dem.get(17, 40) - value) <= 1 / 512 + 1e-9);
});

test("with its neighbour a tile goes on across the seam: both sides are the same surface", async () => {
    const [{ dem: west }, { dem: east }] = [await read("ramp", 2, 0, 2), await read("ramp", 2, 1, 2)], alone = west.sampleBilinear(size - 0.5, 20);
    assert.ok(Math.abs(alone - slope(place(0, 2, size - 1, 20))) < 1 / 256); // the last pixel again: half of a pixel's slope too low
    west.backfillBorder(east, 1, 0);
    east.backfillBorder(west, -1, 0);
    for (const k of [0.5, 20, 33.25, 62]) {
        const [fromWest, fromEast] = [west.sampleBilinear(size - 0.5, k), east.sampleBilinear(-0.5, k)]; // MapLibre has the seam there
        assert.equal(fromWest, fromEast);
        assert.ok(Math.abs(fromWest - slope(place(1, 2, -0.5, k))) < 1 / 128);
    }
    const [{ dem: north }, { dem: south }] = [await read("ramp", 2, 1, 2), await read("ramp", 2, 1, 3)];
    north.backfillBorder(south, 0, 1);
    south.backfillBorder(north, 0, -1);
    assert.equal(north.sampleBilinear(30, size - 0.5), south.sampleBilinear(30, -0.5));
});

test("where there is no mesh, and where a value is missing, is fill", async () => {
    const [{ dem: zero }, { dem: filled }, { dem: none }] = [await read("ramp", 1, 0, 1), await read("ramp", 1, 0, 1, ", fill => 750"), await read("ramp", 1, 0, 1, ", fill => -32768")];
    const hole = [Math.floor((2.5 / 8) * size), Math.floor(((8 - 2.5) / 8) * size)];
    assert.deepEqual([zero, filled, none].map((dem) => dem.get(...hole)), [0, 750, -32768]);
    assert.deepEqual([none.min, zero.min], [-32768, 0]); // a height like others
    assert.ok(Math.abs(none.get(60, 60) - zero.get(60, 60)) === 0);
    const { dem: beyond } = await read("ramp", 2, 3, 0, ", fill => 1");
    assert.deepEqual([beyond.min, beyond.max], [1, 1]);
    assert.deepEqual(notices, []);
});

test("heights beyond the encoding are its ends, not others, and are said", async () => {
    const { dem } = await read("abyss", 0, 0, 0);
    assert.deepEqual([dem.min, dem.max], [-32768, 32768 - 1 / 256]);
    assert.deepEqual([dem.get(4, 32), dem.get(60, 32)], [-32768, 32768 - 1 / 256]);
    const between = dem.get(30, 32); // on the cliff, between 7 and 8
    assert.ok(between > -32768 && between < 32767);
    assert.equal(notices.length, 1);
    const count = Number(/^(\d+) heights of the tile are beyond the range of its encoding$/.exec(notices[0].message)[1]);
    assert.ok(count > 0.8 * size * size && count < size * size);
    assert.match(notices[0].hint, /whose unit is larger/);
    await read("abyss", 2, 1, 1, ", fill => 40000");
    assert.equal(notices.length, 1);
});
