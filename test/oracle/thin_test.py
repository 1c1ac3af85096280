#!/usr/bin/python3
"""Thinned meshes against the rule, followed by brute force in rational arithmetic: which vertices stay, and the greatest error."""
import itertools
import unittest
from fractions import Fraction

import numpy

import abacus


def determinant(rows):
    if len(rows) == 1:
        return rows[0][0]
    return sum((-1) ** i * row[0] * determinant([other[1:] for j, other in enumerate(rows) if j != i]) for i, row in enumerate(rows))


def less(p, q):
    return [a - b for a, b in zip(p, q)]


def volume(corners):
    return determinant([less(c, corners[0]) for c in corners[1:]])


class Cloud:
    """Points with a value (None: without), as fractions."""

    def __init__(self, points, values):
        self.points = [tuple(map(Fraction, p)) for p in points.tolist()]
        self.values = [None if numpy.isnan(v) else Fraction(v) for v in values.tolist()]
        self.dimension = points.shape[1]
        self.valued = [i for i, v in enumerate(self.values) if v is not None]

    def weights(self, simplex, p):
        """Barycentric coordinates."""
        corners = [self.points[i] for i in simplex]
        whole = volume(corners)
        return [volume(corners[:k] + [p] + corners[k + 1:]) / whole for k in range(len(corners))]

    def errors(self, simplices):
        """For each simplex its vertices, with their errors."""
        found = {}
        for simplex in simplices:
            used = set(simplex)
            box = [(min(self.points[i][a] for i in simplex), max(self.points[i][a] for i in simplex)) for a in range(self.dimension)]
            for i in self.valued:
                p = self.points[i]
                if i in used or any(not low <= x <= high for x, (low, high) in zip(p, box)):
                    continue
                weights = self.weights(simplex, p)
                if min(weights) >= 0:
                    error = abs(sum(w * self.values[c] for w, c in zip(weights, simplex)) - self.values[i])
                    found.setdefault(tuple(simplex), []).append((-error, p, i))
        return found

    def hull(self):
        """Its strict corners: a point is one unless it is in a simplex of others, or on their border."""
        if self.dimension == 2:
            order = sorted(self.valued, key=lambda i: self.points[i])
            half = lambda ids: self.chain(ids)
            return set(half(order)) | set(half(order[::-1]))
        return {i for i in self.valued if self.is_extreme(i)}

    def chain(self, ids):
        kept = []
        for i in ids:
            while len(kept) > 1 and volume([self.points[j] for j in (*kept[-2:], i)]) <= 0:
                kept.pop()
            kept.append(i)
        return kept

    def is_extreme(self, i):
        """By Caratheodory: no convex combination of at most four others."""
        p = self.points[i]
        others = [self.points[j] for j in self.valued if j != i]
        seen = [tuple(less(q, p)) for q in others]
        # p is extreme if a plane through it has all others strictly on one side, or on it in a smaller face where the same holds
        for a, b in itertools.combinations(seen, 2):
            normal = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
            if not any(normal):
                continue
            sides = [sum(n * x for n, x in zip(normal, q)) for q in seen]
            if min(sides) >= 0 or max(sides) <= 0:
                flat = [q for q, side in zip(seen, sides) if side == 0]
                if self.is_corner_of(flat, normal):
                    return True
        return False

    @staticmethod
    def is_corner_of(flat, normal):
        """Whether the origin is a corner of the hull of itself and points in a plane through it."""
        drop = max(range(3), key=lambda axis: abs(normal[axis]))
        plane = [tuple(x for axis, x in enumerate(q) if axis != drop) for q in flat]
        for a in plane:
            turns = [a[0] * q[1] - a[1] * q[0] for q in plane]
            if (min(turns) >= 0 or max(turns) <= 0) and all(a[0] * q[0] + a[1] * q[1] > 0 for q, turn in zip(plane, turns) if turn == 0):
                return True
        return False


def thin(cloud, max_error, kept=(), target=None):
    """The ids (from 1) that stay, and the greatest error: by the rule."""
    ids = cloud.hull() | set(kept)
    while True:
        simplices = triangulation(ids)
        errors = cloud.errors(simplices)
        worst = {min(candidates) for candidates in errors.values() if -min(candidates)[0] > max_error}
        worst = sorted(worst)
        if target is not None:
            worst = worst[:max(0, target - len(ids))]
        if not worst:
            greatest = max((-error for candidates in errors.values() for error, _, _ in candidates), default=Fraction(0))
            return {i + 1 for i in ids}, float(greatest)
        ids |= {i for _, _, i in worst}


