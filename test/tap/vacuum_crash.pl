# VACUUM that moves pages, killed at any moment: the mesh is the same, and the next one cuts the file.
#
#     ABACUS_KILLS   how many times (default 8)
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusCrash;
use AbacusMesh;
use PostgreSQL::Test::Utils;
use Test::More;

my $kills = $ENV{ABACUS_KILLS} || 8;

my $node = crash_node('vacuum_crash');
$node->append_conf('postgresql.conf', "autovacuum = off\nsession_preload_libraries = 'abacus'");
$node->restart;
plan skip_all => 'built without shortcuts' unless has_shortcuts($node);
$node->safe_psql('postgres', q{SELECT setseed(0.5);
	CREATE TABLE points AS SELECT i AS id, random() AS x, random() AS y FROM generate_series(1, 100000) AS i;
	SELECT abacus_triangulate('plane', 'SELECT * FROM points')});
my $fresh = mesh_pages($node, 'postgres', 'plane');
my $content = mesh_content($node, 'postgres', 'plane');

# An UPDATE is the shortest way to spread the rows over the table.
my @statements = ('UPDATE plane SET part = part', 'VACUUM plane') x 100;
for my $n (1 .. $kills)
{
	my (undef, $victim) = run_and_strike($node, \@statements, 0.5, sub { });
	is(mesh_content($node, 'postgres', 'plane'), $content, "$victim: the same mesh");
	is_intact($node, 'postgres', 'plane', $victim);
	$node->safe_psql('postgres', 'VACUUM plane');
	cmp_ok(mesh_pages($node, 'postgres', 'plane'), '<=', 1.1 * $fresh, "$victim: the next VACUUM cuts the file");
}

$node->stop;
done_testing();
