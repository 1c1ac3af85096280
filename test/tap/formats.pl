# A mesh of each format, written by a version of its time (meshes/format-N.sql, octree-N.sql). This version gives the
# answers that the writer gave, finds it sound, changes it and takes the change back, and builds the same mesh from its
# points. A format that is not read is refused, with what to do. The files never change.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

# Format 1 is that of meshes/0.1.0.sql (update.pl).
my %unread = map { $_ => 1 } 2;
my $newest = 9;

my $node = PostgreSQL::Test::Cluster->new('formats');
$node->init;
$node->append_conf('postgresql.conf', 'fsync = off');
$node->start;

# The number in the header, whose first word is a name of 6 bytes and the number.
sub format_of
{
	my ($database, $mesh) = @_;
	return hex substr $node->safe_psql($database, "SELECT encode(substr(page::bytea, 7, 1), 'hex') FROM $mesh WHERE code = -1 AND part = 0"), 0, 2;
}

# A database with what a file has.
sub restored
{
	my ($file) = @_;
	(my $database = $file) =~ s/\W/_/g;
	$node->safe_psql('postgres', "CREATE DATABASE $database");
	$node->safe_psql($database, 'CREATE EXTENSION abacus; CREATE EXTENSION amcheck');
	$node->safe_psql($database, slurp_file("$FindBin::RealBin/meshes/$file.sql"));
	return $database;
}

# Tests: what the writer noted is answered now.
sub answers_as_written
{
	my ($database, $what) = @_;
	my $queries = $node->safe_psql($database, 'SELECT count(*) FROM written');
	cmp_ok($queries, '>', 0, "$what: there are notes");
	for my $n (0 .. $queries - 1)
	{
		my $query = $node->safe_psql($database, "SELECT query FROM written ORDER BY query LIMIT 1 OFFSET $n");
		is($node->safe_psql($database, $query), $node->safe_psql($database, "SELECT answer FROM written ORDER BY query LIMIT 1 OFFSET $n"), "$what: $query");
	}
	return;
}

for my $format (2 .. $newest)
{
	my $database = restored("format-$format");
	if ($unread{$format})
	{
		my ($status, $out, $err) = $node->psql($database, "\\set VERBOSITY verbose\nSELECT abacus_locate('plane', 1, 1)");
		like($err, qr/ERROR:  55000: mesh is stored in format $format, but this version of Abacus reads formats 3 to $newest\nHINT:  Read its points with the version that wrote it/,
			"format $format: refused");
		($status, $out, $err) = $node->psql($database, "SELECT abacus_insert('plane', 'SELECT 1, 2, 3, 4')");
		like($err, qr/stored in format $format/, "format $format: and not changed");
		next;
	}
	answers_as_written($database, "format $format");
	my $meshes = $node->safe_psql($database, 'SELECT mesh, dimension FROM meshes ORDER BY mesh');
	for my $row (split /\n/, $meshes)
	{
		my ($mesh, $dimension) = split /\|/, $row;
		my $what = "format $format, $mesh";
		is(format_of($database, $mesh), $format, "$what: has the format");
		is_intact($node, $database, $mesh, $what);

		# the points that wait are not in the other one
		$node->safe_psql($database, $node->safe_psql($database, "SELECT anew FROM meshes WHERE mesh = '$mesh'"));
		is(other_simplices($node, $database, $mesh, 'anew', $dimension), 0, "$what: this version builds the same mesh");
		$node->safe_psql($database, 'DROP TABLE anew');

		if (!mesh_figure($node, $database, $mesh, 'changeable'))
		{
			my ($status, $out, $err) = $node->psql($database, "SELECT abacus_insert('$mesh', 'SELECT 1000, 0.5, 0.25, 0')");
			like($err, qr/^psql:<stdin>:\d+: ERROR:  /, "$what: read only");
			next;
		}
		# what waits is inserted first
		$node->safe_psql($database, "SELECT abacus_triangulate('$mesh')");
		is_sound($node, $database, $mesh, "$what: with what waited");
		my $before = mesh_content($node, $database, $mesh);
		my $query = $node->safe_psql($database, "SELECT 'SELECT 1000 + i, 0.375 * i, 0.28125 * i' || CASE $dimension WHEN 3 THEN ', 1.5 * i' ELSE '' END || repeat(', i / 2.0', (SELECT count(*)::int FROM abacus_attributes('$mesh'))) || ' FROM generate_series(1, 30) AS i'");
		is($node->safe_psql($database, "SELECT abacus_insert('$mesh', '$query')"), 30, "$what: points are inserted");
		is_intact($node, $database, $mesh, "$what: changed");
		is($node->safe_psql($database, "SELECT abacus_delete('$mesh', '$query')"), 30, "$what: and deleted");
		is_intact($node, $database, $mesh, "$what: changed back");
		# labels and markers of the triangles that were gone are not
		is(mesh_content($node, $database, $mesh), $before, "$what: points and triangles are as before");
	}
}

for my $format (1)
{
	my $database = restored("octree-$format");
	answers_as_written($database, "octrees of format $format");
	for my $octree (split /\n/, $node->safe_psql($database, "SELECT relname FROM pg_class WHERE reloftype = 'abacus_simplex_page'::regtype ORDER BY 1"))
	{
		my $what = "format $format, $octree";
		is(format_of($database, $octree), $format, "$what: has the format");
		is_sound($node, $database, $octree, $what);
		my $coordinates = $octree eq 'oct' ? '1.5, 2.5, 3.5' : '1.5, 2.5';
		my $leaves = "SELECT count(*) FROM abacus_octants('$octree')";
		my $before = $node->safe_psql($database, $leaves);
		$node->safe_psql($database, "SELECT abacus_octree_refine('$octree', 'SELECT 8, $coordinates')");
		cmp_ok($node->safe_psql($database, $leaves), '>', $before, "$what: refined");
		is_sound($node, $database, $octree, "$what: refined");
	}
}

# no file is left out
opendir(my $folder, "$FindBin::RealBin/meshes") or die;
my $tested = join ' ', sort +(map { "format-$_.sql" } 2 .. $newest), 'octree-1.sql';
is(join(' ', sort grep { /^(format|octree)-/ } readdir $folder), $tested, 'all files are tested');
closedir $folder;
# nor a format: that after the newest is refused
my ($status, $out, $err) = $node->psql("format_$newest", sprintf <<'SQL', $newest + 1);
UPDATE plane SET page = set_byte(page::bytea, 6, %d)::abacus_page WHERE code = -1 AND part = 0;
SELECT abacus_locate('plane', 1, 1);
SQL
like($err, qr/mesh is stored in format ${\($newest + 1)}, but this version of Abacus reads formats 3 to $newest\n/, 'a later format is refused');

$node->stop;
done_testing();
