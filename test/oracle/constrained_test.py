#!/usr/bin/python3
"""Lines of a mesh against CGAL's constrained Delaunay triangulation: triangles and fixed edges, whatever the order, threads and cache.
CGAL's triangulation is also loaded, with its constrained edges as lines, as it is and with other edges among points on one circle.

ABACUS_LARGE=1 takes more points and all settings for each input."""
import math
import os
import unittest
from fractions import Fraction

import numpy
from scipy.spatial import Delaunay

import abacus
from constrained_oracle import canonical, theirs

LARGE = bool(os.environ.get("ABACUS_LARGE"))
# threads, the tiny intervals that let few points use many threads, and the cache in MB
SETTINGS = [(threads, tiny, cache) for threads in (1, 2, 3, 7) for tiny in ("off", "on") for cache in (1, 64)]
USUAL = [(1, "off", 1), (2, "on", 64), (3, "on", 1), (7, "on", 1)]


def ours(mesh):
    """Triangles and fixed edges of a mesh whose ids count from 1, in canonical order; and the lines of the edges."""
    edges = abacus.rows(f"SELECT v0 - 1, v1 - 1, array_to_string(lines, ' ') FROM abacus_edges('{mesh}', fixed => true)")
    edges = sorted((min(int(a), int(b)), max(int(a), int(b)), lines) for a, b, lines in edges)
    lines = [{int(line) for line in of.split()} for *_, of in edges]
    return canonical(abacus.simplices(mesh)), numpy.array([edge[:2] for edge in edges], dtype=int).reshape(-1, 2), lines


def unique(points):
    return numpy.unique(points + 0.0, axis=0)


def on_one_circle(places):
    """Whether four places are, exactly."""
    rows = [[x - places[3][0], y - places[3][1]] for x, y in places[:3]]
    (a, b), (c, d), (e, f) = rows
    return (a * a + b * b) * (c * f - d * e) - (c * c + d * d) * (a * f - b * e) + (e * e + f * f) * (a * d - b * c) == 0


def otherwise(points, triangles, fixed, random):
    """The triangles with some of the free edges among four points on one circle exchanged for the other diagonal; and how many."""
    beyond, changed, used = {}, triangles.copy(), set()
    fixed = {tuple(sorted(edge)) for edge in fixed.tolist()}
    for t, corners in enumerate(triangles.tolist()):
        for i in range(3):
            a, b, c = corners[i], corners[(i + 1) % 3], corners[(i + 2) % 3]
            if (b, a) not in beyond:
                beyond[a, b] = t, c
                continue
            u, d = beyond[b, a]
            if {t, u} & used or (min(a, b), max(a, b)) in fixed or random.random() < 0.3:
                continue
            near = points[[a, b, c]] - points[d]  # as doubles first, which rule most of them out
            square = (near ** 2).sum(axis=1)
            if abs(numpy.linalg.det(numpy.column_stack([near, square]))) > 1e-6 * numpy.abs(near).max() ** 2 * square.max():
                continue
            if on_one_circle([tuple(map(Fraction, points[k].tolist())) for k in (a, b, c, d)]):
                changed[t], changed[u] = (a, d, c), (d, b, c)
                used |= {t, u}
    return changed, len(used) // 2


def chains(segments, random, most=5):
    """Segments as lines of up to so many points, broken up at random: lists of indices."""
    out = {}
    for a, b in segments:
        out.setdefault(a, []).append(b)
    lines = []
    for start in list(out):
        while out.get(start):
            line = [start]
            while len(line) <= random.integers(2, most + 1) and out.get(line[-1]):
                line.append(out[line[-1]].pop())
            lines.append(line)
    return lines


