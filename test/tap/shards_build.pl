# The build of a mesh over several servers: builds that meet, errors and notices, what each server keeps, what is
# shown meanwhile; and whatever is killed, cut or full in each phase, the same call ends right.
# ABACUS_KILLS   how often a server is killed or cut off (default 50; 9 are each way in each phase)
# ABACUS_SMALL_DISK   an empty folder on a file system of about 14 MB (scripts/test.sh mounts one)
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusCrash;
use AbacusShards;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;
use Time::HiRes qw(time usleep);

my $kills = $ENV{ABACUS_KILLS} || 50;
my $node = shards_node('coordinator');
my $other = shards_node('other');
$node->safe_psql('postgres', 'CREATE EXTENSION abacus; CREATE EXTENSION dblink');
shards_server($node, "s$_", $node) for 1 .. 3;
shards_server($node, 'far', $other);

sub sql { return $node->safe_psql('postgres', $_[0]); }
sub fails { return shards_fails($node, @_); }

# ---- Builds that meet ---------------------------------------------------------------------------------------

my @builds = map { "SELECT i, (i * 0.7548776662466927 + $_ / 10.0) % 1, (i * 0.5698402909980532) % 1, i AS h FROM generate_series(1, 12000) AS i" } 0 .. 1;
sql("SELECT abacus_triangulate('wanted$_', '$builds[$_]')") for 0 .. 1;
sql("SELECT abacus_shard_create('met', '{s1,s2}')");
for my $isolation ('read committed', 'repeatable read')
{
	my (@out, @err);
	my @sessions = map { shards_in_background($node, \$out[$_], \$err[$_], "SET default_transaction_isolation = '$isolation'",
			"CALL abacus_shard_build('met', '$builds[$_]')", 'SELECT clock_timestamp()') } 0 .. 1;
	$_->finish for @sessions;
	unlike("@err", qr/ERROR/, "two builds at once, $isolation");
	my $last = $out[0] gt $out[1] ? 0 : 1;
	shards_is_same($node, 'met', "wanted$last", "the later one, $isolation");
}
{
	my ($out, $err);
	my $session = shards_in_background($node, \$out, \$err, "CALL abacus_shard_build('met', '$builds[0]')");
	ok($node->poll_query_until('postgres', "SELECT EXISTS (SELECT FROM pg_locks WHERE mode = 'ShareUpdateExclusiveLock' AND granted AND relation = 'met'::regclass)"), 'a build is running');
	sql("SELECT abacus_shard_drop('met')");
	$session->finish;
	is($err, '', 'one that is dropped ends first');
	is($node->safe_psql("s$_", "SELECT count(*) FROM pg_class WHERE relname LIKE 'abacus\\__%' AND relkind = 'r'"), 0, "nothing is left on server $_") for 1 .. 2;
}
{
	my $call = sprintf("dblink_exec('host=%s port=%s dbname=postgres', \$\$CALL abacus_shard_build('seen', '%s')\$\$)", $node->host, $node->port, $builds[0] =~ s/12000/600/r);
	sql("SELECT abacus_shard_create('seen', '{s1,s2}'); SELECT $call");
	sql("BEGIN ISOLATION LEVEL REPEATABLE READ; SELECT FROM pg_class LIMIT 1; SELECT $call; SELECT abacus_shard_drop('seen'); COMMIT");
	is($node->safe_psql("s$_", "SELECT count(*) FROM pg_class WHERE relname LIKE 'abacus\\__%' AND relkind = 'r'"), 0, "nor of a build that the snapshot does not show, on server $_") for 1 .. 2;
}

# ---- A mesh is dropped with its transaction ------------------------------------------------------------------

