#!/usr/bin/python3
"""abacus_compare against rational arithmetic over all pairs of simplices, in the plane and in space: the greatest difference and its place are the
nearest doubles, whatever the order of the points and the size of the cache; means are near. Small and large units come out as others do."""
import itertools
import math
import unittest
from fractions import Fraction

import numpy

import abacus


def determinant(rows):
    if len(rows) == 1:
        return rows[0][0]
    return sum((-1) ** i * row[0] * determinant([other[1:] for j, other in enumerate(rows) if j != i]) for i, row in enumerate(rows) if row[0])


def less(p, q):
    return [a - b for a, b in zip(p, q)]


def volume(corners):
    """With its sign; corners are places, perhaps with a value behind."""
    d = len(corners) - 1
    return Fraction(determinant([less(c[:d], corners[0][:d]) for c in corners[1:]])) / math.factorial(d)


def split(simplex, side):
    """Simplices that make up the part of one where a linear function of its corners is not negative."""
    sides = [side(c) for c in simplex]
    kept = [i for i, s in enumerate(sides) if s >= 0]
    left = [i for i, s in enumerate(sides) if s < 0]
    if not kept or not left:
        return [simplex] if kept else []

    def between(a, b):
        share = sides[a] / (sides[a] - sides[b])
        return tuple(p + share * (q - p) for p, q in zip(simplex[a], simplex[b]))

    if len(kept) == 1:
        return [[simplex[kept[0]], *(between(kept[0], b) for b in left)]]
    if len(left) == 1:
        below, above = [simplex[a] for a in kept], [between(a, left[0]) for a in kept]
    else:
        below, above = ([simplex[a], *(between(a, b) for b in left)] for a in kept)
    return [below[:i + 1] + above[i:] for i in range(len(below))]


def cut(simplices, side):
    return [part for simplex in simplices for part in split(simplex, side) if volume(part)]


class Mesh:
    """Its simplices, with corners in positive order and their values behind the coordinates."""

    def __init__(self, name, dimension):
        query = ", ".join(f"corners[{i}][{axis}]" for i in range(1, dimension + 2) for axis in range(1, dimension + 1))
        values = {tuple(row[:-1]): row[-1] for row in abacus.numbers(f"SELECT {', '.join('xyz'[:dimension])}, attributes[1] FROM abacus_vertices('{name}')").tolist()}
        self.name, self.dimension, self.simplices = name, dimension, []
        for row in abacus.numbers(f"SELECT {query} FROM abacus_cells('{name}')").tolist():
            corners = [tuple(row[i:i + dimension]) for i in range(0, len(row), dimension)]
            numbers = [values[corner] for corner in corners]
            if not any(map(math.isnan, numbers)):
                self.simplices.append([tuple(map(Fraction, (*corner, number))) for corner, number in zip(corners, numbers)])


def at(simplex, p):
    """The value of the function of a simplex, continued."""
    d = len(simplex) - 1
    places, whole = [c[:d] for c in simplex], volume(simplex)
    return sum(volume(places[:i] + [p[:d]] + places[i + 1:]) / whole * c[d] for i, c in enumerate(simplex))


def boxes_meet(a, b, d):
    return all(max(c[i] for c in a) > min(c[i] for c in b) and max(c[i] for c in b) > min(c[i] for c in a) for i in range(d))


def pieces(first, second, window):
    d = first.dimension
    found = []
    for a, b in itertools.product(first.simplices, second.simplices):
        if not boxes_meet(a, b, d):
            continue
        parts = [a]
        for i in range(d + 1):
            facet = [c[:d] for j, c in enumerate(b) if j != i]
            sign = 1 if volume(facet + [b[i][:d]]) > 0 else -1
            parts = cut(parts, lambda p: sign * volume(facet + [p[:d]]))
        for i, (low, high) in enumerate(window or ()):
            parts = cut(cut(parts, lambda p: p[i] - low), lambda p: high - p[i])
        found += [[(*c[:d], c[d] - at(b, c)) for c in part] for part in parts]
    return found


