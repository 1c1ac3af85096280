# One mesh over several servers: databases of one cluster, and a second cluster. It has the simplices, ids and
# attributes of one server's mesh whatever the points, the number of shards and the order; answers on the
# coordinator are those of one server; whatever is killed, the same call ends right, and no reader sees half a mesh.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusCrash;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;
use Time::HiRes qw(usleep);

my $kills = $ENV{ABACUS_KILLS} || 5;
my $shards = 7;

my $node = PostgreSQL::Test::Cluster->new('coordinator');
$node->init;
$node->append_conf('postgresql.conf', "fsync = off\nmax_connections = 60");
$node->append_conf('pg_hba.conf', '');
my $hba = slurp_file($node->data_dir . '/pg_hba.conf');
unlink $node->data_dir . '/pg_hba.conf';
$node->append_conf('pg_hba.conf', "local all low scram-sha-256\n$hba");
$node->start;
my $other = PostgreSQL::Test::Cluster->new('other');
$other->init;
$other->append_conf('postgresql.conf', 'fsync = off');
$other->start;

my $user = $node->safe_psql('postgres', 'SELECT current_user');

# A foreign server for a database of a cluster.
sub add_server
{
	my ($name, $cluster, $database) = @_;
	$cluster->safe_psql('postgres', "CREATE DATABASE $database");
	$cluster->safe_psql($database, 'CREATE EXTENSION abacus');
	$node->safe_psql('postgres', sprintf(
		"CREATE SERVER %s FOREIGN DATA WRAPPER dblink_fdw OPTIONS (host '%s', port '%s', dbname '%s');
		CREATE USER MAPPING FOR CURRENT_USER SERVER %s OPTIONS (user '%s')",
		$name, $cluster->host, $cluster->port, $database, $name, $user));
	return;
}
$node->safe_psql('postgres', 'CREATE EXTENSION abacus; CREATE EXTENSION dblink');
add_server("s$_", $node, "shard$_") for 1 .. $shards;
add_server('far', $other, 'shard');

sub servers
{
	my ($count) = @_;
	return '{' . join(',', map { "s$_" } 1 .. $count) . '}';
}

# How many rows of a call on two meshes differ.
sub differing
{
	my ($call, $mesh, $one) = @_;
	(my $a = $call) =~ s/MESH/'$mesh'/g;
	(my $b = $call) =~ s/MESH/'$one'/g;
	return $node->safe_psql('postgres', "SELECT count(*) FROM (
		(SELECT r::text FROM $a AS r EXCEPT ALL SELECT r::text FROM $b AS r) UNION ALL
		(SELECT r::text FROM $b AS r EXCEPT ALL SELECT r::text FROM $a AS r)) AS other");
}
sub is_same
{
	my ($mesh, $one, $what) = @_;
	# points that wait are counted in each shard, so their sequence may differ
	is( differing('abacus_cells(MESH)', $mesh, $one) . ' '
		  . differing('(SELECT id, x, y, z, attributes, vertex FROM abacus_vertices(MESH))', $mesh, $one),
		'0 0', "$what: simplices and points are those of one server");
	return;
}

# ---- The same mesh ------------------------------------------------------------------------------------------