sub tables { return join ' ', map { my ($cluster, $database) = @$_; $cluster->safe_psql($database, "SELECT count(*) FROM pg_class WHERE relname LIKE 'abacus\\__%' AND relkind = 'r'") } [ $node, 's1' ], [ $other, 'far' ]; }
sql("SELECT abacus_shard_create('going', '{s1,far}'); CALL abacus_shard_build('going', '$builds[0]')");
is(tables(), '5 5', 'tables of a mesh');
sql("BEGIN; SELECT abacus_shard_drop('going'); ROLLBACK");
sql("BEGIN; SAVEPOINT a; SELECT abacus_shard_drop('going'); ROLLBACK TO a; SELECT count(*) FROM abacus_cells('going'); COMMIT");
shards_is_same($node, 'going', 'wanted0', 'a drop that is rolled back');
fails("BEGIN; SELECT abacus_shard_drop('going'); PREPARE TRANSACTION 'p'", qr/0A000.*cannot PREPARE|55000.*prepared transactions are disabled/, 'a drop that is prepared');
is(tables(), '5 5', 'nothing is dropped');
sql("BEGIN; SAVEPOINT a; SELECT abacus_shard_drop('going'); RELEASE a; COMMIT");
is(tables(), '0 0', 'dropped');
{
	sql("SELECT abacus_shard_create('going', '{s1,far}'); CALL abacus_shard_build('going', '$builds[0]')");
	my ($out, $err);
	my $session = shards_in_background($node, \$out, \$err, 'BEGIN', "SELECT abacus_shard_drop('going')", 'SELECT pg_sleep(2)', 'COMMIT');
	ok($node->poll_query_until('postgres', "SELECT EXISTS (SELECT FROM pg_stat_activity WHERE query LIKE 'SELECT pg_sleep%')"), 'a drop waits');
	$other->safe_psql('postgres', "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = 'far'");
	$session->finish;
	like($err, qr/WARNING.*tables abacus_\w+, abacus_\w+_guests, abacus_\w+_arrivals and abacus_\w+_version remain on server "far"/, 'a server that is lost before the commit');
	is(tables(), '0 5', 'the others are dropped');
	my ($mesh) = $err =~ /tables (abacus_\w+),/;
	$other->safe_psql('far', "DROP TABLE $mesh, ${mesh}_guests, ${mesh}_arrivals, ${mesh}_version");
	is(tables(), '0 0', 'and those, as the warning says');
}

# ---- A part of a mesh is missing ------------------------------------------------------------------------------

sql("SELECT abacus_shard_create('torn', '{s1,far}'); CALL abacus_shard_build('torn', '$builds[0]')");
{
	my ($out, $err, $held, $nothing);
	my $lock = shards_in_background($node, \$held, \$nothing, "SELECT pg_advisory_lock(1), 'held'", 'SELECT pg_sleep(3600)');
	$lock->pump until $held =~ /held/;
	my $session = shards_in_background($node, \$out, \$err, 'BEGIN ISOLATION LEVEL REPEATABLE READ', "SELECT count(*), 'seen' FROM torn",
		'SELECT pg_advisory_lock(1)', "SELECT count(*) FROM abacus_cells('torn')");
	$session->pump until $out =~ /seen/;
	sql("CALL abacus_shard_build('torn', '$builds[$_]')") for 1, 0;
	sql("SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE query LIKE 'SELECT pg_sleep%'");
	$_->finish for $session, $lock;
	like($err, qr/40001.*mesh "torn" was built again since the transaction began.*HINT:  Repeat the transaction/s, 'a snapshot that is older than two builds');
}
my ($torn) = sql("SELECT shard_mesh FROM abacus_shards('torn') WHERE shard = 2");
$other->safe_psql('far', "DROP TABLE $torn CASCADE");
fails("SELECT count(*) FROM abacus_cells('torn')", qr/42P01.*"$torn" does not exist.*HINT:  If the mesh was built again meanwhile, repeat the transaction/s, 'a part that is missing');
is(sql("SELECT state FROM abacus_shards('torn') WHERE shard = 2"), 'absent', 'it is shown as absent');
sql("CALL abacus_shard_build('torn', '$builds[1]')");
shards_is_same($node, 'torn', 'wanted1', 'built again');
sql("SELECT abacus_shard_drop('torn')");

# ---- Errors and notices -------------------------------------------------------------------------------------

