# Many changes of tracked tables in one transaction: versions of pages that it has made and replaced are
# pruned before it ends. Replaying this after a crash and on a standby gives the same bytes. And meshes that
# follow at commit: prepared, dumped and restored, with partitions.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $node = PostgreSQL::Test::Cluster->new('track_transaction');
$node->init(allows_streaming => 1);
$node->append_conf('postgresql.conf', <<'CONF');
wal_keep_size = '1GB' # a slow standby still finds what it needs
max_prepared_transactions = 5
fsync = off
wal_consistency_checking = 'heap, heap2'
CONF
$node->start;
$node->safe_psql('postgres', <<'SQL');
CREATE EXTENSION abacus; CREATE EXTENSION amcheck;
CREATE TABLE wells (id int, x float8, y float8);
INSERT INTO wells SELECT i, (i * 7919) % 1009, (i * 104729) % 997 FROM generate_series(1, 5000) AS i;
SELECT abacus_create('field', 2);
SELECT abacus_track('field', 'wells');
CREATE PROCEDURE one_by_one(first int, last int) LANGUAGE plpgsql AS $$
BEGIN
	FOR i IN first .. last LOOP
		INSERT INTO wells VALUES (i, i * 0.7548 % 1009, i * 0.5698 % 997);
		UPDATE wells SET y = y + 0.25 WHERE id = i - 3;
		DELETE FROM wells WHERE id = i - 7;
	END LOOP;
END $$;
SQL
$node->backup('base');
my $standby = PostgreSQL::Test::Cluster->new('track_standby');
$standby->init_from_backup($node, 'base', has_streaming => 1);
$standby->start;

sub differences
{
	my ($server, $database, $mesh, $table) = @_;
	return $server->safe_psql($database, <<"SQL");
WITH here AS (SELECT id, x, y FROM $table), there AS (SELECT id, x, y FROM abacus_vertices('$mesh'))
SELECT (SELECT count(*) FROM (TABLE here EXCEPT ALL TABLE there) AS a)
     + (SELECT count(*) FROM (TABLE there EXCEPT ALL TABLE here) AS b);
SQL
}

my $size = $node->safe_psql('postgres', "SELECT pg_relation_size('field')");
$node->safe_psql('postgres', 'CALL one_by_one(10001, 10600)');
SKIP:
{
	skip 'built without shortcuts', 1 unless has_shortcuts($node);
	cmp_ok($node->safe_psql('postgres', "SELECT pg_relation_size('field')"), '<', 12 * $size, 'the mesh stays small');
}
is(differences($node, 'postgres', 'field', 'wells'), 0, '... and in step');
is_intact($node, 'postgres', 'field', '... and whole');

# on the standby, with a reader
my $reader = $standby->background_psql('postgres', on_error_stop => 0);
$reader->query_safe('BEGIN ISOLATION LEVEL REPEATABLE READ');
my $count = "SELECT count(*) FROM abacus_simplices('field')";
my $seen = $reader->query($count);
$node->safe_psql('postgres', 'BEGIN; CALL one_by_one(11001, 11100); SAVEPOINT a; CALL one_by_one(11101, 11200); ROLLBACK TO a; CALL one_by_one(11201, 11300); COMMIT');
$node->wait_for_catchup($standby);
is($reader->query($count), $seen, 'standby: a reader is not disturbed');
$reader->quit;
is(differences($standby, 'postgres', 'field', 'wells'), 0, 'standby: in step');