def comparison(found, d):
    """Greatest difference, place, mean, mean absolute value, root of the mean square."""
    size = total = absolute = squares = Fraction(0)
    for part in found:
        amount, values = abs(volume(part)), [c[d] for c in part]
        size += amount
        total += amount * sum(values) / (d + 1)
        squares += amount * (sum(v * v for v in values) + sum(values) ** 2) / ((d + 1) * (d + 2))
        for sign in 1, -1:
            for half in cut([part], lambda p: sign * p[d]):
                absolute += abs(volume(half)) * abs(sum(c[d] for c in half)) / (d + 1)
    corners = [c for part in found for c in part]
    most = max(abs(c[d]) for c in corners)
    where = min(c for c in corners if abs(c[d]) == most)
    return [float(where[d]), *map(float, where[:d])], [float(total / size), float(absolute / size), math.sqrt(squares / size)]


def call(first, second, bounds="", setting=""):
    return abacus.numbers(f"SELECT * FROM abacus_compare('{first}', '{second}'{bounds})") if not setting else \
        numpy.array([[math.nan if x == "" else float(x) for x in abacus.psql(f"SET {setting}; COPY (SELECT * FROM abacus_compare('{first}', '{second}'{bounds})) TO STDOUT (FORMAT csv)").strip().split(",")]])


def make(name, points, values):
    abacus.triangulate(name, points, height=values)
    return Mesh(name, points.shape[1])


def grid(dimension, n, step=1.0, shift=0.0):
    return numpy.array(list(itertools.product(range(n), repeat=dimension))) * step + shift


