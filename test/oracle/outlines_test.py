#!/usr/bin/python3
"""Regions of outlines against CGAL: triangles with an odd nesting level, in the constrained triangulation of the same points and lines. Rings
overlap, nest, touch, share edges, are given twice and in parts; points and lines come and go; whatever the order, threads and cache.

ABACUS_LARGE=1 takes more sets of rings."""
import os
import unittest

import numpy
from scipy.spatial import Delaunay

import abacus
from constrained_oracle import canonical, theirs

EXTENT = 8192
# threads, the tiny intervals that let few points use many threads, and the cache in MB: of a mesh that changes, and of a new one
SETTINGS = [((1, "off", 1), (3, "on", 64)), ((2, "on", 1), (1, "off", 64)), ((3, "on", 1), (2, "off", 1))]


def segments_of(line):
    """Segments of a line whatever their direction. Lines that have the same ones count once in a region."""
    return tuple(sorted(tuple(sorted(pair)) for pair in zip(line, line[1:])))


def odd_edges(triangles):
    """Sides of triangles that come an odd number of times, the lesser end first."""
    sides = numpy.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    sides, count = numpy.unique(sides, axis=0, return_counts=True)
    return sides[count % 2 == 1]


def rings_of(edges, random):
    """Edges of which an even number meets at each end, as closed lines, which may touch themselves."""
    ends = {}
    for a, b in random.permutation(edges):
        ends.setdefault(int(a), []).append(int(b))
        ends.setdefault(int(b), []).append(int(a))
    rings = []
    for start in ends:
        while ends[start]:
            ring = [start]
            while len(ring) == 1 or ring[-1] != start:
                following = ends[ring[-1]].pop()
                ends[following].remove(ring[-1])
                ring.append(following)
            rings.append(ring)
    return rings


