# What the free space map is told of a mesh's heap pages: of new ones that were not used, of
# pages that another session has filled, and of pages too full of dead line pointers.
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
$node->append_conf('postgresql.conf', "fsync = off\nautovacuum = off");
$node->start;
sub sql { return $node->safe_psql('postgres', $_[0]); }
sub map_bytes { return sql("SELECT pg_relation_size('$_[0]', 'fsm')"); }

sql(<<'SQL');
CREATE EXTENSION abacus; CREATE EXTENSION pg_freespacemap;
SELECT setseed(0.5);
CREATE TABLE points AS SELECT n AS id, random() AS x, random() AS y FROM generate_series(1, 400000) AS n;
CREATE FUNCTION unused(mesh regclass) RETURNS bigint[] LANGUAGE sql AS
	$$ SELECT coalesce(array_agg(blkno), '{}') FROM pg_freespace(mesh) WHERE avail >= 8128 $$;
CREATE FUNCTION written(mesh regclass, blocks bigint[]) RETURNS bigint LANGUAGE plpgsql AS $$
DECLARE
	n bigint;
BEGIN
	EXECUTE format('SELECT count(DISTINCT (ctid::text::point)[0]) FROM %s WHERE (ctid::text::point)[0] = ANY ($1)', mesh)
		INTO n USING blocks;
	RETURN n;
END $$;
SQL

# abacus_build looks at all heap pages at its end, and so does VACUUM where the module is loaded.
sql("SELECT abacus_create('built', 2)");
sql("SELECT abacus_stage('built', 'SELECT * FROM points WHERE id <= 200000')");
sql("CALL abacus_build('built')");
my $blocks = sql("SELECT unused('built')");
isnt($blocks, '{}', 'a build has left new heap pages');
sql("LOAD 'abacus'; VACUUM built");
my $after = sql("SELECT unused('built')");
$after =~ tr/{}//d;
my $pages = sql("SELECT pg_relation_size('built') / 8192");
is(sql("SELECT count(*) FROM unnest('$blocks'::bigint[]) AS b WHERE b < $pages AND b NOT IN (0" . ($after ne '' ? ",$after" : '') . ')'),
	0, 'VACUUM has cut them or leaves them in the map');
sql("SELECT abacus_insert('built', 'SELECT * FROM points WHERE id > 200000')");
# ... but perhaps for one whose row has been replaced once more
my $left = sql("SELECT count(*) FROM unnest('$blocks'::bigint[]) AS b WHERE b < $pages");
cmp_ok(sql("SELECT written('built', ARRAY(SELECT b FROM unnest('$blocks'::bigint[]) AS b WHERE b < $pages))"),
	'>=', 0.9 * $left, "the next statement writes those $left");
is_sound($node, 'postgres', 'built', 'after it');

# Two sessions in turns: what the one has left, and remembers, the other one fills. Rows are replaced
# all the time and VACUUM never comes, so that line pointers of dead rows fill the pages.
sql("SELECT abacus_triangulate('$_', 'SELECT * FROM points WHERE id <= 6000')") for qw(turns tight);
sql('ALTER TABLE tight SET (fillfactor = 90)');
for my $mesh (qw(turns tight))
{
	my $fresh = sql("SELECT pg_relation_size('$mesh')");
	my @sessions = map { $node->background_psql('postgres') } 1 .. 2;
	for my $n (1 .. 149)
	{
		my $some = 'SELECT * FROM points WHERE id BETWEEN ' . 40 * $n . ' AND ' . (40 * $n + ($n % 3 == 0 ? 39 : 1));
		$sessions[$n % 2]->query_safe("SELECT abacus_delete('$mesh', '$some')");
		$sessions[$n / 2 % 2]->query_safe("SELECT abacus_insert('$mesh', '$some')");
	}
	$_->quit for @sessions;
	cmp_ok(map_bytes($mesh), '<=', 65536, "$mesh: the map is small");
	cmp_ok(sql("SELECT pg_relation_size('$mesh')"), '<=', 4 * $fresh, "$mesh: so is the table");
	is_sound($node, 'postgres', $mesh, 'after them');
	is(mesh_figure($node, 'postgres', $mesh, 'points'), 6000, "$mesh: all points are there");
}

$node->stop;
done_testing();
