#!/usr/bin/python3
"""What varies linearly in meshes with flat simplices, against fractions: they are exact, and coordinates are the doubles as they are stored."""
import itertools
import math
import os
import unittest
import unittest.mock
from fractions import Fraction

import numpy

import abacus


def determinant(m):
    if len(m) == 2:
        return m[0][0] * m[1][1] - m[0][1] * m[1][0]
    return sum(m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]) for i in range(3))


def fractions(point):
    return [Fraction(float(x)) for x in point]


def edges(corners):
    first, *others = map(fractions, corners)
    return [[a - b for a, b in zip(other, first)] for other in others]


def exact_weights(corners, place):
    """By Cramer's rule, of all corners; negative beyond the facet opposite."""
    matrix = edges(corners)
    whole = determinant(matrix)
    seen = [a - b for a, b in zip(fractions(place), fractions(corners[0]))]
    weights = [determinant([seen if k == i else row for k, row in enumerate(matrix)]) / whole for i in range(len(matrix))]
    return [1 - sum(weights), *weights]


def exact_gradient(corners, values):
    matrix = edges(corners)
    right = [Fraction(float(v)) - Fraction(float(values[0])) for v in values[1:]]
    whole = determinant(matrix)
    return [float(determinant([[r if k == axis else x for k, x in enumerate(row)] for row, r in zip(matrix, right)]) / whole)
            for axis in range(len(matrix))]


def turned_grid(n, angle):
    return numpy.array([(i * math.cos(angle) - j * math.sin(angle), i * math.sin(angle) + j * math.cos(angle))
                        for i in range(n) for j in range(n)])


def rational_lines(random):
    """Lines of points with the slopes 3, 1/3 and 7/9, which no doubles are exactly on, and some beside them."""
    lines = [(x * k * 0.1, y * k * 0.1) for x, y in ((1, 3), (3, 1), (9, 7)) for k in range(0, 60, 3)]
    return numpy.unique(numpy.array(lines + list(random.random((40, 2)) * 9)), axis=0)


def lattice(n, turn):
    """Sheared, or turned about two axes."""
    points = numpy.array(list(itertools.product(range(n), repeat=3)), dtype=float)
    if turn is None:
        i, j, k = points.T
        return numpy.column_stack([i + 0.1 * j + 0.3 * k, j + 0.7 * k, k * 0.9])
    c, s = math.cos(turn), math.sin(turn)
    return points @ numpy.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ numpy.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def needles(random, dimension):
    """Along a diagonal, a million times as long as wide."""
    along = random.random(80) * 1e6
    points = random.random((80, dimension))
    return points + along[:, None] * numpy.arange(1, dimension + 1)


# Factors of the coordinates in the linear value.
FACTORS = numpy.array([3.0, -2.0, 0.5])