# a crash in the middle, and after the end
my $session = $node->background_psql('postgres');
$session->query_safe('BEGIN');
$session->query_safe('CALL one_by_one(12001, 12300)');
$node->safe_psql('postgres', 'CHECKPOINT');
$session->query_safe('CALL one_by_one(12301, 12400)');
$node->stop('immediate');
$session->{run}->finish;
$node->start;
is(differences($node, 'postgres', 'field', 'wells'), 0, 'crashed in the middle: in step');
is_intact($node, 'postgres', 'field', '... whole');
$node->safe_psql('postgres', 'CALL one_by_one(13001, 13200)');
$node->stop('immediate');
$node->start;
is(differences($node, 'postgres', 'field', 'wells'), 0, 'crashed after the end: in step');
is_intact($node, 'postgres', 'field', '... whole');
$node->safe_psql('postgres', 'VACUUM field');
is_intact($node, 'postgres', 'field', '... after VACUUM');
$node->wait_for_catchup($standby);
is(differences($standby, 'postgres', 'field', 'wells'), 0, 'standby: in step after all that');
$standby->stop;

# prepared: the mesh is already changed
$node->safe_psql('postgres', "SELECT abacus_track('field', 'wells', deferred => true)");
for my $end ('ROLLBACK', 'COMMIT')
{
	$node->safe_psql('postgres', "BEGIN; INSERT INTO wells VALUES (20001, 1.5, 1.5), (20002, 2.5, 2.5); DELETE FROM wells WHERE id < 100; PREPARE TRANSACTION 'deferred'");
	is(differences($node, 'postgres', 'field', 'wells'), 0, "$end PREPARED: before");
	$node->stop('immediate');
	$node->start;
	$node->safe_psql('postgres', "$end PREPARED 'deferred'");
	is(differences($node, 'postgres', 'field', 'wells'), 0, "$end PREPARED: in step");
	is($node->safe_psql('postgres', "SELECT count(*) FROM abacus_vertices('field') WHERE id > 20000"),
		$end eq 'COMMIT' ? 2 : 0, "$end PREPARED: the points");
}

# dumped and restored, with partitions and at commit
$node->safe_psql('postgres', <<'SQL');
CREATE TABLE survey (id int, x float8, y float8, year int) PARTITION BY LIST (year);
CREATE TABLE survey_2020 PARTITION OF survey FOR VALUES IN (2020);
CREATE TABLE survey_2021 PARTITION OF survey FOR VALUES IN (2021);
INSERT INTO survey SELECT id, x, y, 2020 + id % 2 FROM wells;
SELECT abacus_create('surveyed', 2);
SELECT abacus_track('surveyed', 'survey');
CREATE DATABASE copy;
SQL
my $dump = $node->basedir . '/dump';
$node->command_ok([ 'pg_dump', '-d', $node->connstr('postgres'), '-Fc', '-f', $dump ], 'dumped');
$node->command_ok([ 'pg_restore', '-e', '-d', $node->connstr('copy'), $dump ], 'restored');
$node->safe_psql('copy', 'BEGIN; INSERT INTO wells VALUES (30001, 3.5, 1.5); INSERT INTO wells VALUES (30002, 4.5, 2.5); COMMIT');
is(differences($node, 'copy', 'field', 'wells'), 0, 'restored: the mesh follows at commit');
$node->safe_psql('copy', 'INSERT INTO survey_2020 VALUES (1, 0.5, 0.5, 2020); UPDATE survey SET year = 2021 WHERE id = 1; DELETE FROM survey WHERE id % 3 = 0');
is(differences($node, 'copy', 'surveyed', 'survey'), 0, 'restored: it follows partitions');
is($node->safe_psql('copy', "SELECT count(*) FROM pg_depend WHERE classid = 'pg_trigger'::regclass AND refobjid = 'surveyed'::regclass"),
	4, '... by triggers that are bound to it again');
$node->safe_psql('copy', 'TRUNCATE survey_2021');
is(differences($node, 'copy', 'surveyed', 'survey'), 0, '... one truncated by itself');
$node->safe_psql('copy', "DROP TABLE surveyed");
is($node->safe_psql('copy', "SELECT count(*) FROM pg_trigger WHERE tgrelid IN (SELECT relid FROM pg_partition_tree('survey'))"),
	0, '... and go with the mesh');

$node->stop;
done_testing();
