#!/usr/bin/python3
"""Values between the vertices against SciPy."""
import unittest

import numpy
from scipy.interpolate import LinearNDInterpolator, NearestNDInterpolator
from scipy.spatial import Delaunay

import abacus


class Interpolation(unittest.TestCase):
    def compare(self, dimension, seed):
        random = numpy.random.default_rng(seed)
        points = random.random((500, dimension)) * 100
        heights = numpy.sin(points[:, 0] / 9) + points[:, 1] * 0.1
        places = random.random((2000, dimension)) * 120 - 10  # some are outside
        mesh = f"values_{dimension}d"
        abacus.triangulate(mesh, points, height=heights)
        columns = "xyz"[:dimension]
        abacus.store(f"{mesh}_places", columns, places)
        query = f"SELECT id, {', '.join(columns)} FROM {mesh}_places"
        for method, theirs in ("linear", LinearNDInterpolator(Delaunay(points), heights)), \
                              ("nearest", NearestNDInterpolator(points, heights)):
            outside = "null" if method == "linear" else "nearest"
            ours = abacus.numbers(f"SELECT values[1] FROM abacus_interpolate('{mesh}', '{query}', method => '{method}', "
                                  f"outside => '{outside}') ORDER BY id")[:, 0]
            expected = theirs(places)
            with self.subTest(method=method):
                numpy.testing.assert_array_equal(numpy.isnan(ours), numpy.isnan(expected))
                self.assertGreater(numpy.isfinite(ours).sum(), 500)
                numpy.testing.assert_allclose(ours, expected, rtol=1e-9, atol=1e-9)

    def test_in_the_plane(self):
        self.compare(2, 1)

    def test_in_space(self):
        self.compare(3, 2)


if __name__ == "__main__":
    unittest.main()
