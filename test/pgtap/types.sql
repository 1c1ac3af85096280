-- Signatures, results, volatility and marks of every function, type and view.
BEGIN;
SELECT no_plan();

SELECT has_type('abacus_page');
SELECT has_type('abacus_simplex');
SELECT has_type('abacus_simplex_page');
SELECT has_type('abacus_vertex_page');
SELECT has_type('abacus_line_point');
SELECT has_type('abacus_region_part');
SELECT has_type('abacus_thinning');
SELECT has_type('abacus_step_values');
SELECT has_type('abacus_level');
SELECT has_type('abacus_shard_generation');
SELECT is(typstorage::text || typalign::text, 'pd', 'pages are plain and aligned to doubles')
FROM pg_type WHERE typname = 'abacus_page';
SELECT has_cast('bytea', 'abacus_page');
SELECT has_cast('abacus_page', 'bytea');
SELECT results_eq(
    $$ SELECT attname::text COLLATE "default", format_type(atttypid, NULL) FROM pg_attribute
       WHERE attrelid = (SELECT typrelid FROM pg_type WHERE typname = 'abacus_simplex') ORDER BY attnum $$,
    $$ VALUES ('code', 'bigint'), ('v0', 'bigint'), ('v1', 'bigint'), ('v2', 'bigint'), ('v3', 'bigint') $$,
    'columns of abacus_simplex');

SELECT has_type('abacus_octant');
SELECT results_eq(
    $$ SELECT attname::text COLLATE "default", format_type(atttypid, NULL) FROM pg_attribute
       WHERE attrelid = (SELECT typrelid FROM pg_type WHERE typname = 'abacus_octant') ORDER BY attnum $$,
    $$ VALUES ('code', 'bigint'), ('level', 'integer'), ('lower', 'double precision[]'), ('upper', 'double precision[]'),
              ('attributes', 'double precision[]') $$,
    'columns of abacus_octant');

