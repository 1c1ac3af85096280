# The space of replaced pages: a table that grew while old versions were still visible returns to its size.
# Pages are written to the first heap pages that have become empty, so that VACUUM can cut the rest.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $node = PostgreSQL::Test::Cluster->new('space');
$node->init;
$node->append_conf('postgresql.conf', "fsync = off\nautovacuum = off");
$node->start;

# Each change is a transaction of its own, and affects a few of the mesh's pages.
$node->safe_psql('postgres', <<'SQL');
CREATE EXTENSION abacus;
-- always the same places: they decide how far back a row lies that has not been replaced since
SELECT setseed(0.5);
CREATE TABLE points AS SELECT n AS id, random() AS x, random() AS y FROM generate_series(1, 40000) AS n;
SELECT abacus_triangulate('mesh', 'SELECT * FROM points WHERE id <= 20000');
CREATE PROCEDURE exchange(first int, last int) LANGUAGE plpgsql AS $$
BEGIN
	FOR n IN first .. last LOOP
		PERFORM abacus_delete('mesh', format('SELECT * FROM points WHERE id BETWEEN %s AND %s', 10 * n, 10 * n + 9));
		COMMIT;
		PERFORM abacus_insert('mesh', format('SELECT * FROM points WHERE id BETWEEN %s AND %s', 20001 + 10 * n, 20010 + 10 * n));
		COMMIT;
	END LOOP;
END $$;
SQL
my $size = q{SELECT pg_relation_size('mesh');};
my $fresh = $node->safe_psql('postgres', $size);

my ($in, $out, $err) = ('', '', '');
my $keeper = IPC::Run::start(
	[ 'psql', '-X', '-d', $node->connstr('postgres'), '-c', "SET application_name = 'keeper'",
		'-c', 'BEGIN ISOLATION LEVEL REPEATABLE READ', '-c', 'SELECT 1', '-c', 'SELECT pg_sleep(600)' ],
	'<', \$in, '>', \$out, '2>', \$err);
$node->poll_query_until('postgres',
	"SELECT count(*) = 1 FROM pg_stat_activity WHERE application_name = 'keeper' AND query ~ 'sleep'")
  or die 'nobody sees the old versions';

# One session, which remembers the pages that it has replaced.
my ($grown, $after, $vacuumed) = split /\n/, $node->safe_psql('postgres', <<"SQL");
CALL exchange(1, 40);
$size
DO \$\$ BEGIN
	PERFORM pg_terminate_backend(pid, 60000) FROM pg_stat_activity WHERE application_name = 'keeper';
END \$\$;
CALL exchange(41, 160);
$size
VACUUM mesh;
$size
SQL
$keeper->finish;

cmp_ok($grown, '>', 3 * $fresh, 'old versions that somebody sees stay');
cmp_ok($after, '<=', $grown, 'afterwards their space is used');
cmp_ok($vacuumed, '<=', 1.45 * $fresh, 'and VACUUM cuts what is left');
is_sound($node, 'postgres', 'mesh', 'after it');
is(mesh_figure($node, 'postgres', 'mesh', 'points'), 20000, 'all points are there');

$node->stop;
done_testing();
