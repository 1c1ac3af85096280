# READ ONLY transactions: every function that changes something is refused there with read_only_sql_transaction
# (25006) and changes nothing, also through a foreign server; every other one answers as elsewhere. The list of both is
# compared with the catalogue, so that no function can be left out. Temporary meshes may be changed, as temporary tables
# may.
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusMesh;
use PostgreSQL::Test::Cluster;
use PostgreSQL::Test::Utils;
use Test::More;

my $node = PostgreSQL::Test::Cluster->new('read_only');
$node->init;
$node->append_conf('postgresql.conf', 'fsync = off');
$node->start;
my $user = $node->safe_psql('postgres', 'SELECT current_user');
my ($host, $port) = ($node->host, $node->port);
$node->safe_psql('postgres', 'CREATE DATABASE shard');
$node->safe_psql('shard', 'CREATE EXTENSION abacus');
$node->safe_psql('postgres', <<"SQL");
CREATE EXTENSION abacus; CREATE EXTENSION dblink; CREATE EXTENSION postgres_fdw;
CREATE TABLE points AS SELECT i AS id, (i * 7919) % 101 + 0.0 AS x, (i * 104729) % 97 + 0.0 AS y, i / 3.0 AS h FROM generate_series(1, 900) AS i;
CREATE TABLE followed AS TABLE points;
CREATE TABLE lines AS SELECT 1 AS line, i AS position, NULL::bigint AS id, 3.5 + i * 9 AS x, 5.5 + i * 8 AS y FROM generate_series(1, 9) AS i;
SELECT abacus_triangulate('field', 'TABLE points'), abacus_triangulate('lined', 'TABLE points');
SELECT abacus_constrain('lined', 'TABLE lines');
SELECT abacus_constrain('lined', 'VALUES (2, 1, NULL::bigint, 40.25, 10.25), (2, 2, NULL, 60.25, 10.25), (2, 3, NULL, 60.25, 20.25), (2, 4, NULL, 40.25, 10.25)');
SELECT abacus_region('lined', \$\$VALUES ('inner', 2)\$\$);
SELECT abacus_create('mesh', 2, '{h}');
SELECT abacus_track('mesh', 'followed', '{id,x,y,h}');
SELECT abacus_octree_create('tree', 2, '{0,0}', '{1,1}');
SELECT abacus_octree_refine('tree', 'SELECT 2, 0.1, 0.1');
SELECT abacus_publish('field');
CREATE SERVER shard FOREIGN DATA WRAPPER dblink_fdw OPTIONS (host '$host', port '$port', dbname 'shard');
CREATE SERVER self FOREIGN DATA WRAPPER postgres_fdw OPTIONS (host '$host', port '$port', dbname 'postgres');
CREATE USER MAPPING FOR CURRENT_USER SERVER shard OPTIONS (user '$user');
CREATE USER MAPPING FOR CURRENT_USER SERVER self OPTIONS (user '$user');
SELECT abacus_shard_create('wide', '{shard}');
CALL abacus_shard_build('wide', 'TABLE points');
CREATE VIEW counted AS SELECT count(*) FROM abacus_simplices('field');
CREATE FOREIGN TABLE counted_there (count bigint) SERVER self OPTIONS (table_name 'counted');
CREATE VIEW changed AS SELECT abacus_insert('field', 'SELECT 9999, 50.5, 50.5, 1') AS count;
CREATE FOREIGN TABLE changed_there (count bigint) SERVER self OPTIONS (table_name 'changed');
SQL

