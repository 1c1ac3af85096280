// Tiles of terrain as triangles, read back by other programs: HERE's decoder, Cesium's provider of terrain, and Khronos' validator of glTF.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { connect, packages, psql } from "./support.js";

const decode = packages("@here/quantized-mesh-decoder").default, { validateBytes } = packages("gltf-validator");
const last = 32767;

let client;
before(async () => {
    // Some triangles everywhere, many in one place, and very many across one border of tiles of zoom 8
    psql(`SET client_min_messages = warning; DROP TABLE IF EXISTS alps, flats CASCADE;
        CREATE TEMPORARY TABLE places AS
            SELECT 7 + i / 30.0 + sin(i * 3 + j) / 90 AS lon, 45 + j / 30.0 + cos(i + 5 * j) / 90 AS lat FROM generate_series(0, 100) AS i, generate_series(0, 70) AS j
            UNION ALL SELECT 9.3 + i * 0.0008 + sin(i * 7 + j) / 9000, 45.3 + j * 0.0008 + cos(i + j * 3) / 9000 FROM generate_series(0, 99) AS i, generate_series(0, 99) AS j
            UNION ALL SELECT 7.734375 + side * 0.001, 45.05 + i * 0.0001 FROM generate_series(0, 2999) AS i, (VALUES (-1), (1)) AS s (side);
        SELECT abacus_triangulate('alps', 'SELECT row_number() OVER (ORDER BY lon, lat), lon, lat, 1500 + 900 * sin(lon * 9) * cos(lat * 7) + 20 * sin(lon * 900) FROM places', attributes => '{height}');
        SELECT abacus_set_srid('alps', 4326);
        SELECT abacus_triangulate('flats', 'SELECT row_number() OVER (ORDER BY lon, lat), lon * 111319.49, lat * 140000, -4.25 + sin(lon * 9) FROM places', attributes => '{height}');
        SELECT abacus_set_srid('flats', 3857)`);
    client = await connect();
});
after(() => client?.end());

/** A tile, or null. */
async function read(mesh, z, x, y, more = "") {
    const { rows: [{ tile }] } = await client.query(`SELECT abacus_tile_mesh($1, $2, $3, $4${more}) AS tile`, [mesh, z, x, y]);
    return tile;
}

/** What HERE's decoder reads of a tile; null if there is none. */
async function surface(mesh, z, x, y) {
    const tile = await read(mesh, z, x, y);
    if (!tile) return null;
    const bytes = new Uint8Array(tile), { header, vertexData, triangleIndices, extensions, ...borders } = decode(bytes.buffer);
    const count = vertexData.length / 3, part = (n) => vertexData.subarray(n * count, (n + 1) * count), [u, v, h] = [0, 1, 2].map(part);
    return { header, count, u, v, h, triangles: triangleIndices, normals: extensions.vertexNormals, ...borders, step: (header.maxHeight - header.minHeight) / last,
        height: (i) => header.minHeight + (h[i] * (header.maxHeight - header.minHeight)) / last };
}

/** The tiles of a zoom around the mesh, by "x,y". */
async function level(mesh, z, [west, south, east, north], side, left, bottom) {
    const tiles = new Map();
    for (let x = Math.floor((west - left) / side); x <= Math.floor((east - left) / side); ++x)
        for (let y = Math.floor((south - bottom) / side); y <= Math.floor((north - bottom) / side); ++y) tiles.set(`${x},${y}`, await surface(mesh, z, x, y));
    return tiles;
}

/** The least and the greatest height at each place along a border. */
function profile(tile, indices, along) {
    const found = new Map();
    for (const i of indices) {
        const [least, greatest] = found.get(along[i]) ?? [Infinity, -Infinity], height = tile.height(i);
        found.set(along[i], [Math.min(least, height), Math.max(greatest, height)]);
    }
    return new Map([...found].sort(([a], [b]) => a - b));
}

function compareSeam(a, ofA, alongA, b, ofB, alongB, where) {
    const [one, other] = [profile(a, ofA, alongA), profile(b, ofB, alongB)];
    assert.deepEqual([...one.keys()], [...other.keys()], `places along the border ${where}`);
    for (const [at, heights] of one)
        heights.forEach((height, i) => assert.ok(Math.abs(height - other.get(at)[i]) <= a.step + b.step, `heights at ${at} of the border ${where}`));
    return one.size;
}

/** Twice the area of all triangles, in steps; what is folded counts less. */
function area({ u, v, triangles }) {
    let sum = 0;
    for (let i = 0; i < triangles.length; i += 3) {
        const [a, b, c] = triangles.subarray(i, i + 3);
        sum += (u[b] - u[a]) * (v[c] - v[a]) - (u[c] - u[a]) * (v[b] - v[a]);
    }
    return sum;
}

