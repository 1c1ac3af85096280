# Functions in SQL and expressions that are compiled: a question about a small window, a line or a raster
# takes milliseconds, and must not wait for the compiler, which the planner may choose when it does not know
# the arguments.
use strict;
use warnings;

use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $node = PostgreSQL::Test::Cluster->new('jit');
$node->init;
$node->append_conf('postgresql.conf', 'fsync = off');
$node->start;
my $is_available = $node->safe_psql("postgres", "SELECT pg_jit_available()");
if ($is_available ne "t")
{
	$node->stop;
	plan skip_all => 'this PostgreSQL compiles no expressions';
}
$node->safe_psql('postgres', <<'SQL');
CREATE EXTENSION abacus_postgis_raster CASCADE;
SELECT abacus_triangulate('field', 'SELECT 101 * i + j, i, j, (i * j) % 7 AS z FROM generate_series(0, 100) AS i, generate_series(0, 100) AS j');
SELECT abacus_triangulate('rock', 'SELECT 100 * i + 10 * j + k, i, j, k, i + j * k AS v FROM generate_series(0, 9) AS i, generate_series(0, 9) AS j, generate_series(0, 9) AS k', dimension => 3);
ANALYZE field, rock;
SQL

# By the called function; p is a place that the planner does not know.
my $window = 'ST_Expand(p, 3)';
my %calls = (
	_abacus_lower => "SELECT _abacus_lower('field', $window)",
	_abacus_upper => "SELECT _abacus_upper('field', $window)",
	_abacus_pixels => "SELECT _abacus_pixels('field', ST_MakeEmptyRaster(6, 5, ST_X(p), 20, 1, 1, 0.1, 0.1, 0), 'z', 'linear', 'null', NULL, NULL)",
	_abacus_part_within => "SELECT _abacus_part_within('field', $window, 'POLYGON((0 0, 50 0, 50 50, 0 0))')",
	abacus_raster => "SELECT abacus_raster('field', ST_MakeEmptyRaster(6, 5, ST_X(p), 20, 1, -1, 0, 0, 0))",
	abacus_visible => "SELECT abacus_visible('field', '{50,50}'::text, '{53,53}'::text)",
	abacus_cells_geom => "SELECT abacus_cells_geom('field', $window)",
	abacus_vertices => "SELECT abacus_vertices('field', 'z', ST_X(p) - 50, 6)",
	abacus_vertices_geom => "SELECT abacus_vertices_geom('field', $window)",
	abacus_edges_geom => "SELECT abacus_edges_geom('field', $window)",
	abacus_contours_geom => "SELECT abacus_contours_geom('field', 1, bounds => $window, polygonize => true)",
	abacus_profile_geom => "SELECT abacus_profile_geom('field', ST_MakeLine(p, ST_Translate(p, 3, 3)))",
	abacus_voronoi_geom => "SELECT abacus_voronoi_geom('field', $window)",
	abacus_voronoi_facets_geom => "SELECT abacus_voronoi_facets_geom('field', $window)",
	abacus_hull_geom => "SELECT abacus_hull_geom('field')",
	abacus_alpha_shape_geom => "SELECT abacus_alpha_shape_geom('field', 1)",
	abacus_isosurface_geom => "SELECT abacus_isosurface_geom('rock', 5.5)",
	abacus_section_geom => "SELECT abacus_section_geom('rock', ST_MakePoint(5, 5, 5), '{0,0,1}')",
	abacus_clip => "SELECT abacus_clip('field', $window)");

is_deeply(
	[ sort keys %calls ],
	[ split /\n/, $node->safe_psql('postgres', q{
		SELECT DISTINCT p.proname COLLATE "C"
		FROM pg_proc AS p JOIN pg_depend AS d ON d.classid = 'pg_proc'::regclass AND d.objid = p.oid AND d.deptype = 'e'
		JOIN pg_extension AS e ON e.oid = d.refobjid JOIN pg_language AS l ON l.oid = p.prolang
		WHERE d.refclassid = 'pg_extension'::regclass AND e.extname LIKE 'abacus%' AND l.lanname NOT IN ('c', 'internal')
		ORDER BY 1}) ],
	'all functions that are not in C');

sub logged
{
	my ($query, $settings) = @_;
	my ($status, undef, $log) = $node->psql('postgres', <<"SQL");
LOAD 'auto_explain';
SET auto_explain.log_min_duration = 0; SET auto_explain.log_nested_statements = on; SET auto_explain.log_analyze = on;
SET jit = on; $settings
SET client_min_messages = log;
$query
SQL
	is($status, 0, $query);
	return $log;
}

for my $name (sort keys %calls)
{
	my $query = "$calls{$name} FROM (SELECT ST_Point(50 + i, 50) AS p FROM generate_series(1, 2) AS i OFFSET 0) AS places;";
	my $log = logged($query, '');
	like($log, qr/cost=/, "$name: plans are shown");
	unlike($log, qr/^JIT:/m, "$name: nothing is compiled");
}
like(logged('SELECT sum(i * 2) FROM generate_series(1, 10) AS i;', 'SET jit_above_cost = 0;'), qr/^JIT:/m, 'which would be shown');

$node->stop;
done_testing();
