# pg_dump and pg_restore: whole databases and single tables, every format, into other databases and schemas;
# then the restored mesh is changed like the original.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $node = PostgreSQL::Test::Cluster->new('dump');
$node->init;
$node->append_conf('postgresql.conf', 'fsync = off');
$node->start;
my $folder = $node->basedir;

# The origin: two meshes, in two schemas, one with a name that needs quotes;
# attributes, repeated points, and points that wait. The extension has a schema
# of its own.
my @meshes = ('public.field', 's."My Mesh"');
my %dimension = ($meshes[0] => 2, $meshes[1] => 3);
my %more = (
	$meshes[0] => 'SELECT 50000 + i, sin(i), cos(i), NULL::float8 FROM generate_series(1, 1000) AS i',
	$meshes[1] => 'SELECT 50000 + i, sin(i), cos(i), cos(i * i) FROM generate_series(1, 1000) AS i');
$node->safe_psql('postgres', $_) for 'CREATE DATABASE origin', 'CREATE ROLE owner LOGIN';
$node->safe_psql('origin', <<'SQL');
CREATE SCHEMA abacus;
CREATE EXTENSION abacus SCHEMA abacus;
ALTER DATABASE origin SET search_path = public, abacus;
CREATE SCHEMA s AUTHORIZATION owner;
SET search_path = public, abacus;
SELECT abacus_triangulate('field', 'SELECT i, (i * 7919) % 1009 / 1e3, (i * 104729) % 997 / 1e3, i AS height FROM generate_series(1, 6000) AS i UNION ALL SELECT -i, i * 7919 / 1e3, i * 104729 / 1e3, NULL FROM generate_series(1, 9) AS i UNION ALL SELECT -i - 100, i * 7919 / 1e3, i * 104729 / 1e3, 1 FROM generate_series(1, 9) AS i');
SELECT abacus_stage('field', 'SELECT 7000 + i, i, i * i, 3 FROM generate_series(1, 40) AS i');
SELECT abacus_publish('field', geometry => false);
CREATE SCHEMA before;
SELECT abacus_triangulate('before.named', 'VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)');
SELECT abacus_publish('before.named', geometry => false);
ALTER TABLE before.named RENAME TO renamed;
ALTER SCHEMA before RENAME TO after;
SELECT abacus_octree_create('soil', 3, '{0,0,0}', '{8,4,2}', '{v}');
SELECT abacus_octree_from_points('soil', 'SELECT i, sin(i) + 1, cos(i) + 1, i / 3e3 FROM generate_series(1, 3000) AS i', 5);
SELECT abacus_octree_update('soil', 'SELECT code, lower[1] FROM abacus_octants(''soil'')');
SELECT abacus_triangulate('fenced', 'SELECT 10 * x + y, x, y FROM generate_series(0, 9) AS x, generate_series(0, 9) AS y WHERE (x, y) <> (5, 5)');
SELECT abacus_constrain('fenced', 'VALUES (7, 1, 0), (7, 2, 99), (7, 3, 90)', kind => 'soft');
SELECT abacus_constrain('fenced', 'VALUES (8, 1, 1), (8, 2, 4), (8, 3, 24), (8, 4, 1)');
SELECT abacus_region('fenced', $$VALUES ('corner', 8)$$);
SELECT abacus_publish('fenced', geometry => false);
SELECT abacus_thin('field', 'thinned', 900, keep => 'border');
SELECT abacus_triangulate('tiered', 'SELECT 100 * x + y, x, y, 10 * sin(x / 5.0) * cos(y / 7.0) AS height FROM generate_series(0, 30) AS x, generate_series(0, 30) AS y');
SELECT abacus_levels('tiered', '{0.5,2}');
ALTER TABLE tiered_level_2 RENAME TO coarse;
ALTER TABLE tiered_level_2_vertices RENAME TO coarse_vertices;
ALTER TABLE tiered_level_2_thinning RENAME TO coarse_thinning;
SELECT abacus_publish('tiered', geometry => false);
GRANT USAGE ON SCHEMA abacus TO owner;
SET ROLE owner;
SELECT abacus_triangulate('s."My Mesh"', 'SELECT i, (i * 7919) % 101, (i * 104729) % 97, (i * 31) % 89 FROM generate_series(1, 3000) AS i', dimension => 3);
SELECT abacus_publish('s."My Mesh"', geometry => false);
SELECT abacus_set_srid('s."My Mesh"', 2154);
SELECT abacus_label('s."My Mesh"', 'SELECT code, v0, v1, v2, v3, v0 % 5 AS material, v1 AS n FROM abacus_simplices(''s."My Mesh"'') WHERE v2 % 7 > 0');
SELECT abacus_mark('s."My Mesh"', 'SELECT code, v0, v1, v2, v3, 1, v0 % 9 FROM abacus_simplices(''s."My Mesh"'') WHERE v2 % 3 = 0');
SELECT abacus_triangulate('s.levels', 'SELECT i, i % 7, i / 7, 1 AS f, 4 AS g, 100 AS h FROM generate_series(0, 27) AS i');
SELECT abacus_drop_attribute('s.levels', 'f');
RESET ROLE;
SELECT abacus_publish('s.levels', schema => 'public', geometry => false);
SQL
my (%content, %labels, %bytes, %grown);
for my $mesh (@meshes)
{
	my $vertices = $mesh =~ s/("?)$/_vertices$1/r;
	$content{$mesh} = mesh_content($node, 'origin', $mesh);
	$labels{$mesh} = mesh_labels($node, 'origin', $mesh);
	$bytes{$mesh} = mesh_bytes($node, 'origin', $mesh) . mesh_bytes($node, 'origin', $vertices);
}

sub leaves { return $node->safe_psql($_[0], q{SELECT md5(string_agg(o::text, ',' ORDER BY code)) FROM abacus_octants('soil') AS o}); }
my $leaves = leaves('origin');

# Names of many attributes are in rows beside the header, and points that wait take rows of their own.
my $values = join(', ', map { "i / $_.0::float8 AS a$_" } 1 .. 1000);
$node->safe_psql('origin', "SELECT abacus_triangulate('many', 'SELECT i, i % 7, i / 7, $values FROM generate_series(1, 40) AS i'); SELECT abacus_stage('many', 'SELECT i, i, i, $values FROM generate_series(50, 55) AS i')");
sub many { return $node->safe_psql($_[0], q{SELECT count(*), md5(string_agg(v::text, ',' ORDER BY id)), (SELECT md5(string_agg(name, ',' ORDER BY position)) FROM abacus_attributes('many')) FROM abacus_vertices('many') AS v}); }
my $many = many('origin');
like($many, qr/^46\|/, 'a mesh with 1,000 attributes');

# The lines of a mesh, and the edges on them.
sub lines_of_mesh { return $node->safe_psql($_[0], q{SELECT * FROM abacus_lines('fenced'); SELECT v0, v1, lines, kind FROM abacus_edges('fenced', fixed => true)}); }
sub views_of_lines { return $node->safe_psql($_[0], q{SELECT * FROM fenced_breaklines; SELECT v0, v1, lines, kind FROM fenced_fixed_edges}); }
sub regions_of_mesh { return $node->safe_psql($_[0], q{SELECT * FROM abacus_regions('fenced'); SELECT * FROM abacus_simplices('fenced', 'corner')}); }
my $regions = regions_of_mesh('origin');
like($regions, qr/^corner\|1\|\d+\|3\|/, 'with a region');
my $lines = lines_of_mesh('origin');
like($lines, qr/^7\|1\|0\|0\|0\|soft\|\n7\|2\|99\|9\|9\|soft\|\n/, 'a mesh with lines');

# How a mesh was thinned.
sub thinning_of_mesh { return $node->safe_psql($_[0], q{SELECT * FROM thinned_thinning; SELECT count(*), sum(id) FROM abacus_vertices('thinned')}); }
my $thinning = thinning_of_mesh('origin');
like($thinning, qr/^public\.field\|-?\d+\|height\|900\|border\|\|[\d.]+\|\n/, 'a thinned mesh');

# The levels of a mesh, and what is in them.
sub levels_of_mesh
{
	return $node->safe_psql($_[0], q{SELECT level, max_error, greatest FROM tiered_levels ORDER BY level; SELECT value FROM abacus_stats('tiered') WHERE name = 'levels_old';
		SELECT string_agg(v::text, ' ' ORDER BY id) FROM abacus_vertices('tiered_level_1') AS v; SELECT string_agg(v::text, ' ' ORDER BY id) FROM abacus_vertices(abacus_level('tiered', 2)) AS v;
		SELECT count(*) FROM tiered_cells_2});
}
my $levels = levels_of_mesh('origin');
like($levels, qr/^1\|0\.5\|0\.\d+\n2\|2\|1\.\d+\n0\n/, 'a mesh with levels');

sub change_levels
{
	my ($database) = @_;
	$node->safe_psql($database, q{SELECT abacus_insert('tiered', 'VALUES (-1, 15.5, 15.5, 30)')});
	is($node->safe_psql($database, q{SELECT value FROM abacus_stats('tiered') WHERE name = 'levels_old'}), 2, 'levels are older than a changed mesh');
	$node->safe_psql($database, q{SELECT abacus_levels_refresh('tiered')});
	return levels_of_mesh($database);
}

sub vertex_table { return $_[0] =~ s/("?)$/_vertices$1/r; }

# The foreign table of its cells, or of its points.
sub shown_table { my ($mesh, $what) = @_; return $mesh =~ s/("?)$/_$what$1/r; }

sub grow
{
	my ($database, $mesh) = @_;
	$node->safe_psql($database,
		"SELECT abacus_stage('$mesh', '$more{$mesh}'), abacus_triangulate('$mesh')");
	return mesh_content($node, $database, $mesh) . mesh_labels($node, $database, $mesh);
}

# Whether dropping the mesh drops its vertex table.
sub is_bound
{
	my ($database, $mesh) = @_;
	my $vertices = vertex_table($mesh);
	return $node->safe_psql($database,
		"SELECT count(*) FROM pg_depend WHERE objid = '$vertices'::regclass AND refobjid = '$mesh'::regclass");
}

sub fresh_database
{
	my ($name) = @_;
	$node->safe_psql('postgres', "CREATE DATABASE $name");
	$node->safe_psql('postgres', "ALTER DATABASE $name SET search_path = public, abacus");
	return;
}

# Checks after a restore; then the mesh changes as the original does later.
sub examine
{
	my ($database, $what) = @_;
	for my $mesh (@meshes)
	{
		my $vertices = vertex_table($mesh);
		is(mesh_content($node, $database, $mesh), $content{$mesh}, "$what: $mesh");
		is(mesh_labels($node, $database, $mesh), $labels{$mesh}, "$what: its labels and markers");
		is(mesh_bytes($node, $database, $mesh) . mesh_bytes($node, $database, $vertices),
			$bytes{$mesh}, "$what: its pages, byte by byte");
		is_sound($node, $database, $mesh, "$what: $mesh");
		is($node->safe_psql($database, "SELECT count(*) FROM " . shown_table($mesh, 'cells')),
			$node->safe_psql($database, "SELECT count(*) FROM abacus_simplices('$mesh')"), "$what: its cells as a table");
		my ($status, $out, $err) = $node->psql($database, "DROP TABLE $mesh");
		like($err, qr/constraint mesh on foreign table .* depends on table/, "$what: no table loses its mesh");
	}
	is($node->safe_psql($database, 'SELECT count(*) FROM after.named_points'), 3, "$what: points of a mesh that was renamed");
	is($node->safe_psql($database, "SELECT abacus_srid('$meshes[0]'), abacus_srid('$meshes[1]')"), '0|2154',
		"$what: the spatial reference systems");
	is($node->safe_psql($database, 'SELECT DISTINCT g, h FROM levels_points'), '4|100', "$what: attributes as a table");
	$node->safe_psql($database, q{SET client_min_messages = warning; SET ROLE owner; SELECT abacus_drop_attribute('s.levels', 'g')});
	is($node->safe_psql($database, 'SELECT DISTINCT h FROM levels_points'), 100, "$what: one of them when another is dropped");
	like(($node->psql($database, 'SELECT g FROM levels_points'))[2], qr/column "g" of foreign table "levels_points" shows an attribute/,
		"$what: which the table of another user says");
	is_sound($node, $database, 's.levels', "$what: a mesh that has lost attributes");
	is(leaves($database), $leaves, "$what: an octree");
	is($node->safe_psql($database, q{SELECT count(*) FROM abacus_check('soil')}), 0, "$what: which is sound");
	$node->safe_psql($database, q{SELECT abacus_octree_balance('soil')});
	is(many($database), $many, "$what: a mesh with 1,000 attributes");
	is_sound($node, $database, 'many', "$what: a mesh with 1,000 attributes");
	is(lines_of_mesh($database), $lines, "$what: a mesh with lines");
	is(views_of_lines($database), $lines, "$what: and as views");
	is(regions_of_mesh($database), $regions, "$what: its region");
	is_sound($node, $database, 'fenced', "$what: a mesh with lines");
	is(thinning_of_mesh($database), $thinning, "$what: a thinned mesh");
	$node->safe_psql($database, q{SELECT abacus_insert('thinned', 'VALUES (-1, 0.5, 0.5, 1)')});
	is($node->safe_psql($database, q{DROP TABLE thinned; SELECT to_regclass('thinned_thinning')}), '', "$what: which binds the table of its thinning");
	is($node->safe_psql($database, q{SELECT abacus_insert('fenced', 'VALUES (100, 5, 5)')}), 1, "$what: it grows");
	is($node->safe_psql($database, "SELECT count(*) FROM pg_depend WHERE objid = 'fenced_lines'::regclass AND refobjid = 'fenced'::regclass"), 1, "$what: which binds the table of lines");
	is($node->safe_psql($database, "SELECT count(*) FROM pg_depend WHERE objid = 'fenced_regions'::regclass AND refobjid = 'fenced'::regclass"), 1, "$what: and that of regions");
	is($node->safe_psql($database, q{SELECT abacus_unconstrain('fenced', 'VALUES (7)')}), 1, "$what: the line goes");
	is($node->safe_psql($database, q{DROP TABLE fenced; SELECT concat(to_regclass('fenced_lines'), to_regclass('fenced_regions'), to_regclass('fenced_breaklines'), to_regclass('fenced_fixed_edges'))}), '',
		"$what: dropping the mesh drops its lines and their views");
	is(levels_of_mesh($database), $levels, "$what: a mesh with levels");
	is(change_levels($database), $grown{levels}, "$what: made anew as in the origin");
	is($node->safe_psql($database, q{DROP TABLE tiered; SELECT count(*) FROM pg_class WHERE relname ~ '^(tiered|coarse)'}), 0,
		"$what: dropping the mesh drops its levels, and what was published of them");
	for my $mesh (@meshes)
	{
		is(grow($database, $mesh), $grown{$mesh}, "$what: $mesh grows as the origin does");
		is_sound($node, $database, $mesh, "$what: $mesh grown");
		is(is_bound($database, $mesh), 1, "$what: which binds its tables");
		$node->safe_psql($database, "DROP TABLE $mesh");
		is($node->safe_psql($database, "SELECT to_regclass('" . vertex_table($mesh) . "')"),
			'', "$what: dropping $mesh drops both");
		is($node->safe_psql($database, "SELECT to_regclass('" . shown_table($mesh, $_) . "')"),
			'', "$what: and the table of its $_") for 'cells', 'points';
	}
	return;
}

my $origin = $node->connstr('origin');
$node->command_ok([ 'pg_dump', '-d', $origin, '-f', "$folder/plain.sql" ], 'dump as text');
$node->command_ok([ 'pg_dump', '-d', $origin, '-Fc', '-f', "$folder/custom" ], 'custom format');
$node->command_ok([ 'pg_dump', '-d', $origin, '-Fd', '-j', '2', '-f', "$folder/directory" ], 'in parallel');
$node->command_ok([ 'pg_dump', '-d', $origin, '--schema-only', '-f', "$folder/schema.sql" ], 'schema only');
$node->command_ok([ 'pg_dump', '-d', $origin, '-Fc', '--data-only', '-f', "$folder/data" ], 'data only');
$node->command_ok([ 'pg_dump', '-d', $origin, '-Fc', '-t', 'field', '-f', "$folder/one" ], 'one table');
$node->command_ok([ 'pg_dump', '-d', $origin, '-Fc', '-t', 'field_vertices', '-f', "$folder/other" ], 'the other');

# single tables: the mesh alone answers; with the other table, everything is there
fresh_database('single');
$node->safe_psql('single', 'CREATE SCHEMA abacus; CREATE EXTENSION abacus SCHEMA abacus');
$node->command_ok([ 'pg_restore', '-d', $node->connstr('single'), "$folder/one" ], 'single table restored');
is($node->safe_psql('single', "SELECT count(*) FROM abacus_simplices('field')"),
	mesh_figure($node, 'origin', 'field', 'simplices'), 'single table: simplices');
is($node->safe_psql('single', "SELECT (abacus_locate('field', 0.5, 0.5)).v0 IS NOT NULL"),
	't', 'single table: located');
my ($status, $out, $err) = $node->psql('single', "SELECT count(*) FROM abacus_vertices('field')");
like($err, qr/mesh "field" has no vertex table/, 'single table: what is missing is said');
$node->command_ok([ 'pg_restore', '-d', $node->connstr('single'), "$folder/other" ], 'the other restored');
is(mesh_content($node, 'single', 'field'), $content{'public.field'}, 'both: complete');
# before any change: two tables that only their names connect
is(is_bound('single', 'public.field'), 0, 'both: not bound yet');
$node->safe_psql('single', <<'SQL');
CREATE SCHEMA elsewhere;
ALTER TABLE field SET SCHEMA elsewhere;
ALTER TABLE field_vertices SET SCHEMA elsewhere;
SQL
is(mesh_content($node, 'single', 'elsewhere.field'), $content{'public.field'}, 'moved: complete');
$node->safe_psql('single', "CALL abacus_build('elsewhere.field', 1000)");
is(is_bound('single', 'elsewhere.field'), 1, 'moved, and changed: bound');
$node->safe_psql('single', 'ALTER TABLE elsewhere.field_vertices RENAME TO any_name');
is_sound($node, 'single', 'elsewhere.field', 'moved, changed, renamed');
$node->safe_psql('single', 'DROP TABLE elsewhere.field');
is($node->safe_psql('single', "SELECT to_regclass('elsewhere.any_name')"), '', 'dropping drops both');

# if the mesh is dropped before any change, the vertex table stays, and says what it is
$node->command_ok([ 'pg_restore', '-d', $node->connstr('single'), "$folder/one" ], 'single table again');
$node->command_ok([ 'pg_restore', '-d', $node->connstr('single'), "$folder/other" ], 'the other again');
$node->safe_psql('single', 'DROP TABLE field');
is($node->safe_psql('single', "SELECT reloftype::regtype FROM pg_class WHERE relname = 'field_vertices'"),
	'abacus_vertex_page', 'dropped before any change: the vertex table is left');

# COPY of both tables to files and back, as text and binary
fresh_database('copied');
$node->safe_psql('copied', 'CREATE SCHEMA abacus; CREATE EXTENSION abacus SCHEMA abacus');
$node->safe_psql('copied', "SELECT abacus_create('field', 2); TRUNCATE field");
$node->safe_psql('origin', "COPY field TO '$folder/field.text'; COPY field_vertices TO '$folder/vertices.binary' (FORMAT binary)");
$node->safe_psql('copied', "COPY field FROM '$folder/field.text'; COPY field_vertices FROM '$folder/vertices.binary' (FORMAT binary)");
is(mesh_content($node, 'copied', 'field'), $content{'public.field'}, 'COPY out and in');
is_sound($node, 'copied', 'field', 'COPY out and in');

like($labels{$meshes[1]}, qr/^labels [1-9]\d{3,} .*\nmarkers [1-9]\d{3,} /, 'there are labels and markers');

# everything else is compared with the later original
$grown{$_} = grow('origin', $_) for @meshes;
$grown{levels} = change_levels('origin');

fresh_database('plain');
$node->command_ok([ 'psql', '-Xq', '-v', 'ON_ERROR_STOP=1', '-d', $node->connstr('plain'), '-f', "$folder/plain.sql", '-o', '/dev/null' ], 'text restored');
examine('plain', 'text');
fresh_database('custom');
$node->command_ok([ 'pg_restore', '-e', '-1', '-d', $node->connstr('custom'), "$folder/custom" ], 'custom format restored');
# over existing objects
$node->command_ok([ 'pg_restore', '-e', '--clean', '-d', $node->connstr('custom'), "$folder/custom" ], '... and once more, dropping what is there');
examine('custom', 'custom format');
fresh_database('directory');
$node->command_ok([ 'pg_restore', '-e', '-j', '3', '-d', $node->connstr('directory'), "$folder/directory" ], 'restored in parallel');
examine('directory', 'in parallel');
fresh_database('data');
$node->command_ok([ 'psql', '-Xq', '-v', 'ON_ERROR_STOP=1', '-d', $node->connstr('data'), '-f', "$folder/schema.sql", '-o', '/dev/null' ], 'schema restored');
$node->command_ok([ 'pg_restore', '-e', '-j', '2', '-d', $node->connstr('data'), "$folder/data" ], 'data restored');
examine('data', 'schema, then data');

# names of attributes are in the pages, which are not converted: there and back between encodings
sub attribute_works
{
	my ($database) = @_;
	is($node->safe_psql($database, q{SELECT substr(abacus_draw('heights', attribute => U&'h\00f6he'), 2, 3) = 'PNG'}), 't', "an attribute is found by its name, $database");
	my ($status, $out, $err) = $node->psql($database, q{SELECT abacus_draw('heights', attribute => 'none')});
	return like($err, qr/Its attributes are "h\xc3\xb6he"\./, '... and shown by it');
}
$ENV{PGCLIENTENCODING} = 'UTF8';
$node->safe_psql('postgres', "CREATE DATABASE in_$_ TEMPLATE template0 ENCODING $_ LOCALE 'C'") for qw(utf8 latin1 sql_ascii);
$node->safe_psql('in_latin1', <<'SQL');
CREATE EXTENSION abacus;
CREATE TABLE peaks AS SELECT i AS id, i % 10 AS x, i / 10 AS y, i AS hoehe FROM generate_series(0, 99) AS i;
SELECT abacus_create('heights', 2, ARRAY[U&'h\00f6he']);
SELECT abacus_track('heights', 'peaks', '{id,x,y,hoehe}');
SQL
attribute_works('in_latin1');
$node->safe_psql('in_latin1', q{DELETE FROM peaks WHERE id < 10});
attribute_works('in_latin1');
($status, $out, $err) = $node->psql('in_latin1', q{SELECT abacus_create('long', 2, ARRAY[repeat(U&'\00f6', 32)])});
like($err, qr/of an attribute or a label is too long/, 'a name that is too long in UTF-8');
is($node->safe_psql('in_latin1', q{SELECT abacus_create('fits', 2, ARRAY[repeat(U&'\00f6', 31)])}), 'fits', 'one that is not');
is($node->safe_psql('in_latin1', q{SELECT abacus_create('many', 2, (SELECT array_agg(U&'\00f6' || i) FROM generate_series(1, 300) i))}), 'many', '300 of them');
$node->command_ok([ 'pg_dump', '-Fc', '-d', $node->connstr('in_latin1'), '-f', "$folder/latin1" ], 'dumped in LATIN1');
$node->command_ok([ 'pg_restore', '-e', '-d', $node->connstr('in_utf8'), "$folder/latin1" ], 'restored in UTF8');
attribute_works('in_utf8');
is($node->safe_psql('in_utf8', q{SELECT count(*) FROM abacus_check('heights')}), 0, 'sound there');
is($node->safe_psql('in_utf8', q{SELECT count(*) FROM abacus_attributes('many') WHERE name = U&'\00f6' || position}), 300, 'and so are 300 names');

# characters that the encoding of a database lacks: read there as escapes, but still stored
sub characters_of
{
	my ($database) = @_;
	return $node->safe_psql($database, q{SELECT string_agg(name, '|' ORDER BY position) FROM abacus_attributes('kinds')});
}
sub labels_of { return $node->safe_psql($_[0], q{SELECT array_to_string(abacus_labels('kinds'), '|')}); }
my $kinds = "h\xc3\xb6he|\xe9\xab\x98\xe3\x81\x95|\xf0\x9f\x9c\x81x|" . "\xe9\xab\x98" x 20;
my $escaped = "h\xc3\xb6he|\\9AD8\\3055|\\+01F701x|" . '\9AD8' x 12 . '~4';
sub copy_kinds
{
	my ($from, $to) = @_;
	foreach my $table ('kinds', 'kinds_vertices')
	{
		$node->command_ok([ 'psql', '-Xq', '-d', $node->connstr($from), '-c', "COPY $table TO '$folder/$table'" ], "$table out of $from");
		$node->safe_psql($to, "DROP TABLE IF EXISTS $table; CREATE TABLE $table OF abacus_" . ($table eq 'kinds' ? 'simplex_page (page WITH OPTIONS NOT NULL, PRIMARY KEY (code, part))' : 'vertex_page (page WITH OPTIONS NOT NULL, PRIMARY KEY (first, part))'));
		$node->command_ok([ 'psql', '-Xq', '-d', $node->connstr($to), '-c', "COPY $table FROM '$folder/$table'" ], "$table into $to");
	}
	return;
}
$node->safe_psql('in_utf8', q{SELECT abacus_create('kinds', 2, ARRAY[U&'h\00f6he', U&'\9AD8\3055', U&'\+01F701x', repeat(U&'\9AD8', 20)])});
$node->safe_psql('in_utf8', q{SELECT abacus_insert('kinds', 'VALUES (1, 0, 0, 1, 1, 1, 1), (2, 1, 0, 2, 2, 2, 2), (3, 0, 1, 3, 3, 3, 3)')});
$node->safe_psql('in_utf8', q{SELECT abacus_label('kinds', U&'SELECT code, v0, v1, v2, 1 AS "b\00f6den", 2 AS "\9AD8" FROM abacus_simplices(''kinds'')')});
is(characters_of('in_utf8'), $kinds, 'names of many characters');
is(labels_of('in_utf8'), "b\xc3\xb6den|\xe9\xab\x98", '... of labels, too');
copy_kinds('in_utf8', 'in_latin1');
is(characters_of('in_latin1'), $escaped, '... escaped where the encoding lacks them');
is(labels_of('in_latin1'), "b\xc3\xb6den|\\9AD8", '... of labels, too');
is($node->safe_psql('in_latin1', q{SELECT count(*) FROM abacus_check('kinds')}), 0, '... in a mesh that is sound');
is($node->safe_psql('in_latin1', q{SELECT substr(abacus_draw('kinds', attribute => '\9AD8\3055'), 2, 3) = 'PNG'}), 't', '... and that knows them so');
is($node->safe_psql('in_latin1', q{SELECT abacus_insert('kinds', 'VALUES (4, 1, 1, 4, 4, 4, 4)')}), 1, '... and is changed');
copy_kinds('in_latin1', 'in_utf8');
is(characters_of('in_utf8'), $kinds, '... which keeps what was stored');
$node->safe_psql('in_latin1', q{SELECT abacus_rename_attribute('kinds', '\9AD8\3055', U&'H\00f6he')});
like(characters_of('in_latin1'), qr/^h\xc3\xb6he\|H\xc3\xb6he\|\\\+01F701x\|/, 'another name');
copy_kinds('in_latin1', 'in_utf8');
like(characters_of('in_utf8'), qr/^h\xc3\xb6he\|H\xc3\xb6he\|\xf0\x9f\x9c\x81x\|/, '... and the others as they were');
is(labels_of('in_utf8'), "b\xc3\xb6den|\xe9\xab\x98", '... those of labels, too');
$node->safe_psql('in_latin1', q{SELECT abacus_add_attribute('kinds', U&'gr\00f6sse'), abacus_drop_attribute('kinds', U&'h\00f6he')});
is(characters_of('in_latin1'), "H\xc3\xb6he|\\+01F701x|" . '\9AD8' x 12 . "~3|gr\xc3\xb6sse", 'one more, and one less');
copy_kinds('in_latin1', 'in_utf8');
is(characters_of('in_utf8'), "H\xc3\xb6he|\xf0\x9f\x9c\x81x|" . "\xe9\xab\x98" x 20 . "|gr\xc3\xb6sse", '... and the others as they were');
is(labels_of('in_utf8'), "b\xc3\xb6den|\xe9\xab\x98", '... those of labels, too');

# bytes that are not valid text are not a valid name, except where that cannot be known
$node->safe_psql('in_utf8', q{UPDATE heights SET page = replace(page::text, 'c3b6', '66f6')::abacus_page WHERE code = -1});
($status, $out, $err) = $node->psql('in_utf8', q{SELECT abacus_locate('heights', 1, 1)});
like($err, qr/mesh is corrupted.*The name of attribute 1 is not valid in UTF-8/s, 'bytes that are no text');
is($node->safe_psql('in_utf8', q{SELECT fault, message FROM abacus_check('heights')}), 'header|The name of attribute 1 is not valid in UTF-8.', '... and their fault');
$node->safe_psql('in_sql_ascii', q{CREATE EXTENSION abacus; SELECT abacus_create('heights', 2, ARRAY[E'h\xf6he'])});
is($node->safe_psql('in_sql_ascii', q{SELECT abacus_insert('heights', 'VALUES (1, 0, 0, 1), (2, 1, 0, 2), (3, 0, 1, 3)')}), 3, 'any bytes in SQL_ASCII');
is($node->safe_psql('in_sql_ascii', q{SELECT substr(abacus_draw('heights', attribute => E'h\xf6he'), 2, 3) = 'PNG'}), 't', '... name an attribute');

$node->stop;
done_testing();
