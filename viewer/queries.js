// All SQL of the viewer. Every value is a parameter, and so is the mesh: $1 is its oid. Where
// Abacus takes a query as a text, PostgreSQL makes it, of parameters that have a type.

const corners = `code, v0, v1, v2, v3, corners, "values"`;
const vertices = (row) => `ARRAY[${row}.v0, ${row}.v1, ${row}.v2, ${row}.v3]`;
const point = (from, dimension) =>
    Array.from({ length: dimension }, (_, i) => `$${from + i}::float8`);

/** Rows of one point for a query as a text: an id, coordinates, and values if there are any. */
function row(id, at, values) {
    const lists = ["%s", ...at.map(() => "%L::float8")];
    return `format('SELECT ${lists.join(", ")}', ${id}::bigint, ${at.join(", ")})` +
        (values ? ` || (SELECT coalesce(string_agg(format(', %L::float8', v), '' ORDER BY n), '') FROM unnest(${values}) WITH ORDINALITY AS u (v, n))` : "");
}

const info = `
    SELECT $1::oid::regclass::text AS name, abacus_srid($1::oid::regclass) AS srid, abacus_labels($1::oid::regclass) AS labels,
           (SELECT jsonb_object_agg(name, value) FROM abacus_stats($1::oid::regclass)
            WHERE name IN ('dimension', 'vertices', 'simplices', 'delaunay', 'changeable')) AS stats,
           (SELECT coalesce(jsonb_agg(jsonb_build_object('name', name, 'least', least, 'greatest', greatest) ORDER BY position), '[]')
            FROM abacus_attributes($1::oid::regclass)) AS attributes,
           (SELECT jsonb_build_array(min(x), min(y), min(z), max(x), max(y), max(z)) FROM abacus_hull($1::oid::regclass)) AS extent`;

/** The simplex at a place, with the facet -1, and those across its facets. Their vertices tell which these are, by
    id and place: places alone are the same on both sides of a fault, and ids alone need not be unique. Each facet
    has one of any two vertices, so all neighbours are around the first two. */
const located = (dimension) => {
    const at = point(2, dimension), count = dimension + 1;
    return `
    WITH found AS MATERIALIZED (SELECT (s).* FROM abacus_locate($1::oid::regclass, ${at}) AS s WHERE (s).code IS NOT NULL),
         cell AS MATERIALIZED (
            SELECT c.* FROM found AS f, abacus_cells($1::oid::regclass, ARRAY[${at}], ARRAY[${at}]) AS c
            WHERE c.code = f.code AND ${vertices("c")} = ${vertices("f")} LIMIT 1)
    SELECT -1 AS facet, ${corners} FROM cell
    UNION ALL
    (SELECT DISTINCT ON (facet) facet, o.code, o.v0, o.v1, o.v2, o.v3, o.corners, o."values"
     FROM cell AS c, generate_series(1, 2) AS k, LATERAL (SELECT ARRAY(SELECT unnest(c.corners[k:k])) AS at) AS corner,
          LATERAL abacus_cells($1::oid::regclass, corner.at, corner.at) AS o,
          LATERAL (SELECT count(*) AS shared, (${count * (count + 1) / 2} - sum(i) - 1)::integer AS facet
                   FROM generate_series(1, ${count}) AS i, generate_series(1, ${count}) AS j
                   WHERE (${vertices("c")})[i] = (${vertices("o")})[j] AND c.corners[i:i] = o.corners[j:j]) AS common
     WHERE shared = ${dimension} ORDER BY facet)`;
};

/** Values by all methods; natural neighbours where the mesh is Delaunay, as they are in no other. */
const values = (dimension) => `
    SELECT method, abacus_interpolate($1::oid::regclass, ${point(2, dimension)}, $${2 + dimension}::text, method) AS value
    FROM unnest(ARRAY['linear', 'natural', 'nearest']) AS method WHERE method <> 'natural' OR $${3 + dimension}`;

/** What the list of meshes is made of. A mesh is a table whose third column is of pages; tables that belong to a mesh begin
    with another column than `code`. When a table was written last only some roles may know. */
