# A session whose threads are at work is terminated, or killed: the server continues, and the mesh is as
# before.
use strict;
use warnings;

use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;
use Time::HiRes qw(sleep time);

my $node = PostgreSQL::Test::Cluster->new('threads');
$node->init;
$node->append_conf('postgresql.conf', "restart_after_crash = on\n");
$node->start;
$node->safe_psql('postgres', <<'SQL');
CREATE EXTENSION abacus;
CREATE TABLE points AS SELECT i AS id, random() AS x, random() AS y FROM generate_series(1, 200000) AS i;
SELECT abacus_triangulate('field', 'TABLE points');
SQL
my $before = $node->safe_psql('postgres', "SELECT count(*), sum(v0) FROM abacus_simplices('field')");

my $insertion = "SELECT abacus_insert('field', 'SELECT id + 1000000, x + 0.3, y + 0.3 FROM points')";
my $deletion = "SELECT abacus_delete('field', 'TABLE points')";

# Starts a change in a session of its own; returns the session, and its process once it has threads. It does
# not commit, so a change that is finished before it is stopped also leaves the mesh unchanged.
sub begin_change
{
	my ($change) = @_;
	my ($out, $err) = ('', '');
	my $session = IPC::Run::start(
		[ 'psql', '-XAtq', '-d', $node->connstr('postgres'), '-c', 'SET abacus.threads = 3', '-c',
			'SET abacus.tiny_intervals = on', '-c', 'SELECT pg_backend_pid()', '-c', 'BEGIN', '-c',
			$change ],
		'>', \$out, '2>', \$err);
	$session->pump until $out =~ /(\d+)/;
	my $pid = $1;
	my $deadline = time() + 120;
	while (time() < $deadline && -e "/proc/$pid")
	{
		my @tasks = glob("/proc/$pid/task/*");
		return ($session, $pid) if @tasks > 2;
		sleep 0.001;
	}
	die 'no threads were started';
}

# A rejected psql may end before it has read its query, which would be a different error.
sub wait_for_server
{
	my $deadline = time() + 120;
	until (system('pg_isready', '-q', '-d', $node->connstr('postgres')) == 0)
	{
		die 'the server is down' if time() > $deadline;
		sleep 0.05;
	}
}

foreach my $case (map { [ $_, $insertion ], [ $_, $deletion ] } ('cancel', 'terminate', 'kill'))
{
	my ($way, $change) = @$case;
	my ($session, $pid) = begin_change($change);
	my $began = time();
	if ($way eq 'kill')
	{
		kill 'KILL', $pid;
	}
	else
	{
		$node->safe_psql('postgres', "SELECT pg_${way}_backend($pid)");
	}
	$session->finish;
	cmp_ok(time() - $began, '<', 20, "$way: the session ends soon");
	wait_for_server();
	sleep 0.01 while -e "/proc/$pid" && time() - $began < 20; # psql ends before it
	is(-e "/proc/$pid" ? 1 : 0, 0, "$way: its process has gone");
	is($node->safe_psql('postgres', "SELECT count(*), sum(v0) FROM abacus_simplices('field')"), $before, "$way: the mesh is as it was");
	is($node->safe_psql('postgres', "SELECT count(*) FROM abacus_check('field')"), 0, "$way: and sound");
}
my $log = slurp_file($node->logfile);
unlike($log, qr/signal 11|signal 6|PANIC/, 'nothing has crashed but what was killed');
like($log, qr/signal 9/, 'which was');
$node->stop;
done_testing();
