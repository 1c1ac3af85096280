# Pages of a mesh's tables that are all-visible: VACUUM sets that, and from PostgreSQL 19 on a reader that prunes a page
# as well. Neither hides a row from a snapshot that needs it, here and on a standby, nor shows one that others have
# taken back; and every change clears it.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $primary = PostgreSQL::Test::Cluster->new('primary');
$primary->init(allows_streaming => 1);
$primary->append_conf('postgresql.conf', "fsync = off\nautovacuum = off");
$primary->start;
$primary->safe_psql('postgres', <<'SQL');
CREATE EXTENSION abacus; CREATE EXTENSION amcheck; CREATE EXTENSION pg_visibility;
SELECT setseed(0.5);
CREATE TABLE points AS SELECT i AS id, random() AS x, random() AS y, i / 7.0 AS h FROM generate_series(1, 30000) AS i;
SELECT abacus_triangulate('field', 'SELECT * FROM points WHERE id <= 20000');
SQL
$primary->backup('base');
my $standby = PostgreSQL::Test::Cluster->new('standby');
$standby->init_from_backup($primary, 'base', has_streaming => 1);
$standby->append_conf('postgresql.conf', "hot_standby_feedback = on\nmax_standby_streaming_delay = -1");
$standby->start;

my @tables = qw(field field_vertices);

# How many pages are all-visible; and that no row on them is not, nor any frozen page has one that is not.
sub visible
{
	my ($node, $what) = @_;
	is($node->safe_psql('postgres', join ' UNION ALL ', map { "SELECT count(*) FROM pg_check_visible('$_') UNION ALL SELECT count(*) FROM pg_check_frozen('$_')" } @tables),
		"0\n0\n0\n0", "$what: the maps are right");
	return $node->safe_psql('postgres', 'SELECT ' . join ' + ', map { "(SELECT all_visible FROM pg_visibility_map_summary('$_'))" } @tables);
}

# Every page is read, as a query does that may prune.
sub read_all
{
	my ($node) = @_;
	return mesh_content($node, 'postgres', 'field');
}

$primary->safe_psql('postgres', "VACUUM $_") for @tables;
cmp_ok(visible($primary, 'VACUUM'), '>', 50, 'VACUUM: pages are all-visible');
for my $change (
	[ 'insertion' => q{SELECT abacus_insert('field', 'SELECT * FROM points WHERE id > 20000 AND id <= 25000')} ],
	[ 'deletion' => q{SELECT abacus_delete('field', 'SELECT * FROM points WHERE id % 5 = 0 AND id <= 20000')} ],
	[ 'update of attributes' => q{SELECT abacus_update('field', 'SELECT id, x, y, -h AS h FROM points WHERE id % 5 = 1 AND id <= 20000')} ],
	[ 'change taken back' => q{BEGIN; SELECT abacus_insert('field', 'SELECT * FROM points WHERE id > 25000'); ROLLBACK} ],
	[ 'changes in one transaction' => q{BEGIN; SELECT abacus_insert('field', 'SELECT * FROM points WHERE id > 25000'); SELECT abacus_delete('field', 'SELECT * FROM points WHERE id > 26000'); COMMIT} ])
{
	my ($what, $statement) = @$change;
	my $before = read_all($primary);
	$primary->wait_for_catchup($standby);
	my %session = (primary => $primary->background_psql('postgres'), standby => $standby->background_psql('postgres'));
	# snapshots from before, which have read nothing of the mesh yet
	$_->query_safe('BEGIN ISOLATION LEVEL REPEATABLE READ; SELECT count(*) FROM points WHERE id < 10') for values %session;
	# the standby's snapshot is known here before anything may be pruned
	$primary->poll_query_until('postgres', 'SELECT backend_xmin IS NOT NULL FROM pg_stat_replication') or die 'no feedback';
	my $visible = visible($primary, "$what, before");
	$primary->safe_psql('postgres', $statement);
	cmp_ok(visible($primary, $what), '<', $visible, "$what: pages are all-visible no more");
	# readers come by, and VACUUM
	my $after = read_all($primary);
	read_all($primary) for 1 .. 2;
	visible($primary, "$what, read");
	$primary->safe_psql('postgres', "VACUUM $_") for @tables;
	visible($primary, "$what, VACUUM");
	$primary->wait_for_catchup($standby);
	for my $where (sort keys %session)
	{
		my $seen = $session{$where}->query("SELECT 'simplices ' || count(*) FROM abacus_simplices('field')");
		like($before, qr/^\Q$seen\E /m, "$what: the older snapshot on the $where sees what it saw");
		is($session{$where}->query(q{SELECT count(*) FROM abacus_check('field')}), 0, "$what: and a sound mesh");
		$session{$where}->quit;
	}
	is(read_all($primary), $after, "$what: new snapshots see the change");
	is(read_all($standby), $after, "$what: on the standby as well");
	visible($standby, "$what, standby");
	is($standby->safe_psql('postgres', 'SELECT sum(confl_snapshot) FROM pg_stat_database_conflicts'), 0, "$what: no reader was in the way");
	is_intact($_->[1], 'postgres', 'field', "$what, $_->[0]") for [ primary => $primary ], [ standby => $standby ];
	if ($what eq 'change taken back') { is($after, $before, "$what: nothing has changed"); }
	else { isnt($after, $before, "$what: something has changed"); }
	# with no snapshot left, pages become all-visible again
	$primary->poll_query_until('postgres', 'SELECT pg_snapshot_xmin(pg_current_snapshot())::text::bigint - (SELECT max(backend_xmin::text::bigint) FROM pg_stat_replication) <= 0')
	  or die 'feedback does not go on';
	$primary->safe_psql('postgres', "VACUUM $_") for @tables;
	cmp_ok(visible($primary, "$what, VACUUM at the end"), '>', 50, "$what: pages are all-visible again");
}

# promoted: the standby goes on with its maps
$primary->wait_for_catchup($standby);
$standby->promote;
cmp_ok(visible($standby, 'promoted'), '>', 50, 'promoted: pages are all-visible');
$standby->safe_psql('postgres', q{SELECT abacus_delete('field', 'SELECT * FROM points WHERE id % 3 = 0')});
visible($standby, 'promoted and changed');
is_intact($standby, 'postgres', 'field', 'promoted and changed');

$standby->stop;
$primary->stop;
done_testing();
