# abacus_build under kill -9.
#
# Builds are stopped at random moments: the backend, the checkpointer or the
# postmaster is killed, the build is cancelled or terminated. After recovery
# nothing of a committed batch is missing and nothing of an unfinished one is
# there; the mesh and its indexes are sound; and a further call ends with the
# same simplices as a build at once.
#
#     ABACUS_KILLS   how many times (default 20)
#     ABACUS_SEED    of the random moments; printed, to do it again
use strict;
use warnings;

use IPC::Run ();
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;
use Time::HiRes qw(time usleep);

my $kills = $ENV{ABACUS_KILLS} || 20;
my $seed = srand($ENV{ABACUS_SEED} || (time * 1000) % 1_000_000_000);
diag("$kills times, ABACUS_SEED=$seed");

my @meshes = (
	{ dimension => 2, columns => 'id, x, y', points => 150_000, batch => 1500 },
	{ dimension => 3, columns => 'id, x, y, z', points => 25_000, batch => 300 });
my @victims = qw(builder postmaster builder checkpointer builder cancel postmaster terminate);

my $node = PostgreSQL::Test::Cluster->new('crash');
$node->init(extra => ['--data-checksums']);
$node->append_conf('postgresql.conf', <<'CONF');
restart_after_crash = on
wal_level = replica
checkpoint_timeout = 30s
log_statement = none
CONF
$node->start;

sub sql { return $node->safe_psql('postgres', $_[0]); }

sub inserted
{
	my ($mesh) = @_;
	return sql("SELECT value FROM abacus_stats('$mesh') WHERE name = 'inserted'");
}

# After the postmaster has been killed, the others take a moment to notice.
sub start_again
{
	my $until = time + $PostgreSQL::Test::Utils::timeout_default;
	until ($node->start(fail_ok => 1))
	{
		BAIL_OUT('the server does not start') if time > $until;
		usleep(100_000);
		$node->stop('fast', fail_ok => 1);
	}
	return;
}

# A server that has lost a process ends all others, recovers, and has a new checkpointer.
sub await_other_checkpointer
{
	my ($old) = @_;
	my $query = "SELECT pid FROM pg_stat_activity WHERE backend_type = 'checkpointer'";
	my $until = time + $PostgreSQL::Test::Utils::timeout_default;
	while (1)
	{
		my ($pid) = run_command([ 'psql', '-XAtq', '-d', $node->connstr('postgres'), '-c', $query ]);
		return if $pid && $pid != $old;
		BAIL_OUT('the server does not come back') if time > $until;
		usleep(100_000);
	}
	return;
}

# Stops the build that runs as process $pid, and waits until the server is there again.
sub strike
{
	my ($victim, $pid) = @_;
	return sql("SELECT pg_cancel_backend($pid)") if $victim eq 'cancel';
	return sql("SELECT pg_terminate_backend($pid)") if $victim eq 'terminate';

	my $checkpointer =
	  sql("SELECT pid FROM pg_stat_activity WHERE backend_type = 'checkpointer'");
	if ($victim eq 'postmaster')
	{
		$node->kill9;
		kill 9, $pid;
		start_again();
	}
	else
	{
		kill 9, $victim eq 'builder' ? $pid : $checkpointer;
		await_other_checkpointer($checkpointer);
	}
	return;
}

# Calls abacus_build and strikes after at most $longest seconds. Returns whether it was in time.
sub build_and_strike
{
	my ($mesh, $batch, $victim, $longest) = @_;
	my ($out, $err) = ('', '');
	my $builder = IPC::Run::start(
		[   'psql', '-XAtq', '-v', 'ON_ERROR_STOP=1', '-d', $node->connstr('postgres'),
			'-c', 'SELECT pg_backend_pid()', '-c', "CALL abacus_build('$mesh', $batch)",
			'-c', "SELECT 'done'", '-c', 'SELECT pg_sleep(3600)' ], # so that there is one to kill
		'>', \$out, '2>', \$err,
		IPC::Run::timeout($PostgreSQL::Test::Utils::timeout_default));

	$builder->pump until $out =~ /^(\d+)\n/;
	my $pid = $1;
	usleep(1e6 * rand($longest));
	my $before = inserted($mesh);
	$builder->pump_nb;
	strike($out =~ /done/ ? 'terminate' : $victim, $pid);
	$builder->finish;
	return ($out !~ /done/, $before);
}

sql('CREATE EXTENSION abacus; CREATE EXTENSION amcheck;');
sql(q{SELECT setseed(0.5);
	CREATE TABLE points AS
	SELECT i AS id, random() AS x, random() AS y, random() AS z FROM generate_series(1, 150000) AS i});
for my $m (@meshes)
{
	$m->{query} = "SELECT $m->{columns} FROM points WHERE id <= $m->{points}";
	$m->{corners} = join ', ', map { "v$_" } 0 .. $m->{dimension};
	$m->{once} = "once$m->{dimension}";
	sql("SELECT abacus_triangulate('$m->{once}', '$m->{query}', dimension => $m->{dimension})");

	sql("SELECT abacus_create('timed', $m->{dimension})");
	sql("SELECT abacus_stage('timed', '$m->{query}')");
	my $start = time;
	sql("CALL abacus_build('timed', $m->{batch})");
	$m->{seconds} = time - $start;
	sql('DROP TABLE timed');
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
		my $victim = $victims[ $struck % @victims ];
		my $longest = $m->{seconds} * (1 - inserted($mesh) / $m->{points});
		my ($in_time, $before) = build_and_strike($mesh, $m->{batch}, $victim, $longest);
		my $after = inserted($mesh);
		my $what = "$mesh, $victim at $before of $m->{points}";

		if (!$in_time)
		{
			$late++;
			is($after, $m->{points}, "$what: complete");
			next;
		}
		$struck++;
		cmp_ok($after, '>=', $before, "$what: nothing committed is lost");
		ok($after == $m->{points} || $after % $m->{batch} == 0,
			"$what: $after are whole batches");
		is(sql("SELECT count(*) FROM abacus_check('$mesh')"), 0, "$what: the mesh is sound");
		is( sql("SELECT bt_index_check('${mesh}_pkey', true), bt_index_check('${mesh}_vertices_pkey', true);
				SELECT count(*) FROM verify_heapam('$mesh')"),
			"|\n0", "$what: so are table and indexes");
	}
	sql("CALL abacus_build('$mesh', $m->{batch})");
	is(inserted($mesh), $m->{points}, "$mesh: complete");
	is( sql("SELECT count(*) FROM (
				(SELECT $m->{corners} FROM abacus_simplices('$mesh') EXCEPT ALL
				 SELECT $m->{corners} FROM abacus_simplices('$m->{once}')) UNION ALL
				(SELECT $m->{corners} FROM abacus_simplices('$m->{once}') EXCEPT ALL
				 SELECT $m->{corners} FROM abacus_simplices('$mesh'))) AS other"),
		0, "$mesh: the same simplices as built at once");
	sql("DROP TABLE $mesh");
	$complete++;
}
diag("$struck times stopped, $late times too late, $complete meshes completed");

$node->stop;
done_testing();
