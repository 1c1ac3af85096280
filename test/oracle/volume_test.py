#!/usr/bin/python3
"""Areas and volumes against rational arithmetic over all pairs of triangles, against solids whose volume is known, and by identities."""
import math
import unittest
from fractions import Fraction

import numpy

import abacus


def measure(arguments):
    """The row of abacus_volume: area, surface, cut, fill, net."""
    return abacus.numbers(f"SELECT * FROM abacus_volume({arguments})")[0]


def clip(polygon, side):
    """The part of a convex polygon where a linear function of its corners is not negative."""
    part = []
    for a, b in zip(polygon, polygon[1:] + polygon[:1]):
        at_a, at_b = side(a), side(b)
        if at_a >= 0:
            part.append(a)
        if at_a * at_b < 0:
            share = at_a / (at_a - at_b)
            part.append(tuple(p + (q - p) * share for p, q in zip(a, b)))
    return part


def turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def integrals(polygon):
    """Area, and volume below the heights."""
    fans = [(polygon[0], b, c) for b, c in zip(polygon[1:], polygon[2:])]
    return sum((turn(*fan) / 2 for fan in fans), Fraction(0)), sum((turn(*fan) * sum(p[2] for p in fan) / 6 for fan in fans), Fraction(0))


def plane_at(triangle, x, y):
    a, b, c = triangle
    p = (x, y)
    return (turn(p, b, c) * a[2] + turn(a, p, c) * b[2] + turn(a, b, p) * c[2]) / turn(a, b, c)


def exact(polygons):
    """Area, cut and fill of polygons with heights, without any rounding but the last."""
    area = cut = fill = Fraction(0)
    for polygon in polygons:
        area += integrals(polygon)[0]
        cut += integrals(clip(polygon, lambda p: p[2]))[1]
        fill -= integrals(clip(polygon, lambda p: -p[2]))[1]
    return [float(area), float(cut), float(fill)]


def windowed(polygons, window):
    if window:
        x0, y0, x1, y1 = map(Fraction, window)
        for side in (lambda p: p[0] - x0), (lambda p: x1 - p[0]), (lambda p: p[1] - y0), (lambda p: y1 - p[1]):
            polygons = [clip(polygon, side) for polygon in polygons]
    return [polygon for polygon in polygons if polygon]


def array(values):
    return "'{" + ",".join(repr(float(v)) for v in values) + "}'"


