# A session whose threads check a mesh or locate places is cancelled or terminated; abacus_progress shows the threads.
use strict;
use warnings;

use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;
use Time::HiRes qw(sleep time);

my $node = PostgreSQL::Test::Cluster->new('threads_reading');
$node->init;
$node->start;
$node->safe_psql('postgres', <<'SQL');
CREATE EXTENSION abacus;
CREATE TABLE points AS SELECT i AS id, random() AS x, random() AS y FROM generate_series(1, 200000) AS i;
SELECT abacus_triangulate('field', 'TABLE points');
SQL

# Work that takes long, since it is done in tiny pieces
my %work = (
	check => q{DO 'BEGIN FOR i IN 1 .. 1000 LOOP PERFORM count(*) FROM abacus_check(''field''); END LOOP; END'},
	locate => q{SELECT count(*) FROM generate_series(1, 1000) n, abacus_locate('field', 'SELECT id, x, y FROM points WHERE id >' || n) l},
	insert => q{SELECT abacus_insert('field', 'SELECT id + 1000000, x + 0.3, y + 0.3 FROM points')});

# Starts it in a session of its own; returns the session, its process once it has threads, and the most
# threads shown.
sub begin_work
{
	my ($name) = @_;
	my ($out, $err) = ('', '');
	my $session = IPC::Run::start(
		[ 'psql', '-X', '-d', $node->connstr('postgres'), '-c', 'SET abacus.threads = 3', '-c', 'SET abacus.tiny_intervals = on', '-c',
			"SET application_name = '$name'", '-c', $work{$name} ],
		'>', \$out, '2>', \$err);
	my $deadline = time() + 120;
	while (time() < $deadline)
	{
		my ($pid, $shown) = split /\|/, $node->safe_psql('postgres',
			"SELECT pid, threads FROM abacus_progress JOIN pg_stat_activity USING (pid) WHERE application_name = '$name'") || '|0';
		my @tasks = $pid ? glob("/proc/$pid/task/*") : ();
		return ($session, $pid) if @tasks > 2 && $shown > 1;
		sleep 0.01;
	}
	die "$name: no threads were started, or none shown";
}

foreach my $name (sort keys %work)
{
	foreach my $way ('cancel', 'terminate')
	{
		my ($session, $pid) = begin_work($name);
		my $began = time();
		$node->safe_psql('postgres', "SELECT pg_${way}_backend($pid)");
		$session->finish;
		cmp_ok(time() - $began, '<', 10, "$name, $way: the session ends soon");
		sleep 0.01 while -e "/proc/$pid" && time() - $began < 20; # psql ends before it
		is(-e "/proc/$pid" ? 1 : 0, 0, "$name, $way: its process has gone");
	}
}
is($node->safe_psql('postgres', "SELECT count(*) FROM abacus_check('field')"), 0, 'the mesh is sound');
unlike(slurp_file($node->logfile), qr/signal \d+|PANIC/, 'nothing has crashed');
$node->stop;
done_testing();