class Ground:
    """Points with even coordinates that lines connect, other points, lines, and regions with outlines."""

    def __init__(self, random):
        self.random = random
        corners = numpy.unique(random.integers(0, EXTENT // 2, (90, 2)) * 2, axis=0).astype(float)
        coarse = Delaunay(corners).simplices
        edges = numpy.unique(numpy.sort(coarse[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
        self.lines, self.regions = [], {}
        # each region has its triangles in a quarter of them
        quarters = (corners[coarse].mean(axis=1) > EXTENT / 2) @ [1, 2]
        for region in range(4):
            self.outline(region, coarse[quarters == region])
        self.fixed = len(self.lines)  # those before are outlines
        self.lines += [list(map(int, edge)) for edge in random.permutation(edges)[:80]]
        # beside the corners: middles of edges, which are exact, and places anywhere, beyond the hull of the lines as well
        others = numpy.unique(numpy.vstack([corners[edges].mean(axis=1), random.integers(-300, EXTENT + 300, (2000, 2))]), axis=0)
        others = others[~(others[:, None] == corners).all(axis=2).any(axis=1)]
        self.points = numpy.vstack([corners, others])
        # when a point comes: first or later; and whether it goes
        self.later = (random.random(len(self.points)) < 0.5) & (numpy.arange(len(self.points)) >= len(corners))
        self.goes = (random.random(len(self.points)) < 0.3) & (numpy.arange(len(self.points)) >= len(corners))

    def outline(self, region, triangles):
        """Rings around four random parts of these triangles: what is inside of an odd number of them is inside."""
        random = self.random
        rings = [ring for _ in range(4) for ring in rings_of(odd_edges(triangles[random.random(len(triangles)) < 0.5]), random)]
        given, known = [], set()
        for ring in rings:
            cut = int(random.integers(1, len(ring) - 1))
            parts = [ring[:cut + 1], ring[cut:]]
            # a part that is given twice would count once, and leave a ring open
            if random.random() < 0.7 or known & set(map(segments_of, parts)):
                parts = [ring]
            given += parts
            known |= set(map(segments_of, parts))
        # the first one again, the other way round, and from another corner if it is closed
        again = given[0][::-1]
        given.append(again[1:] + [again[1]] if again[0] == again[-1] else again)
        self.regions[region] = list(range(len(self.lines), len(self.lines) + len(given)))
        self.lines += given

    def sides(self):
        """Sides of outlines by region, each line once, with those of equal segments."""
        result = []
        for region, lines in self.regions.items():
            result += [(region, a, b) for segments in {segments_of(self.lines[line]) for line in lines} for a, b in segments]
        return result


class Outlines(unittest.TestCase):
    def store(self, ground):
        abacus.store("outlined_points", ["x", "y", "later", "goes"], numpy.column_stack([ground.points, ground.later, ground.goes]))
        abacus.psql("DROP TABLE IF EXISTS outlined_rows, outlined_regions_given CASCADE; CREATE TABLE outlined_rows (line bigint, k int, id bigint);"
                    "CREATE TABLE outlined_regions_given (region text, line bigint)")
        abacus.psql("COPY outlined_rows FROM STDIN (FORMAT csv)", "".join(f"{n},{k},{i + 1}\n" for n, line in enumerate(ground.lines) for k, i in enumerate(line)))
        abacus.psql("COPY outlined_regions_given FROM STDIN (FORMAT csv)", "".join(f"{region},{line}\n" for region, lines in ground.regions.items() for line in lines))

    def run_with(self, setting, *statements):
        """The first statement takes many points, so it has no tiny intervals, with which threads are slow."""
        threads, tiny, cache = setting
        abacus.psql(f"SET abacus.threads = {threads}; SET abacus.cache_size = '{cache}MB'; {statements[0]}; SET abacus.tiny_intervals = {tiny};" + ";".join(statements[1:]))

    def expect(self, mesh, ground, there, lines):
        """The mesh has the points that are `there`, and these lines."""
        self.assertEqual(abacus.rows(f"SELECT * FROM abacus_check('{mesh}')"), [])
        kept = numpy.flatnonzero(there)
        number = numpy.full(len(there), -1)
        number[kept] = numpy.arange(len(kept))
        segments = number[[(a, b) for line in lines for a, b in zip(ground.lines[line], ground.lines[line][1:])]]
        sides = numpy.array(ground.sides())
        sides[:, 1:] = number[sides[:, 1:]]
        triangles, _, inside = theirs(ground.points[kept], segments, sides)
        numpy.testing.assert_array_equal(kept[triangles], canonical(abacus.simplices(mesh)))
        found = abacus.numbers(f"SELECT region, v0 - 1, v1 - 1, v2 - 1 FROM abacus_regions('{mesh}') AS r, abacus_simplices('{mesh}', r.region)").astype(int)
        for region in ground.regions:
            numpy.testing.assert_array_equal(canonical(found[found[:, 0] == region, 1:]), kept[inside[inside[:, 0] == region, 1:]])
        self.assertGreater(len(inside), 500)

    def test_outlines(self):
        for seed, (changing, new) in enumerate(SETTINGS * (10 if os.environ.get("ABACUS_LARGE") else 1)):
            with self.subTest(seed=seed, changing=changing, new=new):
                random = numpy.random.default_rng(seed)
                ground = Ground(random)
                self.store(ground)
                plain = range(ground.fixed, len(ground.lines))
                order = lambda: f"ORDER BY hashint8extended(id, {random.integers(10 ** 9)})"
                points = "SELECT id, x, y FROM outlined_points"
                rows = "SELECT * FROM outlined_rows"
                region = lambda mesh: f"SELECT abacus_region('{mesh}', 'TABLE outlined_regions_given ORDER BY hashint8extended(line, {random.integers(10 ** 9)})')"
                # some lines come before the regions, others after, and a third of all goes, in the midst of points that do
                first, gone = f"line < {ground.fixed} OR line % 2 = 0", f"line >= {ground.fixed} AND line % 3 = 0"
                abacus.psql("DROP TABLE IF EXISTS outlined, anew CASCADE")
                self.run_with(changing, f"SELECT abacus_triangulate('outlined', '{points} WHERE later = 0 {order()}')", f"SELECT abacus_constrain('outlined', '{rows} WHERE {first} {order()}')", region("outlined"))
                self.expect("outlined", ground, ~ground.later, [*range(ground.fixed), *(line for line in plain if line % 2 == 0)])
                self.run_with(changing, f"SELECT abacus_insert('outlined', '{points} WHERE later = 1 AND id % 2 = 0 {order()}')",
                              f"SELECT abacus_constrain('outlined', '{rows} WHERE NOT ({first}) {order()}')",
                              f"SELECT abacus_delete('outlined', '{points} WHERE goes = 1 AND (later = 0 OR id % 2 = 0) {order()}')",
                              f"SELECT abacus_unconstrain('outlined', 'SELECT DISTINCT line FROM outlined_rows WHERE {gone}')",
                              f"SELECT abacus_insert('outlined', '{points} WHERE later = 1 AND goes = 0 AND id % 2 = 1 {order()}')")
                kept = [*range(ground.fixed), *(line for line in plain if line % 3)]
                self.expect("outlined", ground, ~ground.goes, kept)
                self.run_with(new, f"SELECT abacus_triangulate('anew', '{points} WHERE goes = 0 {order()}', lines => '{rows} WHERE NOT ({gone}) {order()}')", region("anew"))
                self.expect("anew", ground, ~ground.goes, kept)


if __name__ == "__main__":
    unittest.main()