class Constrained(unittest.TestCase):
    def compare(self, name, points, lines, settings=None):
        """`points` are n x 2, all different; `lines` are lists of indices."""
        random = numpy.random.default_rng(len(points))
        segments = numpy.array([(a, b) for line in lines for a, b in zip(line, line[1:])], dtype=int).reshape(-1, 2)
        triangles, edges, _ = theirs(points, segments)
        # when a point comes: with the first ones, after the first lines, or last; those that lines name must be there
        time = numpy.where(numpy.isin(numpy.arange(len(points)), segments) | (len(points) < 10), 0, random.choice(3, len(points), p=(0.6, 0.39, 0.01)))
        abacus.store("lined_points", ["x", "y", "time"], numpy.column_stack([points, time]))
        rows = [(n, 10 * k - 70, i + 1) for n, line in enumerate(lines) for k, i in enumerate(line)]
        abacus.psql("DROP TABLE IF EXISTS lined_rows CASCADE; CREATE TABLE lined_rows (line bigint, k int, id bigint)")
        abacus.psql("COPY lined_rows FROM STDIN (FORMAT csv)", "".join(f"{n},{k},{i}\n" for n, k, i in rows))
        abacus.psql("CREATE OR REPLACE VIEW later AS SELECT count(DISTINCT line) AS lines FROM lined_rows")
        chosen = SETTINGS if LARGE else settings or [USUAL[0], USUAL[random.integers(1, 4)]]
        for threads, tiny, cache in chosen:
            with self.subTest(name, threads=threads, tiny=tiny, cache=cache):
                seed = random.integers(10 ** 9)
                order = f"ORDER BY hashint8extended(id, {random.integers(10 ** 9)})"
                # tiny intervals make threads slow, so only lines and the last points have them
                abacus.psql(f"""DROP TABLE IF EXISTS lined, lined_vertices, lined_lines CASCADE;
                    SET abacus.threads = {threads}; SET abacus.cache_size = '{cache}MB';
                    SELECT abacus_triangulate('lined', 'SELECT id, x, y FROM lined_points WHERE time = 0 {order}');
                    SET abacus.tiny_intervals = {tiny};
                    SELECT abacus_constrain('lined', 'SELECT * FROM lined_rows WHERE line % 3 > 0 {order}, line') FROM later WHERE lines > 1;
                    SET abacus.tiny_intervals = off;
                    SELECT abacus_insert('lined', 'SELECT id, x, y FROM lined_points WHERE time = 1 {order}');
                    SET abacus.tiny_intervals = {tiny};
                    SELECT abacus_constrain('lined', 'SELECT * FROM lined_rows WHERE line % 3 = 0 {order}, line') FROM later WHERE lines > 0;
                    SELECT abacus_insert('lined', 'SELECT id, x, y FROM lined_points WHERE time = 2 {order}')""")
                self.assertEqual(abacus.rows("SELECT * FROM abacus_check('lined')"), [])
                found, fixed, of = ours("lined")
                numpy.testing.assert_array_equal(fixed, edges)
                numpy.testing.assert_array_equal(found, triangles)
                self.check_lines(points, lines, fixed, of)
        self.load(name, points, triangles, edges, *chosen[-1], random)
        return len(edges)

    def load(self, name, points, triangles, edges, threads, tiny, cache, random):
        """CGAL's triangles, loaded with its constrained edges as lines, are the mesh; and without the lines they are that without lines."""
        given, exchanged = otherwise(points, triangles, edges, random)
        rows = numpy.column_stack([random.integers(0, 1 + len(edges) // 5, len(edges)), edges + 1])
        turned = random.random(len(rows)) < 0.5
        rows[turned] = rows[turned][:, [0, 2, 1]]
        for table, columns, values in (("given_triangles", "v0, v1, v2", given + 1), ("given_lines", "line, v0, v1", rows)):
            abacus.psql(f"DROP TABLE IF EXISTS {table}; CREATE TABLE {table} ({columns.replace(',', ' bigint,')} bigint)")
            abacus.psql(f"COPY {table} FROM STDIN (FORMAT csv)", "".join(",".join(map(str, row)) + "\n" for row in random.permutation(values).tolist()))
        with self.subTest(f"{name}, loaded with {exchanged} edges exchanged", threads=threads, tiny=tiny, cache=cache):
            abacus.psql(f"""DROP TABLE IF EXISTS lined, lined_vertices, lined_lines CASCADE;
                SET abacus.threads = {threads}; SET abacus.cache_size = '{cache}MB'; SET abacus.tiny_intervals = {tiny};
                SELECT abacus_load('lined', 'SELECT id, x, y FROM lined_points', 'TABLE given_triangles', lines => 'TABLE given_lines')""")
            self.assertEqual(abacus.rows("SELECT * FROM abacus_check('lined')"), [])
            found, fixed, of = ours("lined")
            numpy.testing.assert_array_equal(fixed, edges)
            numpy.testing.assert_array_equal(found, triangles)
            line = {(min(a, b) - 1, max(a, b) - 1): n for n, a, b in rows.tolist()}
            self.assertEqual(of, [{line[edge]} for edge in map(tuple, edges.tolist())])
            abacus.psql("SELECT abacus_unconstrain('lined', 'SELECT DISTINCT line FROM given_lines')")
            numpy.testing.assert_array_equal(ours("lined")[0], theirs(points, numpy.empty((0, 2), dtype=int))[0])

    def check_lines(self, points, lines, edges, of):
        """Each edge names the lines that have it: the chains between the corners of a line, followed edge by edge."""
        have = [set() for _ in edges]
        number = {tuple(edge): n for n, edge in enumerate(edges)}
        ends = {}
        for a, b in edges:
            ends.setdefault(a, []).append(b)
            ends.setdefault(b, []).append(a)
        for n, line in enumerate(lines):
            for a, b in zip(line, line[1:]):
                while a != b:
                    direct = (points[b] - points[a]) / numpy.hypot(*(points[b] - points[a]))
                    turns = [((points[c] - points[a]) / numpy.hypot(*(points[c] - points[a]))) @ direct for c in ends[a]]
                    c = b if b in ends[a] else ends[a][int(numpy.argmax(turns))]
                    have[number[min(a, c), max(a, c)]].add(n)
                    a = c
        self.assertEqual(of, have)

    def delaunay_lines(self, points, part, random):
        """Edges of a Delaunay triangulation of some of the points, so none cross."""
        some = random.choice(len(points), max(4, len(points) // part), replace=False)
        triangles = Delaunay(points[some]).simplices
        edges = numpy.unique(numpy.sort(numpy.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [0, 2]]]), axis=1), axis=0)
        chosen = some[edges[random.random(len(edges)) < 0.6]]
        turned = random.random(len(chosen)) < 0.5
        chosen[turned] = chosen[turned][:, ::-1]
        return chains(random.permutation(chosen).tolist(), random)

    def test_random(self):
        random = numpy.random.default_rng(1)
        for count, part in ((60, 2), (3000, 3), (40000 if LARGE else 15000, 40)):
            points = unique(random.random((count, 2)))
            self.compare(f"{count} random points", points, self.delaunay_lines(points, part, random), USUAL if count == 3000 else None)

    def test_clusters(self):
        random = numpy.random.default_rng(2)
        centres = random.random((20, 2)) * 1e6
        points = unique(centres[random.integers(0, 20, 4000)] + random.normal(size=(4000, 2)) * 10.0 ** random.integers(-3, 4, (4000, 1)))
        self.compare("clusters", points, self.uncrossed(points, self.delaunay_lines(points, 10, random)))

    def test_grid(self):
        """Cocircular points, with lines through many of them exactly: along axes, diagonals, and steps of two and one."""
        random = numpy.random.default_rng(3)
        side = 121 if LARGE else 61
        points = numpy.array([(x, y) for x in range(side) for y in range(side)], dtype=float)
        at = lambda x, y: x * side + y
        end = side - 1
        lines = [[at(0, 7), at(end, 7)], [at(12, end), at(12, 0)], [at(0, 0), at(end, end)], [at(end, 0), at(0, end)],
                 [at(0, 0), at(0, end), at(end, end), at(end, 0), at(0, 0)], [at(0, 20), at(end, 20 + end // 2)], [at(5, 5), at(6, 7), at(9, 8)],
                 [at(50, 31), at(57, 39), at(53, 45)], [at(48, 2), at(58, 6), at(50, 3), at(48, 2)], [at(2, 30), at(5, 58), at(2, 58)]]
        kept = self.uncrossed(points, lines)
        self.assertGreater(len(kept), 5)
        self.compare("grid", points, kept)
        thinned = points[random.random(len(points)) < 0.7]
        self.compare("grid with holes", thinned, self.delaunay_lines(thinned, 6, random))

    def test_circle(self):
        """Points exactly on one circle, and its centre, with lines of different length among them."""
        radius, points = 1105, set()
        for x in range(-radius, radius + 1):
            y = math.isqrt(radius * radius - x * x)
            if x * x + y * y == radius * radius:
                points |= {(x, y), (x, -y)}
        points = numpy.array(sorted(points, key=lambda p: math.atan2(p[1], p[0])), dtype=float)
        n = len(points)
        self.compare("circle", points, [[0, n // 2], [n // 4, 1], [n // 2 + 1, n - 2, n // 2 + 3], [n // 2 + 5, n // 2 + 9]])
        self.compare("circle without lines crossing it", points, [[3, 4, 5], [n - 1, 0]])
        centred = numpy.vstack([points, [[0, 0]]])
        self.compare("wheel", centred, [[0, n], [n // 2, n], [n, n // 4, n // 4 + 3], [n // 2 + 3, n // 2 + 9]])

    def test_roads(self):
        """A network: streets that meet in crossroads, with points beside them, on them and bends; dead ends."""
        random = numpy.random.default_rng(4)
        side = 20 if LARGE else 12
        nodes = numpy.array([(x, y) for x in range(side) for y in range(side)]) * 100 + random.integers(-30, 31, (side * side, 2))
        bends, lines, points = [], [], [tuple(p) for p in nodes.astype(float)]
        for x in range(side):
            for y in range(side):
                for u, v in ((x + 1, y), (x, y + 1)):
                    if u == side or v == side or random.random() < 0.15:
                        continue
                    a, b = nodes[x * side + y], nodes[u * side + v]
                    line = [x * side + y]
                    if random.random() < 0.2:  # a dead end
                        b = a + (b - a) * 0.4
                    for t in numpy.linspace(0, 1, random.integers(2, 9))[1:]:
                        if t == 1 and b is nodes[u * side + v]:
                            line.append(u * side + v)
                        else:
                            points.append(tuple(a + (b - a) * t + random.integers(-3, 4, 2) / 2))
                            line.append(len(points) - 1)
                    lines.append(line)
        points = numpy.array(points)
        beside = random.integers(-50, side * 100, (3000, 2)).astype(float)
        everything, first, inverse = numpy.unique(numpy.vstack([points, beside]), axis=0, return_index=True, return_inverse=True)
        number = numpy.asarray(inverse).ravel()
        lines = [[int(number[i]) for i in line] for line in lines]
        lines = [[i for k, i in enumerate(line) if k == 0 or line[k - 1] != i] for line in lines]
        self.compare("roads", everything, self.uncrossed(everything, [line for line in lines if len(line) > 1]))

    def uncrossed(self, points, lines):
        """Those lines that cross no other, by the extension's own list, which the tests of abacus_crossings compare."""
        rows = "".join(f"{n},{k},{points[i][0]!r},{points[i][1]!r}\n" for n, line in enumerate(lines) for k, i in enumerate(line))
        abacus.psql("DROP TABLE IF EXISTS crossing_rows; CREATE TABLE crossing_rows (line bigint, k int, x float8, y float8)")
        abacus.psql("COPY crossing_rows FROM STDIN (FORMAT csv)", rows.replace("np.float64(", "").replace(")", ""))
        abacus.store("crossing_points", ["x", "y"], points)
        abacus.psql("DROP TABLE IF EXISTS crossing CASCADE; SELECT abacus_triangulate('crossing', 'TABLE crossing_points')")
        crossed = {int(row[1]) for row in abacus.rows("SELECT line_a, line_b FROM abacus_crossings('crossing', 'TABLE crossing_rows')")}
        return [line for n, line in enumerate(lines) if n not in crossed]

    def test_coast(self):
        """A closed line of 5,000 vertices, that winds without crossing itself: radii of a star in order of the angle."""
        random = numpy.random.default_rng(5)
        n = 15000 if LARGE else 5000
        angle = numpy.arange(n) * 2 * math.pi / n
        walk = numpy.cumsum(random.normal(size=n))
        radius = 1 + 0.3 * numpy.sin(3 * angle) + 0.2 * (walk - walk[-1] * numpy.arange(n) / n) / numpy.abs(walk).max()
        coast = numpy.column_stack([radius * numpy.cos(angle), radius * numpy.sin(angle)]).round(6)
        points = numpy.vstack([coast, random.uniform(-2, 2, (n, 2))])
        self.assertEqual(len(unique(points)), len(points))
        self.compare("coast", points, [[*range(n), 0]])
        self.compare("coast alone, with every tenth point named", points, [[*range(0, n, 10), 0]] if not LARGE else [[*range(n), 0]])

    def test_dangling(self):
        """Lines whose ends lie inside of the cavities of others: many short ones beside long ones."""
        random = numpy.random.default_rng(6)
        y = numpy.repeat(numpy.arange(40), 2).astype(float)
        long = numpy.column_stack([numpy.tile([0.0, 100.0], 40), y])
        spikes, lines = [], [[2 * i, 2 * i + 1] for i in range(40)]
        for i in range(39):
            for x in numpy.sort(random.random(12)) * 90 + 5:
                spikes += [(x, i + 0.25), (x + random.random(), i + 0.75)] if random.random() < 0.5 else [(x, i + 0.5), (x + 0.2, i + 0.5)]
                lines.append([80 + len(spikes) - 2, 80 + len(spikes) - 1])
        points = numpy.vstack([long, spikes])
        self.assertEqual(len(unique(points)), len(points))
        self.compare("dangling", points, self.uncrossed(points, lines))
        # trees, each a corner where one line ends that no other goes on from
        n = 400
        points = numpy.column_stack([numpy.arange(n) % 20, numpy.arange(n) // 20]) + random.uniform(-0.3, 0.3, (n, 2))
        parent = [[i, i - 1] if i % 20 else [i, i - 20] for i in range(1, n)]
        self.compare("a comb", points, self.uncrossed(points, parent))

    def test_overlapping(self):
        """A segment twice, the other way round, parts of it, and lines that overlap partly."""
        points = numpy.array([(x, y) for x in range(13) for y in range(-3, 4)] + [(2.5, 0), (7.25, 0), (100, 0), (-50, 40)], dtype=float)
        at = lambda x: x * 7 + 3
        lines = [[at(0), at(12)], [at(12), at(0)], [at(3), at(8)], [at(6), 93], [at(5), at(4), at(6), at(2)], [91, 92], [at(1), at(12), at(1)], [94, at(0), 93]]
        self.compare("overlapping", points, lines, USUAL)

    def test_short(self):
        """Segments shorter than 1e-15 of the extent."""
        random = numpy.random.default_rng(7)
        tiny = random.integers(0, 30, (200, 2)) * 2.0 ** -60
        near = 1 + random.integers(0, 8, (60, 2)) * 2.0 ** -52  # neighbouring doubles
        points = unique(numpy.vstack([tiny, near, random.random((400, 2)) * 1e3, random.uniform(-1e-9, 1e-9, (300, 2))]))
        order = numpy.lexsort(points.T)
        is_tiny = numpy.flatnonzero((points >= 0).all(axis=1) & (points < 1e-16).all(axis=1))
        is_near = numpy.flatnonzero((numpy.abs(points - 1) < 1e-14).all(axis=1))
        lines = [[int(a), int(b)] for group in (is_tiny, is_near) for a, b in zip(group, group[1:])]
        lines += [[int(is_tiny[0]), int(order[-1])], [int(is_near[-1]), int(order[-5])]]
        self.assertGreater(self.compare("short", points, self.uncrossed(points, lines)), 100)

    def test_star(self):
        """A thousand segments in one vertex, with points between them, exactly on some of them, and far outside."""
        random = numpy.random.default_rng(8)
        angle = numpy.sort(random.choice(10 ** 6, 1000, replace=False)) * 2 * math.pi / 10 ** 6
        tips = (numpy.column_stack([numpy.cos(angle), numpy.sin(angle)]) * 1000).round(3)
        points = unique(numpy.vstack([[[0, 0]], tips, tips[::3] / 2, random.uniform(-1200, 1200, (2000, 2))]))
        index = {tuple(p): n for n, p in enumerate(points)}
        centre = index[0.0, 0.0]
        lines = [[centre, index[tuple(tip + 0.0)]] if n % 2 else [index[tuple(tip + 0.0)], centre] for n, tip in enumerate(tips)]
        self.compare("star", points, lines, USUAL)

    def test_line_alone(self):
        """As few points as span a triangle; lines along all of the hull; all points but one on a line."""
        self.compare("one triangle", numpy.array([(0.0, 0), (1, 0), (0, 1)]), [[0, 1, 2, 0]])
        self.compare("square, the diagonal that perturbation takes", numpy.array([(0.0, 0), (0, 1), (1, 0), (1, 1)]), [[1, 2]])
        self.compare("square, the other", numpy.array([(0.0, 0), (0, 1), (1, 0), (1, 1)]), [[0, 3]])
        points = numpy.array([(float(x), 0.0) for x in range(1000)] + [(499.5, 1.0)])
        self.compare("a row and one point", points, [[0, 999], [1000, 500]])


if __name__ == "__main__":
    unittest.main()
