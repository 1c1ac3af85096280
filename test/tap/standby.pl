# A streaming standby answers while the primary builds, always from one committed state; it refuses changes; a
# reader that delays recovery gets an error.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $points = 40_000;
my $batch = 50;

my $primary = PostgreSQL::Test::Cluster->new('primary');
$primary->init(allows_streaming => 1);
$primary->append_conf('postgresql.conf', 'fsync = off');
$primary->start;
$primary->safe_psql('postgres', <<"SQL");
CREATE EXTENSION abacus; CREATE EXTENSION amcheck;
SELECT setseed(0.5);
CREATE TABLE points AS SELECT i AS id, random() AS x, random() AS y FROM generate_series(1, $points) AS i;
SELECT abacus_triangulate('once', 'TABLE points');
SELECT abacus_create('field', 2);
SELECT abacus_stage('field', 'TABLE points');
SELECT abacus_octree_create('tree', 2, '{0,0}', '{1,1}');
-- feedback tells the primary of snapshots, not of locks
ALTER TABLE field_vertices SET (vacuum_truncate = off);
SQL
$primary->backup('base');
my $standby = PostgreSQL::Test::Cluster->new('standby');
$standby->init_from_backup($primary, 'base', has_streaming => 1);
$standby->append_conf('postgresql.conf', <<'CONF');
hot_standby_feedback = on
max_standby_streaming_delay = 1s
CONF
$standby->start;

sub build
{
	my ($mesh) = @_;
	my ($out, $err) = ('', '');
	return IPC::Run::start(
		[ 'psql', '-XAtq', '-v', 'ON_ERROR_STOP=1', '-d', $primary->connstr('postgres'),
			'-c', "CALL abacus_build('$mesh', $batch)" ],
		'>', \$out, '2>', \$err,
		IPC::Run::timeout($PostgreSQL::Test::Utils::timeout_default));
}

# One look at the mesh, in a session of its own or in $session: returns the number of inserted points, after a
# test that all answers belong to that state.
sub look
{
	my ($session) = @_;
	my $query = <<"SQL";
BEGIN ISOLATION LEVEL REPEATABLE READ;
SELECT (SELECT value FROM abacus_stats('field') WHERE name = 'inserted'),
	(SELECT value FROM abacus_stats('field') WHERE name = 'simplices')
		= (SELECT count(*) FROM abacus_simplices('field')),
	(SELECT count(vertex) FROM abacus_vertices('field'))
		= (SELECT value FROM abacus_stats('field') WHERE name = 'inserted'),
	(SELECT count(*) FROM abacus_check('field')),
	(SELECT count(*) FROM (SELECT * FROM abacus_simplices('field') LIMIT 5) AS s,
		LATERAL (SELECT avg(x) AS x, avg(y) AS y FROM abacus_vertices('field') WHERE id IN (s.v0, s.v1, s.v2)) AS centroid,
		abacus_locate('field', centroid.x, centroid.y) AS t WHERE t IS NOT DISTINCT FROM s::abacus_simplex);
COMMIT;
SQL
	my $row = $session ? $session->query($query) : $standby->safe_psql('postgres', $query);
	my ($inserted, @wrong) = split /\|/, $row;
	return ($inserted, "@wrong" eq ($inserted > 0 ? 't t 0 5' : 't t 0 0') ? '' : $row);
}

# long sessions, which have a cache, and new ones
my $session = $standby->background_psql('postgres');
my (%seen, %wrong);
my ($last, $looks) = (0, 0);
sub note_look
{
	my ($inserted, $wrong) = look(@_);
	$wrong{$wrong || "$inserted after $last"} = 1 if $wrong || $inserted < $last || $inserted % $batch;
	$seen{$inserted} = 1;
	$last = $inserted;
	$looks++;
	return;
}
note_look($session);
my $builder = build('field');
while ($last < $points)
{
	note_look($_) for $session, undef;
}
$builder->finish;
is(join("\n", keys %wrong), '', "$looks looks during the build, each at one whole state");
cmp_ok(scalar(keys %seen), '>=', 2, scalar(keys %seen) . ' states seen');
is($standby->safe_psql('postgres', 'SELECT sum(confl_snapshot) + sum(confl_lock) FROM pg_stat_database_conflicts'),
	0, 'with feedback no reader is in the way');
$primary->wait_for_catchup($standby);
is(other_simplices($standby, 'postgres', 'field', 'once', 2), 0, 'at the end the mesh of the primary');
cmp_ok($standby->safe_psql('postgres', "SELECT pg_relation_size('field_vertices')"), '>', 0, '... whose vertex table was not to be truncated');
is_intact($standby, 'postgres', 'field', 'standby');

# changes of a mesh are refused there
my ($status, $out, $err) = $standby->psql('postgres', "CALL abacus_build('field')");
like($err, qr/cannot execute abacus_build\(\) in a read-only transaction/, 'no building');
($status, $out, $err) = $standby->psql('postgres', "SELECT abacus_stage('field', 'TABLE points')");
like($err, qr/cannot execute abacus_stage\(\) in a read-only transaction/, 'no staging');
for my $function (qw(abacus_track abacus_untrack))
{
	($status, $out, $err) = $standby->psql('postgres', "SELECT $function('field', 'points')");
	like($err, qr/cannot execute $function\(\) in a read-only transaction/, "no $function");
}
is($standby->safe_psql('postgres', 'SELECT count(*) FROM abacus_progress'), 0, 'no progress there');

