#!/usr/bin/python3
"""Contours and bands against matplotlib's tricontour and tricontourf over the same triangles, and against themselves: windows side by side
give what the whole gives."""
import collections
import unittest

import matplotlib

matplotlib.use("Agg")

import numpy
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation

import abacus

Line = collections.namedtuple("Line", "id value closed path")


def contours(mesh, arguments):
    found = abacus.rows(f"SELECT id, value, closed, path FROM abacus_contours('{mesh}', {arguments})")
    return [Line(int(row[0]), float(row[1]), row[2] == "t", abacus.vector(row[3], 2)) for row in found]


def length(path):
    return numpy.hypot(*numpy.diff(path, axis=0).T).sum()


def area(ring):
    x, y = (ring - ring[0]).T
    return (x[:-1] * y[1:] - x[1:] * y[:-1]).sum() / 2


def drawn(function, triangles, values, levels):
    """What matplotlib draws: by level, or by band."""
    return getattr(Figure().subplots(), function)(triangles, values, levels=levels)


def distinct(path):
    """The points of a line, without those that differ by rounding only."""
    return {tuple(point) for point in numpy.round(path, 6) + 0.0}


def total(lines, measure):
    sums = collections.Counter()
    for line in lines:
        sums[line.value] += measure(line.path)
    return sums


class Contours(unittest.TestCase):
    # name: a function from a seed to points and their values
    sets = {
        "smooth": lambda random: (points := random.random((3000, 2)) * 50,
                                  12 * numpy.sin(points[:, 0] / 4) * numpy.cos(points[:, 1] / 5) + 0.1 * points[:, 0]),
        "noise": lambda random: (random.random((2000, 2)) * 50, random.normal(size=2000) * 6),
        # values that are levels, and points in rows
        "steps": lambda random: (numpy.stack(numpy.meshgrid(numpy.arange(40.0), numpy.arange(40.0)), -1).reshape(-1, 2),
                                 random.integers(-3, 4, 1600).astype(float)),
    }

    def make(self, name, seed=1):
        points, values = self.sets[name](numpy.random.default_rng(seed))
        abacus.triangulate(name, points, height=values)
        return points, values, Triangulation(points[:, 0], points[:, 1], abacus.simplices(name))

    def compare_lines(self, name, values, triangles, arguments=""):
        levels = numpy.arange(-20.0, 21.0, 2.0)
        theirs = drawn("tricontour", triangles, values, levels)
        ours = contours(name, f"fixed_levels => '{{{','.join(map(str, levels))}}}'{arguments}")
        compared = 0
        for level, lines in zip(theirs.levels, theirs.allsegs):
            # a line with a single point does not count
            expected = sorted((sorted(distinct(line)) for line in lines if len(distinct(line)) > 1))
            found = [line.path for line in ours if line.value == level]
            self.assertEqual(sorted(sorted(distinct(path)) for path in found), expected)
            self.assertAlmostEqual(sum(map(length, found)), sum(map(length, lines)), 6)
            compared += len(found)
        self.assertEqual(compared, len(ours))
        self.assertGreater(compared, 20)
        return ours

    def test_lines_are_those_of_tricontour(self):
        for name in self.sets:
            with self.subTest(name):
                _, values, triangles = self.make(name)
                for line in self.compare_lines(name, values, triangles):
                    self.assertEqual(line.closed, bool((line.path[0] == line.path[-1]).all()) and line.closed)

    def test_long_edges_and_missing_values_end_lines(self):
        points, values, triangles = self.make("smooth")
        corners = points[triangles.triangles]
        longest = max(numpy.hypot(*(corners - numpy.roll(corners, 1, 1)).T).T.max(1)) / 3
        edges = numpy.hypot(*numpy.moveaxis(corners - numpy.roll(corners, 1, 1), 2, 0))
        triangles.set_mask((edges > longest).any(1))
        self.assertTrue(triangles.mask.any())
        self.compare_lines("smooth", values, triangles, f", max_edge => {float(longest)!r}")
        gone = values.copy()
        gone[::50] = numpy.nan
        abacus.triangulate("gaps", points, height=gone)
        triangles.set_mask(numpy.isnan(gone[triangles.triangles]).any(1))
        self.compare_lines("gaps", numpy.nan_to_num(gone), triangles)

    def test_higher_ground_is_on_the_right(self):
        abacus.triangulate("cone", numpy.array([[0, 0], [9, 0], [9, 9], [0, 9], [4, 5.0]]), height=numpy.array([0, 0, 0, 0, 10.0]))
        for line in contours("cone", "3"):
            if line.value > 0:
                self.assertTrue(line.closed)
                self.assertLess(area(line.path), 0)

    def test_bands_have_the_areas_of_tricontourf(self):
        for name in self.sets:
            with self.subTest(name):
                _, values, triangles = self.make(name)
                levels = numpy.arange(-40.0, 41.0, 2.5)
                if name != "steps":  # tricontourf shifts levels that equal values
                    theirs = drawn("tricontourf", triangles, values, levels)
                    expected = {}
                    for level, polygons, kinds in zip(theirs.levels, theirs.allsegs, theirs.allkinds):
                        starts = [numpy.flatnonzero(kind == 1).tolist() + [len(kind)] for kind in kinds]
                        expected[level] = sum(area(numpy.vstack([polygon[a:b], polygon[a:a + 1]]))
                                              for polygon, at in zip(polygons, starts) for a, b in zip(at, at[1:]))
                    found = total(contours(name, "2.5, polygonize => true"), area)
                    for level, wanted in expected.items():
                        self.assertAlmostEqual(found[level], wanted, 6)
                corners = triangles.triangles
                whole = sum(abs(area(numpy.column_stack([triangles.x[c], triangles.y[c]])[[0, 1, 2, 0]])) for c in corners)
                rings = contours(name, "1, polygonize => true")
                self.assertAlmostEqual(sum(area(ring.path) for ring in rings), whole, 6)
                seen = set()
                for ring in rings:
                    points = [tuple(point) for point in ring.path]
                    self.assertEqual(points[0], points[-1])
                    self.assertEqual(len(set(points)), len(points) - 1)  # no point twice
                    if ring.value not in seen:
                        self.assertGreater(area(ring.path), 0)  # the first ring of a band is an outline
                    seen.add(ring.value)

    def test_windows_fit_at_their_seams(self):
        for name in self.sets:
            self.make(name)
            with self.subTest(name):
                for polygonize, measure in (False, length), (True, area):
                    arguments = f"2, 0.5, polygonize => {polygonize}"
                    whole = total(contours(name, arguments), measure)
                    parts, seams = collections.Counter(), {}
                    for i in range(-1, 6):
                        for j in range(-1, 6):
                            lower, upper = (10 * i, 10 * j), (10 * i + 10, 10 * j + 10)
                            lines = contours(name, f"{arguments}, lower => '{{{lower[0]},{lower[1]}}}', upper => '{{{upper[0]},{upper[1]}}}'")
                            parts.update(total(lines, measure))
                            for x in lower[0], upper[0]:
                                seams[x, j, x == lower[0]] = {(line.value, *point) for line in lines for point in line.path if point[0] == x}
                    for value, wanted in whole.items():
                        self.assertAlmostEqual(parts[value], wanted, 6)
                    for (x, j, is_lower), points in seams.items():
                        if (x, j, not is_lower) in seams and name != "steps":
                            self.assertEqual(points, seams[x, j, not is_lower])


if __name__ == "__main__":
    unittest.main()