# Calls that change something.
my @writes = (
	q{SELECT abacus_create('new', 2)},
	q{SELECT abacus_stage('field', 'SELECT 1, 2, 3, 4')},
	q{SELECT abacus_triangulate('mesh')},
	q{SELECT abacus_triangulate('new', 'TABLE points')},
	q{CALL abacus_build('field')},
	q{SELECT abacus_insert('field', 'SELECT 1, 2.5, 3.5, 4')},
	q{SELECT abacus_delete('field', 'TABLE points')},
	q{SELECT abacus_insert_returning('field', 'SELECT 1, 2.5, 3.5, 4')},
	q{SELECT abacus_delete_returning('field', 'TABLE points')},
	q{SELECT abacus_update('field', 'SELECT 1, 2, 3, 4')},
	q{SELECT abacus_load('new', 'VALUES (1, 0, 0), (2, 1, 0), (3, 0, 1)', 'VALUES (1, 2, 3)')},
	q{SELECT abacus_label('field', 'SELECT code, v0, v1, v2, 1 AS a FROM abacus_simplices(''field'')')},
	q{SELECT abacus_inherit_labels('field')},
	q{SELECT abacus_mark('field', 'SELECT code, v0, v1, v2, 0, 1 FROM abacus_simplices(''field'')')},
	q{SELECT abacus_track('field', 'points')},
	q{SELECT abacus_untrack('mesh', 'followed')},
	q{SELECT abacus_track_lines('lined', 'lines')},
	q{SELECT abacus_constrain('field', 'TABLE lines')},
	q{SELECT abacus_unconstrain('lined', 'SELECT 1')},
	q{SELECT abacus_region('lined', $$VALUES ('other', 2)$$)},
	q{SELECT abacus_unregion('lined', 'inner')},
	q{SELECT abacus_thin('field', 'new', 1)},
	q{CALL abacus_thin_build('field', 'new', 1)},
	q{SELECT abacus_levels('field', '{1}')},
	q{SELECT abacus_levels_refresh('field')},
	q{SELECT abacus_levels_drop('field')},
	q{SELECT abacus_add_attribute('field', 'a')},
	q{SELECT abacus_drop_attribute('field', 'h')},
	q{SELECT abacus_rename_attribute('field', 'h', 'a')},
	q{SELECT abacus_set_srid('field', 4326)},
	q{SELECT abacus_store('field', 1, 1, 0, 'SELECT id, 1 FROM abacus_share_vertices(''field'', 1, 0, 0)')},
	q{SELECT abacus_octree_create('new', 2, '{0,0}', '{1,1}')},
	q{SELECT abacus_octree_from_points('tree', 'SELECT id, x / 200, y / 200 FROM points', 10)},
	q{SELECT abacus_octree_from_size('tree', 'SELECT 0.1')},
	q{SELECT abacus_octree_from_rows('tree', 'SELECT 0, 0')},
	q{SELECT abacus_octree_refine('tree', 'SELECT 3, 0.9, 0.9')},
	q{SELECT abacus_octree_coarsen('tree', 'SELECT 0, 0.1, 0.1')},
	q{SELECT abacus_octree_update('tree', 'SELECT code, level FROM abacus_octants(''tree'')')},
	q{SELECT abacus_octree_balance('tree')},
	q{SELECT abacus_shard_create('new', '{shard}')},
	q{CALL abacus_shard_build('wide', 'TABLE points')},
	q{SELECT abacus_shard_drop('wide')},
	q{SELECT abacus_shard_resolve('wide')},
	q{SELECT abacus_tiles('field', world => '{0,0,200}')},
	q{SELECT abacus_publish('mesh')},
	q{SELECT abacus_unpublish('field')});

# Functions that may call others, or whose answer changes within a statement, but that change nothing.
my @reads = (
	q{SELECT count(*) FROM abacus_crossings('lined', 'TABLE lines')},
	q{SELECT count(*) FROM abacus_locate('field', 'SELECT id, x, y FROM points')},
	q{SELECT count(*) FROM abacus_interpolate('field', 'SELECT id, x, y FROM points', 'h')},
	q{SELECT count(*) FROM abacus_weights('field', 'SELECT id, x, y FROM points')},
	q{SELECT count(*) FROM abacus_nearest('field', 'SELECT id, x, y FROM points')},
	q{SELECT count(*) FROM abacus_stats('field')},
	q{SELECT count(*) FROM abacus_octree_locate('tree', 'SELECT 1, 0.1, 0.1')},
	q{SELECT count(*) FROM abacus_octree_nearest('tree', 'SELECT 1, 0.1, 0.1')},
	q{SELECT count(*) FROM abacus_octree_interpolate('tree', 'SELECT 1, 0.1, 0.1', '{}'::text[])},
	q{SELECT count(*) FROM abacus_shards('wide')},
	# and some of those that the catalogue calls stable
	q{SELECT count(*) FROM abacus_check('field')},
	q{SELECT count(*) FROM abacus_simplices('wide')},
	q{SELECT count(*) FROM abacus_locate('wide', 50, 50)},
	q{SELECT count(*) FROM abacus_regions('lined')},
	q{SELECT count(*) FROM field_cells},
	q{SELECT count FROM counted_there});

