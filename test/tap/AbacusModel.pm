# Meshes whose points are noted in a table by the transactions that change them. So the content of the mesh is
# known for every snapshot.
#
#     mesh2, mesh3               the meshes, by dimension
#     mesh2_noted, mesh3_noted   their points
#     change(dimension)          a function: one random change of both
#     wrong(dimension)           a function: how many points differ
package AbacusModel;

use strict;
use warnings;

use Exporter 'import';
use Test::More;

use AbacusMesh;

our @EXPORT = qw(make_models is_as_noted);

sub make_models
{
	my ($node) = @_;
	$node->safe_psql('postgres', <<'SQL');
CREATE SEQUENCE numbers START 10000 INCREMENT 1000;
CREATE FUNCTION columns(dimension int) RETURNS text LANGUAGE sql IMMUTABLE AS
	$$ SELECT CASE dimension WHEN 2 THEN 'id, x, y' ELSE 'id, x, y, z' END $$;

-- Takes the noted points that a query names out of both.
CREATE FUNCTION take_away(dimension int, ids text) RETURNS void LANGUAGE plpgsql AS $$
DECLARE
	gone text;
BEGIN
	EXECUTE format('WITH gone AS (DELETE FROM mesh%1$s_noted WHERE id IN (%2$s) RETURNING %3$s)
		SELECT string_agg(format(''(%%s, %%s::float8, %%s::float8%4$s)'', %3$s), '', '') FROM gone',
		dimension, ids, columns(dimension), CASE dimension WHEN 3 THEN ', %s::float8' END) INTO gone;
	IF gone IS NOT NULL THEN
		PERFORM abacus_delete('mesh' || dimension, 'VALUES ' || gone);
	END IF;
END $$;

-- What is done is left to chance. Numbers of the fresh points are in no other change.
CREATE FUNCTION change(dimension int) RETURNS void LANGUAGE plpgsql AS $$
DECLARE
	mesh text := 'mesh' || dimension;
	noted text := mesh || '_noted';
	corners text := CASE dimension WHEN 2 THEN 'v0, v1, v2' ELSE 'v0, v1, v2, v3' END;
	first bigint := nextval('numbers');
	fresh text := format('SELECT %s FROM %s WHERE id >= %s AND id < %s + 1000 ORDER BY id', columns(dimension), noted, first, first);
	undo text := format('DELETE FROM %s WHERE id >= %s AND id < %s + 1000', noted, first, first);
BEGIN
	-- some near each other, some outside of all before, some where others are
	EXECUTE format('INSERT INTO %1$s SELECT %2$s + i, c[1] + $1 * random(), c[2] + $1 * random(), c[3] + $1 * random()
			FROM generate_series(0, $2) i, (SELECT ARRAY[random(), random(), random()] AS c) AS centre
			UNION ALL SELECT %2$s + 900 + row_number() OVER (), x, y, z FROM (SELECT * FROM %1$s ORDER BY id DESC LIMIT 5) AS other',
			noted, first) USING power(random(), 6), (random() * 100)::int;
	CASE floor(random() * 8)
	WHEN 0 THEN
		PERFORM abacus_insert(mesh, fresh);
	WHEN 1 THEN
		PERFORM abacus_stage(mesh, fresh), abacus_triangulate(mesh);
	WHEN 2 THEN -- the triangulation undone, and done again
		PERFORM abacus_stage(mesh, fresh);
		BEGIN
			PERFORM abacus_triangulate(mesh);
			RAISE division_by_zero;
		EXCEPTION WHEN division_by_zero THEN
			NULL;
		END;
		PERFORM abacus_triangulate(mesh);
	WHEN 3 THEN -- all undone
		BEGIN
			PERFORM abacus_insert(mesh, fresh);
			RAISE division_by_zero;
		EXCEPTION WHEN division_by_zero THEN
			EXECUTE undo;
		END;
	WHEN 4 THEN -- others go, now and then nearly all
		PERFORM abacus_insert(mesh, fresh);
		PERFORM take_away(dimension, format('SELECT id FROM %s ORDER BY random() LIMIT %s', noted,
				CASE WHEN random() < 0.03 THEN 'greatest(0, (SELECT count(*) - 7 FROM ' || noted || '))' ELSE '300 * random()' END));
	WHEN 5 THEN -- those near a place go; once more, after it has been undone
		PERFORM abacus_insert(mesh, fresh);
		BEGIN
			PERFORM take_away(dimension, format('SELECT id FROM %s WHERE x < 0.3', noted));
			RAISE division_by_zero;
		EXCEPTION WHEN division_by_zero THEN
			NULL;
		END;
		PERFORM take_away(dimension, format('SELECT id FROM %s WHERE abs(x - %s) + abs(y - %s) < 0.1', noted, random(), random()));
	WHEN 6 THEN -- all pages are written twice
		PERFORM abacus_insert(mesh, fresh);
		PERFORM abacus_add_attribute(mesh, 'a');
		PERFORM abacus_drop_attribute(mesh, 'a');
	WHEN 7 THEN -- labels and markers that tell whose they are
		PERFORM abacus_insert(mesh, fresh);
		PERFORM abacus_label(mesh, format('SELECT code, %s, (SELECT max(c) FROM unnest(corners) c) AS greatest FROM abacus_cells(%L)', corners, mesh));
		PERFORM abacus_mark(mesh, format('SELECT code, %s, 0, hashfloat8((SELECT max(c) FROM unnest(corners[2:]) c)) FROM abacus_cells(%L) WHERE v0 %% 3 = 0', corners, mesh));
	END CASE;
END $$;

CREATE FUNCTION wrong(dimension int) RETURNS bigint LANGUAGE plpgsql STABLE AS $$
DECLARE
	differ bigint;
BEGIN
	EXECUTE format('SELECT count(*) FROM (
		(SELECT %1$s FROM mesh%2$s_noted EXCEPT ALL SELECT %1$s FROM abacus_vertices(''mesh%2$s'')) UNION ALL
		(SELECT %1$s FROM abacus_vertices(''mesh%2$s'') EXCEPT ALL SELECT %1$s FROM mesh%2$s_noted)) AS other',
		columns(dimension), dimension) INTO differ;
	RETURN differ;