my %points = (
	uniform => ['SELECT i, (i * 0.7548776662466927) % 1, (i * 0.5698402909980532) % 1, i / 3.0 FROM generate_series(1, 1500) AS i',
		'SELECT i, (i * 0.8191725133961645) % 1, (i * 0.6710436067037893) % 1, (i * 0.5497004779019703) % 1, i / 3.0 FROM generate_series(1, 700) AS i'],
	grid => ['SELECT 100 * i + j, i, j, i + j FROM generate_series(1, 30) AS i, generate_series(1, 30) AS j ORDER BY hashint4(100 * i + j)',
		'SELECT 100 * i + 10 * j + k, i, j, k, i FROM generate_series(0, 8) AS i, generate_series(0, 8) AS j, generate_series(0, 8) AS k'],
	cospherical => ['SELECT 1000 * x + y, x, y, x FROM generate_series(-65, 65) AS x, generate_series(-65, 65) AS y WHERE x * x + y * y = 4225 OR x * x + y * y = 625',
		'SELECT 10000 * x + 100 * y + z, x, y, z, x FROM generate_series(-15, 15) AS x, generate_series(-15, 15) AS y, generate_series(-15, 15) AS z WHERE x * x + y * y + z * z = 225'],
	clusters => ['SELECT i, (i % 5) * 100 + (i * 0.754877) % 1, (i % 3) * 100 + (i * 0.569840) % 1, i FROM generate_series(1, 1000) AS i',
		'SELECT i, (i % 5) * 100 + (i * 0.754877) % 1, (i % 3) * 100 + (i * 0.569840) % 1, (i * 0.4142) % 1, i FROM generate_series(1, 500) AS i'],
	'one shard' => ['SELECT i, CASE WHEN i > 1 THEN 1 + (i * 0.754877) % 1 / 1e6 ELSE 0 END, CASE WHEN i > 1 THEN 1 + (i * 0.569840) % 1 / 1e6 ELSE 0 END, i FROM generate_series(1, 500) AS i',
		'SELECT i, CASE WHEN i > 1 THEN 1 + (i * 0.754877) % 1 / 1e6 ELSE 0 END, 1 + (i * 0.569840) % 1 / 1e6, 1 + (i * 0.4142) % 1 / 1e6, i FROM generate_series(1, 300) AS i'],
	line => ['SELECT i, i % 200, 3.0, i FROM generate_series(1, 300) AS i', 'SELECT i, i % 200, 3.0, 2 * (i % 200), NULL::float8 FROM generate_series(1, 300) AS i'],
	none => ['SELECT i, 0.0, 0.0, 0.0 FROM generate_series(1, 0) AS i', 'SELECT i, 0.0, 0.0, 0.0, 0.0 FROM generate_series(1, 0) AS i'],
	duplicates => ['SELECT i, (i * 7919) % 20, (i * 104729) % 23, i FROM generate_series(1, 1200) AS i',
		'SELECT i, (i * 7919) % 8, (i * 104729) % 7, (i * 1299709) % 9, nullif(i % 5, 0) FROM generate_series(1, 900) AS i']);

for my $name (sort keys %points)
{
	for my $dimension (2, 3)
	{
		my $query = $points{$name}[$dimension - 2];
		my @counts = $name eq 'uniform' ? (1, 2, 4, 7) : $name =~ /grid|dup/ ? (2, 7) : (4);
		$node->safe_psql('postgres', "SELECT abacus_triangulate('one', '$query', dimension => $dimension)");
		for my $count (@counts)
		{
			my $what = "$name in $dimension dimensions over $count";
			$node->safe_psql('postgres', sprintf "SELECT abacus_shard_create('many', '%s', %d)", servers($count), $dimension);
			$node->safe_psql('postgres', "CALL abacus_shard_build('many', '$query')");
			is_same('many', 'one', $what);
			# the vertices as places: some have the greatest code that there is
			my $places = 'SELECT id, x, y' . ($dimension == 3 ? ', z' : '') . " FROM abacus_vertices(''one'') WHERE id % 3 = 0";
			is(differing("abacus_locate(MESH, '$places')", 'many', 'one'), 0, "$what: places");
			is($node->safe_psql('postgres', "SELECT * FROM abacus_check('many')"), '', "$what: sound");
			is( $node->safe_psql('postgres', "SELECT m.value - o.value FROM abacus_stats('many') AS m JOIN abacus_stats('one') AS o USING (name) WHERE name IN ('points', 'vertices', 'duplicates', 'simplices') ORDER BY name"),
				"0\n0\n0\n0", "$what: figures");
			$node->safe_psql('postgres', "SELECT abacus_shard_drop('many')");
		}
		$node->safe_psql('postgres', 'DROP TABLE one');
	}
}
is($node->safe_psql("shard$_", "SELECT count(*) FROM pg_class WHERE relname LIKE 'abacus\\__%' AND relkind = 'r'"),
	0, "nothing is left in database $_") for 1 .. $shards;

