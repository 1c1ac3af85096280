# VACUUM that moves the pages of meshes, beside other sessions, and with failures. It waits for no one, takes
# nothing from readers, and always does a VACUUM's work.
#
#     ABACUS_CANCELS   how many times to cancel (default 20)
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $cancels = $ENV{ABACUS_CANCELS} || 20;

my $node = PostgreSQL::Test::Cluster->new('vacuum_beside');
$node->init;
$node->append_conf('postgresql.conf', <<'CONF');
fsync = off
autovacuum = off
max_prepared_transactions = 2
session_preload_libraries = 'abacus'
CONF
$node->start;
plan skip_all => 'built without shortcuts' unless has_shortcuts($node);

sub sql { return $node->safe_psql('postgres', $_[0]); }
sub pages { return mesh_pages($node, 'postgres', $_[0]); }
sub spread { return spread_mesh($node, 'postgres', $_[0]); }

# The messages of statements, each sent alone.
sub told
{
	my (undef, undef, $told) = $node->psql('postgres', $_[0]);
	return $told =~ s/^psql:<stdin>:\d+: //mgr;
}

sql(q{CREATE EXTENSION abacus; CREATE EXTENSION amcheck; SELECT setseed(0.5);
	CREATE TABLE points AS SELECT i AS id, random() AS x, random() AS y FROM generate_series(1, 60000) AS i;
	SELECT abacus_triangulate('plane', 'SELECT * FROM points');
	SELECT abacus_triangulate('other', 'SELECT * FROM points');});
create_rest($node, 'postgres');
my $fresh = pages('plane');
my $content = mesh_content($node, 'postgres', 'plane');
my $header = 'SELECT xmin FROM plane WHERE code = -1';

sub is_cut
{
	my ($mesh, $what) = @_;
	return cmp_ok(pages($mesh), '<=', 1.1 * $fresh, "$what: the file of $mesh is cut");
}

# Another session has locked the mesh, or a row of it: the rest of VACUUM is done at once.
spread($_) for qw(plane other);
my $holder = $node->background_psql('postgres');
for my $statement ("SELECT abacus_insert('plane', 'SELECT 0, 0.5, 0.5')",
	'SELECT code FROM plane WHERE code = -1 FOR UPDATE', 'LOCK TABLE plane_vertices IN SHARE MODE')
{
	$holder->query_safe("BEGIN; $statement");
	my $before = sql($header);
	my $told = told("SET statement_timeout = '60s'; VACUUM (VERBOSE) plane");
	like($told, qr/pages of mesh "public.plane" are not moved, since the mesh is locked/, "$statement: is not waited for");
	like($told, qr/finished vacuuming "postgres.public.plane"/, "$statement: VACUUM does the rest");
	unlike($told, qr/ERROR|WARNING/, "$statement: no error");
	is(sql($header), $before, "$statement: nothing is moved");
	$holder->query_safe('ROLLBACK');
}
$holder->query_safe("BEGIN; SELECT abacus_insert('plane', 'SELECT 0, 0.5, 0.5'); PREPARE TRANSACTION 'prepared'");
$holder->quit;
my $told = told("SET statement_timeout = '60s'; VACUUM (VERBOSE)");
unlike($told, qr/ERROR|WARNING/, 'prepared transaction: no error');
like($told, qr/"public.plane" are not moved/, 'prepared transaction: is not waited for');
like($told, qr/ moved \d+ pages of mesh "public.other"/, 'prepared transaction: the next mesh is moved');
sql("ROLLBACK PREPARED 'prepared'");
is(told('VACUUM other'), '', 'when it has ended, no error');
is_cut('other', 'when it has ended');

