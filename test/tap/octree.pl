# Octrees under kill -9, cancel, and many sessions at once.
#
# Each change is a transaction that also notes the leaves after it. Whatever has happened meanwhile, the
# leaves in a snapshot are those noted in it, and the pages are sound.
#
#     ABACUS_KILLS    how many times (default 10)
#     ABACUS_SECONDS  of many sessions at once (default 5)
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusCrash;
use PostgreSQL::Test::Utils;
use Test::More;
use Time::HiRes qw(time);

my $kills = $ENV{ABACUS_KILLS} || 10;
my $seconds = $ENV{ABACUS_SECONDS} || 5;
my $node = crash_node('octree');
$node->safe_psql('postgres', <<'SQL');
CREATE TABLE noted (dimension int PRIMARY KEY, changes int, leaves text);
CREATE FUNCTION leaves(dimension int) RETURNS text LANGUAGE sql STABLE AS $$
	SELECT count(*) || ' ' || md5(string_agg(concat(code, ':', level, ':', attributes), ',' ORDER BY code))
	FROM abacus_octants('octree' || dimension);
$$;
-- One change at random: at a few places, or of all.
CREATE FUNCTION change(dimension int) RETURNS void LANGUAGE plpgsql AS $$
DECLARE
	octree text := 'octree' || dimension;
	n int := 10 ^ (1 + random() * 2);
	places text := format('SELECT (random() * %s)::int, random(), random()%s FROM generate_series(1, %s)',
		18 - 4 * dimension, CASE dimension WHEN 3 THEN ', random()' ELSE '' END, n);
BEGIN
	CASE (random() * 5)::int
		WHEN 0 THEN PERFORM abacus_octree_balance(octree, CASE WHEN random() < 0.5 THEN 'faces' ELSE 'corners' END);
		WHEN 1 THEN PERFORM abacus_octree_coarsen(octree, replace(places, 'SELECT (', 'SELECT 1 + ('));
		WHEN 2 THEN PERFORM abacus_octree_update(octree, format('SELECT code, random() FROM abacus_octants(%L) WHERE random() < 0.1', octree));
		ELSE PERFORM abacus_octree_refine(octree, places);
	END CASE;
	-- the octree is locked: this sees the earlier leaves and this change
	UPDATE noted SET changes = changes + 1, leaves = leaves(change.dimension) WHERE noted.dimension = change.dimension;
END $$;
CREATE PROCEDURE change_on(dimension int) LANGUAGE plpgsql AS $$
BEGIN
	LOOP
		PERFORM change(dimension);
		COMMIT;
	END LOOP;
END $$;
CREATE FUNCTION look(dimension int) RETURNS void LANGUAGE plpgsql STABLE AS $$
DECLARE
	octree text := 'octree' || dimension;
BEGIN
	ASSERT leaves(look.dimension) = (SELECT noted.leaves FROM noted WHERE noted.dimension = look.dimension), 'other leaves';
	ASSERT 0 = (SELECT count(*) FROM abacus_check(octree)), 'faults';
	ASSERT (SELECT value FROM abacus_stats(octree) WHERE name = 'leaves') = (SELECT count(*) FROM abacus_octants(octree)), 'count';
END $$;
SELECT abacus_octree_create('octree2', 2, '{0,0}', '{1,1}', '{v}', 14);
SELECT abacus_octree_create('octree3', 3, '{0,0,0}', '{1,1,1}', '{v}', 9);
SELECT abacus_octree_refine('octree2', 'SELECT 10, random(), random() FROM generate_series(1, 3000)');
SELECT abacus_octree_refine('octree3', 'SELECT 6, random(), random(), random() FROM generate_series(1, 3000)');
INSERT INTO noted SELECT d, 0, leaves(d) FROM generate_series(2, 3) d;
SQL

sub changes
{
	return $node->safe_psql('postgres', "SELECT changes FROM noted WHERE dimension = $_[0]");
}