# A query for each shard. Many places are in all of them: the first query's row is the vertex.
$node->safe_psql("shard$_", "CREATE TABLE own AS SELECT 10 * i + $_ AS id, (i * 7919 * $_) % 41 AS x, (i * 104729 + $_) % 43 AS y, i / 7.0 AS h FROM generate_series(1, 500) AS i") for 1 .. 4;
my @own = map { "SELECT id, x, y, h FROM own ORDER BY id" . ($_ == 3 ? ' DESC;' : '') } 1 .. 4;
my $queries = 'ARRAY[' . join(', ', map { "'$_'" } @own) . ']';
$node->safe_psql('postgres', "CREATE TABLE all_own (n serial, id bigint, x float8, y float8, h float8)");
$node->safe_psql('postgres', "INSERT INTO all_own (id, x, y, h) SELECT * FROM dblink('s$_', '$own[$_ - 1]') AS t(id bigint, x float8, y float8, h float8)") for 1 .. 4;
$node->safe_psql('postgres', "SELECT abacus_triangulate('one', 'SELECT id, x, y, h FROM all_own ORDER BY n')");
$node->safe_psql('postgres', "SELECT abacus_shard_create('many', '{s1,s2,s3,s4}'); SET extra_float_digits = 0; CALL abacus_shard_build('many', $queries)");
is_same('many', 'one', 'a query for each shard');
is($node->safe_psql('postgres', "SELECT * FROM abacus_check('many')"), '', 'a query for each shard: sound');

# ---- Answers -------------------------------------------------------------------------------------------------

$node->safe_psql('postgres', "CREATE TABLE places AS SELECT i AS id, (i * 0.618) % 44 - 1 AS x, (i * 0.414) % 45 - 1 AS y FROM generate_series(1, 400) AS i UNION ALL SELECT id + 100000, x, y FROM all_own WHERE n % 7 = 0 UNION ALL SELECT n + 200000, x + 0.5, y FROM all_own WHERE n % 9 = 0");
for my $call (
	"abacus_locate(MESH, 'TABLE places')",
	"abacus_interpolate(MESH, 'TABLE places')",
	"abacus_interpolate(MESH, 'TABLE places', '{h}', max_edge => 2)",
	"abacus_weights(MESH, 'TABLE places')",
	"abacus_nearest(MESH, 'TABLE places', 3)",
	"(SELECT p.id, abacus_locate(MESH, p.x, p.y) FROM places AS p WHERE id % 4 = 0)",
	"(SELECT p.id, abacus_interpolate(MESH, p.x, p.y) FROM places AS p WHERE id % 4 = 0)",
	"(SELECT p.id, abacus_gradient(MESH, p.x, p.y) FROM places AS p WHERE id < 20)",
	"(SELECT p.id, abacus_slope(MESH, p.x, p.y) FROM places AS p WHERE id < 20)",
	"(SELECT p.id, s.* FROM places AS p, abacus_star(MESH, p.x, p.y) AS s WHERE p.id % 4 = 1)",
	"(SELECT p.id, w.* FROM places AS p, abacus_weights(MESH, p.x, p.y) AS w WHERE p.id % 4 = 1)",
	"(SELECT p.id, n.* FROM places AS p, abacus_nearest(MESH, p.x, p.y, 4) AS n WHERE p.id % 4 = 2)",
	"abacus_cells(MESH, '{3,3}', '{9,12}')", "abacus_cells(MESH, '{20,20}'::float8[], 3.5)",
	"abacus_simplices(MESH)", "abacus_simplices(MESH, '{0,0}'::float8[], '{5,5}'::float8[])",
	"abacus_vertices(MESH, '{20,20}'::float8[], 5.5)", "abacus_vertices(MESH, 'h', 3, 9)")
{
	is(differing($call, 'many', 'one'), 0, $call);
}
is($node->safe_psql('postgres', "SELECT abacus_locate('many', 'Infinity', 0) IS NULL AND abacus_locate('many', 1000, 0) IS NULL AND abacus_interpolate('many', NULL, 0) IS NULL"), 't', 'outside and NULL');

