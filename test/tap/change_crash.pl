# Changes of a mesh, each a transaction, under kill -9.
#
# Random changes are stopped at random moments. After recovery the mesh has exactly the points that the
# committed transactions have noted, the simplices of a mesh made from them, and sound tables and indexes; and
# the changes continue.
#
#     ABACUS_KILLS   how many times (default 20)
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusCrash;
use AbacusModel;
use PostgreSQL::Test::Utils;
use Test::More;

my $kills = $ENV{ABACUS_KILLS} || 20;
my $node = crash_node('crash');
make_models($node);
$node->safe_psql('postgres', <<'SQL');
CREATE TABLE changes (dimension int, count int);
INSERT INTO changes VALUES (2, 0), (3, 0);
CREATE PROCEDURE change_on(dimension int) LANGUAGE plpgsql AS $$
BEGIN
	LOOP
		PERFORM change(dimension);
		UPDATE changes SET count = count + 1 WHERE changes.dimension = change_on.dimension;
		COMMIT;
	END LOOP;
END $$;
SQL

sub changes
{
	return $node->safe_psql('postgres', "SELECT count FROM changes WHERE dimension = $_[0]");
}

for my $strike (1 .. $kills)
{
	my $d = 2 + $strike % 2;
	my ($before, $victim) = run_and_strike($node, "CALL change_on($d)", 0.5, sub { changes($d) });
	my $what = "mesh$d, $victim after $before changes";
	cmp_ok(changes($d), '>=', $before, "$what: nothing committed is lost");
	is_as_noted($node, $d, $what);
}
cmp_ok(changes($_), '>', 0, changes($_) . " changes of the mesh of dimension $_") for 2, 3;

$node->stop;
done_testing();