def triangulation(ids):
    """Simplices as rows of indices; the triangulation itself is compared with CGAL elsewhere."""
    name = f"abacus_triangulate('oracle_part', 'SELECT id, {Thin.columns} FROM source_points WHERE id IN ({','.join(str(i + 1) for i in sorted(ids))})'"
    abacus.psql(f"DROP TABLE IF EXISTS oracle_part CASCADE; SELECT {name}, '{{}}', {Thin.dimension})")
    return abacus.simplices("oracle_part", Thin.dimension + 1).tolist()


SETTINGS = ("abacus.cache_size = '1MB'; SET abacus.threads = 1", "abacus.threads = 2; SET abacus.tiny_intervals = on",
            "abacus.threads = 3; SET abacus.tiny_intervals = on", "abacus.threads = 7; SET abacus.tiny_intervals = on; SET maintenance_work_mem = '1MB'")


def ids_of(mesh):
    return {int(row[0]) for row in abacus.rows(f"SELECT id FROM abacus_vertices('{mesh}')")}


def kept_error():
    return float(abacus.rows("SELECT greatest FROM thinned_thinning")[0][0])


class Thin(unittest.TestCase):
    dimension = 2
    columns = "x, y"
    settings = itertools.cycle(SETTINGS)

    def make(self, points, values):
        Thin.dimension = points.shape[1]
        Thin.columns = ", ".join("xyz"[:Thin.dimension])
        abacus.triangulate("source", points, height=values)
        return Cloud(points, values)

    def call(self, arguments, setting, source="source"):
        abacus.psql("DROP TABLE IF EXISTS thinned CASCADE")
        abacus.psql(f"SET {setting}; SELECT abacus_thin('{source}', 'thinned', {arguments})")
        self.assertEqual(abacus.rows("SELECT * FROM abacus_check('thinned')"), [])
        return ids_of("thinned"), kept_error()

    def expect(self, points, values, max_error, kept=(), **how):
        cloud = self.make(points, values)
        wanted = thin(cloud, Fraction(max_error), kept, how.get("target"))
        arguments = ", ".join([repr(max_error), *(f"{name} => {value}" for name, value in how.items())])
        setting = next(Thin.settings)
        self.assertEqual(self.call(arguments, setting), wanted, f"{arguments} {setting}")
        # the same mesh of shuffled rows
        columns = f"id, {Thin.columns}, height"
        abacus.psql("DROP TABLE IF EXISTS shuffled CASCADE; SELECT abacus_triangulate('shuffled', "
                    f"'SELECT {columns} FROM source_points ORDER BY sin(id)', '{{height}}', {Thin.dimension})")
        setting = next(Thin.settings)
        self.assertEqual(self.call(arguments, setting, "shuffled"), wanted, f"{arguments} {setting}")
        # ... and in steps that are committed
        abacus.psql("DROP TABLE IF EXISTS thinned CASCADE")
        abacus.psql(f"CALL abacus_thin_build('source', 'thinned', {arguments})")
        self.assertEqual((ids_of("thinned"), kept_error()), wanted)

    def test_scattered_points(self):
        random = numpy.random.default_rng(1)
        points = random.uniform(0, 10, (120, 2))
        self.expect(points, numpy.sin(points[:, 0]) * 2 + numpy.cos(points[:, 1]), 0.2)

    def test_grid_with_ties(self):
        """Cocircular points, vertices on edges, equal errors, and a plane part."""
        x, y = map(numpy.ravel, numpy.meshgrid(numpy.arange(9.0), numpy.arange(8.0)))
        points = numpy.column_stack([x, y])
        self.expect(points, numpy.abs(x - 4) + numpy.maximum(0, y - 5), 0.0)
        self.expect(points, (x * 7 + y * 3) % 5, 1.0)
        self.expect(points, 2 * x + 3 * y, 0.0)
        self.expect(points, numpy.where(x == 4, 1.0, 0.0), 0.5)

    def test_the_error_is_exact(self):
        """The middle is off by exactly 0.1 as a double, and by one unit of its last place more."""
        points = numpy.array([[0, 0], [4, 0], [4, 4], [0, 4], [2, 2], [1, 2.5]])
        for height in 0.1, numpy.nextafter(0.1, 1):
            self.expect(points, numpy.array([0, 0, 0, 0, height, 0.0]), 0.1)

    def test_target(self):
        random = numpy.random.default_rng(2)
        points = random.uniform(0, 10, (120, 2))
        heights = numpy.sin(points[:, 0]) + points[:, 1] ** 2 / 20
        for target in 1, 30, 500:
            self.expect(points, heights, 0.05, target=target)
        x, y = map(numpy.ravel, numpy.meshgrid(numpy.arange(7.0), numpy.arange(7.0)))
        self.expect(numpy.column_stack([x, y]), (x * y) % 3, 0.0, target=20)

    def test_missing_values(self):
        random = numpy.random.default_rng(3)
        points = random.uniform(0, 10, (80, 2))
        heights = points[:, 0] ** 2 / 10
        heights[random.uniform(size=80) < 0.3] = numpy.nan
        self.expect(points, heights, 0.4)

    def test_kept(self):
        random = numpy.random.default_rng(4)
        x, y = map(numpy.ravel, numpy.meshgrid(numpy.arange(7.0), numpy.arange(6.0)))
        points = numpy.column_stack([x, y])
        heights = random.uniform(0, 1, len(points))
        border = [i for i in range(len(points)) if x[i] in (0, 6) or y[i] in (0, 5)]
        self.expect(points, heights, 0.6, border, keep="'border'")
        self.expect(points, heights, 0.6, [9, 16, 30], keep="'SELECT id FROM source_points WHERE id IN (10, 17, 31)'")

    def test_far_coordinates(self):
        random = numpy.random.default_rng(5)
        points = 4e6 + numpy.round(random.uniform(0, 100, (90, 2)), 2)
        self.expect(points, numpy.round(100 + 3 * numpy.sin((points[:, 0] - 4e6) / 9), 2), 0.25)

    def test_diagonal_band(self):
        """All that comes first or last on an axis is on one line; the span needs the farthest point."""
        along = numpy.arange(12.0)
        points = numpy.concatenate([numpy.column_stack([along, along]), [[5, 6], [6, 4.5]]])
        self.expect(points, numpy.concatenate([along % 3, [2, 0]]), 0.5)

    def test_space(self):
        random = numpy.random.default_rng(6)
        points = random.uniform(0, 4, (26, 3))
        self.expect(points, numpy.sin(points[:, 0] * 2) + points[:, 1] * points[:, 2] / 4, 0.4)
        x, y, z = (axis.ravel().astype(float) for axis in numpy.meshgrid(range(3), range(2), range(3)))
        self.expect(numpy.column_stack([x, y, z]), (x * 3 + y * 5 + z * 7) % 4, 1.0)

    def interrupt(self, arguments):
        """Thins in steps, ended again and again in the middle of one."""
        abacus.psql("DROP TABLE IF EXISTS thinned CASCADE")
        begun, milliseconds = 0, 100
        while True:
            said = abacus.script(f"SET statement_timeout = {milliseconds}; CALL abacus_thin_build('source', 'thinned', {arguments})")
            if "ERROR" not in said:
                break
            self.assertIn("statement timeout", said)
            begun += abacus.rows("SELECT count(*) FROM pg_class WHERE relname = 'thinned_thinning'") == [["1"]]
            milliseconds *= 1.4
        self.assertGreater(begun, 0)
        said = abacus.script(f"CALL abacus_thin_build('source', 'thinned', {arguments})")
        self.assertIn("already exists", said)

    def test_large(self):
        """Every vertex left out is within the error of the surface, as abacus_interpolate() has it."""
        random = numpy.random.default_rng(7)
        points = random.uniform(0, 1000, (200000, 2))
        abacus.triangulate("source", points, height=20 * numpy.sin(points[:, 0] / 60) * numpy.cos(points[:, 1] / 80) + random.normal(0, 0.05, len(points)))
        wanted = self.call("0.3", "abacus.threads = 1; SET abacus.cache_size = '1MB'; SET maintenance_work_mem = '1MB'")
        for setting in "abacus.threads = 3", "abacus.threads = 7":
            self.assertEqual(self.call("0.3", setting), wanted)
        self.interrupt("0.3")
        self.assertEqual((ids_of("thinned"), kept_error()), wanted)
        ids, greatest = wanted
        self.assertLess(len(ids), 20000)
        most, missing = abacus.numbers("SELECT max(abs(height - \"values\"[1])), count(*) FILTER (WHERE \"values\"[1] IS NULL) FROM source_points "
                                       "JOIN abacus_interpolate('thinned', 'SELECT id, x, y FROM source_points') USING (id)")[0]
        self.assertEqual(missing, 0)
        self.assertLessEqual(greatest, 0.3)
        self.assertAlmostEqual(most, greatest, places=12)


if __name__ == "__main__":
    unittest.main()