sub fails
{
	my ($sql, $pattern, $what) = @_;
	my ($out, $err);
	$node->psql('postgres', $sql, stdout => \$out, stderr => \$err, on_error_stop => 1, extra_params => [ '-v', 'VERBOSITY=verbose' ]);
	like($err, $pattern, $what);
	return;
}
fails("SELECT * FROM abacus_steps('many')", qr/0A000.*lies on several servers/, 'a function for meshes of one server');
fails("SELECT abacus_insert('many', 'SELECT 1, 2, 3, 4')", qr/55000.*takes no changes.*max_prepared_transactions is 0/, 'a change without prepared transactions');
fails("SELECT abacus_locate('many', 'NaN', 1)", qr/22023.*x is not a number/, 'a NaN');
fails("SELECT abacus_locate('many', 1, 1, 1)", qr/22023.*z is given/, 'a coordinate too many');
fails("SELECT * FROM abacus_nearest('many', 1, 1, 0)", qr/22023.*k must be at least 1/, 'no vertices');
fails("SET max_parallel_workers_per_gather = 2; SET parallel_setup_cost = 0; SET parallel_tuple_cost = 0; SET min_parallel_table_scan_size = 0; SELECT count(abacus_interpolate('many', x, y)) FROM places",
	qr/25000.*in a parallel query/, 'a parallel query');
fails("SELECT * FROM abacus_shards('one')", qr/42809.*is not a mesh over several servers/, 'a mesh of one server');
fails("BEGIN; CALL abacus_shard_build('many', 'SELECT 1, 2, 3, 4')", qr/2D000.*cannot commit/, 'a transaction block');
fails("CALL abacus_shard_build('many', ARRAY['SELECT 1, 2, 3, 4'])", qr/22023.*1 queries for 4 servers/, 'queries are missing');
fails("SELECT abacus_shard_create('x', '{nowhere}')", qr/42704.*server "nowhere" does not exist/, 'an unknown server');
$node->safe_psql('postgres', "CREATE FOREIGN DATA WRAPPER another; CREATE SERVER strange FOREIGN DATA WRAPPER another; CREATE USER MAPPING FOR CURRENT_USER SERVER strange");
fails("SELECT abacus_shard_create('x', '{strange}')", qr/42809.*is not one of dblink or postgres_fdw/, 'a server of another wrapper');
fails("SELECT abacus_locate('many', 1, 1); ALTER USER MAPPING FOR CURRENT_USER SERVER s1 OPTIONS (SET user 'nobody'); SELECT abacus_locate('many', 20.2, 20.1) FROM generate_series(1, 2)",
	qr/08001.*could not connect to server "s1".*role "nobody" does not exist/s, 'a mapping that was altered');
$node->safe_psql('postgres', "ALTER USER MAPPING FOR CURRENT_USER SERVER s1 OPTIONS (SET user '$user')");
fails("SELECT abacus_shard_create('x', '{}')", qr/22023.*servers must not be empty/, 'no server');
fails("SELECT abacus_shard_create('many', '{s1}')", qr/42P07/, 'a name that is taken');
fails("SELECT abacus_shard_create('x', '{s1}', 4)", qr/22023/, 'another dimension');
$node->safe_psql('postgres', "SELECT abacus_shard_create('empty', '{s1,s2}')");
fails("SELECT abacus_locate('empty', 1, 1)", qr/55000.*has not been built/, 'a mesh that is not built');
is($node->safe_psql('postgres', "SELECT shard, state FROM abacus_shards('empty')"), "1|absent\n2|absent", 'its shards');
$node->safe_psql('postgres', "SELECT abacus_shard_drop('empty')");

# ---- Failures -------------------------------------------------------------------------------------------------