END $$;

-- The simplices of a mesh, each by the least number noted at the places of its corners: which
-- of several points at one place gives the vertex its id depends on which session came first.
CREATE FUNCTION simplices(mesh text, dimension int) RETURNS SETOF bigint[] LANGUAGE plpgsql STABLE AS $$
BEGIN
	RETURN QUERY EXECUTE format('
		WITH place AS MATERIALIZED (SELECT id, min(id) OVER (PARTITION BY %s) AS number FROM mesh%s_noted)
		SELECT (SELECT array_agg(v ORDER BY v) FROM unnest(ARRAY[a.number, b.number, c.number, d.number]) AS v)
		FROM abacus_simplices(%L) AS s JOIN place AS a ON a.id = v0 JOIN place AS b ON b.id = v1
			JOIN place AS c ON c.id = v2 LEFT JOIN place AS d ON d.id = v3',
		substr(columns(dimension), 5), dimension, mesh);
END $$;
CREATE FUNCTION other_simplices(dimension int) RETURNS bigint LANGUAGE sql STABLE AS $$
	SELECT count(*) FROM (
		(SELECT * FROM simplices('mesh' || dimension, dimension) EXCEPT ALL SELECT * FROM simplices('wanted', dimension)) UNION ALL
		(SELECT * FROM simplices('wanted', dimension) EXCEPT ALL SELECT * FROM simplices('mesh' || dimension, dimension))) AS other $$;
SQL
	for my $d (2, 3)
	{
		$node->safe_psql('postgres', <<"SQL");
SELECT abacus_create('mesh$d', $d);
CREATE TABLE mesh${d}_noted (id bigint PRIMARY KEY, x float8, y float8, z float8);
INSERT INTO mesh${d}_noted SELECT i, random(), random(), random() FROM generate_series(1, 1000) AS i;
SELECT abacus_insert('mesh$d', 'SELECT ' || columns($d) || ' FROM mesh${d}_noted');
SQL
	}
	return;
}

# Six tests: it has exactly the points of the committed changes, exactly their simplices, labels and markers,
# and sound pages and indexes.
sub is_as_noted
{
	my ($node, $d, $what) = @_;
	is($node->safe_psql('postgres', "SELECT wrong($d)"), 0, "$what: the points of what is committed, and no other");
	$node->safe_psql('postgres', <<"SQL");
DROP TABLE IF EXISTS wanted;
SELECT abacus_triangulate('wanted', 'SELECT ' || columns($d) || ' FROM mesh${d}_noted ORDER BY id', dimension => $d);
SQL
	is(other_simplices($node, 'postgres', "mesh$d", 'wanted', $d)
		  && $node->safe_psql('postgres', "SELECT other_simplices($d)"), 0, "$what: their simplices");
	is($node->safe_psql('postgres', "SELECT count(*) FROM abacus_cells('mesh$d') WHERE labels[1] <> (SELECT max(c) FROM unnest(corners) c)"),
		0, "$what: labels are where they were put");
	is($node->safe_psql('postgres', "SELECT count(*) FROM abacus_facets('mesh$d') WHERE marker <> hashfloat8((SELECT max(c) FROM unnest(corners) c))"),
		0, "$what: so are markers");
	return is_intact($node, 'postgres', "mesh$d", $what);
}

1;
