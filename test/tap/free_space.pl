# What the free space map knows about a mesh's heap pages: new ones that were not used, and empty ones that
# another session has filled in the meantime.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $node = PostgreSQL::Test::Cluster->new('free_space');
$node->init;
$node->append_conf('postgresql.conf', "fsync = off\nautovacuum = off\n" .
	"abacus.threads = 1");  # the number of unused pages depends on the layout, which threads change
$node->start;
sub sql { return $node->safe_psql('postgres', $_[0]); }

sql(<<'SQL');
CREATE EXTENSION abacus; CREATE EXTENSION pg_freespacemap; CREATE EXTENSION pageinspect;
SELECT setseed(0.5);
CREATE TABLE points AS SELECT n AS id, random() AS x, random() AS y FROM generate_series(1, 400000) AS n;
-- heap pages that never had a row, and what the map takes their room for
CREATE FUNCTION zeros(mesh regclass) RETURNS TABLE (block bigint, avail int) LANGUAGE sql AS
	$$ SELECT b, pg_freespace(mesh, b) FROM generate_series(0, pg_relation_size(mesh) / 8192 - 1) AS b
	   WHERE get_raw_page(mesh::text, b::int) = decode(repeat('00', 8192), 'hex') $$;
SQL
my $unknown = "SELECT count(*) FROM zeros('built') WHERE avail < 8128";

# abacus_build reads all heap pages at its end, and so does VACUUM if the module is loaded.
sql("SELECT abacus_create('built', 2)");
sql("SELECT abacus_stage('built', 'SELECT * FROM points WHERE id <= 200000')");
sql("CALL abacus_build('built')");
sql("CREATE TABLE left_over AS SELECT block FROM zeros('built')");
SKIP:
{
	skip 'built without shortcuts', 1 unless has_shortcuts($node) || sql('SHOW server_version_num') >= 160000;
	cmp_ok(sql('SELECT count(*) FROM left_over'), '>', 0, 'a build has left new heap pages');
}
is(sql($unknown), 0, 'the map knows them');
sql("LOAD 'abacus'; VACUUM built");
is(sql($unknown), 0, '... after VACUUM, too');
sql("SELECT abacus_insert('built', 'SELECT * FROM points WHERE id > 200000')");
is(sql("SELECT count(*) FROM left_over JOIN zeros('built') USING (block)"), 0, 'the next statement writes them');
is_sound($node, 'postgres', 'built', 'after it');

# A session remembers pages that it has left empty, and finds them filled: none of them has room for its next
# rows, nor has any other page.
for my $fill (100, 90)
{
	my $mesh = "filled$fill";
	my $some = sub { "'SELECT * FROM points WHERE id <= 6000 AND id % 20 = $_[0]'" };
	sql("SELECT abacus_triangulate('$mesh', 'SELECT * FROM points WHERE id <= 6000')");
	sql("ALTER TABLE $mesh SET (fillfactor = $fill)");
	my $session = $node->background_psql('postgres');
	$session->query_safe("SELECT abacus_delete('$mesh', " . $some->(1) . ')');
	$session->query_safe("SELECT abacus_insert('$mesh', " . $some->(1) . ')');
	$session->query_safe("SELECT abacus_delete('$mesh', 'SELECT * FROM points WHERE id = 2')");
	sql("UPDATE $mesh SET part = part");
	$session->query_safe("SELECT abacus_delete('$mesh', " . $some->(7) . ')');
	$session->quit;
	cmp_ok(sql("SELECT pg_relation_size('$mesh', 'fsm')"), '<=', 65536, "$mesh: the map is small");
	is_sound($node, 'postgres', $mesh, 'after it');
	is(mesh_figure($node, 'postgres', $mesh, 'points'), 5699, "$mesh: all other points are there");
}

$node->stop;
done_testing();