const meshTables = `
    FROM pg_class AS c JOIN pg_namespace AS n ON n.oid = c.relnamespace
    WHERE c.relkind = 'r' AND c.relpersistence <> 't' AND has_table_privilege(c.oid, 'SELECT') AND has_schema_privilege(n.oid, 'USAGE')
      AND EXISTS (SELECT FROM pg_attribute WHERE attrelid = c.oid AND attnum = 1 AND attname = 'code' AND NOT attisdropped)
      AND EXISTS (SELECT FROM pg_attribute WHERE attrelid = c.oid AND attnum = 3 AND atttypid = 'abacus_page'::regtype AND NOT attisdropped)`;
export const catalogue = {
    stats: "SELECT name, value FROM abacus_stats($1::oid::regclass) WHERE name IN ('dimension', 'leaves')",
    brief: `
        SELECT abacus_srid($1::oid::regclass) AS srid,
               (SELECT jsonb_object_agg(name, value) FROM abacus_stats($1::oid::regclass) WHERE name IN ('vertices', 'simplices', 'leaves')) AS stats`,
    mesh: `SELECT c.oid ${meshTables} AND n.nspname = $1::text AND c.relname = $2::text`,
    maySeeFiles: "SELECT has_function_privilege('pg_stat_file(text, boolean)', 'EXECUTE') AS may",
    written: "SELECT oid, (pg_stat_file(pg_relation_filepath(oid), true)).modification AS changed FROM unnest($1::oid[]) AS u (oid)",
    meshes: `
        SELECT c.oid, n.nspname AS schema, c.relname AS name,
               (SELECT sum(pg_total_relation_size(other.oid)) FROM pg_class AS other
                WHERE other.relnamespace = c.relnamespace AND other.relkind = 'r' AND other.relname IN (c.relname, c.relname || '_vertices', c.relname || '_lines')) AS bytes
        ${meshTables} ORDER BY n.nspname <> 'public', n.nspname, c.relname`,
};

/** Pictures of meshes in space, of octrees and of quadtrees: nothing is behind the mesh. */
const sectionPicture = `SELECT abacus_draw_section($1::oid::regclass, $2::float8[], $3::float8[], $4, $5, attribute => $6, edges => $7, lower => $8::float8[], upper => $9::float8[],
    exaggeration => $10, range => $11::float8[], ramp => $12, transparent => true) AS picture`;
const wholePicture = `SELECT abacus_draw($1::oid::regclass, $2, $3, attribute => $4, edges => $5, lower => $6::float8[], upper => $7::float8[], range => $8::float8[], ramp => $9, transparent => true) AS picture`;

