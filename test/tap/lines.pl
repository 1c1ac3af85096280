# Meshes with lines and regions: kill -9 during changes, cancelling, two writers, a standby, and planted damage.
#
#     ABACUS_KILLS   how many times a process is killed (default 12)
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusCrash;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;
use Time::HiRes qw(time usleep);

my $kills = $ENV{ABACUS_KILLS} || 12;
my $node = crash_node('lines');
$node->safe_psql('postgres', <<'SQL');
ALTER DATABASE postgres SET client_min_messages = warning;
CREATE SEQUENCE numbers START 100000;
CREATE TABLE noted_points AS SELECT i AS id, (i * 7919) % 10007 / 10007::float8 AS x, (i * 104729) % 9973 / 9973::float8 AS y FROM generate_series(1, 4000) AS i;
INSERT INTO noted_points VALUES (5001, 0.1, 0.5), (5002, 0.4, 0.5), (5003, 0.4, 0.95), (5004, 0.1, 0.95), (5005, 0.2, 0.6), (5006, 0.3, 0.6), (5007, 0.25, 0.85);
CREATE TABLE noted_lines (line bigint, position int, point bigint, x float8, y float8);
CREATE TABLE changes AS SELECT 0 AS count;
SELECT abacus_triangulate('net', 'SELECT * FROM noted_points');
SELECT abacus_constrain('net', 'SELECT 1, id, id FROM noted_points WHERE id IN (1, 2)');
SELECT abacus_constrain('net', 'VALUES (-1, 1, 5001), (-1, 2, 5002), (-1, 3, 5003), (-1, 4, 5004), (-1, 5, 5001), (-2, 1, 5005), (-2, 2, 5006), (-2, 3, 5007), (-2, 4, 5005)');
SELECT abacus_region('net', $$VALUES ('ring', -1), ('ring', -2)$$);
SELECT abacus_region('net', $$VALUES ('hole', 0.25, 0.65)$$);
INSERT INTO noted_lines SELECT line, position, point, x, y FROM abacus_lines('net');

-- Lines along the axis x, each at a height of its own, so none cross; points, some of them on lines
CREATE FUNCTION change() RETURNS void LANGUAGE plpgsql AS $$
DECLARE
	first bigint := nextval('numbers') * 1000;
	lines text := format('SELECT line, position, point, x, y FROM noted_lines WHERE line > %s AND line < %s + 1000', first, first);
	points text := format('SELECT * FROM noted_points WHERE id > %s AND id < %s + 1000', first, first);
BEGIN
	CASE floor(random() * 5)
	WHEN 0, 1 THEN
		INSERT INTO noted_lines SELECT first + i, p, first + 10 * i + p, random() / 5 + p / 5.0, i / 70::float8 + first / 1e11 + 2 FROM generate_series(1, 60) AS i, generate_series(0, 4) AS p;
		INSERT INTO noted_points SELECT point, x, y FROM noted_lines WHERE line > first;
		PERFORM abacus_constrain('net', lines, kind => 'soft');
	WHEN 2 THEN
		INSERT INTO noted_points SELECT first + 500 + row_number() OVER (), x + random() / 100, y FROM (SELECT * FROM noted_lines ORDER BY random() LIMIT 50) AS at;
		INSERT INTO noted_points SELECT first + i, random(), random() * 3 FROM generate_series(1, 300) AS i;
		PERFORM abacus_insert('net', points);
	WHEN 3 THEN
		CREATE TEMP TABLE gone AS SELECT * FROM noted_points WHERE id NOT IN (SELECT point FROM noted_lines) ORDER BY random() LIMIT 200;
		PERFORM abacus_delete('net', 'TABLE gone');
		DELETE FROM noted_points WHERE id IN (SELECT id FROM gone);
		DROP TABLE gone;
	WHEN 4 THEN
		CREATE TEMP TABLE gone AS SELECT line FROM (SELECT DISTINCT line FROM noted_lines WHERE line > 1) AS l ORDER BY random() LIMIT 20;
		PERFORM abacus_unconstrain('net', 'TABLE gone');
		DELETE FROM noted_lines WHERE line IN (SELECT line FROM gone);
		DROP TABLE gone;
	END CASE;
	UPDATE changes SET count = count + 1;
