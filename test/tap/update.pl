# ALTER EXTENSION UPDATE of abacus and the extensions that go with it (those for PostGIS only if it is installed), from
# every released version. The result must be what CREATE EXTENSION makes. A mesh made by that version (meshes/<version>.sql, from pg_dump) still works, or a message
# says that it cannot. Objects that have moved from abacus to abacus_lab keep working where they are used.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

# Versions whose meshes can no longer be read. All others must still work.
my %unread = map { $_ => 1 } '0.1.0';
# Versions in which abacus_quake belonged to abacus.
my %without_lab = map { $_ => 1 } '0.1.0';

my $node = PostgreSQL::Test::Cluster->new('update');
$node->init;
$node->append_conf('postgresql.conf', 'fsync = off');
$node->start;

# All objects of an extension, from the catalogues.
sub catalogue
{
	my ($database, $extension) = @_;
	return $node->safe_psql($database, <<"SQL");
CREATE TEMP VIEW member AS
SELECT classid, objid, pg_describe_object(classid, objid, 0) AS name FROM pg_depend
WHERE deptype = 'e' AND refobjid = (SELECT oid FROM pg_extension WHERE extname = '$extension');
SELECT m.name, obj_description(objid, classid::regclass::name) FROM member m ORDER BY 1;
SELECT m.name, pg_get_function_arguments(objid), pg_get_function_result(objid), prokind, proisstrict, provolatile,
	proparallel, procost, prorows, prosupport, prosecdef, proleakproof, prosrc, probin, proacl, proconfig, prolang
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
SELECT extversion, extrelocatable FROM pg_extension WHERE extname = '$extension';
SQL
}

# The released versions; from each there must be a direct update.
sub released
{
	my ($extension, $version) = @_;
	my @released = split /\n/, $node->safe_psql('fresh',
		"SELECT version FROM pg_available_extension_versions WHERE name = '$extension' AND NOT installed ORDER BY 1");
	is( $node->safe_psql('fresh',
			"SELECT path FROM pg_extension_update_paths('$extension') WHERE source = '$_' AND target = '$version'"),
		"$_--$version", "$extension $_: the way leads straight here")
	  for @released;
	return @released;
}

$node->safe_psql('postgres', "CREATE DATABASE $_") for 'fresh', 'elsewhere';
# those that go with it, and what they need
my @others = ('abacus_lab');
push @others, 'abacus_postgis', 'abacus_postgis_raster'
  if $node->safe_psql('postgres', "SELECT count(*) FROM pg_available_extensions WHERE name IN ('postgis', 'postgis_raster')") == 2;
my $needed = @others > 1 ? 'CREATE EXTENSION postgis; CREATE EXTENSION postgis_raster;' : '';
$node->safe_psql('fresh', join ';', $needed, map { "CREATE EXTENSION $_" } 'abacus', @others);
my %fresh = map { $_ => catalogue('fresh', $_) } 'abacus', @others;
my $version = $node->safe_psql('fresh', 'SELECT abacus_version()');
is($node->safe_psql('fresh', "SELECT string_agg(extversion, ' ') FROM pg_extension WHERE extname ~ '^abacus'"),
	join(' ', ($version) x (1 + @others)), 'module and SQL objects have one version');
cmp_ok(length($fresh{abacus}), '>', 5000, 'the catalogues are read');
cmp_ok(length($fresh{$_}), '>', 500, "those of $_, too") for @others;