sub first_line
{
	my ($statement) = @_;
	my ($out, $err);
	$node->psql('postgres', $statement, stdout => \$out, stderr => \$err);
	return join "\n", grep { /ERROR|NOTICE|DETAIL|HINT/ } map { s/^psql:\S+ //r } split /\n/, $err;
}
my %odd = (
	'a NULL' => 'SELECT i, NULLIF(i, 7)::float8, i FROM generate_series(1, 9) AS i',
	'a NaN' => "SELECT i, CASE i WHEN 7 THEN ''NaN'' ELSE i END::float8, i FROM generate_series(1, 9) AS i",
	'an infinity' => "SELECT i, i, CASE i WHEN 7 THEN ''Infinity'' ELSE i END::float8 FROM generate_series(1, 9) AS i",
	'no id' => 'SELECT NULLIF(i, 7), i, i FROM generate_series(1, 9) AS i',
	'a text' => "SELECT i, ''x''::text, i FROM generate_series(1, 9) AS i",
	'too few columns' => 'SELECT i, i FROM generate_series(1, 9) AS i',
	'no query' => 'DELETE FROM points',
	'duplicates' => 'SELECT i, (i % 7)::float8, (i % 11)::float8, i AS h FROM generate_series(1, 300) AS i',
	'a point' => 'SELECT 1, 2.0, 3.0',
	'a line' => 'SELECT i, i % 50, 2 * (i % 50), i AS h FROM generate_series(1, 90) AS i',
	'duplicates in space' => 'SELECT i, (i % 7)::float8, (i % 11)::float8, (i % 5)::float8 FROM generate_series(1, 900) AS i',
	'a plane' => 'SELECT i, (i % 7)::float8, (i % 11)::float8, 1.0 FROM generate_series(1, 90) AS i');
for my $what (sort keys %odd)
{
	my $dimension = $what =~ /space|plane/ ? 3 : 2;
	my $wanted = first_line("SELECT abacus_triangulate('odd', '$odd{$what}', dimension => $dimension)");
	sql("DROP TABLE IF EXISTS odd, odd_vertices; SELECT abacus_shard_create('odd', '{s1,s2}', $dimension)");
	$wanted =~ s/\nHINT:  Use on_duplicate.*//;
	like($wanted, qr/ERROR|NOTICE/, "$what: one server says something");
	is(first_line("CALL abacus_shard_build('odd', '$odd{$what}')"), $wanted, "$what: several say the same");
	sql("SELECT abacus_shard_drop('odd')");
}

sql("SELECT abacus_shard_create('named', '{s1,s2}')");
fails("CALL abacus_shard_build('named', ARRAY['SELECT 1, 2.0, 3.0, 4 AS a, 5 AS b', 'SELECT 1, 2.0, 3.0, 4 AS b, 5 AS a'])",
	qr/42804.*attribute 1 is named "b" in query 2, but "a" in query 1/, 'columns in another order');
fails("CALL abacus_shard_build('named', ARRAY['SELECT 1, 2.0, 3.0, 4 AS a', 'SELECT 1, 2.0, 3.0'])",
	qr/42804.*query 2 has 0 columns after the coordinates, but the mesh has 1 attributes/, 'a column less');
fails("CALL abacus_shard_build('named', ARRAY['SELECT 1, 2.0, 3.0', 'SELECT i, 1.0 / (i - 2), 3.0 FROM generate_series(1, 3) AS i'])",
	qr/22012/, 'a query that fails on its server');
sql("SELECT abacus_shard_drop('named')");

SKIP:
{
	skip 'PostGIS is not installed', 4 unless sql("SELECT count(*) FROM pg_available_extensions WHERE name IN ('postgis', 'abacus_postgis')") == 2;
	$node->safe_psql($_, 'CREATE EXTENSION postgis') for qw(postgres s1 s2);
	sql("SELECT abacus_shard_create('swiss', '{s1,s2}')");
	my $geometries = 'SELECT i AS id, ST_SetSRID(ST_MakePoint((i * 0.75) % 1, (i * 0.57) % 1), SRID) AS geom, i AS h FROM generate_series(1, 200) AS i';
	(my $swiss = $geometries) =~ s/SRID\)/2056)/;
	(my $world = $geometries) =~ s/SRID\)/4326)/;
	sql("CALL abacus_shard_build('swiss', '$swiss')");
	my ($mesh) = sql("SELECT shard_mesh FROM abacus_shards('swiss') WHERE shard = 2");
	is($node->safe_psql('s2', "SELECT abacus_srid('$mesh')") . sql("SELECT abacus_srid('swiss')"), '20562056', 'the SRID of geometries is kept');
	sql("SELECT abacus_triangulate('one', '$swiss')");
	shards_is_same($node, 'swiss', 'one', 'geometries');
	sql("CALL abacus_shard_build('swiss', ARRAY['$swiss', '$world LIMIT 0'])");
	shards_is_same($node, 'swiss', 'one', 'geometries of the servers');
	fails("CALL abacus_shard_build('swiss', ARRAY['$swiss', '$world'])", qr/22023.*query 2 has geometries of SRID 4326, but earlier ones have SRID 2056/, 'another SRID');
	sql("SELECT abacus_shard_drop('swiss'); DROP TABLE one, one_vertices");
}

