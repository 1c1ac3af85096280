# A mesh over several servers, read on its coordinator: each function that reads gives what it gives on the mesh of
# one server, in the plane and in space, with attributes beside the simplices and apart, over one shard and more, some
# of them empty.
use strict;
use warnings;

use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $shards = 4;
my $node = PostgreSQL::Test::Cluster->new('coordinator');
$node->init;
$node->append_conf('postgresql.conf', "fsync = off\nmax_connections = 60\nmax_prepared_transactions = 20");
$node->start;
$node->safe_psql('postgres', 'CREATE EXTENSION abacus; CREATE EXTENSION dblink');
my $user = $node->safe_psql('postgres', 'SELECT current_user');
for my $i (1 .. $shards)
{
	$node->safe_psql('postgres', "CREATE DATABASE shard$i");
	$node->safe_psql("shard$i", 'CREATE EXTENSION abacus');
	$node->safe_psql('postgres', sprintf(
		"CREATE SERVER s$i FOREIGN DATA WRAPPER dblink_fdw OPTIONS (host '%s', port '%s', dbname 'shard$i');
		CREATE USER MAPPING FOR CURRENT_USER SERVER s$i OPTIONS (user '$user')", $node->host, $node->port));
}

sub build
{
	my ($count, $dimension, $query, $attributes) = @_;
	my $names = $attributes ? "'{$attributes}'" : 'NULL';
	$node->safe_psql('postgres', sprintf "SELECT abacus_shard_create('many', '{%s}', %d, %s)",
		join(',', map { "s$_" } 1 .. $count), $dimension, $names);
	$node->safe_psql('postgres', "CALL abacus_shard_build('many', '$query')");
	return;
}

# How the rows of each call differ, all in one session: pages that it has are read again.
sub same
{
	my ($what, @calls) = @_;
	my ($script, $out, $err) = ($what =~ /work_mem/ ? "SET work_mem = '64kB';\n" : '', '', '');
	for my $n (0 .. $#calls)
	{
		(my $many = $calls[$n]) =~ s/MESH/'many'/g;
		(my $one = $calls[$n]) =~ s/MESH/'one'/g;
		$script .= "SELECT '$n ' || (SELECT count(*) FROM (
			(SELECT r::text FROM $many AS r EXCEPT ALL SELECT r::text FROM $one AS r) UNION ALL
			(SELECT r::text FROM $one AS r EXCEPT ALL SELECT r::text FROM $many AS r)) AS other) || ' ' || (SELECT count(*) FROM $one AS r);\n";
	}
	$node->psql('postgres', $script, stdout => \$out, stderr => \$err, on_error_stop => 0);
	my %rows = map { /^(\d+) (\d+) (\d+)$/ ? ($1 => [ $2, $3 ]) : () } split /\n/, $out;
	my @wrong = map { !$rows{$_} ? "$calls[$_]: an error" : $rows{$_}[0] > 0 ? "$calls[$_]: $rows{$_}[0] rows differ" : $rows{$_}[1] == 0 && $what !~ /^few/ ? "$calls[$_]: no rows" : () } 0 .. $#calls;
	is(join("\n", @wrong) . $err, '', $what);
	return;
}

my $window = "'{0.2,0.3}'::float8[], '{0.6,0.7}'::float8[]";
my @plane = (
	"abacus_edges(MESH)", "abacus_edges(MESH, $window)", "abacus_edges(MESH, '{0.5,0.5}'::float8[], 0.2)",
	"(SELECT i, abacus_walk(MESH, abacus_locate(MESH, i / 40.0, 1 - i / 41.0), i % 3) FROM generate_series(1, 39) AS i)",
	"(SELECT n.* FROM abacus_neighbours(MESH, abacus_locate(MESH, 0.5, 0.5), 6) AS n)",
	"(SELECT i, abacus_interpolate(MESH, i / 40.0, 1 - i / 41.0, 'h', method => m, outside => 'nearest') FROM generate_series(0, 41) AS i, unnest('{natural,nearest}'::text[]) AS m)",
	"abacus_interpolate(MESH, 'SELECT i AS id, i / 97.0 AS x, (i * 0.618) % 1 AS y FROM generate_series(0, 97) AS i', 'h', method => 'natural', outside => 'nearest')",
	"abacus_weights(MESH, 0.4, 0.6, method => 'natural')",
	"abacus_contours(MESH, 40, attribute => 'h')", "abacus_contours(MESH, 40, polygonize => true, attribute => 'h')",
	"abacus_profile(MESH, '{0.1,0.1,0.9,0.5,0.2,0.8}', 'h')", "abacus_ray(MESH, '{-1,0.4}', '{1,0.05}')",
	"(SELECT abacus_visible(MESH, '{0.2,0.2}', '{0.8,0.8}', 'h', observer_height => 500))",
	"abacus_raster(MESH, '{0,0}', '{1,1}', 30, 20, 'h')", "abacus_raster(MESH, '{0,0}', '{1,1}', 12, 8, 'h', method => 'natural')",
	"abacus_volume(MESH, 100, 'h')", "abacus_hull(MESH)", "abacus_hull(MESH, max_edge => 0.05)",
	"abacus_alpha_shape(MESH, 0.02)", "abacus_voronoi(MESH)", "abacus_voronoi_facets(MESH, $window)", "abacus_spanning_tree(MESH)",
	"(SELECT md5(abacus_draw(MESH, 300, edges => false)))",
	"(SELECT md5(abacus_tile_picture(MESH, 1, 0, 1, world => '{0,0,1}', edges => false)))",
	"(SELECT octet_length(abacus_tile_vector(MESH, 1, 1, 1, world => '{0,0,1}', attribute => 'h', contours => 50)) / 500)",
	"(SELECT md5(abacus_tile_terrain(MESH, 1, 1, 0, world => '{0,0,1}', attribute => 'h')))",
	"abacus_partition(MESH, 3)", "abacus_share_vertices(MESH, 3, 2)", "abacus_share_simplices(MESH, 3, 1)",
	"abacus_numbered_vertices(MESH)", "abacus_numbered_simplices(MESH)", "abacus_attributes(MESH)",
	"(SELECT abacus_srid(MESH))", "abacus_compare(MESH, 'other', 'h')", "abacus_volume(MESH, 'other'::regclass, 'h')");
my $box = "'{0.2,0.3,0.1}'::float8[], '{0.6,0.7,0.8}'::float8[]";
my @space = (
	"abacus_edges(MESH)", "abacus_edges(MESH, $box)",
	"(SELECT i, abacus_walk(MESH, abacus_locate(MESH, i / 40.0, 1 - i / 41.0, 0.5), i % 4) FROM generate_series(1, 39) AS i)",
	"(SELECT i, abacus_interpolate(MESH, i / 40.0, 1 - i / 41.0, 0.4, 'h', method => m, outside => 'nearest') FROM generate_series(0, 41) AS i, unnest('{natural,nearest}'::text[]) AS m)",
	"abacus_ray(MESH, '{-1,0.4,0.5}', '{1,0.05,0.02}')",
	# the last digits of distances depend on the order of corners, in which pages have them
	"(SELECT round(distance::numeric, 12), round(x::numeric, 12), round(value::numeric, 9) FROM abacus_profile(MESH, '{0.1,0.1,0.1,0.9,0.5,0.8}', 'h'))",
	"abacus_raster(MESH, '{0,0,0.5}', '{1,1,0.5}', 12, 8, 'h')", "abacus_volume(MESH, 100, 'h')", "abacus_hull(MESH)",
	"abacus_alpha_shape(MESH, 0.1)", "abacus_voronoi(MESH)", "abacus_voronoi_facets(MESH, $box)", "abacus_spanning_tree(MESH)",
	"abacus_isosurface(MESH, 120, 'h')", "(SELECT code, array_length(polygon, 1), (SELECT round(sum(v)::numeric, 9) FROM unnest(\"values\") AS v) FROM abacus_section(MESH, '{0.5,0.5,0.5}', '{1,1,1}', 'h'))",
	"(SELECT md5(abacus_draw_section(MESH, '{0.5,0.5,0.5}', '{1,0,0}', 200, attribute => 'h')))",
	"(SELECT md5(abacus_draw_volume(MESH, width => 60, attribute => 'h')))",
	"abacus_partition(MESH, 3)", "abacus_share_vertices(MESH, 3, 2)", "abacus_share_simplices(MESH, 3, 1)",
	"abacus_numbered_vertices(MESH)", "abacus_numbered_simplices(MESH)", "abacus_attributes(MESH)");

my %points = (
	2 => 'SELECT i AS id, (i * 0.7548776662466927) % 1 AS x, (i * 0.5698402909980532) % 1 AS y, i % 251 AS h',
	3 => 'SELECT i AS id, (i * 0.8191725133961645) % 1 AS x, (i * 0.6710436067037893) % 1 AS y, (i * 0.5497004779019703) % 1 AS z, i % 251 AS h');
for my $dimension (2, 3)
{
	my $calls = $dimension == 2 ? \@plane : \@space;
	for my $apart (0, 1)
	{
		my $more = $apart ? ', i * 2 AS b, i * 3 AS c, i * 4 AS d, NULL::float8 AS e, i AS f' : '';
		my $query = "$points{$dimension}$more FROM generate_series(1, " . ($dimension == 2 ? 1200 : 400) . ') AS i';
		$node->safe_psql('postgres', "SELECT abacus_triangulate('one', '$query', dimension => $dimension)");
		$node->safe_psql('postgres', "SELECT abacus_triangulate('other', 'SELECT i AS id, (i * 0.618) % 1 AS x, (i * 0.414) % 1 AS y, i % 199 AS h FROM generate_series(1, 90) AS i')") if $dimension == 2;
		for my $count ($apart ? 3 : (1, 2, 4))
		{
			build($count, $dimension, $query);
			same("$dimension dimensions, $count shards" . ($apart ? ', attributes apart' : ''), @$calls);
			$node->safe_psql('postgres', "SELECT abacus_shard_drop('many')");
		}
		$node->safe_psql('postgres', 'DROP TABLE one');
		$node->safe_psql('postgres', 'DROP TABLE other') if $dimension == 2;
	}
}

# ---- Few points, which leave shards empty ---------------------------------------------------------------------

my @few = (
	"abacus_edges(MESH)", "abacus_hull(MESH)", "abacus_contours(MESH, 1, attribute => 'h')", "abacus_voronoi(MESH)", "abacus_numbered_vertices(MESH)",
	"(SELECT i, abacus_locate(MESH, i / 3.0, 1.1) FROM generate_series(0, 9) AS i)", "abacus_volume(MESH, 0, 'h')", "abacus_partition(MESH, 2)",
	"(SELECT i, abacus_interpolate(MESH, i / 3.0, 1.1, 'h', method => 'natural', outside => 'nearest') FROM generate_series(0, 9) AS i)");
my %few = (
	none => 'SELECT i, 0.0, 0.0, i FROM generate_series(1, 0) AS i', one => 'SELECT 1, 1.0, 1.0, 5', line => 'SELECT i, i, 2.0, i FROM generate_series(1, 9) AS i',
	three => 'SELECT i, i % 2, i / 2, i FROM generate_series(1, 3) AS i', five => 'SELECT i, i * i % 5, i, i FROM generate_series(1, 5) AS i',
	cluster => 'SELECT i, CASE WHEN i > 1 THEN 1 + (i * 0.754877) % 1 / 1e6 ELSE 0 END, CASE WHEN i > 1 THEN 1 + (i * 0.569840) % 1 / 1e6 ELSE 0 END, i FROM generate_series(1, 300) AS i',
	far => 'SELECT i, CASE WHEN i > 1 THEN (i * 0.754877) % 1 ELSE 1e300 END, CASE WHEN i > 2 THEN (i * 0.569840) % 1 ELSE -1e300 END, i FROM generate_series(1, 800) AS i');
for my $name (sort keys %few)
{
	my $query = "SELECT q.* FROM ($few{$name}) AS q(id, x, y, h)";
	$node->safe_psql('postgres', "SELECT abacus_create('one', 2, '{h}'); SELECT abacus_insert('one', '$query')");
	build(4, 2, $query, 'h');
	same("few: $name", grep { $name ne 'far' || !/volume/ } @few);
	$node->safe_psql('postgres', "SELECT abacus_shard_drop('many'); DROP TABLE one");
}

# ---- Published tables, other functions, rights, cancelling ----------------------------------------------------

my $query = "$points{2} FROM generate_series(1, 20000) AS i";
build(4, 2, $query);
$node->safe_psql('postgres', "SELECT abacus_triangulate('one', '$query'); SELECT abacus_publish('one'); SELECT abacus_publish('many')");
for my $rows ('SELECT code, v0, v1, v2, h FROM %s_cells', 'SELECT code, v0 FROM %s_cells WHERE code < 900000000000000000', 'SELECT id, x, y, h FROM %s_points WHERE x < 0.3 AND h > 100', 'SELECT count(*) FROM %s_points')
{
	my ($a, $b) = (sprintf($rows, 'many'), sprintf($rows, 'one'));
	is($node->safe_psql('postgres', "SELECT (SELECT count(*) FROM ($a EXCEPT ALL $b) AS x), (SELECT count(*) FROM ($b EXCEPT ALL $a) AS y), (SELECT count(*) > 0 FROM ($b) AS z)"), '0|0|t', $rows);
}
like($node->safe_psql('postgres', 'ANALYZE many_cells; EXPLAIN SELECT * FROM many_cells'), qr/rows=39\d\d\d /, 'how many rows there are');
same('pages that make room for others, work_mem 64 kB', map { $_, $_ } "abacus_contours(MESH, 40, attribute => 'h')", "abacus_edges(MESH, '{0.2,0.2}'::float8[], '{0.8,0.7}'::float8[])",
	"(SELECT i, abacus_interpolate(MESH, (i * 0.618) % 1, (i * 0.414) % 1, 'h', method => 'natural') FROM generate_series(1, 300) AS i)");

sub fails
{
	my ($sql, $pattern, $what) = @_;
	my ($out, $err);
	$node->psql('postgres', $sql, stdout => \$out, stderr => \$err, on_error_stop => 1, extra_params => [ '-v', 'VERBOSITY=verbose' ]);
	like($err, $pattern, $what);
	return;
}
for my $call ("abacus_steps('many')", "abacus_store('many', 1, 2, 1, 'SELECT 1, 2.0')", "abacus_interpolate('many', 0.5, 0.5, step => 1)", "abacus_levels('many', '{1}')",
	"abacus_level('many', 1)", "abacus_constrain('many', 'SELECT 1, 1, 2')", "abacus_label('many', 'SELECT 1, 1, 2, 3, 1')", "abacus_add_attribute('many', 'x')", "abacus_set_srid('many', 4326)")
{
	fails("SELECT * FROM $call", qr/0A000.*lies on several servers/, $call);
}
fails("SELECT abacus_octree_locate('many', 1, 1)", qr/42809.*"many" is a mesh, not an octree/, 'an octree');
fails("SELECT * FROM abacus_contours('many', 10, attribute => 'nothing')", qr/42703.*no attribute "nothing"/, 'an attribute that is not there');
$node->safe_psql('postgres', 'CREATE USER reader');
fails("SET ROLE reader; SELECT count(*) FROM abacus_edges('many')", qr/42501.*permission denied for table many/, 'no right to the table');
$node->safe_psql('postgres', 'GRANT SELECT ON many TO reader');
fails("SET ROLE reader; SELECT count(*) FROM abacus_edges('many')", qr/42501.*permission denied for foreign server/, 'no right to a server');
fails("SET ROLE reader; SELECT count(*) FROM abacus_edges('many'); ", qr/42501/, 'not after an error either');
fails("SELECT count(*) FROM abacus_edges('many'); SET ROLE reader; SELECT count(*) FROM abacus_edges('many')", qr/42501.*permission denied for foreign server/, 'not with pages that another user has read');
fails("SELECT abacus_walk('many', abacus_locate('many', 0.5, 0.5), 0); SET ROLE reader; SELECT abacus_locate('many', 0.5, 0.5)", qr/42501.*permission denied for foreign server/, 'nor in the cache');
# A user who may use the servers, as somebody who may not read there.
$node->safe_psql('postgres', "CREATE USER poor; CREATE USER other SUPERUSER");
$node->safe_psql('postgres', "CREATE USER MAPPING FOR other SERVER s$_ OPTIONS (user 'poor')") for 1 .. $shards;
for my $call ("count(*) FROM abacus_edges('many')", "abacus_locate('many', 0.5, 0.5) IS NULL", "count(*) FROM many_points")
{
	fails("SELECT $call; SET ROLE other; SELECT $call", qr/42501.*permission denied for table abacus_/, "no right on the servers: $call");
}
fails("SET statement_timeout = 100; SELECT count(*) FROM generate_series(1, 1000) AS i, abacus_edges('many')", qr/57014/, 'a timeout');

# Changes that are undone leave nothing in the session's memory, though versions after them are the same again.
$node->safe_psql('postgres', "SELECT abacus_insert('one', 'SELECT 900002, 0.7003, 0.2004, 5000')");
my $differ = 'SELECT (SELECT count(*) FROM (' . join(' UNION ALL ', map { "(SELECT r::text FROM $_->[0] AS r EXCEPT ALL SELECT r::text FROM $_->[1] AS r)" }
	map { my $call = $_; ([ map { sprintf $call, $_ } 'many', 'one' ], [ map { sprintf $call, $_ } 'one', 'many' ]) } "abacus_edges('%s')", "(SELECT i, abacus_locate('%s', i / 50.0, 0.2004) FROM generate_series(1, 49) AS i)") . ') AS d)';
my $undone = "SELECT abacus_insert('many', 'SELECT 900001, 0.4001, 0.3002, 9000'); SELECT count(*) > 0 FROM abacus_edges('many'); SELECT abacus_locate('many', 0.4002, 0.3002) IS NULL";
is($node->safe_psql('postgres', "BEGIN; $undone; ROLLBACK; SELECT abacus_insert('many', 'SELECT 900002, 0.7003, 0.2004, 5000'); $differ"), "1\nt\nf\n1\n0", 'a change undone, and another');
is($node->safe_psql('postgres', "SELECT abacus_delete('many', 'SELECT 900002, 0.7003, 0.2004'); BEGIN; SAVEPOINT a; $undone; ROLLBACK TO a; SELECT abacus_insert('many', 'SELECT 900002, 0.7003, 0.2004, 5000'); $differ; COMMIT; $differ"),
	"1\n1\nt\nf\n1\n0\n0", 'and in a savepoint');
$node->safe_psql('postgres', "SELECT abacus_delete('one', 'SELECT 900002, 0.7003, 0.2004'); SELECT abacus_delete('many', 'SELECT 900002, 0.7003, 0.2004')");
is($node->safe_psql('postgres', $differ), 0, 'after all of them');

# What servers send is not trusted: forged pages are data_corrupted.
my $pages = 'abacus_shard_pages(mesh, kind, "first", "last", from_code, from_part, bytes)';
for my $forged (
	[ "SELECT code, part, set_byte(page, 100, 255 - get_byte(page, 100)) FROM public.$pages", 'wrong checksum' ],
	[ "SELECT code, part, ''::bytea FROM public.$pages WHERE page IS NOT NULL UNION ALL SELECT 9223372036854775807, 0, NULL", 'impossible size' ],
	[ "SELECT code, part, page FROM public.$pages WHERE page IS NOT NULL", 'do not follow one another' ],
	[ "SELECT code, part, page || page || page FROM public.$pages", 'do not follow one another' ],
	[ "SELECT -code, part, page FROM public.$pages", 'do not follow one another' ],
	[ 'SELECT from_code + 1000, from_part, NULL::bytea', 'corrupted' ],
	[ "SELECT from_code, from_part, page FROM public.abacus_shard_pages(mesh, kind, \"first\", \"last\", \"first\", 0, bytes) WHERE page IS NOT NULL UNION ALL SELECT 9223372036854775807, 0, NULL", 'corrupted|follow' ])
{
	$node->safe_psql('shard2', "CREATE SCHEMA IF NOT EXISTS $user");
	$node->safe_psql('shard2', "CREATE FUNCTION $user.abacus_shard_pages(mesh regclass, kind int, \"first\" bigint, \"last\" bigint, from_code bigint, from_part bigint, bytes int) RETURNS TABLE (code bigint, part bigint, page bytea) LANGUAGE sql AS \$\$ $forged->[0] \$\$");
	fails("SELECT count(*) FROM abacus_edges('many')", qr/XX001.*($forged->[1])/s, "forged: $forged->[0]");
	$node->safe_psql('shard2', "DROP FUNCTION $user.abacus_shard_pages");
}

# Errors of servers, also in the middle of reading; the session goes on afterwards.
my $broken = "DO \$\$ BEGIN PERFORM count(*) FROM abacus_edges('many'); RAISE NOTICE 'read'; EXCEPTION WHEN others THEN RAISE NOTICE 'failed: %', SQLSTATE; END \$\$";
my ($shard) = $node->safe_psql('postgres', "SELECT shard_mesh FROM abacus_shards('many') WHERE shard = 3");
$node->safe_psql('shard3', "ALTER TABLE $shard RENAME TO hidden");
my ($out, $err);
$node->psql('postgres', "$broken; SELECT 1", stdout => \$out, stderr => \$err);
like("$out $err", qr/^1 .*failed: 42P01/, 'a table is missing on a server');
$node->safe_psql('shard3', "ALTER TABLE hidden RENAME TO $shard");
$node->psql('postgres', "BEGIN; SAVEPOINT a; SELECT abacus_locate('many', 0.5, 0.5) IS NULL; SELECT 1 / 0; ROLLBACK TO a; $broken; SELECT abacus_locate('many', 0.2, 0.7) IS NULL; COMMIT",
	stdout => \$out, stderr => \$err, on_error_stop => 0);
like("$out $err", qr/^f\nf.*read/s, 'after an error in a subtransaction');
is($node->safe_psql('postgres', "SELECT abacus_unpublish('many') = abacus_unpublish('one')"), 't', 'unpublished');
$node->safe_psql('postgres', "SELECT abacus_shard_drop('many')");
done_testing();
