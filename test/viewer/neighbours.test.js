// A place of a mesh as the viewer's server reports it: the mesh's own neighbours, even at faults and with equal ids,
// and only the values that a mesh has.
import assert from "node:assert/strict";
import { test } from "node:test";
import { connect, psql, serve } from "./support.js";

/** Meshes made elsewhere: none is Delaunay, and at faults vertices of two ids are at one place. */
const loaded = {
    fault: `abacus_load('fault', 'VALUES (1, 0, 0, 0), (2, 2, 0, 0), (4, 0, 2, 0), (5, 2, 2, 0), (12, 2, 0, 1), (3, 4, 0, 1), (6, 4, 2, 1), (15, 2, 2, 1)',
        'VALUES (1, 2, 5), (1, 5, 4), (12, 3, 6), (12, 6, 15)', attributes => '{slip}', split_nodes => true)`,
    tip: `abacus_load('tip', 'VALUES (1, 0, 0, 0), (2, 2, 0, 0), (4, 0, 2, 0), (5, 2, 2, 0), (12, 2, 0, 1), (3, 4, 0, 1), (6, 4, 2, 1)',
        'VALUES (1, 2, 5), (1, 5, 4), (12, 3, 6), (12, 6, 5)', attributes => '{slip}', split_nodes => true)`, // a fault that ends at 5
    flipped: `abacus_load('flipped', 'VALUES (1, 0, 0, 5), (2, 4, 0, 6), (3, 8, 1, 7), (4, 4, 2, 8)', 'VALUES (1, 2, 3), (1, 3, 4)', attributes => '{z}')`,
    block: `abacus_load('block', 'VALUES (1, -1, 0, 0, 5), (2, 0, 0, 0, 6), (3, 0, 1, 0, 7), (4, 0, 0, 1, 8), (5, 1, 0, 0, 9), (6, 1, 1, 1, 10), (12, 0, 0, 0, 11), (13, 0, 1, 0, 12), (14, 0, 0, 1, 13)',
        'VALUES (1, 2, 3, 4), (12, 13, 14, 5), (13, 14, 5, 6)', attributes => '{vs}', split_nodes => true)`,
};

/** The simplices of a mesh, each with its centre, its neighbours by the mesh's own links, and its values, as SQL has them. */
const simplices = (name, dimension) => `
    WITH cell AS (SELECT code, v0, v1, v2, v3, ARRAY(SELECT avg(corners[i][k]) FROM generate_series(1, ${dimension + 1}) AS i, generate_series(1, ${dimension}) AS k GROUP BY k ORDER BY k) AS place FROM abacus_cells('${name}'))
    SELECT ARRAY[v0, v1, v2, v3]::text[] AS ids, place,
           ARRAY(SELECT concat_ws(' ', n.v0, n.v1, n.v2, n.v3) FROM generate_series(0, ${dimension}) AS facet, abacus_walk('${name}', (code, v0, v1, v2, v3), facet) AS n ORDER BY facet) AS neighbours,
           (SELECT jsonb_object_agg(method, abacus_interpolate('${name}', ${Array.from({ length: dimension }, (_, i) => `place[${i + 1}]`)}, method => method)) FROM unnest(ARRAY['linear', 'nearest']) AS method) AS values
    FROM cell`;

test("a loaded mesh that is not Delaunay is asked for all but natural neighbours", async (t) => {
    const client = await connect();
    t.after(() => client.end());
    for (const [name, load] of Object.entries(loaded)) {
        psql(`SET client_min_messages = error; SELECT ${load}`);
        const server = await serve(name), { body: { dimension } } = await server.get("/api/info");
        try {
            for (const { ids, place, neighbours, values } of (await client.query(simplices(name, dimension))).rows) {
                const { status, body } = await server.get(`/api/locate?${place.map((x, i) => `${"xyz"[i]}=${x}`).join("&")}`);
                assert.equal(status, 200);
                assert.deepEqual(body.simplex.ids, ids.slice(0, dimension + 1));
                assert.deepEqual(body.values, values);
                assert.deepEqual(body.neighbours.map((one) => one?.ids.join(" ") ?? ""), neighbours);
                for (const one of body.neighbours) if (one) assert.equal(one.corners.length, dimension + 1);
            }
            const paths = dimension === 2 ? ["/api/profile?path=0.5,0.1,3,0.4", "/api/sight?from=0.5,0.1&to=3,0.4", "/api/star?x=2&y=0", ...["picture", "vector", "terrain"].map((kind) => `/tiles/${kind}/10/512/511?contours=0.5`)]
                : ["/api/section?through=0,0.1,0.1&normal=0,0,1", "/api/isosurface?value=9", "/api/ray?origin=-2,0.1,0.1&direction=1,0,0", "/api/hull", "/api/star?x=0&y=0&z=0"];
            for (const path of paths) assert.equal((await fetch(server.origin + path)).status, 200, `${name} ${path}`);
        } finally {
            await server.stop();
            psql(`DROP TABLE ${name} CASCADE`);
        }
    }
});

test("neighbours of points whose ids are equal are those across the facets", async () => {
    psql("SET client_min_messages = warning; SELECT abacus_triangulate('alike', 'SELECT 0, x * x, y * y + x FROM generate_series(0, 4) AS x, generate_series(0, 4) AS y')");
    const server = await serve("alike");
    try {
        let sides = 0;
        const places = psql("SELECT avg(corners[i][1]), avg(corners[i][2]) FROM abacus_cells('alike') WITH ORDINALITY AS c (code, v0, v1, v2, v3, corners, v, l, n), generate_series(1, 3) AS i GROUP BY n").split("\n");
        for (const [x, y] of places.map((line) => line.split("|"))) {
            const { body: { simplex, neighbours } } = await server.get(`/api/locate?x=${x}&y=${y}`);
            neighbours.forEach((one, facet) => {
                if (!one) return;
                ++sides;
                const common = simplex.corners.filter((corner) => one.corners.some((other) => String(other) === String(corner)));
                assert.deepEqual(common, simplex.corners.filter((_, i) => i !== facet));
            });
        }
        assert.equal(sides, 3 * places.length - Number(psql("SELECT value FROM abacus_stats('alike') WHERE name = 'hull_facets'")));
    } finally {
        await server.stop();
        psql("DROP TABLE alike CASCADE");
    }
});