# ---- What each server keeps ---------------------------------------------------------------------------------

# Each database has figures of its own. Rows that are aligned with the curve nearly all stay where they are.
my $points = 60000;
sub temporary_bytes
{
	my ($database) = @_;
	$node->safe_psql($database, 'SELECT pg_stat_force_next_flush()') if $node->pg_version >= 15;
	return $node->safe_psql($database, "SELECT temp_bytes FROM pg_stat_database WHERE datname = current_database()");
}
sql("SELECT abacus_shard_create('kept', '{s1,s2,s3}')");
my @own = map { "SELECT i AS id, (i * 0.7548776662466927) % 1 AS x, (i * 0.5698402909980532) % 1 AS y, i / 2.0 AS h FROM generate_series(1, $points) AS i WHERE i % 3 = $_" } 0 .. 2;
my %forms = ('one query' => "'SELECT i AS id, (i * 0.7548776662466927) % 1 AS x, (i * 0.5698402909980532) % 1 AS y, i / 2.0 AS h FROM generate_series(1, $points) AS i'",
	'three queries' => 'ARRAY[' . join(', ', map { "'$_'" } @own) . ']');
for my $form (sort keys %forms)
{
	my %before = map { $_ => temporary_bytes($_) } qw(postgres s1 s2 s3);
	my ($out, $err);
	# a function scan writes its rows to a temporary file, beyond work_mem
	my $session = shards_in_background($node, \$out, \$err, "SET work_mem = '64MB'", "CALL abacus_shard_build('kept', $forms{$form})");
	my (%phases, %most);
	until ($out || !$session->pumpable)
	{
		$session->pump_nb;
		$phases{$_}++ for split /\n/, sql("SELECT phase FROM abacus_progress WHERE mesh = 'kept'::regclass");
	}
	$session->finish;
	is($err, '', "$form: built");
	cmp_ok(scalar(grep { /^(spreading|triangulating|exchanging)$/ } keys %phases), '>=', 2, "$form: its phases are shown");
	is(temporary_bytes('postgres') - $before{postgres}, 0, "$form: the coordinator writes no temporary file");
	cmp_ok(sql("SELECT pg_total_relation_size('kept')"), '<', 200_000, "$form: nor much into its table");
	my ($all, $least, $most, $guests) = split /\|/, sql("SELECT sum(points), min(points), max(points), sum(guests) FROM abacus_shards('kept')");
	is($all, $points, "$form: each point is on one server");
	cmp_ok($most, '<', 1.2 * $points / 3, "$form: a third of them on each");
	cmp_ok($guests, '<', $points / 10, "$form: few travel");
	for my $shard (1 .. 3)
	{
		# 40 bytes a point: those of its query, and those that it owns
		cmp_ok(temporary_bytes("s$shard") - $before{"s$shard"}, '<=', 2 * 1.2 * 40 * $points / 3, "$form: nor does shard $shard write more than its own");
		my ($mesh, $bytes) = split /\|/, sql("SELECT shard_mesh, bytes FROM abacus_shards('kept') WHERE shard = $shard");
		cmp_ok($bytes, '<', 200 * ($most + $guests), "$form: tables of shard $shard have its own rows and guests");
		is($node->safe_psql("s$shard", "SELECT count(*) FROM abacus_vertices('$mesh')"),
			sql("SELECT points + guests FROM abacus_shards('kept') WHERE shard = $shard"), "$form: shard $shard has no others");
	}
}
is(sql("SELECT count(*) FROM abacus_progress"), 0, 'and nothing is shown afterwards');
sql("SELECT abacus_shard_drop('kept')");

