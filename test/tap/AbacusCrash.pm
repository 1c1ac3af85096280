# Servers that lose a process: the common part of the crash tests.
#
# A statement runs in a session of its own. At a random moment its backend, the checkpointer or the postmaster
# is killed with signal 9, or the statement is cancelled, or the session terminated. Then the server recovers.
# Data that a killed process has written is safe in the operating system, so fsync may be off.
#
# ABACUS_SEED    of the random moments; printed, to repeat them
package AbacusCrash;

use strict;
use warnings;

use Exporter 'import';
use IPC::Run ();
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;
use Time::HiRes qw(time usleep);

our @EXPORT = qw(crash_node run_and_strike);

# Killed in this order, again and again.
my @victims = qw(backend postmaster backend checkpointer backend cancel postmaster terminate);

# A server for crashes, with the extensions.
sub crash_node
{
	my ($name) = @_;
	my $seed = srand($ENV{ABACUS_SEED} || (time * 1000) % 1_000_000_000);
	diag("ABACUS_SEED=$seed");
	my $node = PostgreSQL::Test::Cluster->new($name);
	$node->init(extra => ['--data-checksums']);
	$node->append_conf('postgresql.conf', <<'CONF');
restart_after_crash = on
wal_level = replica
checkpoint_timeout = 30s
log_statement = none
fsync = off
CONF
	$node->start;
	$node->safe_psql('postgres', 'CREATE EXTENSION abacus; CREATE EXTENSION amcheck');
	return $node;
}

# After all processes have been killed, it takes a moment until they are gone.
sub start_again
{
	my ($node) = @_;
	my $until = time + $PostgreSQL::Test::Utils::timeout_default;
	until ($node->start(fail_ok => 1))
	{
		BAIL_OUT('the server does not start') if time > $until;
		usleep(100_000);
		$node->stop('fast', fail_ok => 1);
	}
	return;
}

# A server that has lost a process ends all others, recovers, and gets a new checkpointer.
sub await_other_checkpointer
{
	my ($node, $old) = @_;
	my $query = "SELECT pid FROM pg_stat_activity WHERE backend_type = 'checkpointer'";
	my $until = time + $PostgreSQL::Test::Utils::timeout_default;
	while (1)
	{
		my ($pid) = run_command([ 'psql', '-XAtq', '-d', $node->connstr('postgres'), '-c', $query ]);
		return if $pid && $pid != $old;
		BAIL_OUT('the server does not come back') if time > $until;
		usleep(50_000);
	}
	return;
}

# Strikes the process $pid, and waits until the server is up again.
sub strike
{
	my ($node, $victim, $pid) = @_;
	return $node->safe_psql('postgres', "SELECT pg_cancel_backend($pid)") if $victim eq 'cancel';
	return $node->safe_psql('postgres', "SELECT pg_terminate_backend($pid)") if $victim eq 'terminate';

	my $checkpointer = $node->safe_psql('postgres',
		"SELECT pid FROM pg_stat_activity WHERE backend_type = 'checkpointer'");
	if ($victim eq 'postmaster')
	{
		# all of them: a backend that waits for a lock of the killed one notices nothing
		my @others = split /\n/, $node->safe_psql('postgres',
			'SELECT pid FROM pg_stat_activity WHERE pid <> pg_backend_pid()');
		$node->kill9;
		kill 9, $pid, @others;
		start_again($node);
	}
	else
	{
		kill 9, $victim eq 'backend' ? $pid : $checkpointer;
		await_other_checkpointer($node, $checkpointer);
	}
	return;
}

# Runs a statement, or several of a list, and strikes after at most $longest seconds. Returns the result of
# $look at that moment, the victim, and whether the statement was still running.
sub run_and_strike
{
	my ($node, $statement, $longest, $look) = @_;
	my @statements = ref $statement ? @$statement : ($statement);
	my ($out, $err) = ('', '');
	my $session = IPC::Run::start(
		[   'psql', '-XAtq', '-v', 'ON_ERROR_STOP=1', '-d', $node->connstr('postgres'),
			'-c', 'SELECT pg_backend_pid()', (map { ('-c', $_) } @statements),
			'-c', "SELECT 'done'", '-c', 'SELECT pg_sleep(3600)' ], # so that there is a session to kill
		'>', \$out, '2>', \$err,
		IPC::Run::timeout($PostgreSQL::Test::Utils::timeout_default));

	$session->pump until $out =~ /^(\d+)\n/;
	my $pid = $1;
	usleep(1e6 * rand($longest));
	my $seen = $look->();
	$session->pump_nb;
	BAIL_OUT("@statements: $err") if $err =~ /ERROR/;
	my $victim = $out =~ /done/ ? 'terminate' : $victims[0];
	# between two statements a session does not notice that it is cancelled
	$victim = 'terminate' if $victim eq 'cancel' && @statements > 1;
	strike($node, $victim, $pid);
	if ($victim eq 'cancel')
	{
		# nor does it when the statement is just about to end
		$session->pump while $session->pumpable && $out !~ /done/;
		strike($node, 'terminate', $pid) if $out =~ /done/;
	}
	$session->finish;
	my $in_time = $out !~ /done/;
	push @victims, shift @victims if $in_time;
	return ($seen, $victim, $in_time);
}

1;
