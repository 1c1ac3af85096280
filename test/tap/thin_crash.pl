# abacus_thin_build under kill -9.
#
# Thinnings are stopped at random moments. After recovery the mesh is sound and has no fewer vertices than
# before; the same call goes on; and the mesh is in the end the one that an undisturbed call makes, with the
# same greatest error. One that is not finished is refused where a finished one is needed, and a call does
# not go on with one that others have changed.
#
#     ABACUS_KILLS   how many times (default 20)
use strict;
use warnings;

use FindBin;
use lib $FindBin::RealBin;
use AbacusCrash;
use AbacusMesh;
use Test::More;
use Time::HiRes qw(time);

my $kills = $ENV{ABACUS_KILLS} || 20;
my @sources = (
	{ mesh => 'ground', columns => 'id, x, y', dimension => 2, points => 150_000, error => 0.004 },
	{ mesh => 'rock', columns => 'id, x, y, z', dimension => 3, points => 15_000, error => 0.02 });

my $node = crash_node('thin_crash');
sub sql { return $node->safe_psql('postgres', $_[0]); }
# Vertices of a mesh that may not be there yet.
sub vertices
{
	my ($mesh) = @_;
	return 0 if sql("SELECT to_regclass('$mesh') IS NULL") eq 't';
	return mesh_figure($node, 'postgres', $mesh, 'vertices');
}
sub is_done { return sql("SELECT to_regclass('$_[0]') IS NOT NULL") eq 't' && sql("SELECT greatest IS NOT NULL FROM $_[0]_thinning") eq 't'; }

sql(q{SELECT setseed(0.5);
	CREATE TABLE points AS
	SELECT i AS id, random() AS x, random() AS y, random() AS z FROM generate_series(1, 150000) AS i});
for my $s (@sources)
{
	sql("SELECT abacus_triangulate('$s->{mesh}', 'SELECT $s->{columns}, sin(7 * x) * cos(9 * y) + sin(40 * x) / 50 AS height "
		  . "FROM points WHERE id <= $s->{points}', dimension => $s->{dimension})");
	my $start = time;
	sql("CALL abacus_thin_build('$s->{mesh}', 'once_$s->{mesh}', $s->{error})");
	$s->{seconds} = time - $start;
	$s->{vertices} = vertices("once_$s->{mesh}");
}

my ($struck, $late, $complete) = (0, 0, 0);
while ($struck < $kills)
{
	my $s = $sources[ $complete % @sources ];
	my $mesh = "thinned$complete";
	my $call = "CALL abacus_thin_build('$s->{mesh}', '$mesh', $s->{error})";

	while ($struck < $kills && !is_done($mesh))
	{
		my ($before, $victim, $in_time) = run_and_strike($node, $call, 0.6 * $s->{seconds}, sub { vertices($mesh) });
		my $after = vertices($mesh);
		my $what = "$mesh, $victim at $before of $s->{vertices}";

		if (!$in_time)
		{
			$late++;
			$s->{seconds} *= 0.8; # what is left takes less time
			ok(is_done($mesh), "$what: complete");
			next;
		}
		$struck++;
		cmp_ok($after, '>=', $before, "$what: nothing committed is lost");
		next if $after == 0;
		is_intact($node, 'postgres', $mesh, $what);
	}
	sql($call) if !is_done($mesh);
	is(mesh_content($node, 'postgres', $mesh), mesh_content($node, 'postgres', "once_$s->{mesh}"), "$mesh: the same mesh as undisturbed");
	is(sql("SELECT greatest, reached FROM ${mesh}_thinning"), sql("SELECT greatest, reached FROM once_$s->{mesh}_thinning"),
		"$mesh: ... with the same greatest error");
	sql("DROP TABLE $mesh");
	$complete++;
	$s->{seconds} = $s->{seconds} * 1.2;
}

# Others change an unfinished mesh.
my $s = $sources[0];
my $call = "CALL abacus_thin_build('$s->{mesh}', 'touched', $s->{error})";
my $milliseconds = 50;
until (vertices('touched') > 0)
{
	$node->psql('postgres', "SET statement_timeout = $milliseconds; $call", on_error_stop => 0);
	BAIL_OUT('the thinning is done at once') if is_done('touched');
	$milliseconds *= 1.3;
}
my ($status, $out, $err) = $node->psql('postgres', "SELECT abacus_levels('touched', '{1}')");
like($err, qr/mesh "touched" is not finished/, 'an unfinished mesh gets no levels');
($status, $out, $err) = $node->psql('postgres', "SELECT abacus_thin('touched', 'thinner', 1)");
like($err, qr/mesh "touched" is not finished/, '... and is not thinned');
is(sql("SELECT to_regclass('thinner')"), '', '... which leaves no table');
sql("SELECT abacus_delete('touched', 'SELECT id, x, y FROM abacus_vertices(''touched'') ORDER BY id LIMIT 1')");
($status, $out, $err) = $node->psql('postgres', $call);
like($err, qr/mesh "touched" has changed since its last round/, 'a mesh that others have changed is refused');
like($err, qr/HINT:  Drop it, and thin anew/, '... with a hint');
is(sql('SELECT greatest FROM touched_thinning'), '', '... and not said to be done');

diag("$struck times stopped, $late times too late, $complete meshes completed");

$node->stop;
done_testing();
