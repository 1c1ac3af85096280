# Changes of a mesh, each a transaction, under kill -9.
#
# A procedure changes a mesh in random ways, and in the same transactions a
# table in which the points are noted. It is stopped at random moments. After
# recovery the mesh has exactly the points of the table, its simplices are
# those of a mesh made of the table, tables and indexes are sound; and the
# changes go on from there.
#
#     ABACUS_KILLS   how many times (default 16)
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusCrash;
use AbacusMesh;
use PostgreSQL::Test::Utils;
use Test::More;

my $kills = $ENV{ABACUS_KILLS} || 16;
my $node = crash_node('crash');
sub sql { return $node->safe_psql('postgres', $_[0]); }

# What a transaction does is left to chance.
sql(<<'SQL');
CREATE TABLE done (mesh regclass, rounds int);
CREATE PROCEDURE change(mesh regclass, dimension int, rounds int) LANGUAGE plpgsql AS $$
DECLARE
	noted text := mesh || '_noted';
	columns text := CASE dimension WHEN 2 THEN 'id, x, y' ELSE 'id, x, y, z' END;
	turn int;
	first bigint;
	fresh text;
BEGIN
	FOR i IN 1 .. rounds LOOP
		turn := floor(random() * 4);
		EXECUTE format('SELECT coalesce(max(id), 0) + 1 FROM %s', noted) INTO first;
		-- some near each other, some outside of all before, some where others are
		EXECUTE format('INSERT INTO %1$s SELECT %2$s + i, c[1] + $1 * random(), c[2] + $1 * random(), c[3] + $1 * random()
				FROM generate_series(0, $2) i, (SELECT ARRAY[random(), random(), random()] AS c) AS centre
				UNION ALL SELECT %2$s + 999 + row_number() OVER (), x, y, z FROM (SELECT * FROM %1$s ORDER BY id DESC LIMIT 5) AS other',
				noted, first) USING power(random(), 6), (random() * 100)::int;
		fresh := format('SELECT %s FROM %s WHERE id >= %s', columns, noted, first);
		CASE turn
		WHEN 0 THEN
			PERFORM abacus_insert(mesh, fresh);
		WHEN 1 THEN
			PERFORM abacus_stage(mesh, fresh), abacus_triangulate(mesh);
		WHEN 2 THEN -- the triangulation undone, and done again
			PERFORM abacus_stage(mesh, fresh);
			BEGIN
				PERFORM abacus_triangulate(mesh);
				RAISE division_by_zero;
			EXCEPTION WHEN division_by_zero THEN
				NULL;
			END;
			PERFORM abacus_triangulate(mesh);
		WHEN 3 THEN -- all undone
			BEGIN
				PERFORM abacus_insert(mesh, fresh);
				RAISE division_by_zero;
			EXCEPTION WHEN division_by_zero THEN
				EXECUTE format('DELETE FROM %s WHERE id >= %s', noted, first);
			END;
		END CASE;
		UPDATE done SET rounds = done.rounds + 1 WHERE done.mesh = change.mesh;
		COMMIT;
	END LOOP;
END $$;
SQL
my %columns = (2 => 'id, x, y', 3 => 'id, x, y, z');
for my $d (2, 3)
{
	sql(<<"SQL");
SELECT abacus_create('mesh$d', $d);
CREATE TABLE mesh${d}_noted (id bigint PRIMARY KEY, x float8, y float8, z float8);
INSERT INTO mesh${d}_noted SELECT i, random(), random(), random() FROM generate_series(1, 1000) AS i;
SELECT abacus_stage('mesh$d', 'SELECT $columns{$d} FROM mesh${d}_noted'), abacus_triangulate('mesh$d');
INSERT INTO done VALUES ('mesh$d', 0);
SQL
}
sub rounds { return sql("SELECT rounds FROM done WHERE mesh = 'mesh$_[0]'::regclass"); }

my %changes = (2 => 0, 3 => 0);
for my $strike (1 .. $kills)
{
	my $d = 2 + $strike % 2;
	my $mesh = "mesh$d";
	my ($before, $victim, $in_time) = run_and_strike($node, "CALL change('$mesh', $d, 1000000)", 0.5, sub { rounds($d) });
	my $after = rounds($d);
	my $what = "$mesh, $victim after $before changes";

	cmp_ok($after, '>=', $before, "$what: nothing committed is lost");
	$changes{$d} = $after;
	my $points = $columns{$d} =~ s/z/z::float8/r;
	is( sql("SELECT count(*) FROM (
			(SELECT $columns{$d} FROM ${mesh}_noted EXCEPT SELECT $columns{$d} FROM abacus_vertices('$mesh')) UNION ALL
			(SELECT $columns{$d} FROM abacus_vertices('$mesh') EXCEPT SELECT $columns{$d} FROM ${mesh}_noted)) AS other"),
		0, "$what: it has the points of the committed changes, and no other");
	is_intact($node, 'postgres', $mesh, $what);
	sql("DROP TABLE IF EXISTS wanted; SELECT abacus_triangulate('wanted', 'SELECT $columns{$d} FROM ${mesh}_noted ORDER BY id', dimension => $d)");
	is(other_simplices($node, 'postgres', $mesh, 'wanted', $d), 0, "$what: its simplices are theirs");
}
cmp_ok($changes{$_}, '>', 0, "$changes{$_} changes of the mesh of dimension $_") for 2, 3;

$node->stop;
done_testing();
