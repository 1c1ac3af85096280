# Logical replication of the two tables of a mesh: the existing rows, then every change as its transaction,
# including batches of a build.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $points = 40_000;
my $batch = 500;

my $publisher = PostgreSQL::Test::Cluster->new('publisher');
$publisher->init(allows_streaming => 'logical');
$publisher->append_conf('postgresql.conf', 'fsync = off');
$publisher->start;
my $subscriber = PostgreSQL::Test::Cluster->new('subscriber');
$subscriber->init;
$subscriber->append_conf('postgresql.conf', 'fsync = off');
$subscriber->start;

$publisher->safe_psql('postgres', <<"SQL");
CREATE EXTENSION abacus;
SELECT setseed(0.5);
CREATE TABLE points AS SELECT i AS id, random() AS x, random() AS y FROM generate_series(1, $points) AS i;
SELECT abacus_triangulate('field', 'SELECT * FROM points WHERE id <= 5000');
SQL

# the tables, without the header that abacus_create would write
my $schema = $publisher->basedir . '/schema.sql';
$publisher->command_ok(
	[ 'pg_dump', '-d', $publisher->connstr('postgres'), '--schema-only', '-t', 'field', '-t', 'field_vertices', '-f', $schema ],
	'definitions of the tables');
$subscriber->safe_psql('postgres', 'CREATE EXTENSION abacus; CREATE EXTENSION amcheck');
$subscriber->command_ok([ 'psql', '-Xq', '-v', 'ON_ERROR_STOP=1', '-d', $subscriber->connstr('postgres'), '-f', $schema, '-o', '/dev/null' ],
	'the same tables there');
my ($status, $out, $err) = $subscriber->psql('postgres', "SELECT abacus_locate('field', 0.5, 0.5)");
like($err, qr/mesh "field" has no header/, 'no mesh yet');

$publisher->safe_psql('postgres', 'CREATE PUBLICATION mesh FOR TABLE field, field_vertices');
my $connection = $publisher->connstr('postgres');
$subscriber->safe_psql('postgres', "CREATE SUBSCRIPTION mesh CONNECTION \$\$$connection\$\$ PUBLICATION mesh");
$subscriber->wait_for_subscription_sync($publisher, 'mesh');

sub is_same
{
	my ($what) = @_;
	$publisher->wait_for_catchup('mesh');
	is(mesh_content($subscriber, 'postgres', 'field'), mesh_content($publisher, 'postgres', 'field'), $what);
	return is_intact($subscriber, 'postgres', 'field', $what);
}
is_same('initial copy');

# a transaction arrives as a whole: changed twice, one of the changes rolled back
my $session = $subscriber->background_psql('postgres');
my $locate = "SELECT v0, v1, v2 FROM abacus_locate('field', 0.5, 0.5)";
my $before = $session->query($locate);
$publisher->safe_psql('postgres', <<'SQL');
BEGIN;
SELECT abacus_stage('field', 'SELECT 100001, 0.501, 0.5'), abacus_triangulate('field');
SAVEPOINT before;
SELECT abacus_stage('field', 'SELECT 100002, 0.5, 0.501'), abacus_triangulate('field');
ROLLBACK TO before;
SELECT abacus_delete('field', 'SELECT id, x, y FROM points WHERE id <= 5000 AND id % 7 = 0');
SELECT abacus_insert('field', 'SELECT 100003, 0.499, 0.4995');
COMMIT;
BEGIN;
SELECT abacus_delete('field', 'SELECT id, x, y FROM points WHERE id <= 5000 AND id % 2 = 0');
ROLLBACK;
SQL
is_same('points inserted and deleted');
my $after = $session->query($locate);
isnt($after, $before, 'a session that had the mesh in its cache sees the change');
is($after, $publisher->safe_psql('postgres', $locate), '... as the publisher does');

# batches of a build, with readers there: they always see a complete batch
$publisher->safe_psql('postgres', "SELECT abacus_stage('field', 'SELECT * FROM points WHERE id > 5000')");
my ($inserted, $looks, %seen, %wrong) = (0, 0);
my $changed = 2 - 714; # points inserted and deleted above
sub look
{
	my $row = $session->query(<<'SQL');
BEGIN ISOLATION LEVEL REPEATABLE READ;
SELECT (SELECT value FROM abacus_stats('field') WHERE name = 'inserted'),
	(SELECT value FROM abacus_stats('field') WHERE name = 'simplices') = (SELECT count(*) FROM abacus_simplices('field')),
	(SELECT count(*) FROM abacus_check('field'));
COMMIT;
SQL
	($inserted, my @wrong) = split /\|/, $row;
	$wrong{$row} = 1 if "@wrong" ne 't 0' || ($inserted - $changed) % $batch;
	$seen{$inserted} = 1;
	$looks++;
	return;
}
look();
my $builder = IPC::Run::start(
	[ 'psql', '-XAtq', '-v', 'ON_ERROR_STOP=1', '-d', $connection, '-c', "CALL abacus_build('field', $batch)" ],
	IPC::Run::timeout($PostgreSQL::Test::Utils::timeout_default));
