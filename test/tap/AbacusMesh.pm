# Questions of the TAP tests to a mesh, through a PostgreSQL::Test::Cluster node.
package AbacusMesh;

use strict;
use warnings;

use Exporter 'import';
use Test::More;

our @EXPORT = qw(has_shortcuts mesh_figure mesh_content mesh_labels mesh_bytes mesh_pages spread_mesh create_rest other_simplices is_sound is_intact);

# Whether the module does more than PostgreSQL offers to extensions (abacus.shortcuts).
sub has_shortcuts
{
	my ($node) = @_;
	return $node->safe_psql('postgres', "LOAD 'abacus'; SHOW abacus.shortcuts") eq 'on';
}

# Value of a row of abacus_stats.
sub mesh_figure
{
	my ($node, $database, $mesh, $name) = @_;
	return $node->safe_psql($database,
		"SELECT value FROM abacus_stats('$mesh') WHERE name = '$name'");
}

# Digests of the simplices and of the points of a mesh, whatever their order.
sub mesh_content
{
	my ($node, $database, $mesh) = @_;
	return $node->safe_psql($database, <<"SQL");
SELECT 'simplices ' || count(*) || ' ' || md5(string_agg(s, ' ' ORDER BY s))
FROM (SELECT concat_ws(' ', v0, v1, v2, v3) AS s FROM abacus_simplices('$mesh') OFFSET 0) AS t;
SELECT 'points ' || count(*) || ' ' || md5(string_agg(p, ' ' ORDER BY p))
FROM (SELECT concat_ws(' ', id, x, y, z, attributes, vertex) AS p FROM abacus_vertices('$mesh') OFFSET 0) AS t;
SQL
}

# Digests of the labels of its simplices and of the markers of its facets.
sub mesh_labels
{
	my ($node, $database, $mesh) = @_;
	return $node->safe_psql($database, <<"SQL");
SELECT 'labels ' || count(labels[1]) || ' ' || md5(string_agg(concat_ws(' ', corners, labels), ' ' ORDER BY corners)) FROM abacus_cells('$mesh');
SELECT 'markers ' || count(*) || ' ' || md5(string_agg(concat_ws(' ', corners, marker), ' ' ORDER BY corners)) FROM abacus_facets('$mesh');
SQL
}

# Digest of all bytes stored in a table of pages.
sub mesh_bytes
{
	my ($node, $database, $table) = @_;
	return $node->safe_psql($database,
		"SELECT md5(string_agg(t::text, ' ' ORDER BY t::text COLLATE \"C\")) FROM $table AS t");
}

# Heap pages of both tables.
sub mesh_pages
{
	my ($node, $database, $mesh) = @_;
	return $node->safe_psql($database,
		"SELECT (pg_relation_size('$mesh') + pg_relation_size('${mesh}_vertices')) / 8192");
}

# Moves all rows from the first half of their table to a second one.
sub spread_mesh
{
	my ($node, $database, $mesh) = @_;
	$node->safe_psql($database, "UPDATE $mesh SET part = part; UPDATE ${mesh}_vertices SET part = part");
	return;
}

# A function rest(cursor): how many rows of a cursor are still to come, all fetched.
sub create_rest
{
	my ($node, $database) = @_;
	$node->safe_psql($database, <<'SQL');
CREATE FUNCTION rest(cursor refcursor) RETURNS bigint LANGUAGE plpgsql AS $$
DECLARE
	rows bigint;
BEGIN
	MOVE FORWARD ALL FROM cursor;
	GET DIAGNOSTICS rows = ROW_COUNT;
	RETURN rows;
END $$
SQL
	return;
}

# How many simplices one mesh has that the other lacks.
sub other_simplices
{
	my ($node, $database, $mesh, $wanted, $dimension) = @_;
	my $corners = join ', ', map { "v$_" } 0 .. $dimension;
	return $node->safe_psql($database, <<"SQL");
SELECT count(*) FROM (
	(SELECT $corners FROM abacus_simplices('$mesh') EXCEPT ALL
	 SELECT $corners FROM abacus_simplices('$wanted')) UNION ALL
	(SELECT $corners FROM abacus_simplices('$wanted') EXCEPT ALL
	 SELECT $corners FROM abacus_simplices('$mesh'))) AS other
SQL
}

# A test: abacus_check finds no fault.
sub is_sound
{
	my ($node, $database, $mesh, $what) = @_;
	return is($node->safe_psql($database, "SELECT * FROM abacus_check('$mesh')"),
		'', "$what: the mesh is sound");
}

# Two tests: amcheck also finds none in its tables and indexes. Needs the extension amcheck.
sub is_intact
{
	my ($node, $database, $mesh, $what) = @_;
	is_sound($node, $database, $mesh, $what);
	return is(
		$node->safe_psql($database, <<"SQL"), "|\n0", "$what: so are tables and indexes");
SELECT bt_index_check('${mesh}_pkey', true), bt_index_check('${mesh}_vertices_pkey', true);
SELECT (SELECT count(*) FROM verify_heapam('$mesh')) + (SELECT count(*) FROM verify_heapam('${mesh}_vertices'));
SQL
}

1;
