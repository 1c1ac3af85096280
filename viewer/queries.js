// All SQL of the viewer. Every value is a parameter, and so is the mesh: $1 is its oid. Where
// Abacus takes a query as a text, PostgreSQL makes it, of parameters that have a type.

const corners = `code, v0, v1, v2, v3, corners, "values"`;
const point = (from, dimension) =>
    Array.from({ length: dimension }, (_, i) => `$${from + i}::float8`);

/** Rows of one point for a query as a text: an id, coordinates, and values if there are any. */
function row(id, at, values) {
    const lists = ["%s", ...at.map(() => "%L::float8")];
    return `format('SELECT ${lists.join(", ")}', ${id}::bigint, ${at.join(", ")})` +
        (values ? ` || (SELECT coalesce(string_agg(format(', %L::float8', v), '' ORDER BY n), '') FROM unnest(${values}) WITH ORDINALITY AS u (v, n))` : "");
}

const info = `
    SELECT $1::oid::regclass::text AS name, abacus_srid($1::oid::regclass) AS srid,
           (SELECT jsonb_object_agg(name, value) FROM abacus_stats($1::oid::regclass)
            WHERE name IN ('dimension', 'vertices', 'simplices', 'changeable')) AS stats,
           (SELECT coalesce(jsonb_agg(jsonb_build_object('name', name, 'least', least, 'greatest', greatest) ORDER BY position), '[]')
            FROM abacus_attributes($1::oid::regclass)) AS attributes,
           (SELECT jsonb_build_array(min(x), min(y), min(z), max(x), max(y), max(z)) FROM abacus_hull($1::oid::regclass)) AS extent`;

export const plane = {
    info,
    etag: "SELECT abacus_tile_etag($1::oid::regclass) AS etag",
    locate: `SELECT (s).* FROM abacus_locate($1::oid::regclass, $2::float8, $3::float8) AS s WHERE (s).code IS NOT NULL`,
    cells: `SELECT ${corners} FROM abacus_cells($1::oid::regclass, ARRAY[$2, $3]::float8[], ARRAY[$2, $3]::float8[])`,
    values: `
        SELECT method, abacus_interpolate($1::oid::regclass, $2::float8, $3::float8, $4::text, method) AS value
        FROM unnest(ARRAY['linear', 'natural', 'nearest']) AS method`,
    nearest: `SELECT vertex, x, y, attributes, distance FROM abacus_nearest($1::oid::regclass, $2::float8, $3::float8, 1)`,
    profile: `SELECT distance, x, y, value FROM abacus_profile($1::oid::regclass, $2::float8[], $3::text) LIMIT $4`,
    sight: `
        SELECT visible, x, y, z FROM abacus_visible($1::oid::regclass, ARRAY[$2, $3]::float8[], ARRAY[$4, $5]::float8[],
            attribute => $6::text, observer_height => $7::float8, target_height => $8::float8)`,
    picture: `SELECT abacus_tile_picture($1::oid::regclass, $2, $3, $4, $5, $6::float8[], attribute => $7, range => $8::float8[],
        ramp => $9, contours => $10, exaggeration => $11, edges => $12) AS tile`,
    vector: "SELECT abacus_tile_vector($1::oid::regclass, $2, $3, $4, $5, $6::float8[], attribute => $7, contours => $8) AS tile",
    terrain: "SELECT abacus_tile_terrain($1::oid::regclass, $2, $3, $4, $5, $6::float8[], attribute => $7, fill => $8) AS tile",
};

export const space = {
    info,
    etag: plane.etag,
    locate: `SELECT (s).* FROM abacus_locate($1::oid::regclass, $2::float8, $3::float8, $4::float8) AS s WHERE (s).code IS NOT NULL`,
    cells: `SELECT ${corners} FROM abacus_cells($1::oid::regclass, ARRAY[$2, $3, $4]::float8[], ARRAY[$2, $3, $4]::float8[])`,
    values: `
        SELECT method, abacus_interpolate($1::oid::regclass, $2::float8, $3::float8, $4::float8, $5::text, method) AS value
        FROM unnest(ARRAY['linear', 'natural', 'nearest']) AS method`,
    nearest: `SELECT vertex, x, y, z, attributes, distance FROM abacus_nearest($1::oid::regclass, $2::float8, $3::float8, $4::float8, 1)`,
    section: `SELECT polygon, "values" FROM abacus_section($1::oid::regclass, $2::float8[], $3::float8[], $4::text) LIMIT $5`,
    isosurface: `SELECT corners FROM abacus_isosurface($1::oid::regclass, $2::float8, $3::text) LIMIT $4`,
    ray: `SELECT enters, leaves, v0, v1, v2, v3 FROM abacus_ray($1::oid::regclass, $2::float8[], $3::float8[]) LIMIT $4`,
    hull: `SELECT ring, position, x, y, z FROM abacus_hull($1::oid::regclass) ORDER BY ring, position LIMIT $2`,
};

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
