# pg_upgrade into a new cluster, where every OID that is not kept differs: the tables are taken over as files,
# byte by byte, and the mesh can be used and changed. The old server has the same version, or is the one in
# the folder ABACUS_OLD_SERVER.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my @old_server = $ENV{ABACUS_OLD_SERVER} ? (install_path => $ENV{ABACUS_OLD_SERVER}) : ();
my $old = PostgreSQL::Test::Cluster->new('old', @old_server);
$old->init;
$old->append_conf('postgresql.conf', 'fsync = off');
$old->start;
$old->safe_psql('postgres', <<'SQL');
CREATE EXTENSION abacus; CREATE EXTENSION amcheck;
SELECT abacus_triangulate('field', 'SELECT i, (i * 7919) % 1009, (i * 104729) % 997, sin(i) AS height FROM generate_series(1, 6000) AS i');
SELECT abacus_stage('field', 'SELECT -i, i, i * i, 1 FROM generate_series(1, 100) AS i');
SELECT abacus_triangulate('solid', 'SELECT i, (i * 7919) % 101, (i * 104729) % 97, (i * 31) % 89 FROM generate_series(1, 3000) AS i', dimension => 3);
SQL
my @meshes = ('field', 'solid');
# 15.20 stores a version in the options of added columns. Older servers of other branches do not know it, so
# pg_upgrade could not take over such a table of any extension.
chomp(my $bin = `pg_config --bindir`);
my $knows = system('grep', '-q', 'pg_attver', $bin . '/postgres') == 0;
$old->safe_psql('postgres', q{UPDATE pg_attribute SET attoptions = NULL WHERE attoptions::text ~ 'pg_attver'}) unless $knows;
my %old = map { $_ => mesh_content($old, 'postgres', $_) . "\n" . mesh_bytes($old, 'postgres', $_) } @meshes;
$old->stop;

my $new = PostgreSQL::Test::Cluster->new('new');
# from 18 on a cluster has checksums by default, and both must agree
my @as_before = @old_server && `initdb --help` =~ /--no-data-checksums/ ? (extra => ['--no-data-checksums']) : ();
$new->init(@as_before);
$new->append_conf('postgresql.conf', 'fsync = off');
# pg_upgrade writes into the current folder
chdir ${PostgreSQL::Test::Utils::tmp_check};
command_ok(
	[   'pg_upgrade', '--no-sync', '-d', $old->data_dir, '-D', $new->data_dir,
		'-b', $old->config_data('--bindir'), '-B', $new->config_data('--bindir'),
		'-s', $new->host, '-p', $old->port, '-P', $new->port ],
	'pg_upgrade');
$new->start;

for my $mesh (@meshes)
{
	is(mesh_content($new, 'postgres', $mesh) . "\n" . mesh_bytes($new, 'postgres', $mesh),
		$old{$mesh}, "$mesh: the same, byte by byte");
	is_intact($new, 'postgres', $mesh, $mesh);
}
$old->start;
my %query = (field => 'SELECT 10000 + i, 1000 * sin(i), 1000 * cos(i), 0 FROM generate_series(1, 500) AS i',
	solid => 'SELECT 10000 + i, 100 * sin(i), 100 * cos(i), i % 90 FROM generate_series(1, 500) AS i');
for my $mesh (@meshes)
{
	for my $node ($old, $new)
	{
		$node->safe_psql('postgres', "SELECT abacus_stage('$mesh', '$query{$mesh}'), abacus_triangulate('$mesh')");
	}
	is(mesh_content($new, 'postgres', $mesh), mesh_content($old, 'postgres', $mesh), "$mesh: changed alike");
	is_intact($new, 'postgres', $mesh, "$mesh: changed");
	$new->safe_psql('postgres', "DROP TABLE $mesh");
	is($new->safe_psql('postgres', "SELECT to_regclass('${mesh}_vertices')"), '', "$mesh: dropped with its points");
}
$new->safe_psql('postgres', 'DROP EXTENSION abacus');

$old->stop;
$new->stop;
done_testing();