class Volume(unittest.TestCase):
    def mesh(self, name, points, heights):
        abacus.triangulate(name, points, height=heights)
        corners = [tuple(map(Fraction, (*point, height))) for point, height in zip(points.tolist(), heights.tolist())]
        return [[corners[i] for i in simplex] for simplex in abacus.simplices(name)]

    def expect(self, arguments, polygons):
        row = measure(arguments)
        numpy.testing.assert_allclose(row[[0, 2, 3]], exact(polygons), rtol=1e-12, atol=1e-12, err_msg=arguments)
        self.assertEqual(row[4], row[2] - row[3])

    def test_against_rational_arithmetic(self):
        random = numpy.random.default_rng(1)
        loose = random.random((60, 2))
        grid = numpy.array([(x, y) for x in range(7) for y in range(7)]) / 8 + 0.1
        meshes = {"loose": self.mesh("volume_loose", loose, numpy.sin(9 * loose[:, 0])),
                  "grid": self.mesh("volume_grid", grid, random.integers(-3, 4, 49) / 4),
                  "small": self.mesh("volume_small", loose[:20] / 4 + 0.5, random.random(20) - 0.5)}
        for window in None, (0.2, 0.3, 0.6, 0.9), (0.225, 0.1, 0.35, 0.475):
            bounds = f", lower => {array(window[:2])}, upper => {array(window[2:])}" if window else ""
            for name, triangles in meshes.items():
                for base in 0.0, 0.25, 5.0:
                    raised = [[(x, y, z - Fraction(base)) for x, y, z in t] for t in triangles]
                    self.expect(f"'volume_{name}', {base}{bounds}", windowed(raised, window))
            for first in meshes:
                for second in meshes:
                    both = []
                    for a in meshes[first]:
                        for b in meshes[second]:
                            part = a
                            for i in range(3):
                                part = clip(part, lambda p: turn(b[i], b[(i + 1) % 3], p)) if part else part
                            if part:
                                both.append([(x, y, z - plane_at(b, x, y)) for x, y, z in part])
                    self.expect(f"'volume_{first}', 'volume_{second}'{bounds}", windowed(both, window))

    def disc(self, name, rings, height):
        """A disc of radius 1: points on circles, and the middle."""
        points = [(0.0, 0.0)]
        for ring in range(1, rings + 1):
            for k in range(6 * ring):
                angle = 2 * math.pi * (k + ring % 2 / 2) / (6 * ring)
                points.append((ring / rings * math.cos(angle), ring / rings * math.sin(angle)))
        points = numpy.array(points)
        abacus.triangulate(name, points, height=height(numpy.hypot(points[:, 0], points[:, 1])))

    def test_solids_that_are_known(self):
        for name, height, volume, surface in ("cone", lambda r: 1 - r, math.pi / 3, math.pi * math.sqrt(2)), \
                                             ("paraboloid", lambda r: 1 - r * r, math.pi / 2, math.pi / 6 * (5 * math.sqrt(5) - 1)):
            errors = []
            for rings in 6, 12, 24:
                self.disc("volume_disc", rings, height)
                row = measure("'volume_disc', 0")
                self.assertEqual(row[3], 0)
                errors.append([abs(row[0] - math.pi), abs(row[1] - surface), abs(row[2] - volume)])
            ratios = numpy.array(errors[:-1]) / numpy.array(errors[1:])
            self.assertTrue((ratios > 3).all(), (name, ratios))  # with the square of the distance between points
            self.assertLess(errors[-1][2], 0.01)

    def test_bases_at_the_ends(self):
        random = numpy.random.default_rng(2)
        points = random.random((4000, 2)) * 1000 + 5e6
        heights = numpy.cos(points[:, 0] / 90) * 40 + 700
        abacus.triangulate("volume_hills", points, height=heights)
        low, middle, high = (measure(f"'volume_hills', {base!r}") for base in (float(heights.min()), 700.0, float(heights.max())))
        self.assertEqual(low[3], 0)
        self.assertEqual(high[2], 0)
        self.assertEqual(len({tuple(row[:2]) for row in (low, middle, high)}), 1)
        numpy.testing.assert_allclose(low[2] + high[3], low[0] * (heights.max() - heights.min()), rtol=1e-12)
        numpy.testing.assert_allclose(middle[4] - low[4], low[0] * (heights.min() - 700), rtol=1e-12)
        numpy.testing.assert_array_equal(measure("'volume_hills', 'volume_hills'")[2:], [0, 0, 0])

    def test_tilted_planes(self):
        random = numpy.random.default_rng(3)
        first, second = random.random((900, 2)) * 64, random.random((700, 2)) * 64
        corners = numpy.array([(0, 0), (64, 0), (64, 64), (0, 64)])
        first, second = numpy.vstack([first, corners]), numpy.vstack([second, corners])
        abacus.triangulate("volume_plane", first, height=first[:, 0] / 4 - first[:, 1] / 8)
        abacus.triangulate("volume_level", second, height=second[:, 0] / 8 + second[:, 1] / 8 + 1)
        row = measure("'volume_plane', 'volume_level'")
        # x / 8 - y / 4 - 1 over a square of side 64: above 0 on the triangle (8, 0), (64, 0), (64, 28)
        above = 56 * 28 / 2 * (7 / 3)
        net = 64 * 64 * (64 / 16 - 64 / 8 - 1)
        numpy.testing.assert_allclose(row, [4096, 4096 * math.sqrt(1 + 1 / 16 + 1 / 64), above, above - net, net], rtol=1e-12)

    def test_parts_of_space(self):
        random = numpy.random.default_rng(4)
        points = numpy.vstack([random.random((2000, 3)) * 2 - 1, numpy.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])])
        abacus.triangulate("volume_ball", points, depth=0.8 - numpy.sqrt((points ** 2).sum(axis=1)))
        volume, surface, cut, fill, net = measure("'volume_ball', 0")
        numpy.testing.assert_allclose([volume, cut + fill], [8, 8], rtol=1e-12)
        numpy.testing.assert_allclose([cut, surface], [4 / 3 * math.pi * 0.8 ** 3, 4 * math.pi * 0.64], rtol=0.05)
        self.assertEqual(net, cut - fill)


if __name__ == "__main__":
    unittest.main()
