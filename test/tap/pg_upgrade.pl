# pg_upgrade into a new cluster, where every OID that is not kept differs: the tables are taken over as files,
# byte by byte, and can be used and changed: meshes with labels, lines, regions, levels, of a table that is tracked,
# and octrees. pg_dump and restore take them to the new cluster as well. The old server has the same version, or is
# the one in the folder ABACUS_OLD_SERVER.
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

# All kinds of what a mesh may have.
$old->safe_psql('postgres', <<'SQL');
CREATE TABLE points AS SELECT 100 * x + y AS id, x + 0.0 AS x, y + 0.0 AS y, 10 * sin(x / 5.0) * cos(y / 7.0) AS height FROM generate_series(0, 20) AS x, generate_series(0, 20) AS y;
CREATE TABLE followed AS TABLE points;
CREATE TABLE shores (line int, position int, point int);
INSERT INTO shores VALUES (1, 1, 202), (1, 2, 702), (1, 3, 707), (1, 4, 202), (2, 1, 1010), (2, 2, 1812);
SELECT abacus_triangulate('labelled', 'TABLE points');
SELECT abacus_label('labelled', 'SELECT code, v0, v1, v2, v0 % 5 AS soil FROM abacus_simplices(''labelled'')');
SELECT abacus_mark('labelled', 'SELECT code, v0, v1, v2, 1, v0 % 9 FROM abacus_simplices(''labelled'') WHERE v2 % 3 = 0');
SELECT abacus_create('tracked', 2, '{height}');
SELECT abacus_track('tracked', 'followed', '{id,x,y,height}');
SELECT abacus_track_lines('tracked', 'shores');
SELECT abacus_region('tracked', $$VALUES ('lake', 1)$$);
SELECT abacus_triangulate('tiered', 'TABLE points');
SELECT abacus_levels('tiered', '{0.5,2}');
SELECT abacus_publish('tiered', geometry => false);
SELECT abacus_octree_create('tree', 2, '{0,0}', '{32,32}', '{v}');
SELECT abacus_octree_from_points('tree', 'TABLE points', 5);
SELECT abacus_octree_update('tree', 'SELECT code, lower[1] FROM abacus_octants(''tree'')');
SQL

# What they hold.
sub kinds
{
	my ($node, $database) = @_;
	return $node->safe_psql($database, <<'SQL') . mesh_labels($node, $database, 'labelled') . join ' ', map { mesh_content($node, $database, $_) } qw(labelled tracked tiered);
SELECT * FROM abacus_lines('tracked');
SELECT v0, v1, lines, kind FROM abacus_edges('tracked', fixed => true) ORDER BY 1, 2;
SELECT * FROM abacus_regions('tracked');
SELECT level, max_error, greatest FROM tiered_levels ORDER BY level;
SELECT string_agg(v::text, ' ' ORDER BY id) FROM abacus_vertices(abacus_level('tiered', 2)) AS v;
SELECT count(*) FROM tiered_cells_2;
SELECT md5(string_agg(o::text, ',' ORDER BY code)) FROM abacus_octants('tree') AS o;
SQL
}

# The same changes of each, by statements for tables and calls for the rest, with ids from a number on.
sub change_kinds
{
	my ($node, $database, $first) = @_;
	$node->safe_psql($database, <<"SQL");
INSERT INTO followed SELECT $first + i, 20.5 + i, $first + 3.25 * i, i FROM generate_series(1, 30) AS i;
DELETE FROM followed WHERE id % 7 = $first % 7 AND id NOT BETWEEN 202 AND 707 AND id NOT BETWEEN 1010 AND 1815;
UPDATE shores SET point = point + 1 WHERE line = 2;
SELECT abacus_insert('labelled', 'SELECT $first + i, 20.5 + i / 2.0, $first + 3.25 * i, i FROM generate_series(1, 30) AS i');
SELECT abacus_insert('tiered', 'VALUES (-$first, 10.5, ' || $first / 1000.0 || ', 30)'), abacus_levels_refresh('tiered');
SELECT abacus_octree_refine('tree', 'SELECT 8, 1.5, 2.5');
SQL
	is_sound($node, $database, $_, "$database, changed: $_") for qw(labelled tracked tiered tree);
	return kinds($node, $database);
}
# 15.20 stores a version in the options of added columns. Older servers of other branches do not know it, so
# pg_upgrade could not take over such a table of any extension.
chomp(my $bin = `pg_config --bindir`);
my $knows = system('grep', '-q', 'pg_attver', $bin . '/postgres') == 0;
$old->safe_psql('postgres', q{UPDATE pg_attribute SET attoptions = NULL WHERE attoptions::text ~ 'pg_attver'}) unless $knows;
my $kinds = kinds($old, 'postgres');
like($kinds, qr/^1\|1\|.*\nlake\|1\|\d+\|.*\n1\|0\.5\|.*\n2\|2\|/s, 'the old server has lines, a region and levels');
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

is(kinds($new, 'postgres'), $kinds, 'labels, lines, regions, levels, views and octrees are the same');
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
my $changed = change_kinds($old, 'postgres', 5000);
isnt($changed, $kinds, 'all kinds are changed there');
is(change_kinds($new, 'postgres', 5000), $changed, '... and here alike');

# dumped by the new server's program, from the old one as it is now, and restored
my $dump = $new->basedir . '/dump';
$new->safe_psql('postgres', 'CREATE DATABASE restored');
command_ok([ 'pg_dump', '-Fc', '-d', $old->connstr('postgres'), '-f', $dump ], 'the old server is dumped');
command_ok([ 'pg_restore', '-e', '-1', '-d', $new->connstr('restored'), $dump ], '... and restored in the new one');
is(kinds($new, 'restored'), $changed, '... with all kinds');
is(mesh_content($new, 'restored', $_), mesh_content($old, 'postgres', $_), "... $_") for @meshes;
is(change_kinds($new, 'restored', 6000), change_kinds($old, 'postgres', 6000), '... changed alike');

$new->safe_psql('postgres', 'DROP EXTENSION abacus CASCADE');

$old->stop;
$new->stop;
done_testing();
