"""What is within a polygon, against exact fractions: places, edges and triangles, where polygons touch vertices and edges of the mesh or
miss them by the last digit."""
import math
import unittest
from fractions import Fraction

import numpy

import abacus


def turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def exact(place):
    return tuple(map(Fraction, place))


class Exactly:
    """Rings of places; inside is what an odd number of them goes around."""

    def __init__(self, rings):
        self.edges = [(exact(ring[n - 1]), exact(place)) for ring in rings for n, place in enumerate(ring)]

    def side(self, p):
        odd = False
        for a, b in self.edges:
            if max(a[1], b[1]) < p[1] or p[1] < min(a[1], b[1]) or max(a[0], b[0]) < p[0]:
                continue
            where = turn(a, b, p)
            if where == 0 and min(a[0], b[0]) <= p[0] <= max(a[0], b[0]):
                return 0
            if (a[1] > p[1]) != (b[1] > p[1]) and (b[1] > a[1]) == (where > 0):
                odd = not odd
        return 1 if odd else -1

    def has_stretch(self, a, b):
        shares = {Fraction(0), Fraction(1)}
        axis = 0 if a[0] != b[0] else 1
        for c, d in self.edges:
            at_c, at_d, at_a, at_b = turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)
            shares.update((end[axis] - a[axis]) / (b[axis] - a[axis]) for end, at in ((c, at_c), (d, at_d)) if at == 0)
            if at_c * at_d < 0 and at_a * at_b < 0:
                shares.add(at_a / (at_a - at_b))
        inside = sorted(share for share in shares if 0 <= share <= 1)
        middles = ((s + t) / 2 for s, t in zip(inside, inside[1:]))
        return any(self.side(tuple(a[i] + (b[i] - a[i]) * t for i in range(2))) >= 0 for t in middles)

    def has_part(self, corners):
        """Of a counterclockwise triangle: its middle is inside, or an edge comes into it."""
        if self.side(tuple(sum(corner[i] for corner in corners) / 3 for i in range(2))) > 0:
            return True
        for c, d in self.edges:
            begin, end = Fraction(0), Fraction(1)
            for n in range(3):
                at_c, at_d = turn(corners[n - 1], corners[n], c), turn(corners[n - 1], corners[n], d)
                if at_c <= 0 and at_d <= 0:
                    end = begin
                elif at_c < 0:
                    begin = max(begin, at_c / (at_c - at_d))
                elif at_d < 0:
                    end = min(end, at_c / (at_c - at_d))
            if begin < end:
                return True
        return False


def star(random, middle, corners, step):
    """Corners on a grid, in the order of their directions from the middle, all of which differ."""
    places = {}
    for x, y in numpy.round(random.uniform(-6, 6, (corners, 2)) / step) * step:
        if (x, y) != (0, 0):
            places[math.atan2(y, x)] = (middle[0] + x, middle[1] + y)
    ring = [places[angle] for angle in sorted(places)]
    gaps = numpy.diff([*sorted(places), min(places) + 2 * math.pi])
    return ring if len(ring) > 2 and gaps.max() < 3 else star(random, middle, corners, step)


def text(rings):
    return "POLYGON(" + ", ".join("(" + ", ".join(f"{float(x)!r} {float(y)!r}" for x, y in [*ring, ring[0]]) + ")" for ring in rings) + ")"


class Polygons(unittest.TestCase):
    def agree(self, mesh, points, polygons):
        exactly = {n: exact(place) for n, place in enumerate(points, 1)}
        edges = [tuple(map(int, row)) for row in abacus.numbers(f"SELECT v0, v1 FROM abacus_edges('{mesh}')")]
        triangles = [tuple(map(int, row)) for row in abacus.numbers(f"SELECT v0, v1, v2 FROM abacus_simplices('{mesh}')")]
        found = 0
        for rings in polygons:
            polygon, within = Exactly(rings), f"within => '{text(rings)}'"
            with self.subTest(within):
                self.assertEqual({tuple(map(int, row)) for row in abacus.numbers(f"SELECT v0, v1 FROM abacus_edges('{mesh}', {within})").reshape(-1, 2)},
                                 {edge for edge in edges if polygon.has_stretch(exactly[edge[0]], exactly[edge[1]])})
                parts = {three for three in triangles if polygon.has_part([exactly[n] for n in three])}
                self.assertEqual({tuple(map(int, row)) for row in abacus.numbers(f"SELECT v0, v1, v2 FROM abacus_simplices('{mesh}', {within})").reshape(-1, 3)}, parts)
                self.assertEqual({int(row[0]) for row in abacus.numbers(f"SELECT id FROM {mesh}_points WHERE abacus_interpolate('{mesh}', x, y, {within}) IS NOT NULL").reshape(-1, 1)},
                                 {n for n, place in exactly.items() if polygon.side(place) >= 0})
                found += len(parts)
        self.assertGreater(found, len(triangles))

    def polygons(self, random, step):
        made = []
        while len(made) < 4:
            outer = star(random, (5, 5), 9, step)
            hole = [(5 + x / 4, 5 + y / 4) for x, y in ((1, -1), (0, 1), (-1, -1))]
            rings = [outer, hole] if all(Exactly([outer]).side(exact(place)) > 0 for place in hole) else [outer]
            if abacus.rows(f"SELECT ST_IsValid('{text(rings)}'::geometry)") == [["t"]]:
                made.append(rings)
        return made

    def test_on_a_grid(self):
        abacus.psql("CREATE EXTENSION IF NOT EXISTS postgis")
        points = numpy.array([(x, y) for x in range(11) for y in range(11)], float)
        abacus.triangulate("squares", points, h=points[:, 0])
        random = numpy.random.default_rng(4)
        for step in (1, 0.5, 1e-9):
            self.agree("squares", points, self.polygons(random, step))

    def test_at_random(self):
        random = numpy.random.default_rng(5)
        points = random.uniform(0, 10, (150, 2))
        abacus.psql("CREATE EXTENSION IF NOT EXISTS postgis")
        abacus.triangulate("anywhere", points, h=points[:, 0])
        vertices = [[tuple(place) for place in points[:3]]]
        self.agree("anywhere", points, [vertices, *self.polygons(random, 1e-9)])


if __name__ == "__main__":
    unittest.main()