# A build that fails leaves the mesh as it was to readers, and another query replaces it.
fails("CALL abacus_shard_build('many', 'SELECT i, i, 1 / (i - 5), 1 FROM generate_series(1, 9) AS i')", qr/22012/, 'a query that fails');
is_same('many', 'one', 'after a failed build');
$node->safe_psql('postgres', "CALL abacus_shard_build('many', 'SELECT id, x, y, h FROM all_own ORDER BY n')");
is_same('many', 'one', 'after another build');
is($node->safe_psql('postgres', "SELECT count(DISTINCT shard_mesh) FROM abacus_shards('many')"), 4, 'a mesh for each shard');

# A whole cluster is one of the shards. It is killed, connections are cut, and the coordinator's session, too, while
# readers ask all the time: they see the former mesh or the new one.
my @builds = map { "SELECT i, (i * 0.7548776662466927 + $_ / 10.0) % 1, (i * 0.5698402909980532) % 1, i FROM generate_series(1, 4000) AS i" } 0 .. 1;
$node->safe_psql('postgres', "SELECT abacus_triangulate('wanted$_', '$builds[$_]')") for 0 .. 1;
$node->safe_psql('postgres', "SELECT abacus_shard_create('hit', '{s1,s2,far}'); CALL abacus_shard_build('hit', '$builds[1]')");
is_same('hit', 'wanted1', 'with another cluster');
for my $kill (1 .. $kills)
{
	my $now = $kill % 2;
	my ($before, $query) = ("wanted" . (1 - $now), $builds[$now]);
	$query = $builds[0], $before = 'wanted1' if $kill == 1;
	my $wanted = $query eq $builds[0] ? 'wanted0' : 'wanted1';
	my ($out, $err) = ('', '');
	my $session = IPC::Run::start([ 'psql', '-XqAt', '-d', $node->connstr('postgres'), '-c', "CALL abacus_shard_build('hit', '$query')" ],
		'>', \$out, '2>', \$err);
	usleep(rand(900_000));
	my $how = $kill % 3;
	if ($how == 0)
	{
		# all of them: a backend that waits notices nothing
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
		$node->safe_psql('postgres', "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE query LIKE 'CALL abacus_shard_build%'");
		$session->finish;
	}
	my $seen = $node->safe_psql('postgres', "SELECT value FROM abacus_stats('hit') WHERE name = 'points'");
	is($seen, 4000, "kill $kill: a whole mesh can be read");
	$node->safe_psql('postgres', "CALL abacus_shard_build('hit', '$query')");
	is_same('hit', $wanted, "kill $kill: the same call");
	is($node->safe_psql('postgres', "SELECT * FROM abacus_check('hit')"), '', "kill $kill: sound");
}

# A cancelled build ends at once, and leaves nothing running on the servers.
{
	my ($out, $err) = ('', '');
	my $session = IPC::Run::start([ 'psql', '-XqAt', '-d', $node->connstr('postgres'),
			'-c', "CALL abacus_shard_build('hit', 'SELECT i, (i * 0.7548776662466927) % 1, (i * 0.5698402909980532) % 1, i FROM generate_series(1, 400000) AS i')" ],
		'>', \$out, '2>', \$err);
	usleep(1_500_000);
	my $started = time;
	is($node->safe_psql('postgres', "SELECT pg_cancel_backend(pid) FROM pg_stat_activity WHERE query LIKE 'CALL abacus_shard_build%'"), 't', 'a build is running');
	$session->finish;
	like($err, qr/canceling statement due to user request/, 'cancelled');
	cmp_ok(time - $started, '<', 5, 'at once');
	ok($node->poll_query_until('postgres', "SELECT count(*) = 0 FROM pg_stat_activity WHERE datname LIKE 'shard%' AND backend_type = 'client backend'"), 'nothing runs on the servers');
	is($node->safe_psql('postgres', "SELECT value FROM abacus_stats('hit') WHERE name = 'points'"), 4000, 'the former mesh is there');
}

