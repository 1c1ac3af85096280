#!/usr/bin/python3
"""Rasters, profiles and lines of sight against SciPy and matplotlib."""
import unittest

import numpy
from matplotlib.tri import LinearTriInterpolator, Triangulation
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import Delaunay

import abacus


class Lines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        random = numpy.random.default_rng(4)
        cls.points = random.random((2000, 2)) * 100
        cls.heights = 10 * numpy.sin(cls.points[:, 0] / 9) + cls.points[:, 1] * 0.1
        abacus.triangulate("relief", cls.points, height=cls.heights)
        cls.theirs = LinearNDInterpolator(Delaunay(cls.points), cls.heights)

    def test_raster(self):
        width, height, lower, upper = 230, 170, (-10, -5), (105, 112)
        text = abacus.rows(f"SELECT \"values\" FROM abacus_raster('relief', '{{{lower[0]},{lower[1]}}}', '{{{upper[0]},{upper[1]}}}', "
                           f"{width}, {height}) ORDER BY \"row\"")
        ours = numpy.array([abacus.vector(row[0]) for row in text])
        x = lower[0] + (numpy.arange(width) + 0.5) * (upper[0] - lower[0]) / width
        y = upper[1] - (numpy.arange(height) + 0.5) * (upper[1] - lower[1]) / height
        x, y = numpy.meshgrid(x, y)
        triangulation = Triangulation(*self.points.T, triangles=abacus.simplices("relief"))
        for name, expected in ("SciPy", self.theirs(x, y)), \
                              ("matplotlib", LinearTriInterpolator(triangulation, self.heights)(x, y).filled(numpy.nan)):
            with self.subTest(oracle=name):
                numpy.testing.assert_array_equal(numpy.isnan(ours), numpy.isnan(expected))
                self.assertGreater(numpy.isfinite(ours).sum(), 10000)
                numpy.testing.assert_allclose(ours, expected, rtol=1e-9, atol=1e-9)

    def test_profile(self):
        ours = abacus.numbers("SELECT distance, x, y, value FROM abacus_profile('relief', '{-10, 20, 50, 50, 110, 30}')")
        self.assertGreater(len(ours), 100)
        self.assertTrue((numpy.diff(ours[:, 0]) >= 0).all())
        inside = numpy.isfinite(ours[:, 3])
        expected = self.theirs(ours[inside, 1:3])
        found = numpy.isfinite(expected)  # SciPy takes the hull for inside
        self.assertGreater(found.sum(), inside.sum() - 3)
        numpy.testing.assert_allclose(ours[inside, 3][found], expected[found], rtol=1e-9, atol=1e-9)
        # Nothing is lost between two rows: the values there are linear.
        part = numpy.linspace(ours[1, 0] + 1e-6, ours[-1, 0] - 1e-6, 5000)
        x, y, value = (numpy.interp(part, ours[:, 0], ours[:, k]) for k in (1, 2, 3))
        sampled = self.theirs(x, y)
        both = numpy.isfinite(sampled) & numpy.isfinite(value)
        self.assertGreater(both.sum(), 4000)
        numpy.testing.assert_allclose(value[both], sampled[both], rtol=1e-7, atol=1e-7)

    def test_lines_of_sight(self):
        random = numpy.random.default_rng(5)
        ends = random.random((200, 4)) * 60 + 20
        abacus.store("sights", ["ax", "ay", "bx", "by"], ends)
        ours = abacus.numbers("SELECT visible::int FROM sights, abacus_visible('relief', ARRAY[ax, ay], ARRAY[bx, by], observer_height => 3, "
                              "target_height => 1) ORDER BY id")[:, 0]
        part = numpy.linspace(0, 1, 4000)
        compared = 0
        for seen, (ax, ay, bx, by) in zip(ours, ends):
            ground = self.theirs(ax + part * (bx - ax), ay + part * (by - ay))
            sight = (ground[0] + 3) * (1 - part) + (ground[-1] + 1) * part
            clearance = (sight - ground).min()
            if abs(clearance) > 0.02:  # samples are precise enough
                compared += 1
                self.assertEqual(seen, clearance > 0)
        self.assertGreater(compared, 150)
        self.assertTrue(20 < ours.sum() < 180)


if __name__ == "__main__":
    unittest.main()
