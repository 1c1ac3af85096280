# Many sessions at once. Some change a mesh, and note their changes in a table; the others check whether the
# mesh agrees with the table, in each isolation level, from sessions that keep their cache.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use AbacusModel;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $seconds = $ENV{ABACUS_SECONDS} || 10;
$ENV{PGOPTIONS} = '-c client_min_messages=warning'; # pgbench shows errors alone

my $node = PostgreSQL::Test::Cluster->new('concurrent');
$node->init;
$node->append_conf('postgresql.conf', "fsync = off\nautovacuum_naptime = 1s\nsession_preload_libraries = 'abacus'");
$node->start;
$node->safe_psql('postgres', 'CREATE EXTENSION abacus; CREATE EXTENSION amcheck');
make_models($node);

# A check fails if anything in one snapshot disagrees with the rest of it. Sometimes so few points are left
# that they span no simplex.
$node->safe_psql('postgres', <<'SQL');
CREATE FUNCTION look(dimension int) RETURNS void LANGUAGE plpgsql STABLE AS $$
DECLARE
	mesh text := 'mesh' || dimension;
	simplices bigint := (SELECT value FROM abacus_stats(mesh) WHERE name = 'simplices');
	places bigint;
	place record;
BEGIN
	IF simplices = 0 THEN
		EXECUTE format('SELECT count(DISTINCT (x, y, z)) FROM %s_noted', mesh) INTO places;
		ASSERT places <= dimension, places || ' places, but no simplex';
	END IF;
	FOR place IN EXECUTE format('SELECT * FROM %s_noted TABLESAMPLE SYSTEM (5)', mesh) LOOP
		-- the point is a vertex, or equal to one, of the simplex found at its place
		IF dimension = 2 THEN
			ASSERT simplices = 0 OR (SELECT code IS NOT NULL FROM abacus_locate(mesh, place.x, place.y)), 'not located';
		ELSE
			ASSERT simplices = 0 OR (SELECT code IS NOT NULL FROM abacus_locate(mesh, place.x, place.y, place.z)), 'not located';
		END IF;
	END LOOP;
	ASSERT wrong(dimension) = 0, wrong(dimension) || ' points differ';
	ASSERT simplices = (SELECT count(*) FROM abacus_simplices(mesh)), 'simplices';
	ASSERT 0 = (SELECT count(*) FROM abacus_check(mesh)), 'faults';
END $$;
SQL

my %scripts = (
	change_2 => 'SELECT change(2);',
	change_3 => 'SELECT change(3);',
	both => "BEGIN;\nSELECT change(2);\nSAVEPOINT s;\nSELECT change(3);\nROLLBACK TO s;\nSELECT look(3);\nSELECT change(3);\nSELECT look(2);\nEND;",
	repeatable => "BEGIN ISOLATION LEVEL REPEATABLE READ;\nSELECT look(2);\nSELECT change(2);\nSELECT look(2);\nEND;",
	serializable => "BEGIN ISOLATION LEVEL SERIALIZABLE;\nSELECT look(2);\nSELECT change(3);\nEND;",
	look_2 => "SELECT look(2);",
	look_3 => "SELECT look(3);",
	look_twice => "BEGIN ISOLATION LEVEL REPEATABLE READ;\nSELECT look(3);\nSELECT look(2);\nSELECT look(3);\nEND;",
	look_serializable => "BEGIN ISOLATION LEVEL SERIALIZABLE READ ONLY;\nSELECT look(3);\nSELECT look(2);\nEND;",
	maintenance => "VACUUM mesh2, mesh2_vertices;\nREINDEX TABLE CONCURRENTLY mesh2;\nSELECT pg_sleep(0.2);");
my @files;
for my $name (sort keys %scripts)
{
	my $file = $node->basedir . "/$name.sql";
	append_to_file($file, $scripts{$name});
	push @files, '-f', $file . ($name =~ /look/ ? '@3' : $name eq 'maintenance' ? '@0' : '@1');
}

# one session maintains the tables meanwhile
my $maintenance = $node->basedir . '/maintenance.sql';
my ($out, $err) = ('', '');
my $keeper = IPC::Run::start(
	[ 'pgbench', '-n', '-T', $seconds, '-f', $maintenance, $node->connstr('postgres') ],
	'>', \$out, '2>', \$err);
# serialization failures and deadlocks are retried; anything else ends a client
my ($all, $errors) = run_command(
	[ 'pgbench', '-n', '-T', $seconds, '-c', 6, '-j', 2, '--max-tries', 0, @files, $node->connstr('postgres') ]);
$keeper->finish;
unlike($errors, qr/error|abort/i, 'no session fails');
unlike($err, qr/error|abort/i, 'nor does VACUUM or REINDEX');
my ($count) = $all =~ /number of transactions actually processed: (\d+)/;
my ($retried) = $all =~ /number of transactions retried: (\d+)/;
cmp_ok($count, '>', 50, "$count transactions, $retried of them tried again");

# Calls that begin just when one index replaces another
my ($calls, $reindex) = map { $node->basedir . "/$_.sql" } qw(calls reindex);
append_to_file($calls, "SELECT count(*) FROM abacus_stats('mesh2');");
append_to_file($reindex, 'REINDEX TABLE CONCURRENTLY mesh2;');
my @bench = ('pgbench', '-n', '-T', 3);
$keeper = IPC::Run::start([ @bench, '-f', $reindex, $node->connstr('postgres') ], '>', \$out, '2>', \$err);
($all, $errors) = run_command([ @bench, '-c', 4, '-f', $calls, $node->connstr('postgres') ]);
$keeper->finish;
unlike($errors, qr/error|abort/i, 'nor does a short call beside REINDEX CONCURRENTLY');

for my $d (2, 3)
{
	cmp_ok(mesh_figure($node, 'postgres', "mesh$d", 'removals'), '>', 0, "dimension $d: changed");
	is_as_noted($node, $d, "dimension $d");
}

$node->stop;
done_testing();
