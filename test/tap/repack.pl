# REPACK and REPACK (CONCURRENTLY), from PostgreSQL 19 on, of a mesh's tables while sessions change the mesh, through a
# table that it follows as well, and read it: nothing is lost, and every answer belongs to one state. Until 18, CLUSTER
# and VACUUM FULL rewrite the tables in the same way, and are tested instead.
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

my $node = PostgreSQL::Test::Cluster->new('repack');
$node->init;
$node->append_conf('postgresql.conf', "fsync = off\nwal_level = logical\nsession_preload_libraries = 'abacus'");
$node->start;
$node->safe_psql('postgres', 'CREATE EXTENSION abacus; CREATE EXTENSION amcheck');
my $has_repack = $node->safe_psql('postgres', 'SHOW server_version_num') >= 190000;
make_models($node);
$node->safe_psql('postgres', <<'SQL');
CREATE TABLE wells AS SELECT i AS id, random() AS x, random() AS y FROM generate_series(1, 3000) AS i;
ALTER TABLE wells ADD PRIMARY KEY (id);
SELECT abacus_create('ground', 2);
SELECT abacus_track('ground', 'wells');
CREATE SEQUENCE well_numbers START 100000 INCREMENT 1000;

-- What belongs to one snapshot agrees: a mesh and the points noted, a mesh and the table that it follows.
CREATE FUNCTION look(dimension int) RETURNS void LANGUAGE plpgsql STABLE AS $$
DECLARE
	mesh text := 'mesh' || dimension;
BEGIN
	ASSERT wrong(dimension) = 0, wrong(dimension) || ' points differ';
	ASSERT (SELECT value FROM abacus_stats(mesh) WHERE name = 'simplices') = (SELECT count(*) FROM abacus_simplices(mesh)), 'simplices';
	ASSERT 0 = (SELECT count(*) FROM abacus_check(mesh)), 'faults';
END $$;
CREATE FUNCTION look_at_wells() RETURNS void LANGUAGE plpgsql STABLE AS $$
BEGIN
	ASSERT 0 = (SELECT count(*) FROM (
		(SELECT id, x, y FROM wells EXCEPT ALL SELECT id, x, y FROM abacus_vertices('ground')) UNION ALL
		(SELECT id, x, y FROM abacus_vertices('ground') EXCEPT ALL SELECT id, x, y FROM wells)) AS other), 'wells';
	ASSERT 0 = (SELECT count(*) FROM abacus_check('ground')), 'faults';
END $$;
-- What a query returns, or the SQLSTATE of its error.
CREATE FUNCTION outcome(query text) RETURNS text LANGUAGE plpgsql AS $$
DECLARE
	answer text;
BEGIN
	EXECUTE query INTO answer;
	RETURN answer;
EXCEPTION WHEN OTHERS THEN
	RETURN SQLSTATE;
END $$;
CREATE FUNCTION change_wells() RETURNS void LANGUAGE plpgsql AS $$
DECLARE
	number bigint := nextval('well_numbers');
BEGIN
	INSERT INTO wells SELECT number + i, random(), random() FROM generate_series(1, 30) AS i;
	UPDATE wells SET x = random() WHERE id % 50 = number / 1000 % 50;
	DELETE FROM wells WHERE id IN (SELECT id FROM wells ORDER BY id LIMIT 20);
END $$;
SQL

my @meshes = qw(mesh2 mesh3 ground);
my @tables = map { ($_, "${_}_vertices") } @meshes;

# Every statement that rewrites, for each of the tables.
sub rewriting
{
	my ($table) = @_;
	return $has_repack
	  ? ("REPACK (CONCURRENTLY) $table;", "REPACK $table USING INDEX ${table}_pkey;", "REPACK (CONCURRENTLY) $table;")
	  : ("VACUUM FULL $table;", "CLUSTER $table USING ${table}_pkey;");
}

sub files
{
	return $node->safe_psql('postgres', 'SELECT ' . join ', ', map { "pg_relation_filenode('$_')" } @tables);
}

# ---- Alone: the same mesh, smaller, and it can be changed ------------------------------------------------------

