# Prepared transactions: a change waits unseen, even through a crash; the session that prepared it sees the
# mesh as before, and other writers wait.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $node = PostgreSQL::Test::Cluster->new('prepared');
$node->init;
$node->append_conf('postgresql.conf', "max_prepared_transactions = 5\nfsync = off");
$node->start;
$node->safe_psql('postgres', <<'SQL');
CREATE EXTENSION abacus; CREATE EXTENSION amcheck;
SELECT abacus_triangulate('field', 'SELECT i, (i * 7919) % 1009, (i * 104729) % 997 FROM generate_series(1, 3000) AS i');
CREATE FUNCTION look() RETURNS text LANGUAGE sql STABLE AS $$
	SELECT (SELECT concat_ws(' ', v0, v1, v2) FROM abacus_locate('field', 500.25, 500.5)) || ' of '
		|| (SELECT count(*) FROM abacus_simplices('field')) || ', ' || (SELECT count(*) FROM abacus_vertices('field')) $$;
SQL

sub look { return $node->safe_psql('postgres', 'SELECT look()'); }

my $before = look();
my $changed;
for my $end ('ROLLBACK', 'COMMIT')
{
	for my $crash (0, 1)
	{
		my $what = "$end PREPARED" . ($crash ? ' after a crash' : '');
		my $first = 10_000 * (1 + $crash) + ($end eq 'COMMIT' ? 5000 : 0);
		my $session = $node->background_psql('postgres');
		is($session->query('SELECT look()'), $before, "$what: before");
		$session->query_safe('BEGIN');
		$session->query_safe("SELECT abacus_insert('field', 'SELECT $first + i, 500 + i / 10.0, 500 + i / (7.0 + $crash) FROM generate_series(1, 100) AS i')");
		$changed = $session->query('SELECT look()');
		isnt($changed, $before, "$what: the session sees its change");
		$session->query_safe("PREPARE TRANSACTION 'change'");
		is($session->query('SELECT look()'), $before, "$what: and no more when it is prepared");
		is(look(), $before, "$what: nor does another");
		$session->quit;
		if ($crash)
		{
			$node->stop('immediate');
			$node->start;
		}
		my ($status, $out, $err) = $node->psql('postgres', "SET lock_timeout = '50ms'; SELECT abacus_insert('field', 'SELECT 1, 2, 3')");
		like($err, qr/canceling statement due to lock timeout/, "$what: writers wait");
		($status, $out, $err) = $node->psql('postgres', "SET lock_timeout = '50ms'; DROP TABLE field");
		like($err, qr/canceling statement due to lock timeout/, "$what: so does DROP TABLE");
		is_intact($node, 'postgres', 'field', "$what: prepared");
		$session = $node->background_psql('postgres');
		is($session->query('SELECT look()'), $before, "$what: readers do not");
		$node->safe_psql('postgres', "$end PREPARED 'change'");
		$before = $changed if $end eq 'COMMIT';
		is($session->query('SELECT look()'), $before, "$what: at the end");
		$session->quit;
		is_intact($node, 'postgres', 'field', "$what: at the end");
	}
}
$node->safe_psql('postgres', "SELECT abacus_insert('field', 'SELECT 1, 2, 3')");
is_intact($node, 'postgres', 'field', 'changed after all that');

$node->stop;
done_testing();
