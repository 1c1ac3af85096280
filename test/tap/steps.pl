# Steps of a solution stored by many sessions at once, by sessions and servers that are killed, and in a dump.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusCrash;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $kills = $ENV{ABACUS_KILLS} || 8;
my $node = crash_node('steps');
$node->safe_psql('postgres', <<'SQL');
SELECT abacus_triangulate('mesh', 'SELECT i, (i * 0.7548776662466927) % 1, (i * 0.5698402909980532) % 1 FROM generate_series(1, 100000) AS i');
CREATE FUNCTION store(step bigint, parts int, part int, value float8) RETURNS bigint LANGUAGE sql AS $$
	SELECT abacus_store('mesh', step, parts, part, format('SELECT id, %s, x FROM abacus_share_vertices(''mesh'', %s, %s, 0) WHERE owner = %s', value, parts, part, part)) $$;
SQL

# All ranks at once: the first makes the table, the first of each step makes its partition.
my $script = $node->basedir . '/store.sql';
append_to_file($script, join("\n", map { "SELECT store($_, 8, :client_id, $_);" } 1 .. 3));
my ($out, $err) = run_command([ 'pgbench', '-n', '-t', 1, '-c', 8, '-j', 2, '-f', $script, $node->connstr('postgres') ]);
unlike($err, qr/error|abort|warning/i, 'no session fails');
is($node->safe_psql('postgres', q{SELECT * FROM abacus_steps('mesh')}), join("\n", map { "$_|8|8|100000|t" } 1 .. 3), 'all steps are whole');
is($node->safe_psql('postgres', 'SELECT step, count(id), sum("values"[1]) FROM mesh_steps WHERE id IS NOT NULL GROUP BY step ORDER BY step'),
	join("\n", map { "$_|100000|" . 100000 * $_ } 1 .. 3), 'with all values');

# The same part by many sessions: they take turns.
my $same = $node->basedir . '/same.sql';
append_to_file($same, 'SELECT store(1, 8, 5, :client_id);');
($out, $err) = run_command([ 'pgbench', '-n', '-t', 3, '-c', 4, '-j', 2, '-f', $same, $node->connstr('postgres') ]);
unlike($err, qr/error|abort|warning/i, 'no session fails');
is($node->safe_psql('postgres', 'SELECT count(DISTINCT "values"[1]) FROM mesh_steps WHERE step = 1 AND part = 5 AND id IS NOT NULL'), 1, 'the values of one');
is($node->safe_psql('postgres', q{SELECT * FROM abacus_steps('mesh') WHERE step = 1}), '1|8|8|100000|t', 'the step is whole');

# A second session draws the last whole step and reads values of it while the ranks compute: never a step that is not whole.
my $ranks = $node->basedir . '/ranks.sql';
append_to_file($ranks, join("\n", map { "SELECT store($_, 4, :client_id, $_);" } 10 .. 15));
my $watch = $node->basedir . '/watch.sql';
append_to_file($watch, <<'SQL');
WITH last AS MATERIALIZED (SELECT max(step) AS step FROM abacus_steps('mesh') WHERE whole)
SELECT 1 / (count(*) FILTER (WHERE "values"[1] = step) = 100)::int FROM last, abacus_interpolate('mesh', 'SELECT i, i / 101.0, 0.5 FROM generate_series(1, 100) AS i', step => last.step);
SELECT 1 / (length(abacus_draw('mesh', 100, attribute => '1', edges => false, step => (SELECT max(step) FROM abacus_steps('mesh') WHERE whole))) > 0)::int;
SQL
my ($watched, $seen) = ('', '');
my $watching = IPC::Run::start([ 'pgbench', '-n', '-t', 8, '-f', $watch, $node->connstr('postgres') ], '<', \undef, '>', \$seen, '2>', \$watched);
($out, $err) = run_command([ 'pgbench', '-n', '-t', 1, '-c', 4, '-j', 2, '-f', $ranks, $node->connstr('postgres') ]);
$watching->finish;
unlike($err . $watched, qr/error|abort|warning/i, 'ranks and the watching session do not fail');
like($seen, qr{processed: 8/8}, 'it has drawn all its pictures');

# What a transaction sees of a step stays as it is, though a rank stores its part again.
my $reader = $node->background_psql('postgres');
my $value = q{SELECT abacus_interpolate('mesh', 0.3, 0.4, '1', step => 15), "values"[1] FROM abacus_interpolate('mesh', 'SELECT 1, 0.3, 0.4', step => 15)};
$reader->query_safe('BEGIN ISOLATION LEVEL REPEATABLE READ');
is($reader->query_safe($value), '15|15', 'a value');
$node->safe_psql('postgres', join(';', map { "SELECT store(15, 4, $_, 99)" } 0 .. 3));
is($reader->query_safe($value), '15|15', 'the same in the transaction');
$reader->query_safe('COMMIT');
is($reader->query_safe($value), '99|99', 'the new one after it');
$reader->quit;

# Killed in the middle: whole parts or none, old or new. Then the rank runs again.
my $in_time = 0;
for my $round (1 .. $kills)
{
	my $step = 100 + $round % 3;
	$in_time += (run_and_strike($node, "SELECT store($step, 2, 1, $round)", 0.5, sub { }))[2];
	my $here = $node->safe_psql('postgres',
		"SELECT count(id), count(DISTINCT \"values\"[1]) FILTER (WHERE id IS NOT NULL), count(*) - count(id) FROM mesh_steps WHERE step = $step");
	my $whole = $node->safe_psql('postgres', q{SELECT vertices FROM abacus_partition('mesh', 2) WHERE part = 1});
	like($here, qr/^(0\|0\|0|$whole\|1\|1)$/, "round $round: a whole part or none");
	is($node->safe_psql('postgres', "SELECT store($step, 2, 1, -$round)"), $whole, 'it runs again');
	is($node->safe_psql('postgres', "SELECT DISTINCT \"values\"[1] FROM mesh_steps WHERE step = $step AND id IS NOT NULL"), -$round, 'its values are there');
}
diag("$in_time of $kills were struck in time");
is($node->psql('postgres', 'SELECT bt_index_check(indexrelid, true) FROM pg_index WHERE indrelid IN (SELECT inhrelid FROM pg_inherits)'), 0, 'all indexes are sound');

# A dump has the steps; the owner's next change binds them to the mesh again.
my $steps = q{SELECT * FROM abacus_steps('mesh'); SELECT md5(string_agg(s::text, ',' ORDER BY step, part, id)) FROM mesh_steps AS s};
my $before = $node->safe_psql('postgres', $steps);
my $dump = $node->basedir . '/dump.sql';
$node->command_ok([ 'pg_dump', '-f', $dump, $node->connstr('postgres') ], 'dumped');
$node->safe_psql('postgres', 'CREATE DATABASE restored');
$node->command_ok([ 'psql', '-XAtq', '-v', 'ON_ERROR_STOP=1', '-f', $dump, $node->connstr('restored') ], 'restored');
is($node->safe_psql('restored', $steps), $before, 'the same steps');
is($node->safe_psql('restored', 'SELECT store(1, 8, 0, 9)') > 0, 1, 'a part is stored');
is($node->safe_psql('restored', q{SELECT count(*) FROM pg_depend WHERE objid = 'mesh_steps'::regclass AND refobjid = 'mesh'::regclass}), 1, 'which binds the table');
is($node->safe_psql('restored', q{DROP TABLE mesh; SELECT count(*) FROM pg_class WHERE relname LIKE 'mesh_steps%'}), 0, 'dropping the mesh drops its steps');

$node->stop;
done_testing();