my @released = released('abacus', $version);
ok(scalar(grep { $_ eq '0.1.0' } @released), 'earlier versions: ' . join ', ', @released);
my %other_released;
for my $other (@others) { $other_released{$other}{$_} = 1 for released($other, $version); }
for my $old (@released)
{
	my $database = 'from_' . $old =~ tr/./_/r;
	$node->safe_psql('postgres', "CREATE DATABASE $database");
	$node->safe_psql($database, "CREATE EXTENSION abacus VERSION '$old'");
	$node->safe_psql($database, $needed);
	$node->safe_psql($database, "CREATE EXTENSION $_ VERSION '$old'") for grep { $other_released{$_}{$old} } @others;
	isnt(catalogue($database, 'abacus'), $fresh{abacus}, "$old: differs");

	# a mesh that it made
	$node->safe_psql($database, slurp_file("$FindBin::RealBin/meshes/$old.sql"));
	if ($unread{$old})
	{
		my ($status, $out, $err) = $node->psql($database, "SELECT abacus_locate('field', 1, 1)");
		like($err, qr/mesh is stored in format \d+, but this version of Abacus reads formats \d+ to \d+\n.*HINT:  Read its points with the version that wrote it/,
			"$old: what became of the format is said");
		($status, $out, $err) = $node->psql($database, "SELECT abacus_triangulate('field')");
		like($err, qr/stored in format \d+|has a type of another version of Abacus/, "$old: and that it cannot be changed");
		is($node->safe_psql($database, "SELECT fault FROM abacus_check('field')"), 'header', "$old: abacus_check says so too");
		($status, $out, $err) = $node->psql($database, 'ALTER EXTENSION abacus UPDATE');
		like($err, qr/cannot update meshes of Abacus \Q$old\E.*There are the tables field, field_vertices\..*HINT/s,
			"$old: nor is it updated");
		$node->safe_psql($database, 'DROP TABLE field, field_vertices');
	}
	my $session = $node->background_psql($database);
	$session->query('SET client_min_messages = warning');
	my $locate = "SELECT v0, v1, v2 FROM abacus_locate('field', 1, 0.5)";
	my $located = $unread{$old} ? $session->query('SELECT 1') : $session->query($locate);
	my ($status, $out, $err) = $node->psql($database, 'ALTER EXTENSION abacus UPDATE');
	like($err, qr/WARNING:  abacus_quake\(\) .*so it was dropped.*HINT: .*CREATE EXTENSION abacus_lab/s, "$old: what has gone is said")
	  if $without_lab{$old};
	is(catalogue($database, 'abacus'), $fresh{abacus}, "$old: after the update all is as new");
	is($node->safe_psql($database, "SELECT to_regproc('abacus_quake')"), '', "$old: without what is in abacus_lab")
	  if $without_lab{$old};
	for my $other (@others)
	{
		$node->safe_psql($database, $other_released{$other}{$old} ? "ALTER EXTENSION $other UPDATE" : "CREATE EXTENSION $other");
		is(catalogue($database, $other), $fresh{$other}, "$old: $other as well");
	}
	$session->query_safe("SELECT abacus_triangulate('field', 'VALUES (1, 0, 0, 10), (2, 4, 0, 12), (3, 4, 3, 20), (4, 0, 3, 14), (5, 1, 1, 11), (6, 1, 1, 12)', '{height}')")
	  if $unread{$old};
	is($session->query($locate), $unread{$old} ? '1|2|5' : $located, "$old: a session that was there goes on");
	$session->quit;
	$node->safe_psql($database, "SELECT abacus_stage('field', 'SELECT 7, 5, 5, 1'), abacus_triangulate('field')");
	is($node->safe_psql($database, "SELECT string_agg(id || ':' || vertex, ' ' ORDER BY id) FROM abacus_vertices('field')"),
		'1:1 2:2 3:3 4:4 5:5 6:5 7:7', "$old: a mesh, changed");
	is_sound($node, $database, 'field', "$old: changed");
	$node->safe_psql($database, 'DROP TABLE field; DROP EXTENSION ' . join ', ', @others, 'abacus');
	is($node->safe_psql($database, "SELECT count(*) FROM pg_proc WHERE proname ~ '^abacus'"), 0, "$old: nothing is left behind");
}

# another schema, moved before and after the update
$node->safe_psql('elsewhere', <<"SQL");
CREATE SCHEMA a; CREATE SCHEMA b;
CREATE EXTENSION abacus SCHEMA a VERSION '$released[0]';
ALTER EXTENSION abacus SET SCHEMA b;
ALTER EXTENSION abacus UPDATE;
ALTER EXTENSION abacus SET SCHEMA public;
SQL
is(catalogue('elsewhere', 'abacus'), $fresh{abacus}, 'updated in another schema, and moved');

# objects that use functions moved to abacus_lab: they still work, and abacus_lab takes these functions over
for my $old (sort keys %without_lab)
{
	my $database = 'used_' . $old =~ tr/./_/r;
	$node->safe_psql('postgres', "CREATE DATABASE $database");
	$node->safe_psql($database, <<"SQL");
CREATE SCHEMA "My tools";
CREATE EXTENSION abacus SCHEMA "My tools" VERSION '$old';
SET search_path = "My tools";
CREATE VIEW public.ground AS SELECT * FROM abacus_quake(1e-6, 1);
CREATE FUNCTION public.coarsest() RETURNS bigint RETURN (SELECT count(*) FROM abacus_quake(1e-6, 1));
SQL
	my $used = 'SELECT count(*), coarsest() FROM ground';
	my ($status, $out, $err) = $node->psql($database, 'ALTER EXTENSION abacus UPDATE');
	like($err, qr/WARNING:  abacus_quake\(\) is no longer .* in abacus_lab\nDETAIL:  It stays .*function public\.coarsest\(\) depends on .*HINT: .*CREATE EXTENSION abacus_lab SCHEMA "My tools";/s,
		"$old: who uses it is told what to do");
	is($node->safe_psql($database, $used), '324|324', "$old: what uses it goes on");
	$node->safe_psql($database, <<'SQL');
CREATE EXTENSION abacus_lab SCHEMA "My tools";
ALTER EXTENSION abacus SET SCHEMA public;
ALTER EXTENSION abacus_lab SET SCHEMA public;
SQL
	is($node->safe_psql($database, $used), '324|324', "$old: with abacus_lab, too");
	is(catalogue($database, $_), $fresh{$_}, "$old: $_ is as new") for 'abacus', 'abacus_lab';
}

$node->stop;
done_testing();
