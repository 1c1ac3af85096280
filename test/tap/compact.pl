# abacus_build moves the rows of a mesh to the beginning of its tables, so that VACUUM can cut them: after
# statements that changed points all over the mesh, beside readers, and under kill -9.
#
#     ABACUS_KILLS   how many times (default 8)
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusCrash;
use AbacusMesh;
use PostgreSQL::Test::Utils;
use Test::More;

my $kills = $ENV{ABACUS_KILLS} || 8;
my @meshes = (
	{ name => 'plane', dimension => 2, columns => 'id, x, y', points => 60_000 },
	{ name => 'solid', dimension => 3, columns => 'id, x, y, z', points => 15_000 });

my $node = crash_node('compact');
$node->append_conf('postgresql.conf', 'autovacuum = off');
$node->restart;
sub sql { return $node->safe_psql('postgres', $_[0]); }
sub content { return mesh_content($node, 'postgres', $_[0]); }
sub size { return sql("SELECT pg_total_relation_size('$_[0]') + pg_total_relation_size('$_[0]_vertices')"); }

sql(q{SELECT setseed(0.5);
	CREATE TABLE points AS
	SELECT i AS id, random() AS x, random() AS y, random() AS z, random() AS turn FROM generate_series(1, 60000) AS i;});
create_rest($node, 'postgres');

# Statements that remove a twentieth of the points, and insert them again.
sub change
{
	my ($m, $times) = @_;
	for (1 .. $times)
	{
		my $turn = $m->{turn}++ % 20;
		my $some = "SELECT $m->{columns} FROM points WHERE id <= $m->{points} AND floor(turn * 20) = $turn";
		sql("SELECT abacus_delete('$m->{name}', '$some'); SELECT abacus_insert('$m->{name}', '$some')");
	}
	return;
}

for my $m (@meshes)
{
	my $mesh = $m->{name};
	sql("SELECT abacus_triangulate('$mesh', 'SELECT $m->{columns} FROM points WHERE id <= $m->{points}', dimension => $m->{dimension})");
	$m->{fresh} = size($mesh);
	my $header = "SELECT xmin FROM $mesh WHERE code = -1";
	my $before = sql($header);
	sql("CALL abacus_build('$mesh')");
	is(sql($header), $before, "$mesh: a fresh mesh stays as it is");

	change($m, 3);
	$m->{content} = content($mesh);
	sql("VACUUM $mesh");
	cmp_ok(size($mesh), '>', 1.6 * $m->{fresh}, "$mesh: VACUUM alone does not cut it");

	# A session that knows the places of pages, since it has read them.
	my $places = "SELECT sum(hashint8(v0) + hashint8(v1) * 2::bigint + hashint8(v2) * 3::bigint) FROM points p,
		LATERAL abacus_locate('$mesh', " . ($m->{dimension} == 2 ? 'y, x' : 'y, z, x') . ') WHERE id <= 20000';
	my $locator = $node->background_psql('postgres');
	$locator->query_safe("SET abacus.cache_size = '1MB'");
	my $located = $locator->query_safe($places);

	# A session in the middle of a cursor, with the mesh in its cache.
	my $reader = $node->background_psql('postgres', on_error_stop => 0);
	$reader->query_safe("BEGIN ISOLATION LEVEL REPEATABLE READ;
		DECLARE reading CURSOR FOR SELECT v0, v1, v2 FROM abacus_simplices('$mesh'); MOVE 1000 FROM reading");
	$before = sql($header);
	sql("CALL abacus_build('$mesh')");
	isnt(sql($header), $before, "$mesh: pages are moved beside a reader");
	is(content($mesh), $m->{content}, "$mesh: ... into the same mesh");
	my $grown = size($mesh);
	sql("CALL abacus_build('$mesh'); CALL abacus_build('$mesh'); VACUUM $mesh");
	cmp_ok(size($mesh), '<=', $grown, "$mesh: ... again and again");
	is($locator->query_safe($places), $located, "$mesh: ... and where the pages have gone is found");
	is(1000 + $reader->query_safe("SELECT rest('reading')"), mesh_figure($node, 'postgres', $mesh, 'simplices'),
		"$mesh: ... who reads on");
	is($reader->query_safe("SELECT count(*) FROM abacus_check('$mesh')"), 0, "$mesh: ... all of it");
	$reader->query("SELECT abacus_insert('$mesh', 'SELECT 0, 0.5, 0.5" . ', 0.5' x ($m->{dimension} - 2) . "')");
	like($reader->{stderr}, qr/could not serialize access/, "$mesh: ... but cannot write");
	$reader->{stderr} = '';
	$reader->query_safe('ROLLBACK');
	$reader->quit;

	sql("CALL abacus_build('$mesh'); VACUUM (INDEX_CLEANUP ON) $mesh");
	cmp_ok(size($mesh), '<=', 1.1 * $m->{fresh}, "$mesh: hardly larger than a fresh one");
	is(content($mesh), $m->{content}, "$mesh: the same mesh");
	is($locator->query_safe($places), $located, "$mesh: ... also for who knew pages where the table is cut");
	$locator->quit;
	is_intact($node, 'postgres', $mesh, $mesh);
}

# Whatever happens in between, the mesh is the same, and the next call continues. An UPDATE is the shortest
# way to spread the rows over the table again.
for my $n (1 .. $kills)
{
	my $m = $meshes[ $n % @meshes ];
	my $mesh = $m->{name};
	my (undef, $victim) = run_and_strike($node, <<"SQL", 0.5, sub { });
DO \$\$
BEGIN
	LOOP
		UPDATE $mesh SET part = part;
		COMMIT;
		CALL abacus_build('$mesh');
	END LOOP;
END \$\$
SQL
	is(content($mesh), $m->{content}, "$mesh, $victim: the same mesh");
	is_intact($node, 'postgres', $mesh, "$mesh, $victim");
	# also before: each heap page has been used hundreds of times
	sql("VACUUM $mesh; CALL abacus_build('$mesh'); VACUUM (INDEX_CLEANUP ON) $mesh");
	# a few heap pages are not worth it
	cmp_ok(sql("SELECT pg_relation_size('$mesh') / 8192"), '<=', 8 / 7 * (sql("SELECT count(*) FROM $mesh") + 64),
		"$mesh, $victim: few heap pages are empty");
	change($m, 1);
}
is(content($_->{name}), $_->{content}, "$_->{name}: the same mesh after further changes") for @meshes;

# Pages of repeated points lie behind those of staged points.
sql("SELECT abacus_create('twice', 2)");
sql("SELECT abacus_stage('twice', 'SELECT id, x, y FROM points UNION ALL SELECT -id, x, y FROM points WHERE id <= 3000')");
my $staged = sql("SELECT pg_relation_size('twice_vertices')");
sql("CALL abacus_build('twice', 10000); VACUUM (INDEX_CLEANUP ON) twice_vertices");
cmp_ok(sql("SELECT pg_relation_size('twice_vertices')"), '<', 0.2 * $staged, 'twice: the vertex table is cut');
is(mesh_figure($node, 'postgres', 'twice', 'inserted'), 63_000, 'twice: all points are there');
is_intact($node, 'postgres', 'twice', 'twice');

$node->stop;
done_testing();