# All but those that the server alone calls, and those that abacus_shard_build() calls on the servers of a mesh.
my $listed = join ' ', map { /\b(abacus_\w+)\(/ } @writes, @reads;
my @unlisted = grep { $listed !~ /\b$_\b/ } split /\n/, $node->safe_psql('postgres', <<'SQL');
SELECT DISTINCT proname FROM pg_proc JOIN pg_depend ON objid = pg_proc.oid AND deptype = 'e' AND classid = 'pg_proc'::regclass
WHERE refobjid = (SELECT oid FROM pg_extension WHERE extname = 'abacus') AND (provolatile = 'v' OR prokind = 'p')
	AND proname !~ '^abacus_shard_(?!create|build|drop|resolve)' AND NOT prorettype = ANY ('{internal,fdw_handler,trigger}'::regtype[]) AND proname NOT IN ('abacus_fdw_validator')
SQL
is("@unlisted", '', 'every volatile function is listed here');

# All that there is, in the catalogue and in tables.
sub everything
{
	return $node->safe_psql('postgres', "SELECT relname, relkind, relfilenode FROM pg_class WHERE relnamespace = 'public'::regnamespace ORDER BY 1, 2; SELECT tgname FROM pg_trigger ORDER BY 1")
	  . join ' ', map { mesh_bytes($node, 'postgres', $_) } qw(field field_vertices lined mesh tree wide followed);
}

my $before = everything();
for my $call (@writes)
{
	# procedures commit, so they refuse to run in a block
	for my $session ('SET default_transaction_read_only = on', $call =~ /^CALL/ ? () : 'BEGIN READ ONLY')
	{
		my (undef, undef, $err) = $node->psql('postgres', "\\set VERBOSITY verbose\n$session;\n$call");
		like($err, qr/ERROR:  25006: cannot execute \w+(\(\))?( \w+)* in a read-only transaction/, "$call, $session: refused");
	}
}
my (undef, undef, $err) = $node->psql('postgres', "BEGIN READ ONLY; DELETE FROM followed WHERE id = 1");
like($err, qr/cannot execute DELETE in a read-only transaction/, 'so are changes of a tracked table');
is(everything(), $before, 'nothing has changed');

for my $call (@reads)
{
	my $answer = $node->safe_psql('postgres', $call);
	is($node->safe_psql('postgres', "BEGIN READ ONLY; $call; COMMIT"), $answer, "$call: $answer");
}

# From 19 on a transaction of postgres_fdw is READ ONLY if that here is. Earlier servers begin one that may write.
my $version = $node->safe_psql('postgres', 'SHOW server_version_num');
my ($status, $out) = $node->psql('postgres', 'BEGIN READ ONLY; SELECT * FROM changed_there; ROLLBACK', stderr => \$err);
if ($version >= 190000)
{
	like($err, qr/cannot execute abacus_insert\(\) in a read-only transaction/, 'a change through a foreign server is refused');
}
else
{
	is($out, 1, 'a change through a foreign server is undone with the transaction');
}
is(everything(), $before, '... and has changed nothing');

# temporary meshes
is($node->safe_psql('postgres', <<'SQL'), '1', 'a temporary mesh is changed');
CREATE TEMP TABLE spare (id int, x float8, y float8);
SELECT FROM abacus_triangulate('pg_temp.brief', 'SELECT id, x, y FROM points');
BEGIN READ ONLY;
SELECT abacus_insert('pg_temp.brief', 'SELECT 9999, 50.5, 50.5');
COMMIT;
SQL

$node->stop;
done_testing();