export const plane = {
    info,
    etag: "SELECT abacus_tile_etag($1::oid::regclass) AS etag",
    located: located(2),
    cells: `SELECT ${corners} FROM abacus_cells($1::oid::regclass, ARRAY[$2, $3]::float8[], ARRAY[$2, $3]::float8[])`,
    /** The same with the region at the place. */
    cellsOfRegions: `SELECT ${corners}, abacus_region_at($1::oid::regclass, $2::float8, $3::float8) AS region
        FROM abacus_cells($1::oid::regclass, ARRAY[$2, $3]::float8[], ARRAY[$2, $3]::float8[])`,
    region: "SELECT abacus_region_at($1::oid::regclass, $2::float8, $3::float8) AS region",
    regions: "SELECT region, number, triangles, area FROM abacus_regions($1::oid::regclass) LIMIT $2",
    values: values(2),
    nearest: `SELECT vertex, x, y, attributes, distance FROM abacus_nearest($1::oid::regclass, $2::float8, $3::float8, 1)`,
    profile: `SELECT distance, x, y, value FROM abacus_profile($1::oid::regclass, $2::float8[], $3::text) LIMIT $4`,
    sight: `
        SELECT visible, x, y, z FROM abacus_visible($1::oid::regclass, ARRAY[$2, $3]::float8[], ARRAY[$4, $5]::float8[],
            attribute => $6::text, observer_height => $7::float8, target_height => $8::float8)`,
    hull: `
        SELECT ring, x, y, CASE WHEN $2::text IS NOT NULL THEN abacus_interpolate($1::oid::regclass, x, y, $2::text) END AS value
        FROM abacus_hull($1::oid::regclass, within => $4::text) ORDER BY ring, position LIMIT $3`,
    /** Of the mesh $2 over this one. */
    volume: "SELECT area, surface, cut, fill, net FROM abacus_volume($2::oid::regclass, $1::oid::regclass, attribute => $3::text, other_attribute => $4::text)",
    lines: `SELECT line, part, kind, x, y FROM abacus_lines($1::oid::regclass) ORDER BY line, position LIMIT $2`,
    picture: `SELECT abacus_tile_picture($1::oid::regclass, $2, $3, $4, $5, $6::float8[], attribute => $7, range => $8::float8[],
        ramp => $9, contours => $10, exaggeration => $11, edges => $12, size => $13, within => $14, regions => $15, max_error => $16) AS tile`,
    vector: "SELECT abacus_tile_vector($1::oid::regclass, $2, $3, $4, $5, $6::float8[], attribute => $7, contours => $8, within => $9) AS tile",
    mesh: "SELECT abacus_tile_mesh($1::oid::regclass, $2, $3, $4, $5, $6, max_error => $7) AS tile",
    terrain: "SELECT abacus_tile_terrain($1::oid::regclass, $2, $3, $4, $5, $6::float8[], attribute => $7, fill => $8, within => $9, max_error => $10) AS tile",
    /** The table of the mesh's levels, if it may be read. */
    levelsTable: `
        SELECT c.oid::regclass::text AS name FROM pg_depend AS d JOIN pg_class AS c ON c.oid = d.objid JOIN pg_type AS t ON t.oid = c.reloftype
        WHERE d.classid = 'pg_class'::regclass AND d.refclassid = 'pg_class'::regclass AND d.refobjid = $1::oid AND t.typname = 'abacus_level'
          AND has_table_privilege(c.oid, 'SELECT') AND NOT row_security_active(c.oid)`,
    /** Their attribute, if all may be read and are of the mesh as it is. The name of the table is as PostgreSQL quotes it. */
    levels: (table) => `
        SELECT min(attribute) AS attribute FROM ${table}
        HAVING bool_and(coalesce(has_table_privilege(mesh, 'SELECT'), false))
           AND NOT EXISTS (SELECT FROM abacus_stats($1::oid::regclass) WHERE name IN ('levels_old', 'levels_lost') AND value > 0)`,
};

export const space = {
    info,
    etag: plane.etag,
    located: located(3),
    cells: `SELECT ${corners}, labels FROM abacus_cells($1::oid::regclass, ARRAY[$2, $3, $4]::float8[], ARRAY[$2, $3, $4]::float8[])`,
    values: values(3),
    nearest: `SELECT vertex, x, y, z, attributes, distance FROM abacus_nearest($1::oid::regclass, $2::float8, $3::float8, $4::float8, 1)`,
    section: `SELECT polygon, "values", labels FROM abacus_section($1::oid::regclass, $2::float8[], $3::float8[], $4::text) LIMIT $5`,
    isosurface: `SELECT corners FROM abacus_isosurface($1::oid::regclass, $2::float8, $3::text) LIMIT $4`,
    ray: `SELECT enters, leaves, v0, v1, v2, v3 FROM abacus_ray($1::oid::regclass, $2::float8[], $3::float8[]) LIMIT $4`,
    hull: `SELECT ring, position, x, y, z FROM abacus_hull($1::oid::regclass) ORDER BY ring, position LIMIT $2`,
    /** How many triangles the hull has, and whether it is exactly the box from ($2, $3, $4) to ($5, $6, $7). */
    shape: `
        SELECT count(*)::integer AS triangles, bool_and(${["x", "y", "z"].map((axis, i) => `(low_${axis} = high_${axis} AND low_${axis} IN ($${2 + i}::float8, $${5 + i}::float8))`).join(" OR ")}) AS "isBox"
        FROM (SELECT ${["x", "y", "z"].map((axis) => `min(${axis}) AS low_${axis}, max(${axis}) AS high_${axis}`).join(", ")} FROM abacus_hull($1::oid::regclass) GROUP BY ring) AS triangle`,
    /** The corners of the hull with the attribute at position $2 of each vertex itself: at a fault both sides have their own. */
    body: `
        SELECT DISTINCT ON (h.ring, h.position) h.vertex, h.x, h.y, h.z, v.attributes[$2::integer] AS value
        FROM abacus_hull($1::oid::regclass) AS h JOIN abacus_vertices($1::oid::regclass) AS v ON v.id = h.vertex AND v.x = h.x AND v.y = h.y AND v.z = h.z
        ORDER BY h.ring, h.position`,
    /** The label at position $2 of the tetrahedron behind each triangle of the hull: of those around a corner, the one with all three. */
    bodyLabels: `
        SELECT (SELECT (abacus_labels($1::oid::regclass, s))[$2::integer] FROM abacus_star($1::oid::regclass, h.x, h.y, h.z) AS s
                WHERE ARRAY[s.v0, s.v1, s.v2, s.v3] @> h.vertices LIMIT 1) AS label
        FROM (SELECT ring, array_agg(vertex) AS vertices, min(x) FILTER (WHERE position = first) AS x, min(y) FILTER (WHERE position = first) AS y, min(z) FILTER (WHERE position = first) AS z
              FROM (SELECT *, min(position) OVER (PARTITION BY ring) AS first FROM abacus_hull($1::oid::regclass)) AS corner GROUP BY ring) AS h ORDER BY h.ring`,
    /** The values of the label at position $2: all of them if there are at most $3, and their range. */
    labelValues: `
        WITH seen AS MATERIALIZED (SELECT labels[$2::integer] AS value FROM abacus_cells($1::oid::regclass) WHERE labels[$2::integer] IS NOT NULL GROUP BY 1)
        SELECT min(value) AS least, max(value) AS greatest, CASE WHEN count(*) <= $3::integer THEN array_agg(value ORDER BY value) END AS values FROM seen`,
    brief: sectionPicture,
    picture: sectionPicture,
};

