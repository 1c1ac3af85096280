# ALTER EXTENSION abacus UPDATE: from every version that was released. What it
# leads to is what CREATE EXTENSION makes, and meshes go on.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $node = PostgreSQL::Test::Cluster->new('update');
$node->init;
$node->append_conf('postgresql.conf', 'fsync = off');
$node->start;

# All that the extension is made of, as the catalogues have it.
sub catalogue
{
	my ($database) = @_;
	return $node->safe_psql($database, <<'SQL');
CREATE TEMP VIEW member AS
SELECT classid, objid, pg_describe_object(classid, objid, 0) AS name FROM pg_depend
WHERE deptype = 'e' AND refobjid = (SELECT oid FROM pg_extension WHERE extname = 'abacus');
SELECT m.name, obj_description(objid, classid::regclass::name) FROM member m ORDER BY 1;
SELECT m.name, pg_get_function_arguments(objid), pg_get_function_result(objid), prokind, proisstrict, provolatile,
	proparallel, procost, prorows, prosecdef, proleakproof, prosrc, probin, proacl, proconfig, prolang
FROM member m JOIN pg_proc p ON p.oid = objid AND classid = 'pg_proc'::regclass ORDER BY 1;
SELECT m.name, typlen, typbyval, typtype, typcategory, typalign, typstorage, typdelim, typacl,
	typinput, typoutput, typreceive, typsend, typelem::regtype, typbasetype::regtype
FROM member m JOIN pg_type t ON t.oid = objid AND classid = 'pg_type'::regclass ORDER BY 1;
SELECT m.name, attnum, attname, atttypid::regtype, attstorage, attnotnull, col_description(attrelid, attnum)
FROM member m JOIN pg_type t ON t.oid = objid AND classid = 'pg_type'::regclass
	JOIN pg_attribute a ON a.attrelid = t.typrelid WHERE attnum > 0 AND NOT attisdropped ORDER BY 1, 2;
SELECT m.name, relkind, relacl, pg_get_viewdef(c.oid), attnum, attname, atttypid::regtype, col_description(attrelid, attnum)
FROM member m JOIN pg_class c ON c.oid = objid AND classid = 'pg_class'::regclass
	JOIN pg_attribute a ON a.attrelid = c.oid WHERE attnum > 0 ORDER BY 1, attnum;
SELECT m.name, castcontext, castmethod FROM member m JOIN pg_cast c ON c.oid = objid AND classid = 'pg_cast'::regclass ORDER BY 1;
SELECT extversion FROM pg_extension WHERE extname = 'abacus';
SQL
}

$node->safe_psql('postgres', "CREATE DATABASE $_") for 'fresh', 'elsewhere';
$node->safe_psql('fresh', 'CREATE EXTENSION abacus');
my $fresh = catalogue('fresh');
my $version = $node->safe_psql('fresh', 'SELECT abacus_version()');
is($node->safe_psql('fresh', "SELECT extversion FROM pg_extension WHERE extname = 'abacus'"),
	$version, 'module and SQL objects have one version');
cmp_ok(length($fresh), '>', 5000, 'the catalogues are read');

my @released = split /\n/, $node->safe_psql('fresh',
	"SELECT version FROM pg_available_extension_versions WHERE name = 'abacus' AND NOT installed ORDER BY 1");
ok(scalar(grep { $_ eq '0.1.0' } @released), 'earlier versions: ' . join ', ', @released);
for my $old (@released)
{
	is( $node->safe_psql('fresh',
			"SELECT path FROM pg_extension_update_paths('abacus') WHERE source = '$old' AND target = '$version'"),
		"$old--$version", "$old: the way leads straight here");
	my $database = 'from_' . $old =~ tr/./_/r;
	$node->safe_psql('postgres', "CREATE DATABASE $database");
	$node->safe_psql($database, "CREATE EXTENSION abacus VERSION '$old'");
	isnt(catalogue($database), $fresh, "$old: differs");

	# a mesh, and a session that has it in its cache
	$node->safe_psql($database, <<'SQL');
SELECT abacus_triangulate('field', 'SELECT i, (i * 7919) % 1009, (i * 104729) % 997 FROM generate_series(1, 3000) AS i');
SELECT abacus_triangulate('solid', 'SELECT i, (i * 7919) % 101, (i * 104729) % 97, (i * 31) % 89 FROM generate_series(1, 1000) AS i', dimension => 3);
SQL
	my %before = map { $_ => mesh_content($node, $database, $_) } 'field', 'solid';
	my $session = $node->background_psql($database);
	my $locate = "SELECT v0, v1, v2 FROM abacus_locate('field', 500, 500)";
	my $located = $session->query($locate);
	$node->safe_psql($database, 'ALTER EXTENSION abacus UPDATE');
	is(catalogue($database), $fresh, "$old: after the update all is as new");
	is($session->query($locate), $located, "$old: a session that was there goes on");
	$session->quit;
	for my $mesh ('field', 'solid')
	{
		is(mesh_content($node, $database, $mesh), $before{$mesh}, "$old: $mesh is kept");
		$node->safe_psql($database, "SELECT abacus_stage('$mesh', 'SELECT id + 10000, y, x' || CASE WHEN '$mesh' = 'solid' THEN ', z' ELSE '' END || ' FROM abacus_vertices(''$mesh'') WHERE id < 500'), abacus_triangulate('$mesh')");
		is_sound($node, $database, $mesh, "$old: $mesh, changed");
	}
	$node->safe_psql($database, 'DROP TABLE field, solid; DROP EXTENSION abacus');
	is($node->safe_psql($database, "SELECT count(*) FROM pg_proc WHERE proname ~ '^abacus'"), 0, "$old: nothing is left behind");
}

# another schema, moved before and after
$node->safe_psql('elsewhere', <<"SQL");
CREATE SCHEMA a; CREATE SCHEMA b;
CREATE EXTENSION abacus SCHEMA a VERSION '$released[0]';
ALTER EXTENSION abacus SET SCHEMA b;
ALTER EXTENSION abacus UPDATE;
ALTER EXTENSION abacus SET SCHEMA public;
SQL
is(catalogue('elsewhere'), $fresh, 'updated in another schema, and moved');

$node->stop;
done_testing();