CREATE TEMP TABLE wanted (name text, arguments text, result text, volatility "char", strict boolean, parallel "char");
INSERT INTO wanted VALUES
    ('abacus_create', 'mesh text, dimension integer, attributes text[] DEFAULT ''{}''::text[], lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[]', 'regclass', 'v', false, 'u'),
    ('abacus_octant_rows', 'internal', 'internal', 'v', true, 'u'),
    ('abacus_octants', 'octree regclass, center double precision[], radius double precision', 'SETOF abacus_octant', 's', true, 's'),
    ('abacus_octants', 'octree regclass, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[]', 'SETOF abacus_octant', 's', false, 's'),
    ('abacus_octants', 'octree regclass, lower double precision[], upper text', 'SETOF abacus_octant', 's', false, 's'),
    ('abacus_octree_balance', 'octree regclass, across text DEFAULT ''corners''::text', 'bigint', 'v', true, 'u'),
    ('abacus_octree_coarsen', 'octree regclass, query text', 'bigint', 'v', true, 'u'),
    ('abacus_octree_create', 'octree text, dimension integer, lower double precision[], upper double precision[], attributes text[] DEFAULT ''{}''::text[], levels integer DEFAULT NULL::integer', 'regclass', 'v', false, 'u'),
    ('abacus_octree_elements', 'octree regclass, OUT element bigint, OUT nodes bigint[], OUT code bigint, OUT level integer, OUT attributes double precision[]', 'SETOF record', 's', true, 's'),
    ('abacus_octree_from_points', 'octree regclass, query text, most_in_leaf integer', 'bigint', 'v', true, 'u'),
    ('abacus_octree_from_rows', 'octree regclass, query text', 'bigint', 'v', true, 'u'),
    ('abacus_octree_from_size', 'octree regclass, query text, samples integer DEFAULT 1', 'bigint', 'v', true, 'u'),
    ('abacus_octree_interpolate', 'octree regclass, query text, attributes text[] DEFAULT NULL::text[], OUT id bigint, OUT "values" double precision[]', 'SETOF record', 'v', false, 'u'),
    ('abacus_octree_interpolate', 'octree regclass, query text, attributes text, OUT id bigint, OUT "values" double precision[]', 'SETOF record', 'v', false, 'u'),
    ('abacus_octree_interpolate', 'octree regclass, x double precision, y double precision, attribute text DEFAULT NULL::text', 'double precision', 's', false, 's'),
    ('abacus_octree_interpolate', 'octree regclass, x double precision, y double precision, z double precision, attribute text DEFAULT NULL::text', 'double precision', 's', false, 's'),
    ('abacus_octree_locate', 'octree regclass, query text, OUT id bigint, OUT code bigint, OUT level integer, OUT lower double precision[], OUT upper double precision[], OUT attributes double precision[]', 'SETOF record', 'v', true, 'u'),
    ('abacus_octree_locate', 'octree regclass, x double precision, y double precision', 'abacus_octant', 's', true, 's'),
    ('abacus_octree_locate', 'octree regclass, x double precision, y double precision, z double precision', 'abacus_octant', 's', true, 's'),
    ('abacus_octree_nearest', 'octree regclass, query text, k integer DEFAULT 1, OUT id bigint, OUT rank bigint, OUT code bigint, OUT distance double precision', 'SETOF record', 'v', true, 'u'),
    ('abacus_octree_nearest', 'octree regclass, x double precision, y double precision, k integer DEFAULT 1, OUT code bigint, OUT level integer, OUT lower double precision[], OUT upper double precision[], OUT attributes double precision[], OUT distance double precision', 'SETOF record', 's', true, 's'),
    ('abacus_octree_nearest', 'octree regclass, x double precision, y double precision, z double precision, k integer DEFAULT 1, OUT code bigint, OUT level integer, OUT lower double precision[], OUT upper double precision[], OUT attributes double precision[], OUT distance double precision', 'SETOF record', 's', true, 's'),
    ('abacus_octree_neighbours', 'octree regclass, octant bigint, OUT axis integer, OUT side integer, OUT code bigint, OUT level integer, OUT lower double precision[], OUT upper double precision[], OUT attributes double precision[]', 'SETOF record', 's', true, 's'),
    ('abacus_octree_nodes', 'octree regclass, OUT node bigint, OUT point double precision[], OUT anchors bigint[]', 'SETOF record', 's', true, 's'),
    ('abacus_octree_refine', 'octree regclass, query text', 'bigint', 'v', true, 'u'),
    ('abacus_octree_tetrahedra', 'octree regclass, OUT element bigint, OUT nodes bigint[]', 'SETOF record', 's', true, 's'),
    ('abacus_octree_update', 'octree regclass, query text', 'bigint', 'v', true, 'u'),
    ('abacus_delete', 'mesh regclass, query text', 'bigint', 'v', true, 'u'),
    ('abacus_insert_returning', 'mesh regclass, query text, on_duplicate text DEFAULT ''keep''::text, OUT created boolean, OUT code bigint, OUT v0 bigint, OUT v1 bigint, OUT v2 bigint, OUT v3 bigint, OUT corners double precision[]', 'SETOF record', 'v', true, 'u'),
    ('abacus_delete_returning', 'mesh regclass, query text, OUT created boolean, OUT code bigint, OUT v0 bigint, OUT v1 bigint, OUT v2 bigint, OUT v3 bigint, OUT corners double precision[]', 'SETOF record', 'v', true, 'u'),
    ('abacus_update', 'mesh regclass, query text', 'bigint', 'v', true, 'u'),
    ('abacus_load', 'mesh text, vertices text, simplices text, attributes text[] DEFAULT NULL::text[], lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], reorient boolean DEFAULT true, retriangulate boolean DEFAULT false, labels text[] DEFAULT NULL::text[], facets text DEFAULT NULL::text, split_nodes boolean DEFAULT false, lines text DEFAULT NULL::text, inherit boolean DEFAULT false', 'bigint', 'v', false, 'u'),
    ('abacus_label', 'mesh regclass, query text', 'bigint', 'v', true, 'u'),
    ('abacus_mark', 'mesh regclass, query text', 'bigint', 'v', true, 'u'),
    ('abacus_facets', 'mesh regclass, INOUT marker integer DEFAULT NULL::integer, OUT v0 bigint, OUT v1 bigint, OUT v2 bigint, OUT corners double precision[]', 'SETOF record', 's', false, 's'),
    ('abacus_inherit_labels', 'mesh regclass, inherit boolean DEFAULT true', 'void', 'v', true, 'u'),
    ('abacus_labels', 'mesh regclass', 'text[]', 's', true, 's'),
    ('abacus_labels', 'mesh regclass, simplex abacus_simplex', 'double precision[]', 's', true, 's'),
    ('abacus_insert', 'mesh regclass, query text, on_duplicate text DEFAULT ''keep''::text', 'bigint', 'v', true, 'u'),
    ('abacus_attributes', 'mesh regclass, OUT "position" integer, OUT name text, OUT "least" double precision, OUT "greatest" double precision, OUT nulls bigint', 'SETOF record', 's', true, 's'),
    ('abacus_add_attribute', 'mesh regclass, attribute text', 'void', 'v', true, 'u'),
    ('abacus_drop_attribute', 'mesh regclass, attribute text', 'void', 'v', true, 'u'),
    ('abacus_rename_attribute', 'mesh regclass, attribute text, name text', 'void', 'v', true, 'u'),
    ('abacus_srid', 'mesh regclass', 'integer', 's', true, 's'),
    ('abacus_set_srid', 'mesh regclass, srid integer', 'void', 'v', true, 'u'),
    ('abacus_stage', 'mesh regclass, query text', 'bigint', 'v', true, 'u'),
    ('abacus_track', 'mesh regclass, "table" regclass, columns text[] DEFAULT NULL::text[], synchronize boolean DEFAULT false, deferred boolean DEFAULT false', 'bigint', 'v', false, 'u'),
    ('abacus_tracked', '', 'trigger', 'v', false, 'u'),
    ('abacus_track_lines', 'mesh regclass, "table" regclass, columns text[] DEFAULT NULL::text[], kind text DEFAULT ''hard''::text, z text DEFAULT NULL::text, synchronize boolean DEFAULT false', 'bigint', 'v', false, 'u'),
    ('abacus_tracked_lines', '', 'trigger', 'v', false, 'u'),
    ('abacus_untrack', 'mesh regclass, "table" regclass', 'void', 'v', true, 'u'),
    ('abacus_triangulate', 'mesh regclass', 'bigint', 'v', true, 'u'),
    ('abacus_triangulate', 'mesh text, query text, attributes text[] DEFAULT NULL::text[], dimension integer DEFAULT 2, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], lines text DEFAULT NULL::text', 'bigint', 'v', false, 'u'),
    ('abacus_locate', 'mesh regclass, x double precision, y double precision', 'abacus_simplex', 's', true, 's'),
    ('abacus_locate', 'mesh regclass, x double precision, y double precision, z double precision', 'abacus_simplex', 's', true, 's'),
    ('abacus_locate', 'mesh regclass, query text, OUT id bigint, OUT code bigint, OUT v0 bigint, OUT v1 bigint, OUT v2 bigint, OUT v3 bigint, OUT labels double precision[]', 'SETOF record', 'v', true, 'u'),
    ('abacus_star', 'mesh regclass, x double precision, y double precision', 'SETOF abacus_simplex', 's', true, 's'),
    ('abacus_nearest', 'mesh regclass, x double precision, y double precision, k integer DEFAULT 1, OUT vertex bigint, OUT x double precision, OUT y double precision, OUT z double precision, OUT attributes double precision[], OUT distance double precision', 'SETOF record', 's', true, 's'),
    ('abacus_nearest', 'mesh regclass, x double precision, y double precision, z double precision, k integer DEFAULT 1, OUT vertex bigint, OUT x double precision, OUT y double precision, OUT z double precision, OUT attributes double precision[], OUT distance double precision', 'SETOF record', 's', true, 's'),
    ('abacus_voronoi', 'mesh regclass, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], OUT vertex bigint, OUT bounded boolean, OUT area double precision, OUT volume double precision, OUT ring double precision[]', 'SETOF record', 's', false, 's'),
    ('abacus_voronoi_facets', 'mesh regclass, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], OUT vertex bigint, OUT neighbour bigint, OUT bounded boolean, OUT size double precision, OUT ring double precision[]', 'SETOF record', 's', false, 's'),
    ('abacus_hull', 'mesh regclass, max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, OUT ring bigint, OUT "position" bigint, OUT vertex bigint, OUT x double precision, OUT y double precision, OUT z double precision', 'SETOF record', 's', false, 's'),
    ('abacus_alpha_shape', 'mesh regclass, alpha double precision, allow_holes boolean DEFAULT NULL::boolean, OUT ring bigint, OUT "position" bigint, OUT vertex bigint, OUT x double precision, OUT y double precision, OUT z double precision', 'SETOF record', 's', false, 's'),
    ('abacus_constrain', 'mesh regclass, query text, kind text DEFAULT ''hard''::text, existing text DEFAULT ''error''::text, z text DEFAULT NULL::text', 'bigint', 'v', false, 'u'),
    ('abacus_crossings', 'mesh regclass, query text, OUT line_a bigint, OUT position_a bigint, OUT line_b bigint, OUT position_b bigint, OUT x double precision, OUT y double precision', 'SETOF record', 'v', true, 'u'),
    ('abacus_unconstrain', 'mesh regclass, query text', 'bigint', 'v', true, 'u'),
    ('abacus_lines', 'mesh regclass, OUT line bigint, OUT "position" bigint, OUT point bigint, OUT x double precision, OUT y double precision, OUT kind text, OUT part bigint', 'SETOF record', 's', true, 's'),
    ('abacus_spanning_tree', 'mesh regclass, OUT v0 bigint, OUT v1 bigint, OUT length double precision', 'SETOF record', 's', true, 's'),
    ('abacus_neighbours', 'mesh regclass, simplex abacus_simplex, steps integer', 'SETOF abacus_simplex', 's', true, 's'),
    ('abacus_simplices', 'mesh regclass, center double precision[], radius double precision, within text DEFAULT NULL::text', 'SETOF abacus_simplex', 's', false, 's'),
    ('abacus_simplices', 'mesh regclass, lower double precision[], upper double precision[], within text DEFAULT NULL::text', 'SETOF abacus_simplex', 's', false, 's'),
    ('abacus_simplices', 'mesh regclass, lower double precision[], upper text, within text DEFAULT NULL::text', 'SETOF abacus_simplex', 's', false, 's'),
    ('abacus_edges', 'mesh regclass, center double precision[], radius double precision, max_edge double precision DEFAULT NULL::double precision, fixed boolean DEFAULT false, within text DEFAULT NULL::text, OUT v0 bigint, OUT v1 bigint, OUT length double precision, OUT lines bigint[], OUT kind text', 'SETOF record', 's', false, 's'),
    ('abacus_contours_rows', 'internal', 'internal', 'v', true, 'u'),
    ('abacus_surface_rows', 'internal', 'internal', 'v', true, 'u'),
    ('abacus_isosurface', 'mesh regclass, value double precision, attribute text DEFAULT NULL::text, carry text DEFAULT NULL::text, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], max_edge double precision DEFAULT NULL::double precision, OUT v0 bigint, OUT v1 bigint, OUT v2 bigint, OUT corners double precision[], OUT "values" double precision[]', 'SETOF record', 's', false, 's'),
    ('abacus_section', 'mesh regclass, through double precision[], normal double precision[], attribute text DEFAULT NULL::text, max_edge double precision DEFAULT NULL::double precision, OUT code bigint, OUT polygon double precision[], OUT "values" double precision[], OUT labels double precision[]', 'SETOF record', 's', false, 's'),
    ('abacus_draw_volume', 'mesh regclass, eye double precision[] DEFAULT NULL::double precision[], toward double precision[] DEFAULT NULL::double precision[], up double precision[] DEFAULT NULL::double precision[], field_of_view double precision DEFAULT NULL::double precision, width integer DEFAULT 1024, height integer DEFAULT NULL::integer, attribute text DEFAULT NULL::text, mode text DEFAULT ''mean''::text, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], max_edge double precision DEFAULT NULL::double precision, range double precision[] DEFAULT NULL::double precision[], ramp text DEFAULT NULL::text, legend text DEFAULT NULL::text, transparent boolean DEFAULT false, step bigint DEFAULT NULL::bigint', 'bytea', 's', false, 's'),
    ('abacus_contours', 'mesh regclass, level_interval double precision DEFAULT 100, level_base double precision DEFAULT 0, fixed_levels double precision[] DEFAULT ''{}''::double precision[], polygonize boolean DEFAULT false, attribute text DEFAULT NULL::text, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, max_error double precision DEFAULT NULL::double precision, OUT id bigint, OUT value double precision, OUT closed boolean, OUT path double precision[]', 'SETOF record', 's', false, 's'),
    ('abacus_range_rows', 'internal', 'internal', 'v', true, 'u'),
    ('abacus_cells', 'mesh regclass, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], max_edge double precision DEFAULT NULL::double precision, label text DEFAULT NULL::text, range double precision[] DEFAULT NULL::double precision[], within text DEFAULT NULL::text, OUT code bigint, OUT v0 bigint, OUT v1 bigint, OUT v2 bigint, OUT v3 bigint, OUT corners double precision[], OUT "values" double precision[], OUT labels double precision[]', 'SETOF record', 's', false, 's'),
    ('abacus_cells', 'mesh regclass, lower double precision[], upper text, max_edge double precision DEFAULT NULL::double precision, label text DEFAULT NULL::text, range double precision[] DEFAULT NULL::double precision[], within text DEFAULT NULL::text, OUT code bigint, OUT v0 bigint, OUT v1 bigint, OUT v2 bigint, OUT v3 bigint, OUT corners double precision[], OUT "values" double precision[], OUT labels double precision[]', 'SETOF record', 's', false, 's'),
    ('abacus_star', 'mesh regclass, x double precision, y double precision, z double precision', 'SETOF abacus_simplex', 's', true, 's'),
    ('abacus_vertices', 'mesh regclass, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], attribute text DEFAULT NULL::text, range double precision[] DEFAULT NULL::double precision[], OUT sequence bigint, OUT id bigint, OUT x double precision, OUT y double precision, OUT z double precision, OUT attributes double precision[], OUT vertex bigint', 'SETOF record', 's', false, 's'),
    ('abacus_vertices', 'mesh regclass, lower double precision[], upper text, attribute text DEFAULT NULL::text, range double precision[] DEFAULT NULL::double precision[], OUT sequence bigint, OUT id bigint, OUT x double precision, OUT y double precision, OUT z double precision, OUT attributes double precision[], OUT vertex bigint', 'SETOF record', 's', false, 's'),
    ('abacus_nearest', 'mesh regclass, query text, k integer DEFAULT 1, OUT id bigint, OUT rank bigint, OUT vertex bigint, OUT distance double precision', 'SETOF record', 'v', true, 'u'),
    ('abacus_vertices', 'mesh regclass, center double precision[], radius double precision, OUT sequence bigint, OUT id bigint, OUT x double precision, OUT y double precision, OUT z double precision, OUT attributes double precision[], OUT vertex bigint', 'SETOF record', 's', true, 's'),
    ('abacus_nearest_rows', 'internal', 'internal', 'v', true, 'u'),
    ('abacus_vertices', 'mesh regclass, attribute text, range_lower double precision, range_upper double precision, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], OUT sequence bigint, OUT id bigint, OUT x double precision, OUT y double precision, OUT z double precision, OUT attributes double precision[], OUT vertex bigint', 'SETOF record', 's', false, 's'),
    ('abacus_vertices', 'mesh regclass, attribute text, range_lower text, range_upper text, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], OUT sequence bigint, OUT id bigint, OUT x double precision, OUT y double precision, OUT z double precision, OUT attributes double precision[], OUT vertex bigint', 'SETOF record', 's', false, 's'),
    ('abacus_cells', 'mesh regclass, center double precision[], radius double precision, max_edge double precision DEFAULT NULL::double precision, label text DEFAULT NULL::text, range double precision[] DEFAULT NULL::double precision[], within text DEFAULT NULL::text, OUT code bigint, OUT v0 bigint, OUT v1 bigint, OUT v2 bigint, OUT v3 bigint, OUT corners double precision[], OUT "values" double precision[], OUT labels double precision[]', 'SETOF record', 's', false, 's'),
    ('abacus_edges', 'mesh regclass, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], max_edge double precision DEFAULT NULL::double precision, fixed boolean DEFAULT false, within text DEFAULT NULL::text, OUT v0 bigint, OUT v1 bigint, OUT length double precision, OUT lines bigint[], OUT kind text', 'SETOF record', 's', false, 's'),
    ('abacus_edges', 'mesh regclass, lower double precision[], upper text, max_edge double precision DEFAULT NULL::double precision, fixed boolean DEFAULT false, within text DEFAULT NULL::text, OUT v0 bigint, OUT v1 bigint, OUT length double precision, OUT lines bigint[], OUT kind text', 'SETOF record', 's', false, 's'),
    ('abacus_window_rows', 'internal', 'internal', 'v', true, 'u'),
    ('abacus_numbered_vertices', 'mesh regclass, OUT number bigint, OUT id bigint, OUT x double precision, OUT y double precision, OUT z double precision, OUT attributes double precision[]', 'SETOF record', 's', true, 's'),
    ('abacus_numbered_simplices', 'mesh regclass, OUT code bigint, OUT n0 bigint, OUT n1 bigint, OUT n2 bigint, OUT n3 bigint, OUT labels double precision[]', 'SETOF record', 's', true, 's'),
    ('abacus_partition', 'mesh regclass, parts integer, weight text DEFAULT NULL::text, OUT part integer, OUT vertices bigint, OUT simplices bigint, OUT cut_facets bigint, OUT halo bigint', 'SETOF record', 's', false, 's'),
    ('abacus_share_vertices', 'mesh regclass, parts integer, part integer, halo integer DEFAULT 1, weight text DEFAULT NULL::text, OUT local bigint, OUT id bigint, OUT owner integer, OUT x double precision, OUT y double precision, OUT z double precision, OUT attributes double precision[]', 'SETOF record', 's', false, 's'),
    ('abacus_share_simplices', 'mesh regclass, parts integer, part integer, halo integer DEFAULT 1, weight text DEFAULT NULL::text, OUT code bigint, OUT v0 bigint, OUT v1 bigint, OUT v2 bigint, OUT v3 bigint, OUT owner integer, OUT labels double precision[], OUT markers double precision[]', 'SETOF record', 's', false, 's'),
    ('abacus_store', 'mesh regclass, step bigint, parts integer, part integer, query text, weight text DEFAULT NULL::text', 'bigint', 'v', false, 'u'),
    ('abacus_steps', 'mesh regclass, OUT step bigint, OUT parts integer, OUT stored integer, OUT vertices bigint, OUT whole boolean', 'SETOF record', 's', true, 's'),
    ('abacus_interpolate', 'mesh regclass, x double precision, y double precision, attribute text DEFAULT NULL::text, method text DEFAULT ''linear''::text, outside text DEFAULT ''null''::text, max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, step bigint DEFAULT NULL::bigint', 'double precision', 's', false, 's'),
    ('abacus_interpolate', 'mesh regclass, x double precision, y double precision, z double precision, attribute text DEFAULT NULL::text, method text DEFAULT ''linear''::text, outside text DEFAULT ''null''::text, max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, step bigint DEFAULT NULL::bigint', 'double precision', 's', false, 's'),
    ('abacus_interpolate', 'mesh regclass, query text, attributes text[] DEFAULT NULL::text[], method text DEFAULT ''linear''::text, outside text DEFAULT ''null''::text, max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, step bigint DEFAULT NULL::bigint, OUT id bigint, OUT "values" double precision[]', 'SETOF record', 'v', false, 'u'),
    ('abacus_interpolate', 'mesh regclass, query text, attributes text, method text DEFAULT ''linear''::text, outside text DEFAULT ''null''::text, max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, step bigint DEFAULT NULL::bigint, OUT id bigint, OUT "values" double precision[]', 'SETOF record', 'v', false, 'u'),
    ('abacus_weights', 'mesh regclass, x double precision, y double precision, method text DEFAULT ''linear''::text, outside text DEFAULT ''null''::text, max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, OUT vertex bigint, OUT weight double precision', 'SETOF record', 's', false, 's'),
    ('abacus_weights', 'mesh regclass, x double precision, y double precision, z double precision, method text DEFAULT ''linear''::text, outside text DEFAULT ''null''::text, max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, OUT vertex bigint, OUT weight double precision', 'SETOF record', 's', false, 's'),
    ('abacus_weights', 'mesh regclass, query text, method text DEFAULT ''linear''::text, outside text DEFAULT ''null''::text, max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, OUT id bigint, OUT vertex bigint, OUT weight double precision', 'SETOF record', 'v', false, 'u'),
    ('abacus_gradient', 'mesh regclass, x double precision, y double precision, attribute text DEFAULT NULL::text, max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text', 'double precision[]', 's', false, 's'),
    ('abacus_gradient', 'mesh regclass, x double precision, y double precision, z double precision, attribute text DEFAULT NULL::text, max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text', 'double precision[]', 's', false, 's'),
    ('abacus_slope', 'mesh regclass, x double precision, y double precision, attribute text DEFAULT NULL::text, max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, OUT slope double precision, OUT aspect double precision', 'record', 's', false, 's'),
    ('abacus_walk', 'mesh regclass, simplex abacus_simplex, facet integer', 'abacus_simplex', 's', true, 's'),
    ('abacus_simplices', 'mesh regclass', 'SETOF abacus_simplex', 's', true, 's'),
    ('abacus_thin_build', 'IN mesh regclass, IN new_mesh text, IN max_error double precision, IN attribute text DEFAULT NULL::text, IN keep text DEFAULT NULL::text, IN target bigint DEFAULT NULL::bigint', NULL, 'v', false, 'u'),
    ('abacus_build', 'IN mesh regclass, IN batch bigint DEFAULT 1000000', NULL, 'v', false, 'u'),
    ('abacus_check', 'mesh regclass, max_faults integer DEFAULT 1000, OUT fault text, OUT code bigint, OUT part bigint, OUT message text', 'SETOF record', 's', false, 's'),
    ('abacus_stats', 'mesh regclass, OUT name text, OUT value double precision, OUT description text', 'SETOF record', 'v', true, 'r'),
    ('abacus_thin', 'mesh regclass, new_mesh text, max_error double precision, attribute text DEFAULT NULL::text, keep text DEFAULT NULL::text, target bigint DEFAULT NULL::bigint', 'double precision', 'v', false, 'u'),
    ('abacus_compare', 'mesh regclass, other regclass, attribute text DEFAULT NULL::text, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], max_edge double precision DEFAULT NULL::double precision, other_attribute text DEFAULT NULL::text, within text DEFAULT NULL::text, OUT "greatest" double precision, OUT x double precision, OUT y double precision, OUT z double precision, OUT mean double precision, OUT mean_absolute double precision, OUT rms double precision', 'record', 's', false, 's'),
    ('abacus_levels', 'mesh regclass, errors double precision[], attribute text DEFAULT NULL::text, OUT level integer, OUT level_mesh regclass, OUT error double precision, OUT vertices bigint', 'SETOF record', 'v', false, 'u'),
    ('abacus_levels_refresh', 'mesh regclass, OUT level integer, OUT level_mesh regclass, OUT error double precision, OUT vertices bigint', 'SETOF record', 'v', true, 'u'),
    ('abacus_levels_drop', 'mesh regclass', 'integer', 'v', true, 'u'),
    ('abacus_shard_begin', 'mesh text, dimension integer, attributes text[], lower double precision[], upper double precision[], srid integer DEFAULT 0', 'regclass', 'v', false, 'u'),
    ('abacus_shard_build', 'IN mesh regclass, IN query text', NULL, 'v', false, 'u'),
    ('abacus_shard_build', 'IN mesh regclass, IN queries text[]', NULL, 'v', false, 'u'),
    ('abacus_shard_change', 'mesh regclass, query text, how text, first bigint, last bigint, with_simplices boolean, OUT created boolean, OUT code bigint, OUT v0 bigint, OUT v1 bigint, OUT v2 bigint, OUT v3 bigint, OUT corners double precision[], OUT points bigint, OUT more bigint, OUT duplicates bigint, OUT gained bigint, OUT is_all_new boolean', 'SETOF record', 'v', true, 'u'),
    ('abacus_shard_count', 'mesh regclass, borders bigint[], own integer, "least" double precision[], "greatest" double precision[]', 'bigint', 's', true, 's'),
    ('abacus_shard_create', 'mesh text, servers text[], dimension integer DEFAULT 2, attributes text[] DEFAULT NULL::text[], lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[]', 'regclass', 'v', false, 'u'),
    ('abacus_shard_drop', 'mesh regclass', 'void', 'v', true, 'u'),
    ('abacus_shard_exports', 'mesh regclass, borders bigint[], own integer, "least" double precision[], "greatest" double precision[], OUT shard integer, OUT id bigint, OUT x double precision, OUT y double precision, OUT z double precision, OUT attributes double precision[]', 'SETOF record', 's', true, 's'),
    ('abacus_shard_facts', 'mesh regclass, first bigint, last bigint, OUT simplices bigint, OUT ghosts bigint, OUT vertices bigint, OUT stamp bigint', 'record', 's', true, 's'),
    ('abacus_shard_exports_around', 'mesh regclass, borders bigint[], own integer, "least" double precision[], "greatest" double precision[], query text, OUT shard integer, OUT id bigint, OUT x double precision, OUT y double precision, OUT z double precision, OUT attributes double precision[]', 'SETOF record', 'v', true, 'u'),
    ('abacus_shard_owner', 'lower double precision[], upper double precision[], borders bigint[], place double precision[]', 'integer', 'i', true, 's'),
    ('abacus_shard_pages', 'mesh regclass, kind integer, first bigint, last bigint, from_code bigint, from_part bigint, bytes integer, OUT code bigint, OUT part bigint, OUT page bytea', 'SETOF record', 's', true, 's'),
    ('abacus_shard_resolve', 'mesh regclass', 'bigint', 'v', true, 'u'),
    ('abacus_shard_settled', 'mesh regclass, first bigint, last bigint, ids bigint[], places double precision[], OUT id bigint, OUT x double precision, OUT y double precision, OUT z double precision', 'SETOF record', 's', true, 's'),
    ('abacus_shard_split', 'attributes integer, lower double precision[], upper double precision[], borders bigint[], own integer', 'bigint', 'v', true, 'u'),
    ('abacus_shard_stage', 'mesh regclass, borders bigint[], own integer, "least" double precision[], "greatest" double precision[]', 'bigint', 'v', true, 'u'),
    ('abacus_shard_survey', 'query text, dimension integer, own integer, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], OUT points bigint, OUT attributes text[], OUT "least" double precision[], OUT "greatest" double precision[], OUT srid integer, OUT sample double precision[]', 'record', 'v', false, 'u'),
    ('abacus_shard_take', 'mesh regclass, query text', 'bigint', 'v', true, 'u'),
    ('abacus_shards', 'mesh regclass, OUT shard integer, OUT server text, OUT shard_mesh text, OUT first bigint, OUT "end" bigint, OUT state text, OUT doing text, OUT points bigint, OUT guests bigint, OUT bytes bigint', 'SETOF record', 'v', true, 'u'),
    ('abacus_level', 'mesh regclass, max_error double precision', 'regclass', 's', true, 's'),
    ('abacus_volume', 'mesh regclass, base double precision, attribute text DEFAULT NULL::text, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, OUT area double precision, OUT surface double precision, OUT cut double precision, OUT fill double precision, OUT net double precision', 'record', 's', false, 's'),
    ('abacus_volume', 'mesh regclass, other regclass, attribute text DEFAULT NULL::text, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], max_edge double precision DEFAULT NULL::double precision, other_attribute text DEFAULT NULL::text, within text DEFAULT NULL::text, OUT area double precision, OUT surface double precision, OUT cut double precision, OUT fill double precision, OUT net double precision', 'record', 's', false, 's'),
    ('abacus_volume', 'mesh regclass, other text, attribute text DEFAULT NULL::text, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], max_edge double precision DEFAULT NULL::double precision, other_attribute text DEFAULT NULL::text, within text DEFAULT NULL::text, OUT area double precision, OUT surface double precision, OUT cut double precision, OUT fill double precision, OUT net double precision', 'record', 's', false, 's'),
    ('abacus_tile_picture', 'mesh regclass, z integer, x integer, y integer, srid integer DEFAULT NULL::integer, world double precision[] DEFAULT NULL::double precision[], size integer DEFAULT 256, attribute text DEFAULT NULL::text, range double precision[] DEFAULT NULL::double precision[], edges boolean DEFAULT true, exaggeration double precision DEFAULT 0, max_edge double precision DEFAULT NULL::double precision, ramp text DEFAULT NULL::text, contours double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, regions boolean DEFAULT false, lines boolean DEFAULT false, max_error double precision DEFAULT NULL::double precision, pixel_error double precision DEFAULT NULL::double precision, step bigint DEFAULT NULL::bigint', 'bytea', 's', false, 's'),
    ('abacus_tile_vector', 'mesh regclass, z integer, x integer, y integer, srid integer DEFAULT NULL::integer, world double precision[] DEFAULT NULL::double precision[], attribute text DEFAULT NULL::text, contours double precision DEFAULT NULL::double precision, max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, max_error double precision DEFAULT NULL::double precision, pixel_error double precision DEFAULT NULL::double precision, step bigint DEFAULT NULL::bigint', 'bytea', 's', false, 's'),
    ('abacus_tile_terrain', 'mesh regclass, z integer, x integer, y integer, srid integer DEFAULT NULL::integer, world double precision[] DEFAULT NULL::double precision[], size integer DEFAULT 256, attribute text DEFAULT NULL::text, max_edge double precision DEFAULT NULL::double precision, fill double precision DEFAULT 0, within text DEFAULT NULL::text, max_error double precision DEFAULT NULL::double precision, pixel_error double precision DEFAULT NULL::double precision, step bigint DEFAULT NULL::bigint', 'bytea', 's', false, 's'),
    ('abacus_tile_mesh', 'mesh regclass, z integer, x integer, y integer, attribute text DEFAULT NULL::text, srid integer DEFAULT NULL::integer, world double precision[] DEFAULT NULL::double precision[], format text DEFAULT ''quantized-mesh''::text, scheme text DEFAULT ''tms''::text, max_error double precision DEFAULT NULL::double precision, step bigint DEFAULT NULL::bigint', 'bytea', 's', false, 's'),
    ('abacus_tile_etag', 'mesh regclass, step bigint DEFAULT NULL::bigint', 'text', 's', false, 's'),
    ('abacus_tiles', 'mesh regclass, srid integer DEFAULT NULL::integer, world double precision[] DEFAULT NULL::double precision[], attribute text DEFAULT NULL::text, range double precision[] DEFAULT NULL::double precision[], contours double precision DEFAULT NULL::double precision, ramp text DEFAULT NULL::text, exaggeration double precision DEFAULT 0, edges boolean DEFAULT true, max_edge double precision DEFAULT NULL::double precision, size integer DEFAULT 256, within text DEFAULT NULL::text, regions boolean DEFAULT false, lines boolean DEFAULT false, pixel_error double precision DEFAULT NULL::double precision, step bigint DEFAULT NULL::bigint', 'SETOF regprocedure', 'v', false, 'u'),
    ('abacus_draw', 'mesh regclass, width integer DEFAULT 1024, height integer DEFAULT NULL::integer, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], attribute text DEFAULT NULL::text, edges boolean DEFAULT true, exaggeration double precision DEFAULT 0, max_edge double precision DEFAULT NULL::double precision, range double precision[] DEFAULT NULL::double precision[], ramp text DEFAULT NULL::text, contours double precision DEFAULT NULL::double precision, legend text DEFAULT NULL::text, scale_bar text DEFAULT NULL::text, transparent boolean DEFAULT false, light double precision[] DEFAULT NULL::double precision[], within text DEFAULT NULL::text, regions boolean DEFAULT false, lines boolean DEFAULT false, max_error double precision DEFAULT NULL::double precision, contour_labels boolean DEFAULT false, step bigint DEFAULT NULL::bigint', 'bytea', 's', false, 's'),
    ('abacus_draw_section', 'mesh regclass, through double precision[], normal double precision[], width integer DEFAULT 1024, height integer DEFAULT NULL::integer, attribute text DEFAULT NULL::text, edges boolean DEFAULT true, lower double precision[] DEFAULT NULL::double precision[], upper double precision[] DEFAULT NULL::double precision[], exaggeration double precision DEFAULT 1, max_edge double precision DEFAULT NULL::double precision, range double precision[] DEFAULT NULL::double precision[], ramp text DEFAULT NULL::text, contours double precision DEFAULT NULL::double precision, legend text DEFAULT NULL::text, scale_bar text DEFAULT NULL::text, transparent boolean DEFAULT false, step bigint DEFAULT NULL::bigint', 'bytea', 's', false, 's'),
    ('abacus_simplices_rows', 'internal', 'internal', 'v', true, 'u'),
    ('abacus_vertices_rows', 'internal', 'internal', 'v', true, 'u'),
    ('abacus_profile', 'mesh regclass, path double precision[], attribute text DEFAULT NULL::text, max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, OUT distance double precision, OUT x double precision, OUT y double precision, OUT z double precision, OUT value double precision', 'SETOF record', 's', false, 's'),
    ('abacus_ray', 'mesh regclass, origin double precision[], direction double precision[], OUT enters double precision, OUT leaves double precision, OUT code bigint, OUT v0 bigint, OUT v1 bigint, OUT v2 bigint, OUT v3 bigint, OUT labels double precision[]', 'SETOF record', 's', true, 's'),
    ('abacus_visible', 'mesh regclass, observer double precision[], target double precision[], attribute text DEFAULT NULL::text, observer_height double precision DEFAULT 0, target_height double precision DEFAULT 0, max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, OUT visible boolean, OUT x double precision, OUT y double precision, OUT z double precision', 'record', 's', false, 's'),
    ('abacus_raster', 'mesh regclass, lower double precision[], upper double precision[], width integer, height integer, attribute text DEFAULT NULL::text, method text DEFAULT ''linear''::text, outside text DEFAULT ''null''::text, max_edge double precision DEFAULT NULL::double precision, within text DEFAULT NULL::text, OUT "row" integer, OUT "values" double precision[]', 'SETOF record', 's', false, 's'),
    ('abacus_fdw_handler', '', 'fdw_handler', 'v', true, 's'),
    ('abacus_fdw_validator', 'options text[], catalog oid', 'void', 'v', true, 's'),
    ('abacus_published', 'mesh regclass', 'boolean', 'i', true, 's'),
    ('abacus_publish', 'mesh regclass, cells text DEFAULT NULL::text, points text DEFAULT NULL::text, schema text DEFAULT NULL::text, geometry boolean DEFAULT NULL::boolean, srid integer DEFAULT NULL::integer, z text DEFAULT NULL::text, fixed_edges text DEFAULT NULL::text, breaklines text DEFAULT NULL::text', 'regclass[]', 'v', false, 'u'),
    ('_abacus_fixed_edges', 'mesh regclass, OUT v0 bigint, OUT v1 bigint, OUT length double precision, OUT lines bigint[], OUT kind text, OUT path double precision[]', 'SETOF record', 's', true, 's'),
    ('abacus_unpublish', 'mesh regclass', 'integer', 'v', true, 'u'),
    ('abacus_line_rows', 'internal', 'internal', 'v', true, 'u'),
    ('abacus_raster_rows', 'internal', 'internal', 'v', true, 'u'),
    ('abacus_region', 'mesh regclass, query text', 'bigint', 'v', true, 'u'),
    ('abacus_unregion', 'mesh regclass, region text', 'void', 'v', true, 'u'),
    ('abacus_region_at', 'mesh regclass, x double precision, y double precision', 'text', 's', true, 's'),
    ('abacus_regions', 'mesh regclass, OUT region text, OUT number integer, OUT triangles bigint, OUT area double precision, OUT edges bigint', 'SETOF record', 's', true, 's'),
    ('abacus_simplices', 'mesh regclass, within text', 'SETOF abacus_simplex', 's', true, 's'),
    ('abacus_version', '', 'text', 's', false, 's');