class Comparison(unittest.TestCase):
    def expect(self, first, second, window=None):
        d = first.dimension
        bounds = ""
        if window:
            lower, upper = ("{" + ",".join(repr(float(b[i])) for b in window) + "}" for i in (0, 1))
            bounds = f", lower => '{lower}', upper => '{upper}'"
            window = [tuple(map(Fraction, b)) for b in window]
        found = pieces(first, second, window)
        row = call(first.name, second.name, bounds)[0]
        numpy.testing.assert_array_equal(call(first.name, second.name, bounds, "abacus.cache_size = '1MB'")[0], row)
        if not found:
            self.assertTrue(numpy.isnan(row).all())
            return
        where, means = comparison(found, d)
        self.assertEqual(row[:d + 1].tolist(), where)
        self.assertTrue(d == 3 or math.isnan(row[3]))
        numpy.testing.assert_allclose(row[4:], means, rtol=1e-11, atol=1e-13 * max(abs(where[0]), 1e-300))
        # the other way round
        turned = call(second.name, first.name, bounds)[0]
        self.assertEqual(turned[:d + 1].tolist(), [-where[0], *where[1:]])
        numpy.testing.assert_array_equal(turned[4:], [-row[4], *row[5:]])

    def every_way(self, meshes, windows):
        for first, second in itertools.combinations_with_replacement(meshes, 2):
            for window in windows:
                self.expect(first, second, window)

    def test_plane(self):
        random = numpy.random.default_rng(1)
        loose, far = random.random((40, 2)), random.random((20, 2)) + 7
        lattice = grid(2, 6, 1 / 8, 0.1)
        self.every_way([make("cmp_loose", loose, numpy.sin(9 * loose[:, 0])), make("cmp_grid", lattice, random.integers(-3, 4, 36) / 4),
                        make("cmp_far", far, random.random(20))], [None, [(0.2, 0.6), (0.3, 0.7)], [(0.225, 0.35), (0.1, 0.475)]])

    def test_space(self):
        """Points in general position and cospherical ones; grids that share facets, edges and corners."""
        random = numpy.random.default_rng(2)
        loose = random.random((14, 3)) * 2
        coarse, fine, beside = grid(3, 2, 2.0), grid(3, 3), grid(3, 2, 1.0, 1.0)
        self.every_way([make("cmp_loose", loose, random.random(14)), make("cmp_coarse", coarse, random.integers(-3, 4, 8) / 4),
                        make("cmp_fine", fine, random.integers(-3, 4, 27) / 4), make("cmp_beside", beside, random.random(8)),
                        make("cmp_away", beside + 1, random.random(8))],
                       [None])
        self.expect(Mesh("cmp_loose", 3), Mesh("cmp_fine", 3), [(0.5, 1.5), (0.25, 1.75), (1.0, 2.0)])

    def test_slivers(self):
        """Nearly coplanar points, as rounded ones on a sphere or a plane are."""
        random = numpy.random.default_rng(3)
        sphere = random.normal(size=(9, 3))
        sphere /= numpy.linalg.norm(sphere, axis=1)[:, None]
        flat = numpy.column_stack([random.random((9, 2)), random.random(9) * 1e-14 + 0.3])
        self.every_way([make("cmp_sphere", sphere, random.random(9)), make("cmp_flat", flat, random.random(9))], [None])
        line = numpy.column_stack([random.random(12), random.random(12) * 1e-15])
        self.every_way([make("cmp_line", line, random.random(12)), make("cmp_thin", grid(2, 2, 1.0, -0.5), random.random(4))], [None])

    def test_slanting_slivers(self):
        """All simplices of both meshes are flat, along no axis: nothing is left of their sizes in doubles."""
        random = numpy.random.default_rng(6)
        for dimension, n in (2, 12), (3, 8):
            meshes = []
            for name, off in (("cmp_bent", 1e-16), ("cmp_crossing", 3e-16), ("cmp_level", 1e-13)):
                points = numpy.repeat(random.random((n, 1)), dimension, axis=1)
                points[:, :dimension - 1] = random.random((n, dimension - 1))
                points[:, -1] = points[:, :-1].sum(axis=1) + random.random(n) * off * 4
                meshes.append(make(name, points, random.random(n) * 1000))
            self.every_way(meshes, [None, [(0.25, 0.5)] * dimension])
            for first, second in itertools.permutations(meshes if dimension == 2 else (), 2):
                found = pieces(first, second, None)
                halves = {sign: sum(abs(volume(half) * sum(c[2] for c in half) / 3) for part in found
                                    for half in cut([part], lambda p: sign * p[2])) for sign in (1, -1)}
                row = abacus.numbers(f"SELECT area, cut, fill FROM abacus_volume('{first.name}', '{second.name}')")[0]
                numpy.testing.assert_allclose(row, [float(sum(map(abs, map(volume, found)))), float(halves[1]), float(halves[-1])], rtol=1e-9)

    def test_thinned(self):
        """A mesh and a thinned one of it: they share vertices, edges and facets."""
        for dimension, n in (2, 7), (3, 3):
            points = grid(dimension, n)
            full = make("cmp_full", points, (points[:, 0] * 5 + points[:, 1] * 3 + points.sum(axis=1) ** 2) % 7)
            abacus.psql("DROP TABLE IF EXISTS cmp_thinned CASCADE; SELECT abacus_thin('cmp_full', 'cmp_thinned', 2)")
            self.every_way([full, Mesh("cmp_thinned", dimension)], [None])

    def test_any_order(self):
        random = numpy.random.default_rng(4)
        for dimension, count in (2, 2000), (3, 500):
            columns = "xyz"[:dimension]
            for name in "cmp_a", "cmp_b":
                points = random.random((count, dimension))
                abacus.triangulate(name, points, height=numpy.cos(5 * points).sum(axis=1))
                abacus.psql(f"DROP TABLE IF EXISTS {name}_shuffled CASCADE; SELECT abacus_triangulate('{name}_shuffled', "
                            f"'SELECT id, {', '.join(columns)}, height FROM {name}_points ORDER BY sin(id)', '{{height}}', {dimension})")
            wanted = call("cmp_a", "cmp_b")
            for setting in "abacus.cache_size = '1MB'", "abacus.cache_size = '64MB'":
                numpy.testing.assert_array_equal(call("cmp_a_shuffled", "cmp_b_shuffled", setting=setting), wanted)
                numpy.testing.assert_array_equal(call("cmp_b_shuffled", "cmp_a", setting=setting)[0, :1], -wanted[0, :1])

    def test_units(self):
        """Powers of two as units of coordinates and values change nothing else, up to the ends of the range."""
        random = numpy.random.default_rng(5)
        for dimension in 2, 3:
            sets = [(grid(dimension, 3) + random.random((3 ** dimension, dimension)) / 4, random.random(3 ** dimension) - 0.5) for _ in range(2)]
            wanted = None
            for place, value in (0, 0), (560, 660), (-560, -660), (1000, 1000), (-950, -900):
                for name, (points, values) in zip(("cmp_a", "cmp_b"), sets):
                    abacus.triangulate(name, numpy.ldexp(points, place), height=numpy.ldexp(values, value))
                row = call("cmp_a", "cmp_b")[0]
                row[1:4] = numpy.ldexp(row[1:4], -place)
                row[[0, 4, 5, 6]] = numpy.ldexp(row[[0, 4, 5, 6]], -value)
                wanted = row if wanted is None else wanted
                numpy.testing.assert_array_equal(row, wanted, err_msg=f"{place} {value}")


if __name__ == "__main__":
    unittest.main()