END $$;
CREATE PROCEDURE change_on() LANGUAGE plpgsql AS $$ BEGIN LOOP PERFORM change(); COMMIT; END LOOP; END $$;
SQL

# Tests that the mesh has exactly the lines that were noted, and the edges and triangles of a new mesh of all that was noted.
sub is_as_noted
{
	my ($what) = @_;
	is($node->safe_psql('postgres', q{(SELECT line, position, point, x, y FROM abacus_lines('net') EXCEPT ALL TABLE noted_lines) UNION ALL
		(TABLE noted_lines EXCEPT ALL SELECT line, position, point, x, y FROM abacus_lines('net')) LIMIT 5}), '', "$what: the lines of what is committed");
	$node->safe_psql('postgres', q{DROP TABLE IF EXISTS wanted; SELECT abacus_triangulate('wanted', 'SELECT * FROM noted_points ORDER BY id');
		SELECT abacus_constrain('wanted', 'SELECT line, position, NULL, x, y FROM noted_lines')});
	is(other_simplices($node, 'postgres', 'net', 'wanted', 2), 0, "$what: the triangles of a new mesh");
	is($node->safe_psql('postgres', q{SELECT count(*) FROM (SELECT v0, v1, lines FROM abacus_edges('net', fixed => true) EXCEPT
		SELECT v0, v1, lines FROM abacus_edges('wanted', fixed => true)) AS other}), 0, "$what: its fixed edges");
	$node->safe_psql('postgres', q{SELECT abacus_region('wanted', $$VALUES ('ring', -1), ('ring', -2)$$); SELECT abacus_region('wanted', $$VALUES ('hole', 0.25, 0.65)$$)});
	is($node->safe_psql('postgres', q{SELECT count(*) FROM (SELECT region, s.v0, s.v1, s.v2 FROM abacus_regions('net'), abacus_simplices('net', region) AS s EXCEPT
		SELECT region, s.v0, s.v1, s.v2 FROM abacus_regions('wanted'), abacus_simplices('wanted', region) AS s) AS other}), 0, "$what: its regions");
	is($node->safe_psql('postgres', q{SELECT region, round(area::numeric, 12) FROM abacus_regions('net')}), "hole|0.012500000000\nring|0.122500000000", "$what: their areas");
	is($node->safe_psql('postgres', q{SELECT bt_index_check(oid, true) FROM pg_class AS c JOIN pg_index AS i ON i.indexrelid = c.oid WHERE indrelid = 'net_lines'::regclass;
		SELECT count(*) FROM verify_heapam('net_lines')}), "\n\n0", "$what: the table of lines is intact");
	return is_intact($node, 'postgres', 'net', $what);
}

sub changes { return $node->safe_psql('postgres', 'SELECT count FROM changes'); }
for my $strike (1 .. $kills)
{
	my ($before, $victim) = run_and_strike($node, 'CALL change_on()', 0.7, \&changes);
	my $what = "$victim after $before changes";
	cmp_ok(changes(), '>=', $before, "$what: nothing committed is lost");
	is_as_noted($what);
}
cmp_ok(changes(), '>', 0, changes() . ' changes');

