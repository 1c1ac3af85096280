# abacus_build under kill -9.
#
# Builds are stopped at random moments. After recovery nothing of a committed batch is missing and nothing of
# an unfinished one is there; the mesh and its indexes are sound; and a further call ends with the same
# simplices as a build at once.
#
#     ABACUS_KILLS   how many times (default 20)
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusCrash;
use AbacusMesh;
use PostgreSQL::Test::Utils;
use Test::More;
use Time::HiRes qw(time usleep);

my $kills = $ENV{ABACUS_KILLS} || 20;
my @meshes = (
	{ dimension => 2, columns => 'id, x, y', points => 150_000, batch => 1600 },
	{ dimension => 3, columns => 'id, x, y, z', points => 25_000, batch => 320 });

my $node = crash_node('crash');
sub sql { return $node->safe_psql('postgres', $_[0]); }
sub inserted { return mesh_figure($node, 'postgres', $_[0], 'inserted'); }

sql(q{SELECT setseed(0.5);
	CREATE TABLE points AS
	SELECT i AS id, random() AS x, random() AS y, random() AS z FROM generate_series(1, 150000) AS i});
for my $m (@meshes)
{
	$m->{query} = "SELECT $m->{columns} FROM points WHERE id <= $m->{points}";
	$m->{once} = "once$m->{dimension}";
	sql("SELECT abacus_triangulate('$m->{once}', '$m->{query}', dimension => $m->{dimension})");

	# A strike comes after two sessions of psql have begun. A build must take many times as long, or almost
	# none would be hit. More batches make it longer.
	while (1)
	{
		sql("SELECT abacus_create('timed', $m->{dimension})");
		sql("SELECT abacus_stage('timed', '$m->{query}')");
		my $start = time;
		inserted('timed');
		my $look = time - $start;
		$start = time;
		sql("CALL abacus_build('timed', $m->{batch})");
		$m->{seconds} = time - $start;
		sql('DROP TABLE timed');
		last if $m->{seconds} > 20 * $look || $m->{batch} <= 100;
		$m->{batch} /= 2;
	}
}

my ($struck, $late, $complete) = (0, 0, 0);
while ($struck < $kills)
{
	my $m = $meshes[ $complete % @meshes ];
	my $mesh = "built$complete";
	sql("SELECT abacus_create('$mesh', $m->{dimension})");
	sql("SELECT abacus_stage('$mesh', '$m->{query}')");

	while ($struck < $kills && inserted($mesh) < $m->{points})
	{
		my $longest = 0.6 * $m->{seconds} * (1 - inserted($mesh) / $m->{points});
		my ($before, $victim, $in_time) = run_and_strike($node,
			"CALL abacus_build('$mesh', $m->{batch})", $longest, sub { inserted($mesh) });
		my $after = inserted($mesh);
		my $what = "$mesh, $victim at $before of $m->{points}";

		if (!$in_time)
		{
			$late++;
			$m->{seconds} *= 0.8; # the machine has become quicker
			is($after, $m->{points}, "$what: complete");
			next;
		}
		$struck++;
		cmp_ok($after, '>=', $before, "$what: nothing committed is lost");
		ok($after == $m->{points} || $after % $m->{batch} == 0,
			"$what: $after are whole batches");
		is_intact($node, 'postgres', $mesh, $what);
	}
	sql("CALL abacus_build('$mesh', $m->{batch})");
	is(inserted($mesh), $m->{points}, "$mesh: complete");
	is(other_simplices($node, 'postgres', $mesh, $m->{once}, $m->{dimension}),
		0, "$mesh: the same simplices as built at once");
	sql("DROP TABLE $mesh");
	$complete++;
}
# After the last batch the emptied vertex table is truncated. A crash right then, when no more of the
# write-ahead log is on disk than commits have flushed:
sql("ALTER SYSTEM SET $_") for 'wal_writer_delay = 10000', 'bgwriter_delay = 10000', 'bgwriter_lru_maxpages = 0', 'autovacuum = off';
$node->restart;
sql("SELECT abacus_create('emptied', 2)");
sql("SELECT abacus_stage('emptied', 'SELECT id, x, y FROM points WHERE id <= 20000')");
sql('CHECKPOINT');
my $session = $node->background_psql('postgres');
$session->query_until(qr/begins/, "\\echo begins\nDO \$\$ BEGIN CALL abacus_build('emptied', 5000); RAISE LOG 'emptied is built'; PERFORM pg_sleep(3600); END \$\$;\n");
# Not with a query: its snapshot would keep the vertex table from being truncated.
my $patience = 600;
while (slurp_file($node->logfile) !~ /LOG:  emptied is built/)
{
	die 'the build does not end' if $patience-- == 0;
	usleep(100_000);
}
$node->stop('immediate');
$session->{run}->finish;
$node->start;
is(inserted('emptied'), 20_000, 'emptied: complete');
is(sql("SELECT pg_relation_size('emptied_vertices')"), 0, 'emptied: the vertex table is truncated');
is_intact($node, 'postgres', 'emptied', 'emptied');
sql("SELECT abacus_stage('emptied', 'SELECT id + 1000000, x / 2, y / 2 FROM points WHERE id <= 2000'); CALL abacus_build('emptied', 500)");
is_intact($node, 'postgres', 'emptied', 'emptied, and built on');

diag("$struck times stopped, $late times too late, $complete meshes completed");

$node->stop;
done_testing();
