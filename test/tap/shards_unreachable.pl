# A server of a mesh over several servers that is cut off: it neither answers nor takes connections, as if the
# network were gone. A reader can cancel that at once. A process between coordinator and server plays the
# network: at SIGUSR1 it passes nothing on any more, and its queue of connections is full.
use strict;
use warnings;

use IO::Select;
use IO::Socket::INET;
use IO::Socket::UNIX;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $node = PostgreSQL::Test::Cluster->new('coordinator');
$node->init;
$node->append_conf('postgresql.conf', "fsync = off\nmax_prepared_transactions = 20");
$node->start;

# Passes bytes on between pairs of sockets.
sub relay
{
	my ($listener, $server, $done) = @_;
	my ($is_cut, %other) = (0);
	local $SIG{USR1} = sub { $is_cut = 1 };
	my $sockets = IO::Select->new($listener);
	until ($is_cut)
	{
		for my $from ($sockets->can_read(0.2))
		{
			if ($from == $listener)
			{
				my $client = $listener->accept;
				my $there = IO::Socket::UNIX->new(Peer => $server);
				@other{ $client, $there } = ($there, $client);
				$sockets->add($client, $there);
			}
			elsif (sysread $from, my $bytes, 65536)
			{
				syswrite $other{$from}, $bytes;
			}
			else
			{
				$sockets->remove($from, $other{$from});
				close $_ for $other{$from}, $from;
			}
		}
	}
	my @waiting = map { IO::Socket::INET->new(PeerAddr => $listener->sockhost, PeerPort => $listener->sockport, Blocking => 0) } 1 .. 4;
	append_to_file($done, 'cut');
	sleep 600;
	return;
}

my $listener = IO::Socket::INET->new(Listen => 1, LocalAddr => '127.0.0.1') or die "no socket: $!";
my $done = $node->data_dir . '/network_is_cut';
my $network = fork;
if (!$network)
{
	relay($listener, $node->host . '/.s.PGSQL.' . $node->port, $done);
	exit;
}
END { kill 'KILL', $network if $network }

my $user = $node->safe_psql('postgres', 'SELECT current_user');
$node->safe_psql('postgres', 'CREATE EXTENSION abacus; CREATE EXTENSION postgres_fdw');
for my $name ('near', 'far')
{
	my ($host, $port) = $name eq 'far' ? ('127.0.0.1', $listener->sockport) : ($node->host, $node->port);
	$node->safe_psql('postgres', "CREATE DATABASE $name");
	$node->safe_psql($name, 'CREATE EXTENSION abacus');
	$node->safe_psql('postgres', "CREATE SERVER $name FOREIGN DATA WRAPPER postgres_fdw OPTIONS (host '$host', port '$port', dbname '$name', sslmode 'disable', gssencmode 'disable');
		CREATE USER MAPPING FOR CURRENT_USER SERVER $name OPTIONS (user '$user')");
}
$node->safe_psql('postgres', "SELECT abacus_shard_create('mesh', '{near,far}');
	CALL abacus_shard_build('mesh', 'SELECT i, (i * 0.7548776662466927) % 1, (i * 0.5698402909980532) % 1 FROM generate_series(1, 2000) AS i')");

my ($out, $err);
my $begin = time;
my $read = "SELECT count(*) FROM abacus_cells('mesh')";
$node->psql('postgres', "BEGIN; $read; COPY (SELECT) TO PROGRAM 'kill -USR1 $network';
	DO \$\$ BEGIN WHILE pg_stat_file('$done', true) IS NULL LOOP PERFORM pg_sleep(0.1); END LOOP; END \$\$;
	SET LOCAL statement_timeout = '1s'; $read; ROLLBACK; SET statement_timeout = '1s'; $read; RESET statement_timeout; SELECT 'goes on'",
	stdout => \$out, stderr => \$err, on_error_stop => 0);
like($out, qr/^39\d\d\n.*goes on$/s, 'the mesh is read before, and the session goes on');
is(() = $err =~ /canceling statement due to statement timeout/g, 2, 'a reader is cancelled, who waits for an answer, or for a connection') or diag($err);
cmp_ok(time - $begin, '<', 60, 'soon'); # to connect would take the system two minutes
done_testing();