# A long change is cancelled within a second; no trace of it is left
sub in_background
{
	my ($sql) = @_;
	my %session = (out => '', err => '');
	$session{run} = IPC::Run::start([ 'psql', '-XAtq', '-d', $node->connstr('postgres'), '-c', $sql ],
		'>', \$session{out}, '2>', \$session{err}, IPC::Run::timeout($PostgreSQL::Test::Utils::timeout_default));
	return \%session;
}
$node->safe_psql('postgres', <<'SQL');
CREATE TABLE many AS SELECT i AS id, random() AS x, random() AS y FROM generate_series(1, 60000) AS i;
SELECT abacus_triangulate('wide', 'TABLE many');
CREATE TABLE across AS SELECT i AS line, p AS position, 100000 + 2 * i + p AS id, p * 1.2 - 0.1 AS x, i / 30000.0::float8 AS y FROM generate_series(1, 30000) AS i, generate_series(0, 1) AS p;
SELECT abacus_insert('wide', 'SELECT id, x, y FROM across');
SQL
my ($cancelled, $longest) = (0, 0);
for my $wait (0.2, 0.6, 1.2, 2)
{
	my $long = in_background(q{SELECT abacus_constrain('wide', 'SELECT line, position, id FROM across')});
	usleep(1e6 * $wait);
	my $start = time;
	$node->safe_psql('postgres', q{SELECT pg_cancel_backend(pid) FROM pg_stat_activity WHERE query LIKE 'SELECT abacus_constrain%'});
	$long->{run}->finish;
	$longest = time - $start if time - $start > $longest;
	next unless $long->{err} =~ /canceling statement due to user request/;
	++$cancelled;
	is($node->safe_psql('postgres', q{SELECT count(*) FROM abacus_lines('wide')}), 0, "cancelled after $wait s: no line is left");
	is_sound($node, 'postgres', 'wide', "cancelled after $wait s");
}
cmp_ok($cancelled, '>', 0, "$cancelled changes cancelled");
cmp_ok($longest, '<', 2, sprintf('each within %.2f s', $longest)); # a second, and a busy machine

# Two sessions give a mesh its first lines: one waits for the other
for my $end ('COMMIT', 'ROLLBACK')
{
	$node->safe_psql('postgres', q{DROP TABLE IF EXISTS pair; SELECT abacus_triangulate('pair', 'SELECT i, i % 30, i / 30 FROM generate_series(0, 899) AS i')});
	my $one = $node->background_psql('postgres');
	$one->query_safe(q{BEGIN; SELECT abacus_constrain('pair', 'VALUES (1, 1, 0), (1, 2, 29)')});
	my $other = in_background(q{SELECT abacus_constrain('pair', 'VALUES (2, 1, 30), (2, 2, 59)')});
	$node->poll_query_until('postgres', q{SELECT count(*) = 1 FROM pg_stat_activity WHERE wait_event_type = 'Lock'}) or die 'nobody waits';
	$one->query_safe($end);
	$other->{run}->finish;
	$one->quit;
	is($other->{out} . $other->{err}, "1\n", "$end: the other waits");
	is($node->safe_psql('postgres', q{SELECT array_agg(DISTINCT line) FROM abacus_lines('pair')}), $end eq 'COMMIT' ? '{1,2}' : '{2}', "$end: the lines");
	is_sound($node, 'postgres', 'pair', $end);
}

