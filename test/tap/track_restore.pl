# Tables that a mesh follows, dumped and restored: their triggers find the mesh by name, are bound again at
# once, and have the rights of the table's owner only then. Then an unlogged mesh and table crash.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $node = PostgreSQL::Test::Cluster->new('track');
$node->init;
$node->append_conf('postgresql.conf', 'fsync = off');
$node->start;
my $dump = $node->basedir . '/dump';

$node->safe_psql('postgres', $_)
  for 'CREATE ROLE owner', 'CREATE ROLE guest', 'CREATE DATABASE origin', 'CREATE DATABASE built',
  'CREATE DATABASE written';
$node->safe_psql('origin', <<'SQL');
CREATE SCHEMA abacus;
CREATE EXTENSION abacus SCHEMA abacus;
GRANT USAGE ON SCHEMA abacus TO owner;
CREATE SCHEMA s AUTHORIZATION owner;
GRANT USAGE ON SCHEMA s TO guest;
SET ROLE owner;
SET search_path = s, abacus;
CREATE TABLE wells (id int, x float8, y float8);
GRANT INSERT ON wells TO guest;
INSERT INTO wells SELECT i, i * 7919 % 101, i * 104729 % 97 FROM generate_series(1, 500) AS i;
SELECT abacus_create('field', 2);
SELECT abacus_track('field', 'wells');
CREATE TABLE walls (line int, position int, point int);
GRANT INSERT ON walls TO guest;
INSERT INTO walls VALUES (1, 1, 100), (1, 2, 200);
SELECT abacus_track_lines('field', 'walls');
SQL

sub bound
{
	my ($database) = @_;
	return $node->safe_psql($database,
		"SELECT count(*) FROM pg_depend WHERE classid = 'pg_trigger'::regclass AND refobjid = 's.field'::regclass");
}

# Runs SQL as a role; returns its errors.
sub as
{
	my ($role, $database, $sql) = @_;
	my ($status, $out, $err) = $node->psql($database, "SET ROLE $role; $sql");
	return $err;
}

sub differences
{
	my ($database, $mesh) = @_;
	return $node->safe_psql($database, <<"SQL");
WITH there AS (SELECT id, x, y FROM abacus.abacus_vertices('$mesh'))
SELECT (SELECT count(*) FROM (TABLE s.wells EXCEPT ALL TABLE there) AS a)
     + (SELECT count(*) FROM (TABLE there EXCEPT ALL TABLE s.wells) AS b);
SQL
}

sub lines
{
	my ($database, $mesh) = @_;
	return $node->safe_psql($database,
		"SELECT line, position, point FROM abacus.abacus_lines('$mesh')");
}

$node->command_ok([ 'pg_dump', '-d', $node->connstr('origin'), '-Fc', '-f', $dump ], 'dumped');
for my $database ('built', 'written')
{
	$node->command_ok([ 'pg_restore', '-e', '-d', $node->connstr($database), $dump ], "$database: restored");
	is(bound($database), 0, "$database: no trigger is bound");
	my $insert = 'INSERT INTO s.wells VALUES (1000, 3.5, 4.5)';
	like(as('guest', $database, $insert), qr/permission denied for table field/,
		"$database: who has no rights on the mesh has to wait");
	my $wall = 'INSERT INTO s.walls VALUES (2, 1, 100), (2, 2, 1000)';
	like(as('guest', $database, $wall), qr/permission denied for table field/, "$database: for lines as well");
	# one binds them by changing the mesh, the other by changing the table
	is($database eq 'built'
		? as('owner', $database, "CALL abacus.abacus_build('s.field')")
		: as('owner', $database, 'DELETE FROM s.wells WHERE id < 10'), '', "$database: the owner writes");
	is(bound($database), 8, "$database: all triggers are bound");
	is(as('owner', $database, 'ALTER TABLE s.field RENAME TO meadow'), '', "$database: renamed");
	is(as('guest', $database, $insert), '', "$database: now everybody writes");
	is(differences($database, 's.meadow'), 0, "$database: the mesh follows");
	is(as('guest', $database, $wall), '', "$database: and draws lines");
	is(lines($database, 's.meadow'), "1|1|100\n1|2|200\n2|1|100\n2|2|1000", "$database: which the mesh has");
	$node->safe_psql('postgres', "ALTER DATABASE $database SET search_path = public, abacus");
	is_sound($node, $database, 's.meadow', "$database: the mesh");
	$node->safe_psql($database, 'DROP TABLE s.meadow');
	is($node->safe_psql($database,
			"SELECT count(*) FROM pg_trigger WHERE tgrelid IN ('s.wells'::regclass, 's.walls'::regclass)"),
		0, "$database: the triggers go with the mesh");
}

# a crash empties both, and the rest of the mesh reports that
$node->safe_psql('origin', <<'SQL');
SET search_path = s, abacus;
SELECT abacus_untrack('field', 'walls');
SELECT abacus_unconstrain('field', 'VALUES (1)');
ALTER TABLE wells SET UNLOGGED;
ALTER TABLE field SET UNLOGGED;
ALTER TABLE field_vertices SET UNLOGGED;
SELECT abacus_track('field', 'wells');
SQL
$node->stop('immediate');
$node->start;
is($node->safe_psql('origin', 'SELECT count(*) FROM s.wells'), 0, 'unlogged: the table is empty');
like(as('owner', 'origin', 'INSERT INTO s.wells VALUES (1, 1, 1)'), qr/mesh "field" has no header/,
	'... the mesh is no mesh any more');
$node->safe_psql('origin', <<'SQL');
SET ROLE owner;
SET search_path = s, abacus;
DROP TABLE field;
SELECT abacus_create('field', 2);
ALTER TABLE field SET UNLOGGED;
ALTER TABLE field_vertices SET UNLOGGED;
SELECT abacus_track('field', 'wells');
INSERT INTO wells VALUES (1, 1, 1), (2, 2, 1), (3, 1, 2);
SQL
is(differences('origin', 's.field'), 0, '... created anew it follows again');

$node->stop;
done_testing();
