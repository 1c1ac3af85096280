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
    SELECT $1::oid::regclass::text AS name, abacus_srid($1::oid::regclass) AS srid,
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
    lines: `SELECT line, part, kind, x, y FROM abacus_lines($1::oid::regclass) ORDER BY line, position LIMIT $2`,
    picture: `SELECT abacus_tile_picture($1::oid::regclass, $2, $3, $4, $5, $6::float8[], attribute => $7, range => $8::float8[],
        ramp => $9, contours => $10, exaggeration => $11, edges => $12, size => $13, within => $14, regions => $15) AS tile`,
    vector: "SELECT abacus_tile_vector($1::oid::regclass, $2, $3, $4, $5, $6::float8[], attribute => $7, contours => $8, within => $9) AS tile",
    terrain: "SELECT abacus_tile_terrain($1::oid::regclass, $2, $3, $4, $5, $6::float8[], attribute => $7, fill => $8, within => $9) AS tile",
};

export const space = {
    info,
    etag: plane.etag,
    located: located(3),
    cells: `SELECT ${corners} FROM abacus_cells($1::oid::regclass, ARRAY[$2, $3, $4]::float8[], ARRAY[$2, $3, $4]::float8[])`,
    values: values(3),
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
