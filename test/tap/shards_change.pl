# Changes of a mesh over several servers: after each it has the simplices, ids and attributes of one server's mesh that
# was changed in the same way; they belong to the transaction; whatever fails, nothing is lost and no reader sees half.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusCrash;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;
use Time::HiRes qw(usleep);

# A few of each in the usual size, more in everything.
my $kills = $ENV{ABACUS_KILLS} || 12;
my ($rounds, $kills_each) = $kills > 5 ? (6, $kills) : (2, 3);
my $seed = $ENV{ABACUS_SEED} || time;
srand $seed;
note "seed $seed";

my $node = PostgreSQL::Test::Cluster->new('coordinator');
$node->init;
$node->append_conf('postgresql.conf', "fsync = off\nmax_connections = 60\nmax_prepared_transactions = 20");
$node->start;
my $other = PostgreSQL::Test::Cluster->new('other');
$other->init;
$other->append_conf('postgresql.conf', "fsync = off\nmax_prepared_transactions = 20");
$other->start;
my $user = $node->safe_psql('postgres', 'SELECT current_user');

sub add_server
{
	my ($name, $cluster, $database) = @_;
	$cluster->safe_psql('postgres', "CREATE DATABASE $database");
	$cluster->safe_psql($database, 'CREATE EXTENSION abacus');
	$node->safe_psql('postgres', sprintf(
		"CREATE SERVER %s FOREIGN DATA WRAPPER postgres_fdw OPTIONS (host '%s', port '%s', dbname '%s');
		CREATE USER MAPPING FOR CURRENT_USER SERVER %s OPTIONS (user '%s')",
		$name, $cluster->host, $cluster->port, $database, $name, $user));
	return;
}
$node->safe_psql('postgres', 'CREATE EXTENSION abacus; CREATE EXTENSION postgres_fdw');
add_server("s$_", $node, "shard$_") for 1 .. 4;
add_server('far', $other, 'shard');

sub differing
{
	my ($call) = @_;
	(my $a = $call) =~ s/MESH/'many'/g;
	(my $b = $call) =~ s/MESH/'one'/g;
	return $node->safe_psql('postgres', "SELECT count(*) FROM (
		(SELECT r::text FROM $a AS r EXCEPT ALL SELECT r::text FROM $b AS r) UNION ALL
		(SELECT r::text FROM $b AS r EXCEPT ALL SELECT r::text FROM $a AS r)) AS other");
}
sub is_same
{
	my ($what) = @_;
	is( differing('abacus_cells(MESH)') . ' ' . differing('(SELECT id, x, y, z, attributes, vertex FROM abacus_vertices(MESH))'),
		'0 0', "$what: simplices and points are those of one server");
	is($node->safe_psql('postgres', "SELECT * FROM abacus_check('many')"), '', "$what: sound");
	is($node->safe_psql('postgres', "SELECT (SELECT value FROM abacus_stats('many') WHERE name = 'simplices') = (SELECT count(*) FROM abacus_cells('many'))"),
		't', "$what: the number of simplices");
	return;
}
# The same change of both meshes; both tell the same.
sub change
{
	my ($call, $what) = @_;
	my @said;
	for my $mesh ('many', 'one')
	{
		my ($out, $err);
		(my $sql = $call) =~ s/MESH/'$mesh'/g;
		$node->psql('postgres', $sql, stdout => \$out, stderr => \$err, extra_params => [ '-v', 'VERBOSITY=verbose' ]);
		$err =~ s/^(LOCATION|CONTEXT):.*\n?//mg;
		$err =~ s/"$mesh"/"MESH"/g;
		push @said, "$out\n$err";
	}
	is($said[0], $said[1], "$what: says the same");
	return $said[0];
}
sub fails
{
	my ($sql, $pattern, $what) = @_;
	my ($out, $err);
	$node->psql('postgres', $sql, stdout => \$out, stderr => \$err, on_error_stop => 1, extra_params => [ '-v', 'VERBOSITY=verbose' ]);
	like($err, $pattern, $what);
	return;
}
sub make
{
	my ($servers, $dimension, $query) = @_;
	$node->safe_psql('postgres', "SELECT abacus_shard_drop('many')") if $node->safe_psql('postgres', "SELECT to_regclass('many')");
	$node->safe_psql('postgres', 'DROP TABLE IF EXISTS one');
	$node->safe_psql('postgres', "SELECT abacus_shard_create('many', '$servers', $dimension); CALL abacus_shard_build('many', '$query'); SELECT abacus_triangulate('one', '$query', dimension => $dimension)");
	return;
}

