// Terrain on a globe: what the server hands out as Cesium's own parser reads it, and the page in a headless browser.
import assert from "node:assert/strict";
import { test } from "node:test";
import { page, pictures, servers, setUp } from "./browser.js";
import { eventually, packages, psql, serve } from "./support.js";

setUp(async () => {
    psql(`SET client_min_messages = warning; DROP TABLE IF EXISTS valley, seaside CASCADE;
        SELECT abacus_triangulate('valley', 'SELECT 1000 * i + j AS id, 7 + i / 200.0 + sin(i * 3 + j) / 900 AS lon, 46 + j / 200.0 + cos(i + 5 * j) / 900 AS lat, 1500 + 900 * sin(i / 9.0) * cos(j / 11.0) AS height
              FROM generate_series(0, 79) AS i, generate_series(0, 79) AS j'); SELECT abacus_set_srid('valley', 4326);
        SELECT abacus_triangulate('seaside', 'SELECT 1000 * i + j AS id, 779000 + 500 * i AS x, 5780000 + 500 * j AS y, i + j AS height FROM generate_series(0, 40) AS i, generate_series(0, 40) AS j'); SELECT abacus_set_srid('seaside', 3857)`);
    return { valley: await serve("valley"), seaside: await serve("seaside"), all: await serve(undefined) };
});

const read = (bytes) => packages("@here/quantized-mesh-decoder").default(new Uint8Array(bytes).buffer);
const inside = { valley: [[0, 1, 0], [10, 1064, 774]], seaside: [[0, 0, 0], [10, 532, 659]] };

test("layer.json names the tiles, and each is that of SQL", async () => {
    const { body } = await servers.valley.get("/globe/layer.json"), [west, south, east, north] = body.bounds;
    assert.deepEqual([body.projection, body.scheme, body.format, body.maxzoom], ["EPSG:4326", "tms", "quantized-mesh-1.0", body.available.length - 1]);
    assert.ok(west < 7.01 && south < 46.01 && east > 7.39 && north > 46.39);
    assert.deepEqual(body.available[10], [{ startX: 0, startY: 0, endX: 2047, endY: 1023 }]);
    const url = `${servers.valley.origin}/globe/10/1064/774.terrain?attribute=height`, response = await fetch(url);
    assert.equal(response.headers.get("content-type"), "application/vnd.quantized-mesh");
    assert.equal(Buffer.from(await response.arrayBuffer()).toString("hex"), psql("SELECT encode(abacus_tile_mesh('valley', 10, 1064, 774), 'hex')"));
    assert.equal((await fetch(url, { headers: { "If-None-Match": response.headers.get("etag") } })).status, 304);
    const beside = read(await (await fetch(`${servers.valley.origin}/globe/10/0/0.terrain`)).arrayBuffer()); // nothing to see
    assert.deepEqual([[...beside.triangleIndices], beside.extensions.vertexNormals.length], [[0, 0, 0], 6]);
    for (const path of ["/globe/10/4096/0.terrain", "/globe/10/0/99999999999.terrain", "/globe/10/0/0.terrain?attribute=depth"]) assert.equal((await servers.valley.get(path)).status, 400, path);
    for (const path of ["/globe/x/0/0.terrain", "/globe/other", "/assets/cesium/Workers/..%2f..%2fserver.js"]) assert.equal((await servers.valley.get(path)).status, 404, path);
    for (const name of ["terrain", "globe", "rock"]) assert.equal((await servers[name].get("/globe/layer.json")).status, 404, name); // no place, no heights, not in the plane
    assert.equal((await servers.all.get("/mesh/public/valley/globe/layer.json")).status, 200);
});

test("tiles come from levels of detail whose error is half a pixel of Cesium's, the same for all tiles of a zoom", async () => {
    psql("SELECT abacus_levels('seaside', '{0.5,20}')");
    try {
        const { body: info } = await servers.seaside.get("/api/info"), { EllipsoidTerrainProvider, WebMercatorTilingScheme } = await import(packages.resolve("@cesium/engine"));
        assert.equal(info.levels, "height");
        for (const [z, x, y] of [[4, 8, 10], [10, 532, 659], [12, 2128, 2639]]) {
            const ofCesium = new EllipsoidTerrainProvider({ tilingScheme: new WebMercatorTilingScheme() }).getLevelMaximumGeometricError(z);
            const bytes = Buffer.from(await (await fetch(`${servers.seaside.origin}/globe/${z}/${x}/${y}.terrain`)).arrayBuffer()).toString("hex");
            assert.equal(bytes, psql(`SELECT encode(abacus_tile_mesh('seaside', ${z}, ${x}, ${y}, max_error => ${ofCesium / 4}), 'hex')`), `${z}/${x}/${y}`);
        }
    } finally {
        psql("SELECT abacus_levels_drop('seaside')");
    }
});

test("Cesium's own parser reads what was written", async () => {
    const { CesiumTerrainProvider } = await import(packages.resolve("@cesium/engine"));
    for (const [name, z, x, y] of Object.entries(inside).flatMap(([name, tiles]) => tiles.map((tile) => [name, ...tile]))) {
        const provider = await CesiumTerrainProvider.fromUrl(`${servers[name].origin}/globe/`, { requestVertexNormals: true });
        assert.ok(provider.hasVertexNormals && provider.getTileDataAvailable(x, provider.tilingScheme.getNumberOfYTilesAtLevel(z) - 1 - y, z));
        const data = await provider.requestTileGeometry(x, provider.tilingScheme.getNumberOfYTilesAtLevel(z) - 1 - y, z);
        const { header, vertexData, triangleIndices, eastIndices } = read(await (await fetch(`${servers[name].origin}/globe/${z}/${x}/${y}.terrain`)).arrayBuffer());
        assert.ok(triangleIndices.length > 100);
        assert.deepEqual([...data._quantizedVertices], [...vertexData]);
        assert.deepEqual([...data._indices], [...triangleIndices]);
        assert.deepEqual([data._minimumHeight, data._maximumHeight, data._boundingSphere.radius], [header.minHeight, header.maxHeight, header.boundingSphereRadius]);
        assert.equal(data._eastIndices.length, eastIndices.length);
        assert.equal(data._encodedNormals.length, (2 * vertexData.length) / 3);
    }
});

for (const [name, lon, lat, expected] of [["valley", 7.2, 46.2, "abacus_interpolate('valley', 7.2, 46.2)"], ["seaside", 7.0738, 46.0537, "abacus_interpolate('seaside', 787451.8, 5788567)"]])
    test(`the page shows the terrain of ${name}, and its heights are those of the mesh`, async () => {
        await page.goto(servers[name].origin);
        await page.locator("#globe").click();
        await page.waitForSelector("#view[data-ready=true]");
        await page.screenshot({ path: `${pictures}/viewer_globe_${name}.jpg`, quality: 75 });
        // Near to the ground tiles come that are as fine as the mesh.
        const height = () => page.evaluate(([lon, lat]) => {
            const { widget, Cartographic, Cartesian3 } = window.globe;
            widget.camera.setView({ destination: Cartesian3.fromDegrees(lon, lat, 4000) });
            widget.scene.requestRender();
            return widget.scene.globe.getHeight(Cartographic.fromDegrees(lon, lat)) ?? null;
        }, [lon, lat]);
        const wanted = Number(psql(`SELECT ${expected}`));
        await eventually(async () => { const found = await height(); return found !== null && Math.abs(found - wanted) < 3; }, `the height ${wanted}`, 120_000);
    });