# unlogged tables have no file there
$primary->safe_psql('postgres', <<'SQL');
SELECT abacus_triangulate('fleeting', 'VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1), (4, 0, 1)');
ALTER TABLE fleeting_vertices SET UNLOGGED;
SQL
$primary->wait_for_catchup($standby);
is($standby->safe_psql('postgres', "SELECT count(*) FROM abacus_simplices('fleeting')"), 1, 'a mesh whose vertex table is unlogged');
($status, $out, $err) = $standby->psql('postgres', "SELECT count(*) FROM abacus_vertices('fleeting')");
like($err, qr/cannot access unlogged mesh table "fleeting_vertices" during recovery/, '... has no vertices there');
$primary->safe_psql('postgres', 'ALTER TABLE fleeting SET UNLOGGED');
$primary->wait_for_catchup($standby);
($status, $out, $err) = $standby->psql('postgres', "SELECT abacus_locate('fleeting', 0.1, 0.1)");
like($err, qr/cannot access unlogged mesh table "fleeting" during recovery/, 'an unlogged mesh has nothing there');

# without feedback the primary prunes rows that a reader there still needs: the reader gives way to recovery,
# with an error that suggests a retry
$standby->adjust_conf('postgresql.conf', 'hot_standby_feedback', 'off');
$standby->reload;
$primary->poll_query_until('postgres', 'SELECT backend_xmin IS NULL FROM pg_stat_replication')
  or die 'feedback does not end';
$primary->safe_psql('postgres', "SELECT abacus_stage('field', 'SELECT id + 100000, x * x, y * y FROM points WHERE id <= 8000')");
$primary->wait_for_catchup($standby);
$session->query_safe("BEGIN ISOLATION LEVEL REPEATABLE READ");
$session->query_safe("SELECT count(*) FROM abacus_simplices('field')");
build('field')->finish;
$primary->wait_for_catchup($standby);
cmp_ok($standby->safe_psql('postgres', 'SELECT sum(confl_snapshot) FROM pg_stat_database_conflicts'), '>', 0, 'without feedback an old reader is in the way');
ok($standby->log_contains('due to conflict with recovery'), '... and is told so');
is_sound($standby, 'postgres', 'field', 'a new reader');
is(mesh_content($standby, 'postgres', 'field'), mesh_content($primary, 'postgres', 'field'), '... sees the mesh of the primary');

# promoted between two batches of a build: the first waits for a lock on the header row, the second for one on
# the vertex table, which was requested during the first
$primary->safe_psql('postgres', "SELECT abacus_stage('field', 'SELECT id + 200000, 1 - x * x, y * y FROM points WHERE id <= 24000')");
my $first = $primary->background_psql('postgres');
$first->query_safe('BEGIN; SELECT FROM field WHERE code = -1 FOR UPDATE');
$builder = build('field');
sub await_waiting
{
	my ($count) = @_;
	return $primary->poll_query_until('postgres',
		"SELECT count(*) = $count FROM pg_stat_activity WHERE wait_event_type = 'Lock'") || die 'nobody waits';
}
await_waiting(1);
my $between = $primary->background_psql('postgres');
$between->query_until(qr/asking/, "\\echo asking\nBEGIN; LOCK TABLE field_vertices IN ACCESS EXCLUSIVE MODE;\n");
await_waiting(2);
$first->query_safe('COMMIT');
$primary->poll_query_until('postgres', "SELECT count(*) = 1 FROM pg_locks WHERE relation = 'field_vertices'::regclass AND mode = 'AccessExclusiveLock' AND granted")
  or die 'the first batch does not end';
# an octree and labels, too
$primary->safe_psql('postgres', <<'SQL');
SELECT abacus_triangulate('labelled', 'SELECT * FROM points WHERE id <= 5000');
SELECT abacus_label('labelled', 'SELECT code, v0, v1, v2, v0 AS first, code % 3 AS third FROM abacus_simplices(''labelled'')');
SELECT abacus_mark('labelled', 'SELECT code, v0, v1, v2, 1, 7 FROM abacus_simplices(''labelled'') WHERE v1 % 3 = 0');
SELECT abacus_insert('labelled', 'SELECT * FROM points WHERE id BETWEEN 10001 AND 10500');
SELECT abacus_delete('labelled', 'SELECT * FROM points WHERE id BETWEEN 1001 AND 1200');
SQL
$primary->safe_psql('postgres', q{SELECT abacus_octree_from_points('tree', 'TABLE points', 10)});
$primary->wait_for_catchup($standby);
is($standby->safe_psql('postgres', q{SELECT count(*), sum(code) FROM abacus_octants('tree')}),
	$primary->safe_psql('postgres', q{SELECT count(*), sum(code) FROM abacus_octants('tree')}), 'leaves of an octree');
is(mesh_labels($standby, 'postgres', 'labelled'), mesh_labels($primary, 'postgres', 'labelled'), 'labels and markers');
is_sound($standby, 'postgres', 'labelled', 'with labels');
$standby->promote;
$_->quit for $first, $between;
$builder->finish;
is(mesh_figure($standby, 'postgres', 'field', 'inserted'), 48_000 + $batch, 'promoted in the middle');
is_sound($standby, 'postgres', 'field', 'promoted');
$standby->safe_psql('postgres', "CALL abacus_build('field')");
is(mesh_content($standby, 'postgres', 'field'), mesh_content($primary, 'postgres', 'field'),
	'both end with the same mesh');
is_intact($standby, 'postgres', 'field', 'promoted, built on');
for my $node ($primary, $standby)
{
	$node->safe_psql('postgres', q{SELECT abacus_insert('labelled', 'SELECT * FROM points WHERE id BETWEEN 11001 AND 11500')});
}
is(mesh_labels($standby, 'postgres', 'labelled'), mesh_labels($primary, 'postgres', 'labelled'), 'promoted: labels and markers stay as on the primary');
is_intact($standby, 'postgres', 'labelled', 'promoted, with labels');

$standby->stop;
$primary->stop;
done_testing();