# ---- The same mesh ------------------------------------------------------------------------------------------

my $id = 100_000;
# Some places on a coarse grid, so that some are equal and cocircular; some outside of the domain.
sub random_points
{
	my ($count, $dimension, $fine) = @_;
	my @rows;
	for (1 .. $count)
	{
		my @place = map { rand() < 0.5 ? int(rand(25)) / 16 - 0.25 : ($fine ? rand(1.2) - 0.1 : int(rand(40)) / 32) } 1 .. $dimension;
		push @rows, '(' . join(', ', $id++, @place, rand() < 0.1 ? 'NULL' : int(rand(100))) . ')';
	}
	my $columns = $dimension == 2 ? 'x, y' : 'x, y, z';
	return "SELECT id, $columns, h::float8 FROM (VALUES " . join(', ', @rows) . ") AS v (id, $columns, h)";
}
for my $dimension (2, 3)
{
	my $columns = $dimension == 2 ? 'x, y' : 'x, y, z';
	for my $count (1, 2, 4)
	{
		my $what = "in $dimension dimensions over $count";
		make('{' . join(',', map { "s$_" } 1 .. $count) . '}', $dimension, random_points(60, $dimension, 1) =~ s/'/''/gr);
		for my $round (1 .. $rounds)
		{
			my $kind = int(rand(4));
			my $rows = 1 + int(rand(60));
			my $how = (qw(keep replace keep))[rand 3];
			change("SELECT abacus_insert(MESH, '" . random_points($rows, $dimension, $round % 2) . "', '$how')", "$what: insert, $how") if $kind != 3;
			change("SELECT r FROM abacus_insert_returning(MESH, '" . random_points($rows, $dimension, 1) . "') AS r ORDER BY r.code, r.v0, r.v1, r.v2, r.v3, r.created, r.corners", "$what: insert returning") if $kind == 3;
			$node->safe_psql('postgres', "DROP TABLE IF EXISTS chosen; CREATE TABLE chosen AS SELECT id, $columns, attributes[1] AS h FROM abacus_vertices('one') WHERE random() < 0.15");
			change("SELECT abacus_delete(MESH, 'SELECT id, $columns FROM chosen')", "$what: delete") if $kind != 0;
			change("SELECT r FROM abacus_delete_returning(MESH, 'SELECT id, $columns FROM chosen') AS r ORDER BY r.code, r.v0, r.v1, r.v2, r.v3, r.created, r.corners", "$what: delete returning") if $kind == 0;
			$node->safe_psql('postgres', "DROP TABLE chosen; CREATE TABLE chosen AS SELECT DISTINCT ON ($columns) id, $columns, round(random() * 100) AS h FROM abacus_vertices('one') WHERE random() < 0.2");
			change("SELECT abacus_update(MESH, 'SELECT id, $columns, h FROM chosen')", "$what: update");
			is_same("$what, round $round");
		}
		# all points but a few on a line go: no simplices are left; then some come again
		$node->safe_psql('postgres', "DROP TABLE chosen; CREATE TABLE chosen AS SELECT id, $columns FROM abacus_vertices('one')");
		change("SELECT abacus_delete(MESH, 'SELECT id, $columns FROM chosen')", "$what: delete all");
		is_same("$what: nothing");
		my $line = "SELECT i, i / 10.0, 0.5" . ($dimension == 3 ? ', 0.5' : '') . ', i FROM generate_series(1, 9) AS i';
		change("SELECT abacus_insert(MESH, '$line')", "$what: points on a line");
		change("SELECT abacus_delete(MESH, 'SELECT 3, 0.3, 0.5" . ($dimension == 3 ? ', 0.5' : '') . "')", "$what: one of them goes");
		change("SELECT abacus_insert(MESH, '" . random_points(20, $dimension, 1) . "')", "$what: and others beside it");
		is_same("$what: from a line");
	}
}

# ---- Errors -------------------------------------------------------------------------------------------------

make('{s1,s2,s3,far}', 2, 'SELECT i, (i * 0.7548776662466927) % 1 AS x, (i * 0.5698402909980532) % 1 AS y, i AS h FROM generate_series(1, 400) AS i');
for my $call (
	"abacus_insert(MESH, 'SELECT 1, 1 * 0.7548776662466927 % 1, 1 * 0.5698402909980532 % 1, 1', 'error')",
	"abacus_insert(MESH, 'SELECT 1, 2, 3')", "abacus_insert(MESH, 'SELECT 1, 2, 3, 4', 'perhaps')",
	"abacus_insert(MESH, 'SELECT 1, ''NaN''::float8, 3, 4')", "abacus_update(MESH, 'SELECT 1, 2, 3')",
	"abacus_update(MESH, 'SELECT 1, 2.0 AS x, 3.0 AS y, 4 AS h')", "abacus_update(MESH, 'SELECT 1, 2.0 AS x, 3.0 AS y, 4 AS g')",
	"abacus_insert(MESH, 'SELECT 1 / 0, 2, 3, 4')")
{
	like(change("SELECT $call", $call), qr/ERROR/, "$call: an error");
}
is_same('after errors');
fails("SELECT abacus_insert('many', 'SELECT abacus_insert(''many'', ''SELECT 1, 2, 3, 4''), 0.5, 0.5, 1')", qr/55006.*is being changed/, 'a change within a change');
fails("BEGIN; SELECT abacus_insert('many', 'SELECT 1, 2, 3, 4'); PREPARE TRANSACTION 'mine'", qr/0A000.*cannot PREPARE/, 'the transaction cannot be prepared');
fails("BEGIN READ ONLY; SELECT abacus_insert('many', 'SELECT 1, 2, 3, 4')", qr/25006/, 'a read-only transaction');
$node->safe_psql('postgres', "CREATE USER low; GRANT SELECT ON many TO low");
fails("SET ROLE low; SELECT abacus_insert('many', 'SELECT 1, 2, 3, 4')", qr/42501.*permission denied for table many/, 'no right to change');
is_same('after refusals');

# ---- Transactions --------------------------------------------------------------------------------------------

my $point = "SELECT 900, 0.31, 0.32, 5";
$node->safe_psql('postgres', <<SQL);
BEGIN; SELECT abacus_insert('many', '$point'); ROLLBACK;
SQL
is_same('ROLLBACK');
is($node->safe_psql('postgres', <<SQL), "1\n900\n1\n1\n901\n900\n1\n1\n900", 'savepoints');
BEGIN;
SELECT abacus_insert('many', '$point');
SELECT vertex FROM abacus_nearest('many', 0.31, 0.32);
SAVEPOINT a;
SELECT abacus_insert('many', 'SELECT 901, 0.311, 0.32, 6');
SAVEPOINT b;
SELECT abacus_delete('many', '$point');
SELECT vertex FROM abacus_nearest('many', 0.31, 0.32);
ROLLBACK TO a;
SELECT vertex FROM abacus_nearest('many', 0.311, 0.32);
SAVEPOINT c;
SELECT abacus_insert('many', 'SELECT 902, 0.7, 0.72, 6');
RELEASE c;
SAVEPOINT d;
SELECT abacus_delete('many', 'SELECT 902, 0.7, 0.72');
ROLLBACK TO d;
SELECT vertex FROM abacus_nearest('many', 0.31, 0.32);
COMMIT;
SQL
$node->safe_psql('postgres', "SELECT abacus_insert('one', '$point'); SELECT abacus_insert('one', 'SELECT 902, 0.7, 0.72, 6')");
is_same('savepoints');
# an error on a server in a block that catches it
is($node->safe_psql('postgres', <<'SQL'), "1\n\n900", 'an error that is caught');
BEGIN;
SELECT abacus_delete('many', 'SELECT 902, 0.7, 0.72');
DO $$ BEGIN
	PERFORM abacus_insert('many', 'SELECT 903, 0.9, 0.9, 1');
	PERFORM abacus_update('many', 'SELECT 5, 0.123 AS x, 0.234 AS y, 3 AS h');
EXCEPTION WHEN invalid_parameter_value THEN NULL; END $$;
SELECT abacus_locate('many', 5, 5);
SELECT vertex FROM abacus_nearest('many', 0.31, 0.32);
COMMIT;
SQL
$node->safe_psql('postgres', "SELECT abacus_delete('one', 'SELECT 902, 0.7, 0.72')");
is_same('an error that is caught');
# two writers, and a reader that keeps its snapshot
{
	my $one = $node->background_psql('postgres');
	my $two = $node->background_psql('postgres', on_error_stop => 0);
	$two->query_safe("BEGIN ISOLATION LEVEL REPEATABLE READ; SELECT vertex FROM abacus_nearest('many', 0.5, 0.5)");
	$one->query_safe("BEGIN; SELECT abacus_insert('many', 'SELECT 910, 0.55, 0.55, 1')");
	is($node->safe_psql('postgres', "SELECT vertex FROM abacus_nearest('many', 0.55, 0.55)") == 910 ? 1 : 0, 0, 'a change that is not committed is not seen');
	my ($out, $err);
	$node->psql('postgres', "SET lock_timeout = '100ms'; SELECT abacus_insert('many', 'SELECT 911, 0.6, 0.6, 1')", stderr => \$err);
	like($err, qr/lock timeout/, 'another writer waits');
	$one->query_safe('COMMIT');
	$one->quit;
	isnt($two->query("SELECT vertex FROM abacus_nearest('many', 0.55, 0.55)"), '910', 'a snapshot stays as it is');
	$two->query('COMMIT; BEGIN ISOLATION LEVEL REPEATABLE READ; SELECT 1');
	$node->safe_psql('postgres', "SELECT abacus_delete('many', 'SELECT 910, 0.55, 0.55')");
	$two->{stderr} = '';
	$two->query("SELECT vertex FROM abacus_nearest('many', 0.55, 0.55)");
	like($two->{stderr}, qr/was changed since the transaction began/, 'a snapshot without a transaction on the servers');
	$two->quit;
}
is_same('two sessions');
# the check sees each change whole
fails("BEGIN; SELECT abacus_insert('many', 'SELECT 1, 2, 3, 4'); SELECT * FROM abacus_check('many')", qr/55006.*cannot check/, 'a check in a transaction with changes');
{
	my ($out, $err) = ('', '');
	my $sql = join('', map { "SELECT abacus_insert('many', 'SELECT 920 + i, i / 9.0, (i * 4 % 9) / 9.0, 1 FROM generate_series(1, 8) AS i');\n"
		. "SELECT abacus_delete('many', 'SELECT 920 + i, i / 9.0, (i * 4 % 9) / 9.0 FROM generate_series(1, 8) AS i');\n" } 1 .. 40);
	my $writer = IPC::Run::start([ 'psql', '-XqAt', '-v', 'ON_ERROR_STOP=1', '-d', $node->connstr('postgres') ], '<', \$sql, '>', \$out, '2>', \$err);
	my $faults = '';
	my $checks = 0;
	while ($writer->pumpable && $checks < 25)
	{
		$writer->pump_nb;
		$faults .= $node->safe_psql('postgres', "SELECT * FROM abacus_check('many')");
		$checks++;
	}
	$writer->finish;
	is("$faults$err", '', "$checks checks beside a writer");
}
is_same('checked beside a writer');

# ---- Failures -----------------------------------------------------------------------------------------------

# Servers and sessions are killed while points come and go. What was committed is there; the rest is not.
my $committed = 0;
for my $kill (1 .. $kills_each)
{
	my $first = 20_000 + 1000 * $kill;
	my ($out, $err) = ('', '');
	my $sql = join('', map { my $i = $first + $_; "SELECT abacus_insert('many', 'SELECT $i, ($i * 0.7548776662466927) % 1, ($i * 0.5698402909980532) % 1, $i') \\g (format=unaligned)\n" } 1 .. 200);
	my $session = IPC::Run::start([ 'psql', '-XqAt', '-v', 'ON_ERROR_STOP=1', '-d', $node->connstr('postgres') ], '<', \$sql, '>', \$out, '2>', \$err);
	usleep(300_000 + rand(700_000));
	my $how = $kill % 3;
	if ($how == 0)
	{
		my @backends = split /\n/, $other->safe_psql('postgres', 'SELECT pid FROM pg_stat_activity WHERE pid <> pg_backend_pid()');
		$other->kill9;
		kill 9, @backends;
		$session->finish;
		AbacusCrash::start_again($other);
	}
	elsif ($how == 1)
	{
		$node->safe_psql('postgres', "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = 'shard1'");
		$session->finish;
	}
	else
	{
		my @backends = split /\n/, $node->safe_psql('postgres', 'SELECT pid FROM pg_stat_activity WHERE pid <> pg_backend_pid()');
		$node->kill9;
		kill 9, @backends;
		$session->finish;
		AbacusCrash::start_again($node);
	}
	$node->safe_psql('postgres', "SELECT abacus_shard_resolve('many')");
	my $seen = $node->safe_psql('postgres', "SELECT max(id) FROM abacus_vertices('many') WHERE id > $first");
	my $said = () = $out =~ /^1$/mg;
	$seen = $seen eq '' ? 0 : $seen - $first;
	ok($seen == $said || $seen == $said + 1, "kill $kill: $seen points are there, of which $said were reported");
	$node->safe_psql('postgres', "SELECT abacus_insert('one', 'SELECT i, (i * 0.7548776662466927) % 1, (i * 0.5698402909980532) % 1, i FROM generate_series($first + 1, $first + $seen) AS i')") if $seen;
	is_same("kill $kill");
}

# A change that waits for its end: of a transaction that has failed, and of one that was committed.
my ($mesh) = $node->safe_psql('postgres', "SELECT shard_mesh FROM abacus_shards('many') WHERE shard = 2");
my $version = $node->safe_psql('postgres', "SELECT versions[2] FROM many WHERE phase = 'published'");
$node->safe_psql('shard2', "BEGIN; UPDATE ${mesh}_version SET version = $version + 1; PREPARE TRANSACTION '${mesh}_" . ($version + 1) . "_1'");
like($node->safe_psql('postgres', "SELECT doing FROM abacus_shards('many') WHERE shard = 2"), qr/^prepared: $mesh/, 'abacus_shards names what waits');
is($node->safe_psql('postgres', "SELECT abacus_shard_resolve('many')"), 1, 'resolved');
is($node->safe_psql('shard2', "SELECT version FROM ${mesh}_version"), $version, 'it was rolled back');
$node->safe_psql('shard2', "BEGIN; UPDATE ${mesh}_version SET version = $version; PREPARE TRANSACTION '${mesh}_${version}_1'");
change("SELECT abacus_insert(MESH, 'SELECT 30000, 0.41, 0.42, 7')", 'a writer ends what waits');
is($node->safe_psql('shard2', 'SELECT count(*) FROM pg_prepared_xacts'), 0, 'nothing waits');
is_same('resolved');
$node->safe_psql('shard2', "UPDATE ${mesh}_version SET version = version + 1");
fails("SELECT abacus_locate('many', 0.5, 0.5)", qr/55000.*is not as the mesh was last changed/, 'another version than the coordinator has');

$other->stop;
$node->stop;
done_testing();