SELECT set_eq(
    $$ SELECT p.proname::text COLLATE "default", pg_get_function_arguments(p.oid), pg_get_function_result(p.oid), p.provolatile, p.proisstrict, p.proparallel
       FROM pg_proc p JOIN pg_depend d ON d.objid = p.oid AND d.classid = 'pg_proc'::regclass AND d.deptype = 'e'
            JOIN pg_extension e ON e.oid = d.refobjid AND e.extname = 'abacus'
       WHERE p.proname !~ '^abacus_page_' $$,
    'TABLE wanted', 'signatures and marks');
SELECT is_empty(
    $$ SELECT p.proname FROM pg_proc p JOIN pg_depend d ON d.objid = p.oid AND d.classid = 'pg_proc'::regclass AND d.deptype = 'e'
       JOIN pg_extension e ON e.oid = d.refobjid AND e.extname = 'abacus' WHERE p.prosecdef $$,
    'nothing runs with its owner''s rights');

SELECT ok(has_server_privilege('public', 'abacus', 'USAGE'), 'everyone may publish');
SELECT has_view('abacus_progress');
SELECT ok(has_table_privilege('public', 'abacus_progress', 'SELECT'), 'progress is for everyone');
SELECT columns_are('abacus_progress', ARRAY['pid', 'mesh', 'phase', 'done', 'total', 'per_second', 'time_left', 'elapsed', 'pages_read', 'pages_written', 'threads', 'busy', 'session_busy', 'rounds']);