look() while $inserted < $points + $changed;
$builder->finish;
is(join("\n", keys %wrong), '', "$looks looks during the build, each at one whole state");
cmp_ok(scalar(keys %seen), '>=', 2, scalar(keys %seen) . ' states seen');
is_same('after the build');

# many changes in one transaction, which reuses the space of its own old pages
$publisher->safe_psql('postgres', <<'SQL');
DO $$ BEGIN FOR i IN 1 .. 150 LOOP
	PERFORM abacus_insert('field', format('SELECT %s, %s, %s', 300000 + i, i * 0.7548 % 1, i * 0.5698 % 1));
END LOOP; END $$;
SELECT sum(abacus_insert('field', format('SELECT %s, %s, %s', 310000 + i, i * 0.3247 % 1, i * 0.4301 % 1))) FROM generate_series(1, 150) AS i;
SQL
is_same('many small changes in one transaction');

# TRUNCATE, and statements that fill the tables again
$publisher->safe_psql('postgres', <<'SQL');
CREATE TABLE saved AS TABLE field;
CREATE TABLE saved_vertices AS TABLE field_vertices;
BEGIN;
TRUNCATE field, field_vertices;
INSERT INTO field TABLE saved;
INSERT INTO field_vertices TABLE saved_vertices;
COMMIT;
SQL
is_same('truncated and filled again');

# levels of a mesh, and the same made anew
$publisher->safe_psql('postgres', <<'SQL');
SELECT abacus_triangulate('ground', 'SELECT 100 * x + y, x, y, 10 * sin(x / 5.0) * cos(y / 7.0) AS height FROM generate_series(0, 30) AS x, generate_series(0, 30) AS y');
SELECT abacus_levels('ground', '{0.5,2}');
SQL
my $more = $publisher->basedir . '/more.sql';
$publisher->command_ok([ 'pg_dump', '-d', $connection, '--schema-only', '-t', 'ground*', '-f', $more ], 'definitions of a mesh with levels');
$subscriber->command_ok([ 'psql', '-Xq', '-v', 'ON_ERROR_STOP=1', '-d', $subscriber->connstr('postgres'), '-f', $more, '-o', '/dev/null' ],
	'the same tables there');
my $all = $publisher->safe_psql('postgres', "SELECT string_agg(oid::regclass::text, ', ') FROM pg_class WHERE relname LIKE 'ground%' AND relkind = 'r'");
$publisher->safe_psql('postgres', "ALTER PUBLICATION mesh ADD TABLE $all");
$subscriber->safe_psql('postgres', 'ALTER SUBSCRIPTION mesh REFRESH PUBLICATION');
$subscriber->wait_for_subscription_sync($publisher, 'mesh');
sub levels
{
	return $_[0]->safe_psql('postgres', q{SELECT level, mesh, max_error, greatest, stamp FROM ground_levels ORDER BY level;
		SELECT string_agg(v::text, ' ' ORDER BY id) FROM abacus_vertices(abacus_level('ground', 0.5)) AS v; SELECT string_agg(v::text, ' ' ORDER BY id) FROM abacus_vertices(abacus_level('ground', 2)) AS v});
}
my $levels = levels($publisher);
is(levels($subscriber), $levels, 'initial copy of levels');
$publisher->safe_psql('postgres', q{SELECT abacus_insert('ground', 'VALUES (-1, 15.5, 15.5, 30)'); SELECT abacus_levels_refresh('ground')});
$publisher->wait_for_catchup('mesh');
isnt(levels($publisher), $levels, 'levels are made anew');
is(levels($subscriber), levels($publisher), '... and so they are there');
is_intact($subscriber, 'postgres', 'ground_level_1', 'a level made anew');

# takeover: the subscription ends, and the mesh can be changed
$subscriber->safe_psql('postgres', 'DROP SUBSCRIPTION mesh');
for my $node ($publisher, $subscriber)
{
	$node->safe_psql('postgres', "SELECT abacus_stage('field', 'SELECT 200000 + i, sin(i), cos(i) FROM generate_series(1, 1000) i')");
	$node->safe_psql('postgres', "CALL abacus_build('field', 300)");
}
is(mesh_content($subscriber, 'postgres', 'field'), mesh_content($publisher, 'postgres', 'field'), 'taken over, and grown');
is_intact($subscriber, 'postgres', 'field', 'taken over');

$subscriber->stop;
$publisher->stop;
done_testing();
