# VACUUM alone gives the space of a mesh back, in sessions that have loaded the module: after changes all over
# it, whichever tables are named. It does not if options forbid it, and it does not block others.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $node = PostgreSQL::Test::Cluster->new('vacuum');
$node->init;
$node->append_conf('postgresql.conf', "fsync = off\nautovacuum = off\nmax_prepared_transactions = 2");
$node->start;
plan skip_all => 'built without shortcuts' unless has_shortcuts($node);

sub sql { return $node->safe_psql('postgres', $_[0]); }
sub content { return mesh_content($node, 'postgres', $_[0]); }
sub pages { return mesh_pages($node, 'postgres', $_[0]); }
sub spread { return spread_mesh($node, 'postgres', $_[0]); }

# The messages in a session that has loaded the module.
sub vacuum
{
	my ($statement, $before) = @_;
	my (undef, undef, $told) = $node->psql('postgres', "LOAD 'abacus'; " . ($before // '') . "; $statement");
	return $told;
}

sql(q{CREATE EXTENSION abacus; CREATE EXTENSION amcheck; SELECT setseed(0.5);
	CREATE TABLE points AS
	SELECT i AS id, random() AS x, random() AS y, random() AS z, random() AS turn FROM generate_series(1, 60000) AS i});

# Changes all over a mesh, in large statements and in small ones: VACUUM without the module, or with it turned
# off, does not free their space.
for my $m (
	{ name => 'plane', dimension => 2, columns => 'id, x, y', points => 60_000, parts => 20 },
	{ name => 'pieces', dimension => 2, columns => 'id, x, y', points => 60_000, parts => 2_000 },
	{ name => 'solid', dimension => 3, columns => 'id, x, y, z', points => 30_000, parts => 20 })
{
	my $mesh = $m->{name};
	my $points = "SELECT $m->{columns} FROM points WHERE id <= $m->{points}";
	sql("SELECT abacus_triangulate('$mesh', '$points', dimension => $m->{dimension})");
	my $fresh = pages($mesh);
	my $content = content($mesh);
	sql("CREATE INDEX ON points (floor(turn * $m->{parts}))");
	sql(<<"SQL");
DO \$\$
BEGIN
	FOR n IN 0 .. $m->{parts} * 3 / 4 - 1 LOOP
		PERFORM abacus_delete('$mesh', '$points AND floor(turn * $m->{parts}) = ' || n);
		COMMIT;
		PERFORM abacus_insert('$mesh', '$points AND floor(turn * $m->{parts}) = ' || n);
		COMMIT;
	END LOOP;
END \$\$
SQL
	sql("VACUUM $mesh");
	cmp_ok(pages($mesh), '>', 1.6 * $fresh, "$mesh: VACUUM without the module leaves it large");
	vacuum("VACUUM $mesh", 'SET abacus.vacuum_moves_rows = off');
	cmp_ok(pages($mesh), '>', 1.6 * $fresh, "$mesh: so it does with the setting off");
	my $told = vacuum("VACUUM (VERBOSE) $mesh");
	like($told, qr/INFO:  moved [1-9]\d* pages? of mesh "public.$mesh" to the beginning of its table\n/,
		"$mesh: VACUUM (VERBOSE) says what it moves");
	cmp_ok(pages($mesh), '<=', 1.2 * $fresh, "$mesh: then it is hardly larger than a fresh one");
	is(content($mesh), $content, "$mesh: the mesh is the same");
	is_intact($node, 'postgres', $mesh, $mesh);
	unlike(vacuum("VACUUM (VERBOSE) $mesh"), qr/\bmoved/, "$mesh: and stays as it is");
}


# From now on an UPDATE spreads the rows over the table, as the shortest way.
my $fresh = pages('plane');
my $content = content('plane');
my $header = 'SELECT xmin FROM plane WHERE code = -1';

# Two tests: whether a statement cuts the file, and its messages. Returns the messages.
sub cuts
{
	my ($what, $statement, $before) = @_;
	my $told = vacuum($statement, $before);
	unlike($told, qr/ERROR|WARNING/, "$what: no error");
	cmp_ok(pages('plane'), '<=', 1.1 * $fresh, "$what: the file is cut");
	return $told;
}

# Two tests: a statement leaves rows and files unchanged; and its messages.
sub leaves
{
	my ($what, $wanted, $statement, $before) = @_;
	my $told = sql($header);
	is(vacuum($statement, $before) =~ s/^psql:<stdin>:\d+: //mgr, $wanted, "$what: what is said");
	is(sql($header), $told, "$what: nothing is moved");
	return;
}

spread($_) for qw(plane solid);
leaves('TRUNCATE off', '', 'VACUUM (TRUNCATE off) plane');
leaves('INDEX_CLEANUP off', '', 'VACUUM (INDEX_CLEANUP off) plane');
sql('ALTER TABLE plane SET (vacuum_index_cleanup = off)');
leaves('table without index cleanup', '', 'VACUUM plane');
sql('ALTER TABLE plane RESET (vacuum_index_cleanup); ALTER TABLE plane SET (vacuum_truncate = off)');
leaves('table that is not to be cut', '', 'VACUUM plane');
leaves('read-only session', '', 'VACUUM plane', 'SET default_transaction_read_only = on');
leaves('ANALYZE', '', 'ANALYZE plane');
leaves('transaction block', 'ERROR:  VACUUM cannot run inside a transaction block', 'BEGIN; VACUUM plane; ROLLBACK');
my $caller = $node->safe_psql('postgres', 'SHOW server_version_num') >= 190000 ? 'a function or procedure' : 'a function';
leaves('block of PL/pgSQL', "ERROR:  VACUUM cannot be executed from $caller
CONTEXT:  SQL statement \"VACUUM plane\"\nPL/pgSQL function inline_code_block line 1 at SQL statement",
	q{DO 'BEGIN VACUUM plane; END'});
leaves('several statements', 'ERROR:  VACUUM cannot run inside a transaction block', 'VACUUM plane\; SELECT 1');
leaves('no such table', 'ERROR:  relation "nothing" does not exist', 'VACUUM plane, nothing');
leaves('no such option', "ERROR:  unrecognized VACUUM option \"cut\"\nLINE 1: VACUUM (CUT) plane\n                ^", 'VACUUM (CUT) plane');

# The statement overrides the table's setting; the other table is not named.
cuts('TRUNCATE on', 'VACUUM (TRUNCATE on) plane');
sql('ALTER TABLE plane RESET (vacuum_truncate)');
for my $level ('repeatable read', 'serializable')
{
	spread('plane');
	cuts($level, 'VACUUM plane', "SET default_transaction_isolation = '$level'");
}
spread('plane');
my $told = cuts('whole database', 'VACUUM (VERBOSE, ANALYZE, FREEZE)');
like($told, qr/ moved \d+ pages of mesh "public.$_"/, "whole database: $_") for qw(plane solid);
unlike($told, qr/ moved \d+ pages? of mesh "public.pieces"/, 'whole database: but no mesh without need');
is_intact($node, 'postgres', $_, "whole database: $_") for qw(plane solid);
spread('plane');
cuts('FULL', 'VACUUM FULL plane, plane_vertices');

# Pages of repeated points lie behind those of staged points. A restored vertex table is found by its name.
sql('CREATE ROLE one');
for my $bound (1, 0)
{
	sql("SELECT abacus_create('twice', 2)");
	sql("SELECT abacus_stage('twice', 'SELECT id, x, y FROM points UNION ALL SELECT -id, x, y FROM points WHERE id <= 3000')");
	my $staged = sql("SELECT pg_relation_size('twice_vertices')");
	sql("SELECT abacus_triangulate('twice')");
	sql("DELETE FROM pg_depend WHERE objid = 'twice_vertices'::regclass AND refobjid = 'twice'::regclass") unless $bound;
	sql('ALTER TABLE twice_vertices OWNER TO one');
	unlike(vacuum('VACUUM (VERBOSE) twice_vertices', 'SET ROLE one'), qr/ moved|ERROR|WARNING/,
		"vertex table, bound $bound: not by somebody who does not own the mesh");
	sql('ALTER TABLE twice_vertices OWNER TO CURRENT_USER') unless $bound; # only then it is the mesh's
	like(vacuum('VACUUM (VERBOSE) twice_vertices'), qr/ moved \d+ pages of mesh "public.twice"/, "vertex table, bound $bound: it is moved");
	cmp_ok(sql("SELECT pg_relation_size('twice_vertices')"), '<', 0.2 * $staged, "vertex table, bound $bound: the file is cut");
	is(mesh_figure($node, 'postgres', 'twice', 'inserted'), 63_000, "vertex table, bound $bound: all points are there");
	is_intact($node, 'postgres', 'twice', "vertex table, bound $bound");
	sql('DROP TABLE twice; DROP TABLE IF EXISTS twice_vertices');
}

# Users who may vacuum a table may have its rows moved, whatever their other rights.
sql(q{CREATE ROLE owner; CREATE ROLE other;
	ALTER TABLE plane OWNER TO owner; ALTER TABLE plane_vertices OWNER TO owner});
spread('plane');
# from 17 on there is a privilege for this
my $maintain = sql('SHOW server_version_num') >= 170000;
leaves('somebody else', $maintain ? 'WARNING:  permission denied to vacuum "plane", skipping it'
	: 'WARNING:  skipping "plane" --- only table or database owner can vacuum it', 'VACUUM plane', 'SET ROLE other');
sql(q{REVOKE ALL ON plane, plane_vertices FROM owner; ALTER TABLE plane ENABLE ROW LEVEL SECURITY;
	ALTER TABLE plane FORCE ROW LEVEL SECURITY});
sql('GRANT MAINTAIN ON plane, plane_vertices TO owner') if $maintain;
cuts('owner without privileges', 'VACUUM plane', 'SET ROLE owner');
sql('ALTER DATABASE postgres OWNER TO other');
spread('plane');
cuts('owner of the database', 'VACUUM plane, plane_vertices', 'SET ROLE other');
sql(q{ALTER TABLE plane NO FORCE ROW LEVEL SECURITY; ALTER TABLE plane DISABLE ROW LEVEL SECURITY;
	ALTER TABLE plane OWNER TO CURRENT_USER; ALTER TABLE plane_vertices OWNER TO CURRENT_USER});

# For all sessions of a database.
spread('plane');
sql(q{ALTER DATABASE postgres SET session_preload_libraries = 'abacus'});
$node->command_ok([ 'vacuumdb', '-d', $node->connstr('postgres'), '-t', 'plane' ], 'vacuumdb');
cmp_ok(pages('plane'), '<=', 1.1 * $fresh, 'vacuumdb: the file is cut');
is(content('plane'), $content, 'in the end the mesh is the same');
is_intact($node, 'postgres', 'plane', 'in the end');

$node->stop;
done_testing();