# A session in the middle of a cursor, with the mesh in its cache; another one that knows the places of pages.
my $reader = $node->background_psql('postgres', on_error_stop => 0);
$reader->query_safe("BEGIN ISOLATION LEVEL REPEATABLE READ;
	DECLARE reading CURSOR FOR SELECT v0, v1, v2 FROM abacus_simplices('plane'); MOVE 1000 FROM reading");
my $places = "SELECT sum(hashint8(v0) + hashint8(v1) * 2::bigint + hashint8(v2) * 3::bigint) FROM points p,
	LATERAL abacus_locate('plane', y, x) WHERE id <= 20000";
my $locator = $node->background_psql('postgres');
$locator->query_safe("SET abacus.cache_size = '1MB'");
my $located = $locator->query_safe($places);
like(told('VACUUM (VERBOSE) plane'), qr/ moved \d+ pages of mesh "public.plane"/, 'reader: pages are moved beside it');
is(mesh_content($node, 'postgres', 'plane'), $content, 'reader: ... into the same mesh');
is($locator->query_safe($places), $located, 'reader: where they have gone is found');
is(1000 + $reader->query_safe("SELECT rest('reading')"), mesh_figure($node, 'postgres', 'plane', 'simplices'), 'reader: it reads on');
is($reader->query_safe("SELECT count(*) FROM abacus_check('plane')"), 0, 'reader: ... all of it');
$reader->query("SELECT abacus_insert('plane', 'SELECT 0, 0.5, 0.5')");
like($reader->{stderr}, qr/could not serialize access/, 'reader: but cannot write');
$reader->{stderr} = '';
$reader->query_safe('ROLLBACK');
$reader->quit;
is(told('VACUUM plane'), '', 'reader: when it has gone, no error');
is_cut('plane', 'reader: when it has gone');
is($locator->query_safe($places), $located, 'reader: pages where the file was cut are found, too');
$locator->quit;

# The same with so few pages that VACUUM itself postpones their index entries, and with them the cut.
spread('plane');
sql($_) for 'SET abacus.vacuum_moves_rows = off; VACUUM plane',
	'UPDATE plane SET part = part WHERE ctid NOT IN (SELECT ctid FROM plane ORDER BY ctid DESC LIMIT 3)',
	'SET abacus.vacuum_moves_rows = off; VACUUM plane';
$reader = $node->background_psql('postgres');
$reader->query_safe('BEGIN ISOLATION LEVEL REPEATABLE READ; SELECT 1');
like(told('VACUUM (VERBOSE) plane'), qr/ moved [1-5] pages? of mesh "public.plane"/, 'few pages: they are moved');
cmp_ok(pages('plane'), '>', 1.9 * $fresh, 'few pages: they are seen still');
$reader->query_safe('ROLLBACK');
$reader->quit;
$told = told('VACUUM (VERBOSE) plane');
like($told, qr/index scan bypassed.*index scan needed/s, 'few pages: VACUUM does not put them off again');
is_cut('plane', 'few pages');

# A failure to move pages is reported, leaves no lock, and does not keep VACUUM from the next mesh. Both
# protocols are tried; one of them releases the statement's plan with the transaction.
my $refused = qq{WARNING:  could not move pages of mesh "public.plane"
DETAIL:  cannot change mesh table "plane" because of its index "sums"
HINT:  Drop that index.};
my $locks = "SELECT count(*) FROM pg_locks WHERE relation IN ('plane'::regclass, 'plane_vertices'::regclass)";
spread($_) for qw(plane other);
sql('CREATE INDEX sums ON plane ((code + part))');
my ($code, $out, $err) = $node->psql('postgres', "VACUUM; $locks; SELECT count(*) FROM abacus_check('plane')");
is($err =~ s/^psql:<stdin>:\d+: //mgr, $refused, 'a foreign index: a warning');
is($out, "0\n0", 'a foreign index: no lock is left');
is_cut('other', 'a foreign index: the next mesh');
for my $mode (qw(extended prepared))
{
	spread('other');
	$node->pgbench("-n -t 2 -M $mode", 0, [qr{processed: 2/2}], [qr/(could not move pages.*){2}/s],
		"$mode protocol", { "001_vacuum_$mode" => "VACUUM;\n" });
	is_cut('other', "$mode protocol");
}
sql('DROP INDEX sums');
is(told('VACUUM plane'), '', 'without the index: no error');
is_cut('plane', 'without the index');

# Damage does not concern VACUUM.
spread('plane');
sql('CREATE TABLE kept AS SELECT * FROM plane WHERE code = -1');
sql('UPDATE plane SET page = (SELECT page FROM plane WHERE code >= 0 LIMIT 1) WHERE code = -1');
like(told('VACUUM'), qr/^WARNING:  could not move pages of mesh "public.plane"\nDETAIL:  /, 'a damaged header: a warning');
sql('DELETE FROM plane WHERE code = -1');
like(told('VACUUM plane'), qr/^WARNING:  could not .*\nDETAIL:  mesh "plane" has no header\nHINT:  Restore/, 'no header: a warning');
sql('INSERT INTO plane SELECT * FROM kept; ALTER TABLE plane_vertices RENAME TO away');
is(told('VACUUM plane'), '', 'no vertex table: no error');
sql('ALTER TABLE away RENAME TO plane_vertices');
is(told('VACUUM plane'), '', 'all mended: no error');
is_cut('plane', 'all mended');

# Cancelled at any moment, it leaves no lock and the same mesh.
my $in_time = 0;
for my $n (1 .. $cancels)
{
	spread('plane');
	my $timeout = 1 + int(rand(20));
	my $session = $node->background_psql('postgres', on_error_stop => 0);
	$session->query("SET statement_timeout = $timeout; VACUUM plane");
	is(sql($locks), 0, "cancelled after $timeout ms: no lock is left");
	unlike($session->{stderr}, qr/WARNING/, "cancelled after $timeout ms: no warning");
	$in_time++ if $session->{stderr} =~ /canceling statement due to statement timeout/;
	$session->quit;
}
diag("$in_time of $cancels in time");
is(told('VACUUM plane'), '', 'after all: no error');
# the last of the cancelled ones may have left too little to be worth moving
spread('plane');
sql('VACUUM plane');
is_cut('plane', 'after all');
is(mesh_content($node, 'postgres', $_), $content, "after all: $_ is the same") for qw(plane other);
is_intact($node, 'postgres', $_, "after all: $_") for qw(plane other);
is(told("SELECT abacus_insert('plane', 'SELECT 0, 0.5, 0.5'); SELECT abacus_delete('plane', 'SELECT 0, 0.5, 0.5')"), '', 'after all: it can be changed');
is(mesh_content($node, 'postgres', 'plane'), $content, 'after all: ... and back');

$node->stop;
done_testing();