# Damage of pages and of the table of lines is found. The pages are those of a mesh with the same triangles, and other
# fixed edges.
$node->safe_psql('postgres', <<'SQL');
CREATE TABLE sample AS SELECT i AS id, (i * 7919) % 1009 AS x, (i * 104729) % 997 AS y FROM generate_series(1, 3000) AS i;
SELECT abacus_triangulate('hurt', 'TABLE sample');
SELECT abacus_triangulate('twin', 'TABLE sample');
CREATE TABLE sides AS SELECT row_number() OVER () AS line, v0, v1 FROM (SELECT * FROM abacus_edges('hurt') ORDER BY v0, v1 LIMIT 400) AS e;
SELECT abacus_constrain('hurt', 'SELECT line, 1, v0 FROM sides UNION ALL SELECT line, 2, v1 FROM sides');
SELECT abacus_constrain('twin', 'SELECT 1, 1, v0 FROM sides WHERE line = 1 UNION ALL SELECT 1, 2, v1 FROM sides WHERE line = 1');
-- a line that is no edge without it, and a mesh that lacks it
CREATE TABLE far AS SELECT 1000 AS line, row_number() OVER (ORDER BY x) AS position, id FROM ((SELECT * FROM sample ORDER BY x LIMIT 1) UNION ALL (SELECT * FROM sample ORDER BY x DESC LIMIT 1)) AS p;
SELECT abacus_triangulate('long', 'TABLE sample');
SELECT abacus_constrain('long', 'TABLE far');
SELECT abacus_triangulate('short', 'TABLE sample');
SELECT abacus_constrain('short', 'TABLE far');
SELECT abacus_constrain('short', 'SELECT 1, 1, v0 FROM sides WHERE line = 1 UNION ALL SELECT 1, 2, v1 FROM sides WHERE line = 1');
SELECT abacus_unconstrain('short', 'VALUES (1000)');
SQL
sub is_found
{
	my ($mesh, $damage, $fault, $what) = @_;
	return like($node->safe_psql('postgres', "BEGIN; $damage; SELECT fault, message FROM abacus_check('$mesh') LIMIT 1; ROLLBACK"), $fault, $what);
}
my $pages = 'UPDATE hurt SET page = twin.page FROM twin WHERE (twin.code, twin.part) = (hurt.code, hurt.part) AND hurt.code';
for my $code (split /\n/, $node->safe_psql('postgres', 'SELECT h.code FROM hurt AS h JOIN twin AS t USING (code, part) WHERE code >= 0 AND h.page::bytea <> t.page::bytea'))
{
	is_found('hurt', "$pages = $code", qr/^link\|An edge is fixed on one of its sides only|^lines\|Line \d+ lacks a fixed edge/, "a page with other fixed edges, $code");
}
is_found('hurt', 'DELETE FROM hurt WHERE code >= 0; INSERT INTO hurt SELECT * FROM twin WHERE code >= 0', qr/^lines\|Line 2 lacks a fixed edge/, 'all pages');
is_found('long', 'DELETE FROM long WHERE code >= 0; INSERT INTO long SELECT * FROM short WHERE code >= 0', qr/\|/, 'a fixed edge is flipped away');
is_found('hurt', 'DELETE FROM hurt_lines WHERE line = 5', qr/^lines\|Edges are fixed that belong to no line/, 'a line is lost');
is_found('hurt', 'DELETE FROM hurt_lines WHERE line = 5 AND position = 1', qr/^lines\|Edges are fixed that belong to no line/, 'a row of a line is lost');
is_found('hurt', 'TRUNCATE hurt_lines', qr/^lines\|Edges are fixed that belong to no line/, 'all are');
is_found('hurt', "INSERT INTO hurt_lines SELECT 5000, position, id, x, y, 'hard' FROM far JOIN sample USING (id)", qr/^lines\|Line 5000 lacks a fixed edge/, 'a line by hand');
is_found('hurt', "INSERT INTO hurt_lines SELECT 5000, position, id, x + 0.25, y, 'hard' FROM far JOIN sample USING (id)", qr/^lines\|Line 5000 lacks a fixed edge/, '... at no vertex');
is_found('hurt', "INSERT INTO hurt_lines SELECT 5000, 1, id, x, y, 'hard' FROM sample LIMIT 1", qr/^lines\|The header counts more or fewer lines/, '... of one point');
is_found('hurt', "INSERT INTO hurt_lines SELECT 5000, position, point, x, y, kind FROM hurt_lines WHERE line = 5", qr/^lines\|The header counts more or fewer lines/, '... on an edge that is fixed');
my $wrong = qr/^lines\|Line 7 has a coordinate that is not finite, or a kind that is not known/;
is_found('hurt', "UPDATE hurt_lines SET y = 'NaN' WHERE line = 7", $wrong, 'no number');
is_found('hurt', "UPDATE hurt_lines SET x = '-Infinity' WHERE line = 7", $wrong, 'no finite number');
is_found('hurt', "UPDATE hurt_lines SET kind = 'other' WHERE line = 7", $wrong, 'no kind');
is_found('hurt', "UPDATE hurt_lines SET kind = CASE kind WHEN 'hard' THEN 'soft' ELSE 'hard' END WHERE line = 7", qr/^lines\|Edges are hard or soft, and their lines are not/, 'a line of another kind');
is_found('hurt', 'UPDATE hurt_lines SET x = x + 1 WHERE line = 7 AND position = 1', qr/^lines\|Line 7 lacks a fixed edge/, 'a point is moved');

