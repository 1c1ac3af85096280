# abacus_build on a full disk: committed batches stay, and with free space again the next call continues.
# ABACUS_SMALL_DISK names an empty folder on a file system of about 14 MB (scripts/test.sh mounts one). Then
# temporary files that do not fit.
use strict;
use warnings;

use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $disk = $ENV{ABACUS_SMALL_DISK};
plan skip_all => 'ABACUS_SMALL_DISK is not set' unless $disk;

my $node = PostgreSQL::Test::Cluster->new('full_disk');
$node->init;
$node->start;

sub sql { return $node->safe_psql('postgres', $_[0]); }

sub inserted
{
	return sql("SELECT value FROM abacus_stats('field') WHERE name = 'inserted'");
}

sql("CREATE EXTENSION abacus; CREATE EXTENSION amcheck;
	CREATE TABLESPACE small LOCATION '$disk';
	CREATE TABLE points AS
	SELECT i AS id, random() AS x, random() AS y, (i * 7 % 1000) / 1000.0 AS h FROM generate_series(1, 800000) AS i");
sql("SELECT abacus_triangulate('once', 'TABLE points')");
sql("SELECT abacus_create('field', 2, attributes => '{h}')");
sql("SELECT abacus_stage('field', 'TABLE points')");
sql("ALTER TABLE field SET TABLESPACE small; ALTER INDEX field_pkey SET TABLESPACE small");

for my $attempt (1, 2)
{
	my ($status, $out, $err) = $node->psql('postgres', "CALL abacus_build('field', 20000)",
		extra_params => [ '-v', 'VERBOSITY=verbose' ]);
	like($err, qr/ERROR:  53100: could not extend file/, "attempt $attempt: the disk is full");
	my $points = inserted();
	ok($points > 0 && $points < 800_000 && $points % 20_000 == 0,
		"attempt $attempt: $points points are in whole batches");
	is(sql("SELECT count(*) FROM abacus_check('field')"), 0, "attempt $attempt: the mesh is sound");
	is(sql("SELECT bt_index_check('field_pkey', true)"), '', "attempt $attempt: so is the index");
}

sql("ALTER TABLE field SET TABLESPACE pg_default; ALTER INDEX field_pkey SET TABLESPACE pg_default");
sql("CALL abacus_build('field', 20000)");
is(inserted(), 800_000, 'with room it ends');
is( sql("SELECT count(*) FROM (SELECT v0, v1, v2 FROM abacus_simplices('field') EXCEPT
			SELECT v0, v1, v2 FROM abacus_simplices('once')) AS other"),
	0, 'with the same simplices as built at once');

# If the size of temporary files can be estimated, too large ones are refused before any is written.
sub refused
{
	my ($query) = @_;
	my ($status, $out, $err) = $node->psql('postgres', "SET temp_tablespaces = small; $query",
		extra_params => [ '-v', 'VERBOSITY=verbose' ]);
	like($err, qr/ERROR:  53400: temporary files would take more than the \d+ MB free on the disk/, $query);
}
refused("SELECT count(*) FROM abacus_contours('once', 1e-6, attribute => 'h')");
refused("SELECT count(*) FROM abacus_contours('once', 1e-6, attribute => 'h', polygonize => true)");
refused("SELECT count(*) FROM abacus_spanning_tree('once')");
refused("SELECT count(*) FROM abacus_numbered_vertices('once')");
refused("SELECT count(*) FROM abacus_numbered_simplices('once')");
is(sql("SELECT count(*) FROM pg_ls_tmpdir((SELECT oid FROM pg_tablespace WHERE spcname = 'small'))"), 0, 'no file is left');
cmp_ok(sql("SET temp_tablespaces = small; SELECT count(*) FROM abacus_contours('once', 0.1, attribute => 'h', lower => '{0.5,0.5}', upper => '{0.52,0.52}')"),
	'>', 0, 'what has room is done');

sql('DROP TABLE field; DROP TABLESPACE small');
$node->stop;
done_testing();