const octant = (row) => `${row}.code, ${row}.level, ${row}.lower, ${row}.upper, ${row}.attributes AS "values"`;
const octree = {
    info: `
        SELECT $1::oid::regclass::text AS name, abacus_srid($1::oid::regclass) AS srid,
               (SELECT jsonb_object_agg(name, value) FROM abacus_stats($1::oid::regclass) WHERE name IN ('dimension', 'leaves', 'levels')) AS stats,
               (SELECT coalesce(jsonb_agg(jsonb_build_object('name', name, 'least', least, 'greatest', greatest) ORDER BY position), '[]')
                FROM abacus_attributes($1::oid::regclass)) AS attributes,
               (SELECT jsonb_build_array(min(lower[1]), min(lower[2]), min(lower[3]), max(upper[1]), max(upper[2]), max(upper[3])) FROM abacus_octants($1::oid::regclass)) AS extent`,
    /** A text that changes with each change: an octree has no stamp that SQL shows, but counts what is done to it. */
    etag: `SELECT md5(string_agg(name || value, ',' ORDER BY name)) AS etag FROM abacus_stats($1::oid::regclass)
           WHERE name IN ('leaves', 'created', 'deleted', 'stores', 'bytes_written', 'rewrites')`,
    neighbours: `SELECT ${octant("n")} FROM abacus_octree_neighbours($1::oid::regclass, $2::bigint) AS n LIMIT $3`,
};
const octrees = {
    2: { ...octree, located: `SELECT ${octant("o")} FROM abacus_octree_locate($1::oid::regclass, ${point(2, 2)}) AS o WHERE o.code IS NOT NULL`, brief: wholePicture, picture: wholePicture },
    3: { ...octree, located: `SELECT ${octant("o")} FROM abacus_octree_locate($1::oid::regclass, ${point(2, 3)}) AS o WHERE o.code IS NOT NULL`, brief: sectionPicture, picture: sectionPicture },
};

/** Queries by the kind and dimension of a mesh. */
export const kinds = { mesh2: plane, mesh3: space, octree2: octrees[2], octree3: octrees[3] };

/** Changes, for a mesh of a dimension, with attributes or without. */
export function edits(dimension, hasAttributes) {
    const at = point(3, dimension);
    const values = hasAttributes && `$${3 + dimension}::float8[]`;
    return {
        insert: `SELECT abacus_insert($1::oid::regclass, ${row("$2", at, values)}, on_duplicate => 'error') AS changed`,
        remove: `SELECT abacus_delete($1::oid::regclass, ${row("$2", at)}) AS changed`,
        interpolate: `SELECT "values" FROM abacus_interpolate($1::oid::regclass, ${row("1", point(2, dimension))}, outside => 'nearest')`,
    };
}
