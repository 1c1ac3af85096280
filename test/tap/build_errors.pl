# abacus_build when a call of the database, or an allocation, fails: the earlier batches are there, nothing is
# held, and the next call continues.
use strict;
use warnings;

use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $points = 3000;
my $batch = 250;

my $node = PostgreSQL::Test::Cluster->new('errors');
$node->init;
$node->start;

sub sql { return $node->safe_psql('postgres', $_[0]); }

sql("CREATE EXTENSION abacus;
	CREATE TABLE points AS
	SELECT i AS id, (i * 7919) % 1009 AS x, (i * 104729) % 997 AS y FROM generate_series(1, $points) AS i");
sql("SELECT abacus_triangulate('once', 'TABLE points')");

# The error leaves the session unchanged, so the same one looks and continues.
my ($failures, $call, $failed) = (0, 1, 1);
my %inserted;
while ($failed)
{
	my ($status, $out, $err) = $node->psql('postgres', <<"SQL");
SELECT abacus_create('field', 2) \\g /dev/null
SELECT abacus_stage('field', 'TABLE points') \\g /dev/null
SET abacus.cache_size = '1MB';
SET abacus.fail_host_call = $call;
\\set ON_ERROR_STOP off
CALL abacus_build('field', $batch);
\\set ON_ERROR_STOP on
\\echo :LAST_ERROR_SQLSTATE
RESET abacus.fail_host_call;
SELECT value FROM abacus_stats('field') WHERE name = 'inserted';
SELECT count(*) FROM pg_locks WHERE pid = pg_backend_pid() AND relation = 'field'::regclass;
SELECT count(*) FROM abacus_progress WHERE pid = pg_backend_pid();
SELECT count(*) FROM abacus_check('field');
CALL abacus_build('field', $batch);
SELECT count(*) FROM (SELECT v0, v1, v2 FROM abacus_simplices('field') EXCEPT
	SELECT v0, v1, v2 FROM abacus_simplices('once')) AS other;
DROP TABLE field;
SQL
	my ($state, $inserted, @rest) = split /\n/, $out;
	$failed = $err =~ /ERROR/;
	$inserted{$inserted} = 1;
	ok(!$failed || $state =~ /^(58030|53200)$/, "call $call: SQLSTATE $state");
	ok($inserted % $batch == 0, "call $call: $inserted are whole batches");
	is("@rest", '0 0 0 0', "call $call: nothing held, sound, and completed by the next call");
	$call += 1 + int($call / 20);
	$failures++ if $failed;
}
cmp_ok(scalar(keys %inserted), '>', $points / $batch / 2, "$failures failures, in most batches");

$node->stop;
done_testing();