my $change = "SELECT change(2), change(3), change_wells() FROM generate_series(1, 3)";
$node->safe_psql('postgres', $change);
for my $n (0 .. $#{ [ rewriting('mesh2') ] })
{
	my $statement = (rewriting('MESH'))[$n];
	my %content = map { $_ => mesh_content($node, 'postgres', $_) . mesh_bytes($node, 'postgres', $_) } @meshes;
	my $session = $node->background_psql('postgres');
	my $count = "SELECT count(*) FROM abacus_simplices('mesh2')";
	my $counted = $session->query($count);
	my $before = files();
	$node->safe_psql('postgres', (rewriting($_))[$n]) for @tables;
	my %old = map { $_ => 1 } split /\|/, $before;
	is(scalar(grep { $old{$_} } split /\|/, files()), 0, "$statement all tables have other files");
	is(mesh_content($node, 'postgres', $_) . mesh_bytes($node, 'postgres', $_), $content{$_}, "$statement $_ is the same") for @meshes;
	is($session->query($count), $counted, "$statement a session that had read it reads it again");
	$session->quit;
	is_intact($node, 'postgres', $_, $statement) for @meshes;
	$node->safe_psql('postgres', $change);
	is_sound($node, 'postgres', $_, "$statement changed") for @meshes;
	is($node->safe_psql('postgres', 'SELECT look(2), look(3), look_at_wells()'), '||', "$statement all agree");
}

# ---- A snapshot from before --------------------------------------------------------------------------------------

# REPACK (CONCURRENTLY) gives all rows a new age, so such a snapshot sees none of them: an error, and not an empty mesh.
# The other statements keep what it sees.
for my $n (0, 1)
{
	my $statement = (rewriting('mesh2'))[$n];
	my $count = q{SELECT count(*) FROM abacus_simplices('mesh2')};
	my $seen = $node->safe_psql('postgres', $count);
	my $old = $node->background_psql('postgres');
	$old->query_safe('BEGIN ISOLATION LEVEL REPEATABLE READ; SELECT count(*) FROM wells');
	$node->safe_psql('postgres', 'SELECT change(2)');
	$node->safe_psql('postgres', $statement);
	is($old->query("SELECT outcome(\$\$$count\$\$)"), $statement =~ /CONCURRENTLY/ ? '40001' : $seen, "$statement a snapshot from before");
	$old->quit;
}

# ---- Beside changes and readers --------------------------------------------------------------------------------------

my %scripts = (
	change_2 => 'SELECT change(2);',
	change_3 => 'SELECT change(3);',
	change_wells => 'SELECT change_wells();',
	change_all => "BEGIN;\nSELECT change(2);\nSELECT pg_sleep(0.05);\nSELECT change_wells();\nEND;",
	look_2 => 'SELECT look(2);',
	look_3 => 'SELECT look(3);',
	look_wells => 'SELECT look_at_wells();');
my @files;
for my $name (sort keys %scripts)
{
	my $file = $node->basedir . "/$name.sql";
	append_to_file($file, $scripts{$name});
	push @files, '-f', $file;
}
my $rewrite = $node->basedir . '/rewrite.sql';
append_to_file($rewrite, join "\n", map { rewriting($_) } @tables);

my $before = files();
my ($out, $err) = ('', '');
# deadlocks and snapshots from before are tried again; anything else ends a client
my @bench = ('pgbench', '-n', '-T', $seconds, '--max-tries', 0);
my $keeper = IPC::Run::start([ @bench, '-f', $rewrite, $node->connstr('postgres') ], '>', \$out, '2>', \$err);
my ($all, $errors) = run_command([ @bench, '-c', 5, '-j', 2, @files, $node->connstr('postgres') ]);
$keeper->finish;
unlike($errors, qr/error|abort/i, 'no session fails');
unlike($err, qr/error|abort/i, 'nor does what rewrites');
my ($count) = $all =~ /number of transactions actually processed: (\d+)/;
my ($retried) = $all =~ /number of transactions retried: (\d+)/;
my ($rounds) = $out =~ /number of transactions actually processed: (\d+)/;
cmp_ok($count, '>', 20, "$count transactions, $retried of them tried again");
cmp_ok($rounds, '>', 0, "all tables rewritten $rounds times");
isnt(files(), $before, 'by other files');
for my $d (2, 3)
{
	is_as_noted($node, $d, "dimension $d");
}
is($node->safe_psql('postgres', 'SELECT look_at_wells()'), '', 'the mesh agrees with the table that it follows');
is_intact($node, 'postgres', 'ground', 'the mesh that follows');

$node->stop;
done_testing();