SELECT isnt(abacus_version(), NULL, 'the module is loaded');
SELECT is(current_setting('abacus.cache_size'), '128MB', 'default cache');
SELECT is((SELECT context FROM pg_settings WHERE name = 'abacus.cache_size'), 'user', 'anyone may set the cache size');
SELECT is(current_setting('abacus.vacuum_moves_rows'), 'on', 'VACUUM moves pages');
SELECT is((SELECT context FROM pg_settings WHERE name = 'abacus.vacuum_moves_rows'), 'user', 'anyone may say whether');
SELECT is((SELECT context FROM pg_settings WHERE name = 'abacus.fail_host_call'), 'superuser', 'failing is for superusers');

-- the owner of the type of simplices may alter it; functions that return it then report that
SELECT abacus_triangulate('altered', 'VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)');
SELECT isnt(abacus_locate('altered', 0.2, 0.2), NULL, 'a simplex as it should be');
ALTER TYPE abacus_simplex ADD ATTRIBUTE extra bigint;
SELECT throws_ok($$ SELECT abacus_locate('altered', 0.2, 0.2) $$, '55000', 'type abacus_simplex has been altered', 'one attribute more: locate');
SELECT throws_ok($$ SELECT abacus_walk('altered', ROW(0, 1, 2, 3, NULL, NULL)::abacus_simplex, 0) $$, '55000', 'type abacus_simplex has been altered', 'walk');
SELECT throws_ok($$ SELECT abacus_simplices('altered') $$, '55000', 'type abacus_simplex has been altered', 'simplices');
SELECT is((SELECT count(*) FROM abacus_vertices('altered')), 3::bigint, 'the points can be read');
SELECT is((SELECT count(*) FROM abacus_locate('altered', 'SELECT 1, 0.2, 0.2') WHERE v0 IS NOT NULL), 1::bigint, 'and places located');
ALTER TYPE abacus_simplex DROP ATTRIBUTE extra;
SELECT throws_ok($$ SELECT abacus_locate('altered', 0.2, 0.2) $$, '55000', 'type abacus_simplex has been altered', 'and dropped again');
-- and the same for leaves
SELECT abacus_octree_create('altered_octree', 2, '{0,0}', '{1,1}', '{v}');
SELECT is((abacus_octree_locate('altered_octree', 0.2, 0.2)).code, 0::bigint, 'a leaf as it should be');
ALTER TYPE abacus_octant ALTER ATTRIBUTE level TYPE bigint;
SELECT throws_ok($$ SELECT * FROM abacus_octants('altered_octree') $$, '55000', 'type abacus_octant has been altered', 'another type');
ALTER TYPE abacus_octant ALTER ATTRIBUTE level TYPE integer;
ALTER TYPE abacus_octant ADD ATTRIBUTE extra bigint;
SELECT throws_ok($$ SELECT abacus_octree_locate('altered_octree', 0.2, 0.2) $$, '55000', 'type abacus_octant has been altered', 'one attribute more: octree_locate');
SELECT throws_ok($$ SELECT * FROM abacus_octants('altered_octree') $$, '55000', 'type abacus_octant has been altered', 'octants');
SELECT throws_ok($$ SELECT * FROM abacus_octants('altered_octree', ARRAY[0,0], ARRAY[1,1]) $$, '55000', 'type abacus_octant has been altered', 'octants of a window');
SELECT is((SELECT count(*) FROM abacus_octree_elements('altered_octree')), 1::bigint, 'the leaves can be read');
SELECT is((SELECT count(*) FROM abacus_octree_neighbours('altered_octree', 0)), 0::bigint, 'and neighbours');
ALTER TYPE abacus_octant DROP ATTRIBUTE extra;
SELECT throws_ok($$ SELECT abacus_octree_locate('altered_octree', 0.2, 0.2) $$, '55000', 'type abacus_octant has been altered', 'and dropped again: octree_locate');

SELECT * FROM finish();
ROLLBACK;