# ... and of regions: pages of a mesh with the same triangles, and no region or another one
for my $mesh ('plot', 'bare')
{
	$node->safe_psql('postgres', qq{SELECT abacus_triangulate('$mesh', 'TABLE noted_points'); SELECT abacus_constrain('$mesh', 'SELECT line, position, point FROM noted_lines WHERE line < 0')});
}
$node->safe_psql('postgres', q{SELECT abacus_region('plot', $$VALUES ('ring', -1), ('ring', -2)$$)});
for my $code (split /\n/, $node->safe_psql('postgres', 'SELECT p.code FROM plot AS p JOIN bare AS b USING (code, part) WHERE code >= 0 AND p.page::bytea <> b.page::bytea LIMIT 20'))
{
	is_found('plot', "UPDATE plot SET page = bare.page FROM bare WHERE (bare.code, bare.part) = (plot.code, plot.part) AND plot.code = $code",
		qr/^interval\||^regions\|A region (ends at an edge that is not fixed|has no triangles)/, "a page without the region, $code");
}
is_found('plot', 'DELETE FROM plot WHERE code >= 0; INSERT INTO plot SELECT * FROM bare WHERE code >= 0', qr/^regions\|A region has no triangles/, 'all pages');

# ... or of a mesh whose region with that number is another set of whole faces
for my $parts ("VALUES ('ring', -1)", "VALUES ('ring', 0.25, 0.7)")
{
	$node->safe_psql('postgres', "SELECT abacus_region('bare', \$\$$parts\$\$)");
	is_found('plot', 'DELETE FROM plot WHERE code >= 0; INSERT INTO plot SELECT * FROM bare WHERE code >= 0',
		qr/^regions\|Region "ring" does not have the triangles that its outlines or seeds give it/, "all pages of $parts");
	$node->safe_psql('postgres', "SELECT abacus_unregion('bare', 'ring')");
}
is_found('plot', 'DELETE FROM plot_regions', qr/^regions\|The header counts more or fewer regions/, 'all regions are lost');
is_found('plot', 'UPDATE plot_regions SET number = 5', qr/^regions\|Triangles have the number of a region that does not exist/, 'another number');

# A standby reads lines, and changes none
$node->append_conf('postgresql.conf', 'max_wal_senders = 4');
$node->set_replication_conf;
$node->restart;
$node->backup('before');
my $standby = PostgreSQL::Test::Cluster->new('lines_standby');
$standby->init_from_backup($node, 'before', has_streaming => 1);
$standby->start;
my $questions = q{SELECT md5(string_agg(l::text, ';')) FROM abacus_lines('net') AS l; SELECT count(*), md5(string_agg(e::text, ';' ORDER BY e)) FROM abacus_edges('net', fixed => true) AS e; SELECT region, area FROM abacus_regions('net'); SELECT count(*) FROM abacus_simplices('net', 'ring')};
for my $round (1 .. 5)
{
	$node->safe_psql('postgres', 'SELECT change() FROM generate_series(1, 4)');
	$node->wait_for_catchup($standby);
	is($standby->safe_psql('postgres', $questions), $node->safe_psql('postgres', $questions), "standby, round $round: lines and edges");
	is_sound($standby, 'postgres', 'net', "standby, round $round");
}
like(($standby->psql('postgres', q{SELECT abacus_constrain('net', 'VALUES (3, 1, 1), (3, 2, 2)')}))[2],
	qr/cannot execute abacus_constrain\(\) in a read-only transaction/, 'no lines there');
like(($standby->psql('postgres', q{SELECT abacus_unconstrain('net', 'VALUES (1)')}))[2],
	qr/cannot execute abacus_unconstrain\(\) in a read-only transaction/, '... and none removed');
$node->stop('immediate');
$standby->promote;
is($standby->safe_psql('postgres', q{SELECT abacus_unconstrain('net', 'VALUES (1)')}), 1, 'promoted: a line goes');
is_sound($standby, 'postgres', 'net', 'promoted');
$standby->stop;
done_testing();