# Damage is found.
$node->safe_psql('postgres', "CALL abacus_shard_build('hit', '$builds[0]')");
my ($mesh, $there) = split /\|/, $node->safe_psql('postgres', "SELECT shard_mesh, server FROM abacus_shards('hit') WHERE shard = 2");
$node->safe_psql('shard2', "CREATE TABLE kept AS TABLE ${mesh}_guests; UPDATE ${mesh}_guests SET id = id + 1 WHERE ctid = (SELECT min(ctid) FROM ${mesh}_guests)");
like($node->safe_psql('postgres', "SELECT * FROM abacus_check('hit')"), qr/^shards\|\|\|shard \d: 1 of its points are guests of other shards, with another id/m, 'a guest with another id');
$node->safe_psql('shard2', "DELETE FROM ${mesh}_guests; INSERT INTO ${mesh}_guests TABLE kept; DELETE FROM ${mesh}_guests WHERE ctid = (SELECT max(ctid) FROM ${mesh}_guests)");
like($node->safe_psql('postgres', "SELECT * FROM abacus_check('hit')"), qr/^shards\|\|\|shard 2: 1 points that another shard owns are not listed/m, 'a guest that is not listed');
$node->safe_psql('shard2', "DELETE FROM ${mesh}_guests; INSERT INTO ${mesh}_guests TABLE kept");
$node->safe_psql('shard2', "SELECT abacus_delete('$mesh', 'SELECT id, x, y, 0.0 FROM (SELECT * FROM ${mesh}_guests ORDER BY id LIMIT 1) AS g')");
like($node->safe_psql('postgres', "SELECT * FROM abacus_check('hit')"), qr/^shards\|\|\|shard 2: 1 points .*listed and not there/m, 'a guest that was deleted');

# ---- Rights ---------------------------------------------------------------------------------------------------

$node->safe_psql('postgres', "CREATE USER low PASSWORD 'secret'");
fails("SET ROLE low; SELECT abacus_locate('many', 1, 1)", qr/42501.*permission denied for table many/, 'no right to the table');
$node->safe_psql('postgres', 'GRANT SELECT ON many TO low');
fails("SET ROLE low; SELECT abacus_locate('many', 1, 1)", qr/42501.*permission denied for foreign server s1/, 'no right to the server');
$node->safe_psql('postgres', "GRANT USAGE ON FOREIGN SERVER s1, s2, s3, s4 TO low");
fails("SET ROLE low; SELECT abacus_locate('many', 1, 1)", qr/user mapping not found for/, 'no user mapping');
$node->safe_psql('postgres', join ';', map { "CREATE USER MAPPING FOR low SERVER s$_ OPTIONS (user 'low')" } 1 .. 4);
fails("SET ROLE low; SELECT abacus_locate('many', 1, 1)", qr/2F003.*password is required/, 'no password');
$node->safe_psql('postgres', join ';', map { "ALTER USER MAPPING FOR low SERVER s$_ OPTIONS (SET user '$user', ADD password 'secret')" } 1 .. 4);
fails("SET ROLE low; SELECT abacus_locate('many', 1, 1)", qr/2F003.*password is required/, 'a server that does not ask for the password');
$node->safe_psql('postgres', join ';', map { "ALTER USER MAPPING FOR low SERVER s$_ OPTIONS (SET user 'low')" } 1 .. 4);
fails("SET ROLE low; SELECT abacus_locate('many', 1, 1)", qr/42501.*permission denied for table abacus_/, 'no right to the mesh there');
unlike(slurp_file($node->logfile), qr/password '?secret'? *in|secret.*connection/i, 'no password in errors');
for my $shard (1 .. 4)
{
	my $name = $node->safe_psql('postgres', "SELECT shard_mesh FROM abacus_shards('many') WHERE shard = $shard");
	$node->safe_psql("shard$shard", "GRANT SELECT ON $name, ${name}_vertices, ${name}_guests, ${name}_version TO low");
}
is($node->safe_psql('postgres', "SET ROLE low; SELECT (abacus_locate('many', 20.2, 20.1)).code"),
	$node->safe_psql('postgres', "SELECT (abacus_locate('one', 20.2, 20.1)).code"), 'a reader with all rights');
fails("SET ROLE low; CALL abacus_shard_build('many', 'SELECT 1, 2, 3, 4')", qr/42501.*must be owner/, 'only the owner builds');

$other->stop;
$node->stop;
done_testing();