for my $strike (1 .. $kills)
{
	my $d = 2 + $strike % 2;
	my ($before, $victim) = run_and_strike($node, "CALL change_on($d)", 1, sub { changes($d) });
	my $what = "octree$d, $victim after $before changes";
	cmp_ok(changes($d), '>=', $before, "$what: nothing committed is lost");
	is($node->psql('postgres', "SELECT look($d)", stderr => \my $errors), 0, "$what: leaves are as noted");
	is($node->safe_psql('postgres', "SELECT bt_index_check(conindid, true) FROM pg_constraint WHERE conrelid = 'octree$d'::regclass AND contype = 'p'"),
		'', "$what: the index is sound");
	diag($errors) if $errors;
}
$node->safe_psql('postgres', "SELECT change($_)") for 2, 3; # a process may be struck before its first
cmp_ok(changes($_), '>', 0, changes($_) . " changes of the octree of dimension $_") for 2, 3;

# many sessions: some change, the others check
my %scripts = (
	change_2 => 'SELECT change(2);',
	change_3 => 'SELECT change(3);',
	savepoint => "BEGIN;\nSELECT change(2);\nSAVEPOINT s;\nSELECT change(3);\nROLLBACK TO s;\nSELECT look(3);\nSELECT look(2);\nEND;",
	repeatable => "BEGIN ISOLATION LEVEL REPEATABLE READ;\nSELECT look(3);\nSELECT change(3);\nSELECT look(3);\nEND;",
	look_2 => 'SELECT look(2);',
	look_3 => 'SELECT look(3);',
	look_twice => "BEGIN ISOLATION LEVEL REPEATABLE READ;\nSELECT look(2);\nSELECT look(3);\nSELECT look(2);\nEND;",
	vacuum => 'VACUUM octree2, octree3;');
my @files;
for my $name (sort keys %scripts)
{
	my $file = $node->basedir . "/$name.sql";
	append_to_file($file, $scripts{$name});
	push @files, '-f', $file . ($name =~ /look/ ? '@3' : '@1');
}
my $before = changes(2) + changes(3);
# serialization failures are retried; anything else ends a client
my ($out, $err) = run_command(
	[ 'pgbench', '-n', '-T', $seconds, '-c', 6, '-j', 2, '--max-tries', 0, @files, $node->connstr('postgres') ]);
unlike($err, qr/abort|ERROR/, 'no session fails') or diag($err);
cmp_ok(changes(2) + changes(3), '>', $before, 'there were changes');
$node->safe_psql('postgres', "SELECT look($_)") for 2, 3;

# long work is cancelled soon
$node->safe_psql('postgres', <<'SQL');
SELECT abacus_octree_create('large', 2, '{0,0}', '{1,1}', '{v}', 12);
SELECT abacus_octree_from_size('large', 'SELECT array_fill(0.002::float8, ARRAY[cardinality($1 || $2) / 2])');
SQL
my %long = (
	'growing' => q{SELECT abacus_octree_from_size('large', 'SELECT array_fill(0.0002::float8, ARRAY[cardinality($1 || $2) / 2])')},
	'balancing' => q{BEGIN; SELECT abacus_octree_refine('large', 'SELECT 12, random(), random() FROM generate_series(1, 200000)'); SELECT abacus_octree_balance('large') FROM generate_series(1, 100)},
	'merging' => q{SELECT abacus_octree_coarsen('large', 'SELECT 1, random(), random() FROM generate_series(1, 30000000)')},
	'updating' => q{SELECT abacus_octree_update('large', 'SELECT code, 1 FROM abacus_octants(''large'') CROSS JOIN generate_series(1, 100)')},
	'extracting' => q{SELECT count(*) FROM generate_series(1, 100), abacus_octree_nodes('large')});
my $large = $node->safe_psql('postgres', "SELECT count(*), sum(code), sum(level) FROM abacus_octants('large')");
for my $what (sort keys %long)
{
	for my $after (0.1, 0.7)
	{
		my $began = time;
		$node->psql('postgres', "SET statement_timeout = " . 1000 * $after . "; $long{$what}", stderr => \my $errors);
		my $took = time - $began;
		like($errors, qr/canceling statement due to statement timeout/, "$what is cancelled");
		cmp_ok($took, '<', $after + 2, sprintf('%s is cancelled %.2f s after it was told to', $what, $took - $after));
	}
}
is($node->safe_psql('postgres', "SELECT count(*), sum(code), sum(level) FROM abacus_octants('large')"), $large, 'nothing has changed');
is($node->safe_psql('postgres', "SELECT count(*) FROM abacus_check('large')"), 0, 'and the pages are sound');

$node->stop;
done_testing();
