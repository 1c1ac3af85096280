# Clusters whose databases have the shards of one mesh, for the TAP tests.
package AbacusShards;

use strict;
use warnings;

use Exporter 'import';
use IPC::Run ();
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;
use Time::HiRes qw(time usleep);

our @EXPORT = qw(shards_node shards_server shards_differing shards_is_same shards_in_background shards_fails);

# A cluster. The first one is the coordinator's.
sub shards_node
{
	my ($name, @settings) = @_;
	my $node = PostgreSQL::Test::Cluster->new($name);
	$node->init;
	$node->append_conf('postgresql.conf', join "\n", 'fsync = off', 'max_connections = 60', 'restart_after_crash = on', @settings);
	$node->start;
	return $node;
}

# A database of a cluster becomes a foreign server.
sub shards_server
{
	my ($coordinator, $name, $cluster) = @_;
	my $user = $coordinator->safe_psql('postgres', 'SELECT current_user');
	$cluster->safe_psql('postgres', "CREATE DATABASE $name");
	$cluster->safe_psql($name, 'CREATE EXTENSION abacus');
	$coordinator->safe_psql('postgres', sprintf(
		"CREATE SERVER %s FOREIGN DATA WRAPPER dblink_fdw OPTIONS (host '%s', port '%s', dbname '%s');
		CREATE USER MAPPING FOR CURRENT_USER SERVER %s OPTIONS (user '%s')",
		$name, $cluster->host, $cluster->port, $name, $name, $user));
	return;
}

# How many rows of a call on two meshes differ; it names them MESH.
sub shards_differing
{
	my ($node, $call, $mesh, $one) = @_;
	(my $a = $call) =~ s/MESH/'$mesh'/g;
	(my $b = $call) =~ s/MESH/'$one'/g;
	return $node->safe_psql('postgres', "SELECT count(*) FROM (
		(SELECT r::text FROM $a AS r EXCEPT ALL SELECT r::text FROM $b AS r) UNION ALL
		(SELECT r::text FROM $b AS r EXCEPT ALL SELECT r::text FROM $a AS r)) AS other");
}

# The mesh has the simplices and points of one server's, and is sound.
sub shards_is_same
{
	my ($node, $mesh, $one, $what) = @_;
	is( shards_differing($node, 'abacus_cells(MESH)', $mesh, $one) . ' '
		  . shards_differing($node, '(SELECT id, x, y, z, attributes, vertex FROM abacus_vertices(MESH))', $mesh, $one) . ' '
		  . $node->safe_psql('postgres', "SELECT count(*) FROM abacus_check('$mesh')"),
		'0 0 0', "$what: simplices and points are those of one server");
	return;
}

# Runs statements in a session of their own; its output comes to $$out and $$err.
sub shards_in_background
{
	my ($node, $out, $err, @statements) = @_;
	$$out = $$err = '';
	return IPC::Run::start([ 'psql', '-XqAt', '-v', 'VERBOSITY=verbose', '-d', $node->connstr('postgres'), map { ('-c', $_) } @statements ],
		'>', $out, '2>', $err, IPC::Run::timeout($PostgreSQL::Test::Utils::timeout_default));
}

# A statement fails with such an error.
sub shards_fails
{
	my ($node, $sql, $pattern, $what) = @_;
	my ($out, $err);
	$node->psql('postgres', $sql, stdout => \$out, stderr => \$err, on_error_stop => 1, extra_params => [ '-v', 'VERBOSITY=verbose' ]);
	like($err, $pattern, $what);
	return;
}

1;