async function walk(mesh, zooms, extent, sideOf, left, bottom, inside) {
    let seams = 0, compared = 0, whole = 0;
    for (const z of zooms) {
        const tiles = await level(mesh, z, extent, sideOf(z), left, bottom);
        for (const [name, tile] of tiles) {
            if (!tile) continue;
            const [x, y] = name.split(",").map(Number), east = tiles.get(`${x + 1},${y}`), north = tiles.get(`${x},${y + 1}`);
            const edges = [tile.westIndices, tile.southIndices, tile.eastIndices, tile.northIndices];
            assert.ok(tile.count + 2 * edges.reduce((sum, { length }) => sum + length, 0) < 65536);
            assert.equal(tile.normals.length, 2 * tile.count);
            assert.ok(tile.triangles.every((i) => i < tile.count));
            for (const [edge, along, across, at] of [[edges[0], tile.v, tile.u, 0], [edges[1], tile.u, tile.v, 0], [edges[2], tile.v, tile.u, last], [edges[3], tile.u, tile.v, last]]) {
                assert.deepEqual([...edge].sort((a, b) => a - b), [...across.keys()].filter((i) => across[i] === at), `all vertices of a border of ${z}/${name}`);
                assert.ok(edge.every((i, n) => n === 0 || along[edge[n - 1]] <= along[i]), "vertices of a border are in order");
            }
            // What a tile inside the mesh has covers all of it, and nothing twice.
            const [west, south] = [left + x * sideOf(z), bottom + y * sideOf(z)];
            if (west > inside[0] && south > inside[1] && west + sideOf(z) < inside[2] && south + sideOf(z) < inside[3]) {
                assert.equal(area(tile), 2 * last * last, `the area of ${z}/${name}`);
                ++whole;
            }
            if (east) compared += compareSeam(tile, edges[2], tile.v, east, east.westIndices, east.v, `east of ${z}/${name}`), ++seams;
            if (north) compared += compareSeam(tile, edges[3], tile.u, north, north.southIndices, north.u, `north of ${z}/${name}`), ++seams;
        }
    }
    return { seams, compared, whole };
}

test("all borders of a pyramid fit, and no tile has a gap", async () => {
    const found = await walk("alps", [0, 3, 6, 7, 8, 9, 10], [6.9, 44.9, 10.5, 47.5], (z) => 180 / 2 ** z, -180, -90, [7.1, 45.1, 10.2, 47.2]);
    assert.ok(found.seams > 300 && found.compared > 5000 && found.whole > 100, JSON.stringify(found));
});

test("the same in Web Mercator", async () => {
    const side = 2 * 20037508.342789244, found = await walk("flats", [0, 7, 8, 9], [760000, 6270000, 1180000, 6650000], (z) => side / 2 ** z, -side / 2, -side / 2, [800000, 6330000, 1130000, 6600000]);
    assert.ok(found.seams > 60 && found.compared > 1500 && found.whole > 8, JSON.stringify(found));
});

test("heights and places are those of the mesh", async () => {
    const [z, x, y] = [9, 533, 384], side = 180 / 2 ** z, tile = await surface("alps", z, x, y), places = [...tile.u.keys()].filter((i) => i % 97 === 0);
    const { rows } = await client.query("SELECT abacus_interpolate('alps', lon, lat) AS height FROM unnest($1::float8[], $2::float8[]) WITH ORDINALITY AS p (lon, lat, n) ORDER BY n",
        [places.map((i) => -180 + side * (x + tile.u[i] / last)), places.map((i) => -90 + side * (y + tile.v[i] / last))]);
    assert.ok(rows.length > 5);
    rows.forEach(({ height }, i) => assert.ok(Math.abs(height - tile.height(places[i])) < tile.step + 1, `${height} and ${tile.height(places[i])}`));
});

test("glTF is valid, and begins at the centre that it names", async () => {
    for (const [mesh, z, x, y, more] of [["alps", 9, 533, 384, ""], ["alps", 0, 1, 0, ""], ["flats", 8, 133, 169, ""], ["flats", 0, 0, 0, ", world => '{700000,6200000,600000}'"]]) {
        const tile = await read(mesh, z, x, y, `, format => 'glb'${more}`), { issues, info } = await validateBytes(new Uint8Array(tile));
        assert.deepEqual(issues.messages, [], `${mesh} ${z}/${x}/${y}`);
        assert.ok(info.totalTriangleCount > 500);
        const { asset: { extras }, accessors } = JSON.parse(tile.subarray(20, 20 + tile.readUInt32LE(12)));
        assert.equal(Boolean(extras.ecef), !more);
        assert.equal(extras.centre.length, 3);
        if (z > 0 || more) assert.ok(accessors[1].min[2] <= 0 && accessors[1].max[2] >= 0); // the globe falls away from a centre that is far
    }
});