# ---- Failures in each phase ---------------------------------------------------------------------------------

my @phases = qw(spreading triangulating exchanging);
my @ways = ('the coordinator is killed', 'a server is killed', 'a connection is cut');

sub kill_cluster
{
	my ($cluster) = @_;
	# all of them: a backend that waits notices nothing
	my @backends = split /\n/, $cluster->safe_psql('postgres', 'SELECT pid FROM pg_stat_activity WHERE pid <> pg_backend_pid()');
	$cluster->kill9;
	kill 9, @backends;
	AbacusCrash::start_again($cluster);
	return;
}

sql("SELECT abacus_shard_create('hit', '{s1,s2,far}'); CALL abacus_shard_build('hit', '$builds[1]')");
for my $kill (0 .. $kills - 1)
{
	my $phase = $phases[$kill % 3];
	my $way = $ways[int($kill / 3) % 3];
	my $now = $kill % 2;
	my ($out, $err);
	my $session = shards_in_background($node, \$out, \$err, "CALL abacus_shard_build('hit', '$builds[$now]')");
	my $is_seen = 0;
	while ($session->pumpable && !$is_seen)
	{
		$session->pump_nb;
		$is_seen = sql("SELECT count(*) FROM abacus_progress WHERE phase = '$phase'");
		usleep(2000);
	}
	usleep(rand(20_000));
	if ($way =~ /coordinator/) { kill_cluster($node) }
	elsif ($way =~ /server/) { kill_cluster($other) }
	else { $other->safe_psql('postgres', "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = 'far'") }
	$session->finish;
	my $seen = sql("SELECT value FROM abacus_stats('hit') WHERE name = 'points'");
	is($seen, 12000, "$way while $phase: a whole mesh can be read");
	sql("CALL abacus_shard_build('hit', '$builds[$now]')");
	shards_is_same($node, 'hit', "wanted$now", "$way while $phase");
}

# ---- A full disk on one server ------------------------------------------------------------------------------

SKIP:
{
	my $disk = $ENV{ABACUS_SMALL_DISK};
	skip 'ABACUS_SMALL_DISK is not set', 3 unless $disk;
	$other->safe_psql('postgres', "CREATE TABLESPACE small LOCATION '$disk'");
	$other->safe_psql('far', 'ALTER DATABASE far SET default_tablespace = small');
	my $many = 'SELECT i, (i * 0.7548776662466927) % 1, (i * 0.5698402909980532) % 1, ' . join(', ', map { "i AS h$_" } 1 .. 12) . ' FROM generate_series(1, 250000) AS i';
	fails("CALL abacus_shard_build('hit', '$many')", qr/53100.*could not extend file/, 'the disk of a server is full');
	is(sql("SELECT value FROM abacus_stats('hit') WHERE name = 'points'"), 12000, 'the former mesh can be read');
	$other->safe_psql('far', 'ALTER DATABASE far RESET default_tablespace');
	$other->safe_psql('far', "ALTER TABLE ALL IN TABLESPACE small SET TABLESPACE pg_default; ALTER INDEX ALL IN TABLESPACE small SET TABLESPACE pg_default");
	sql("CALL abacus_shard_build('hit', '$many')");
	is(sql("SELECT sum(points) FROM abacus_shards('hit')"), 250_000, 'with room the same call ends');
	is(sql("SELECT count(*) FROM abacus_check('hit')"), 0, 'and the mesh is sound');
	sql("SELECT abacus_shard_drop('hit')");
	$other->safe_psql('postgres', 'DROP TABLESPACE small');
}

$other->stop;
$node->stop;
done_testing();