class FlatValues(unittest.TestCase):
    def mesh_of(self, name, points):
        """With a value that is linear, and one that is not."""
        linear = points @ FACTORS[:points.shape[1]]
        other = (numpy.arange(len(points)) * 7919 % 1000).astype(float)
        abacus.triangulate(name, points, linear=linear, other=other)
        return linear, other

    def places_of(self, name, points):
        """Vertices, middles of edges, and places about in the inside; with the simplices that are found there, which are None outside."""
        dimension = points.shape[1]
        corners = abacus.simplices(name, dimension + 1)
        pairs = numpy.unique(numpy.sort(numpy.concatenate([corners[:, [i, j]] for i in range(dimension + 1) for j in range(i)]), axis=1), axis=0)
        middles = points[pairs[:, 0]] / 2 + points[pairs[:, 1]] / 2
        inside = points[corners[::5]].mean(axis=1)
        places = numpy.concatenate([points, middles, inside])
        columns = "xyz"[:dimension]
        abacus.store(f"{name}_places", columns, places)
        ids = ", ".join(f"v{i} - 1" for i in range(dimension + 1))
        found = abacus.numbers(f"SELECT {ids} FROM {name}_places AS p LEFT JOIN abacus_locate('{name}', 'SELECT * FROM {name}_places') AS s USING (id) ORDER BY id")
        return places, [None if numpy.isnan(row[0]) else row.astype(int) for row in found]

    def check_values(self, name, places, found, points, values, is_linear):
        column = "linear" if is_linear else "other"
        columns = ", ".join("xyz"[:points.shape[1]])
        single = abacus.numbers(f"SELECT abacus_interpolate('{name}', {columns}, '{column}') FROM {name}_places ORDER BY id")[:, 0]
        for threads in (1,) if is_linear else (1, 3):
            with unittest.mock.patch.dict(os.environ, PGOPTIONS=f"-c abacus.threads={threads} -c abacus.tiny_intervals=on"):
                bulk = abacus.numbers(f"SELECT values[1] FROM {name}_places LEFT JOIN abacus_interpolate('{name}', 'SELECT * FROM {name}_places', "
                                      f"attributes => '{{{column}}}') AS v USING (id) ORDER BY id")[:, 0]
            numpy.testing.assert_array_equal(single, bulk)
        extent = values.max() - values.min()
        for n, (place, simplex) in enumerate(zip(places, found)):
            if simplex is None:
                self.assertTrue(numpy.isnan(single[n]))
                continue
            weights = self.weights[n]
            exact = sum(w * Fraction(float(v)) for w, v in zip(weights, values[simplex]))
            is_sharp = n < len(points) or is_linear or sorted(weights)[-2:] == [Fraction(1, 2)] * 2
            self.assertLessEqual(abs(float(exact - Fraction(single[n]))), (1e-9 if is_sharp else 1e-6) * extent, (name, column, place))

    def check_weights(self, name, places, found, points):
        rows = abacus.numbers(f"SELECT id, vertex - 1, weight FROM abacus_weights('{name}', 'SELECT * FROM {name}_places')")
        ours = [{} for _ in places]
        for place, vertex, weight in rows:
            ours[int(place) - 1][int(vertex)] = weight
        extent = (points.max(axis=0) - points.min(axis=0)).max()
        for n, simplex in enumerate(found):
            if simplex is None:
                self.assertEqual(ours[n], {})
                continue
            exact = {vertex: weight for vertex, weight in zip(simplex, self.weights[n]) if weight != 0}
            self.assertEqual(set(ours[n]), set(exact), (name, places[n]))
            self.assertTrue(all(weight > 0 for weight in ours[n].values()))
            self.assertAlmostEqual(sum(ours[n].values()), 1, delta=1e-15)
            mean = sum(points[vertex] * weight for vertex, weight in ours[n].items())
            self.assertLessEqual(abs(mean - places[n]).max(), 1e-9 * extent)

    def check_gradients(self, name, found, points, values):
        columns = ", ".join("xyz"[:points.shape[1]])
        rows = abacus.rows(f"SELECT abacus_gradient('{name}', {columns}, 'other') FROM {name}_places ORDER BY id")
        expected = {}
        for (text,), simplex in zip(rows, found):
            if simplex is None:
                self.assertEqual(text, "NULL")
                continue
            key = tuple(simplex)
            if key not in expected:
                expected[key] = exact_gradient(points[simplex], values[simplex])
            self.assertEqual(list(abacus.vector(text)), expected[key])

    def check_profiles(self, name, places):
        """From one place to the next: it begins and ends with the values there."""
        def array(*corners):
            return "{" + ",".join(repr(float(x)) for corner in corners for x in corner) + "}"

        def value_at(place):
            return f"abacus_interpolate('{name}', {','.join(repr(float(x)) for x in place)}, 'other')"

        ends = abacus.rows(" UNION ALL ".join(
            f"(SELECT p[1], p[cardinality(p)], {value_at(a)}, {value_at(b)} FROM "
            f"(SELECT array_agg(value) AS p FROM abacus_profile('{name}', '{array(a, b)}', 'other')) AS t)"
            for a, b in zip(places[::37], places[5::37])))
        for first, last, *expected in ends:
            self.assertEqual([first, last], expected)

    def check_places(self, name, points, linear):
        """Profiles, a raster and contours, in space a surface: what is linear has the value there that its place tells."""
        dimension = points.shape[1]
        least, most = points.min(axis=0), points.max(axis=0)
        extent = linear.max() - linear.min()
        level = numpy.quantile(linear, 0.4)

        def array(*places):
            return "{" + ",".join(repr(float(x)) for place in places for x in place) + "}"

        def compare(places, values):
            self.assertGreater(len(places), 5)
            self.assertLessEqual(abs(places @ FACTORS[:dimension] - values).max(), 1e-9 * extent)

        paths = [array(points[i], points[-1 - i], (least + most) / 2) for i in range(0, len(points) // 2, 9)]
        rows = abacus.numbers(" UNION ALL ".join(f"SELECT {', '.join('xyz'[:dimension])}, value FROM abacus_profile('{name}', '{path}', 'linear')"
                                                 for path in paths))
        rows = rows[numpy.isfinite(rows[:, -1])]
        compare(rows[:, :-1], rows[:, -1])
        if dimension == 2:
            text = abacus.rows(f"SELECT \"values\" FROM abacus_raster('{name}', '{array(least)}', '{array(most)}', 30, 30, 'linear') ORDER BY \"row\"")
            values = numpy.array([abacus.vector(row[0]) for row in text])
            steps = (numpy.arange(30) + 0.5) / 30
            x, y = numpy.meshgrid(least[0] + steps * (most[0] - least[0]), most[1] - steps * (most[1] - least[1]))
            inside = numpy.isfinite(values)
            compare(numpy.column_stack([x[inside], y[inside]]), values[inside])
            lines = abacus.rows(f"SELECT path FROM abacus_contours('{name}', fixed_levels => '{array([level])}', attribute => 'linear')")
        else:
            lines = abacus.rows(f"SELECT corners FROM abacus_isosurface('{name}', {float(level)!r}, 'linear')")
        compare(numpy.concatenate([abacus.vector(row[0], dimension) for row in lines]), level)

    def check(self, name, points):
        linear, other = self.mesh_of(name, points)
        places, found = self.places_of(name, points)
        self.weights = [None if simplex is None else exact_weights(points[simplex], place) for place, simplex in zip(places, found)]
        for weights in self.weights:
            self.assertTrue(weights is None or min(weights) >= 0)
        self.assertTrue(all(simplex is not None for simplex in found[:len(points)]))
        self.check_values(name, places, found, points, linear, True)
        self.check_values(name, places, found, points, other, False)
        self.check_weights(name, places, found, points)
        self.check_gradients(name, found, points, other)
        self.check_profiles(name, places)
        self.check_places(name, points, linear)

    def test_turned_grids(self):
        for angle in (0.1, 0.5):
            with self.subTest(angle=angle):
                self.check("turned", turned_grid(12, angle))

    def test_lines_of_rational_slope(self):
        self.check("slopes", rational_lines(numpy.random.default_rng(1)))

    def test_lattices(self):
        for turn in (None, 0.5):
            with self.subTest(turn=turn):
                self.check("lattice", lattice(4, turn))

    def test_small_and_large(self):
        """Products underflow and overflow."""
        for exponent in (-600, 900):
            with self.subTest(exponent=exponent):
                self.check("scaled", turned_grid(6, 0.5) * 2.0 ** exponent)
                self.check("scaled_space", lattice(3, 0.5) * 2.0 ** exponent)

    def test_needles(self):
        for dimension in (2, 3):
            with self.subTest(dimension=dimension):
                self.check("needles", needles(numpy.random.default_rng(2), dimension))


if __name__ == "__main__":
    unittest.main()
