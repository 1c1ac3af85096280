# A snapshot on a standby that is older than an index which REINDEX CONCURRENTLY has built on the primary: the
# index lacks pages that this snapshot should see. PostgreSQL has that gap for every table. A reader of a mesh
# gets an error, not an answer from a part of the mesh.
use strict;
use warnings;

use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;

my $primary = PostgreSQL::Test::Cluster->new('primary');
$primary->init(allows_streaming => 1);
$primary->append_conf('postgresql.conf', 'autovacuum = off');
$primary->start;
$primary->safe_psql('postgres', <<'SQL');
CREATE EXTENSION abacus;
CREATE EXTENSION amcheck;
SELECT abacus_triangulate('field', 'SELECT i, (i * 0.7548776662466927::float8)::numeric % 1, (i * 0.5698402909980532::float8)::numeric % 1 FROM generate_series(1, 20000) i');
SELECT abacus_insert('field', 'SELECT i, 0.5, 0.5 FROM generate_series(1, 5000) i');
SQL
$primary->backup('base');
my $standby = PostgreSQL::Test::Cluster->new('standby');
$standby->init_from_backup($primary, 'base', has_streaming => 1);
# With feedback the primary prunes nothing that such a snapshot sees, not even in its catalogues.
$standby->append_conf('postgresql.conf', <<'CONF');
hot_standby_feedback = on
max_standby_streaming_delay = 10s
CONF
$standby->start;
$primary->wait_for_catchup($standby);

my @reads = (
	"SELECT count(*) FROM abacus_simplices('field')",
	"SELECT count(*) FROM abacus_vertices('field')",
	"SELECT count(*) FROM abacus_check('field')",
	"SELECT length(abacus_draw('field', 50, 50)) > 0",
	"SELECT length(abacus_draw('field', 50, 50, '{0.4,0.4}', '{0.5,0.5}')) > 0",
	"SELECT count(*) FROM generate_series(1, 400) i, abacus_locate('field', 0.37 + 0.26 * (i % 20) / 20, 0.37 + 0.26 * (i / 20) / 20)",
	"SELECT count(*) FROM abacus_locate('field', 'SELECT i, 0.02 + 0.96 * (i % 20) / 20, 0.02 + 0.96 * (i / 20) / 20 FROM generate_series(0, 399) i')");

# Snapshots that are taken now, and used after the index has been replaced.
my @sessions = map { $standby->background_psql('postgres', on_error_stop => 0) } @reads;
$_->query('BEGIN ISOLATION LEVEL REPEATABLE READ; SELECT count(*) FROM pg_class') for @sessions;
$primary->poll_query_until('postgres', 'SELECT backend_xmin IS NOT NULL FROM pg_stat_replication');

# Most pages get new versions, in other heap pages.
$primary->safe_psql('postgres', "SELECT abacus_insert('field', 'SELECT i, random(), random() FROM generate_series(30000, 50000) i')");
$primary->safe_psql('postgres', "REINDEX TABLE CONCURRENTLY $_") for 'field', 'field_vertices';
$primary->wait_for_catchup($standby);

for my $i (0 .. $#reads)
{
	my $session = $sessions[$i];
	$session->query("\\set VERBOSITY verbose");
	$session->{stderr} = '';
	my $answer = $session->query($reads[$i]);
	is($answer, '', "no answer: $reads[$i]");
	like($session->{stderr}, qr/40001: .*was built after this snapshot was taken.*HINT:  The transaction might succeed if retried/s,
		'... but 40001 and what to do');
	$session->query('ROLLBACK');
	$session->{stderr} = '';
	isnt($session->query($reads[$i]), '', 'a new snapshot gets an answer');
	is($session->{stderr}, '', '... without an error');
	$session->quit;
}
is_intact($standby, 'postgres', 'field', 'standby');

# If a page is lost, it is lost for every snapshot.
$primary->safe_psql('postgres', "DELETE FROM field WHERE code = (SELECT code FROM field WHERE code > 0 ORDER BY code OFFSET 5 LIMIT 1)");
$primary->wait_for_catchup($standby);
my ($status, $out, $err) = $standby->psql('postgres', "\\set VERBOSITY verbose\nSELECT count(*) FROM abacus_simplices('field')");
like($err, qr/XX001/, 'a mesh that is damaged is so for new snapshots');

$standby->stop;
$primary->stop;
done_testing();
