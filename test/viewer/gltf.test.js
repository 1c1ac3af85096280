// Surfaces as glTF: files of abacus-export, checked by Khronos' validator and read by three.js.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { packages, psql } from "./support.js";

const { validateBytes } = packages("gltf-validator");
let folder;
before(() => {
    folder = mkdtempSync(join(tmpdir(), "gltf-"));
    psql(`SET client_min_messages = warning; DROP TABLE IF EXISTS seam, summit CASCADE;
        SELECT abacus_triangulate('seam', 'SELECT row_number() OVER (), 500000 + 10 * x + sin(y * z), 5400000 + 10 * y + cos(x * z), -10 * z + sin(x + y), x + y / 10.0, CASE WHEN x > 1 THEN z END
            FROM generate_series(0, 8) AS x, generate_series(0, 7) AS y, generate_series(0, 6) AS z', '{grade,"Tonnage (t)"}', dimension => 3);
        SELECT abacus_label('seam', $$SELECT code, v0, v1, v2, v3, least(greatest(width_bucket((corners[1][3] + corners[2][3]) / 2, -60, 0, 3), 1), 3) AS unit FROM abacus_cells('seam')$$);
        SELECT abacus_triangulate('summit', 'SELECT 100 * x + y, 7 + x / 100.0, 46 + y / 100.0, 100 * sin(x / 3.0) + y FROM generate_series(0, 30) AS x, generate_series(0, 30) AS y', '{height}');
        SELECT abacus_set_srid('summit', 4326)`);
});
after(() => rmSync(folder, { recursive: true }));

async function exported(mesh, ...options) {
    const file = join(folder, "surface.glb");
    const { stderr } = await promisify(execFile)("/usr/bin/python3", ["client/abacus-export", mesh, file, ...options]);
    const bytes = readFileSync(file), { issues, info } = await validateBytes(new Uint8Array(bytes), { maxIssues: 20 });
    assert.deepEqual(issues.messages, [], `${mesh} ${options}`);
    return { bytes, info, stderr, json: JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12))) };
}

for (const [mesh, options, nodes, attributes] of [
    ["seam", ["--isosurface", "grade=3.3"], 1, ["POSITION", "NORMAL", "_GRADE"]],
    ["seam", ["--isosurface", "grade=3.3", "--isosurface", "grade=5", "--colour", "grade"], 2, ["POSITION", "NORMAL", "COLOR_0", "_GRADE"]],
    ["seam", ["--label", "unit=2", "--colour", "Tonnage (t)"], 1, ["POSITION", "NORMAL", "COLOR_0", "_GRADE"]],
    ["seam", ["--label", "unit"], 3, ["POSITION", "NORMAL", "_GRADE"]],
    ["seam", [], 1, ["POSITION", "NORMAL", "_GRADE"]],
    ["summit", ["--z", "height", "--colour", "height"], 1, ["POSITION", "NORMAL", "COLOR_0", "_HEIGHT"]],
])
    test(`${mesh} ${options.join(" ")} is glTF without an issue, and three.js reads it`, async () => {
        const { bytes, info, json, stderr } = await exported(mesh, ...options);
        assert.equal(json.meshes.length, nodes);
        for (const { primitives: [primitive] } of json.meshes) assert.deepEqual(Object.keys(primitive.attributes), attributes);
        assert.equal(json.asset.extras.origin.length, 3);
        if (mesh === "seam") assert.match(stderr, /attributes with a value that is missing or beyond floats \(Tonnage \(t\)\)/);
        const { GLTFLoader } = await import(packages.resolve("three/examples/jsm/loaders/GLTFLoader.js"));
        const { scene } = await new GLTFLoader().parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), "");
        let triangles = 0;
        scene.updateMatrixWorld(true);
        scene.traverse((object) => {
            if (!object.isMesh) return;
            triangles += object.geometry.index.count / 3;
            assert.ok(object.geometry.attributes._grade ?? object.geometry.attributes._height);
        });
        assert.equal(triangles, info.totalTriangleCount);
    });

test("up is up, and a place is the origin and the coordinates", async () => {
    const { bytes, json } = await exported("summit", "--z", "height"), { GLTFLoader } = await import(packages.resolve("three/examples/jsm/loaders/GLTFLoader.js"));
    const { scene } = await new GLTFLoader().parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), ""), [x, y, z] = json.asset.extras.origin;
    scene.updateMatrixWorld(true);
    scene.traverse((object) => {
        if (!object.isMesh) return;
        const { position, _height } = object.geometry.attributes, place = object.localToWorld(object.position.clone().set(position.getX(0), position.getY(0), position.getZ(0)));
        const [lon, lat, height] = [x + place.x, y - place.z, z + place.y];
        assert.ok(Math.abs(height - _height.getX(0)) < 1e-4);
        assert.ok(Math.abs(Number(psql(`SELECT abacus_interpolate('summit', ${lon}, ${lat}, 'height', 'nearest')`)) - height) < 1e-4);
    });
});
