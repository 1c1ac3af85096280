#!/usr/bin/python3
"""Voronoi cells, outlines and spanning trees against SciPy and, where it is installed, PostGIS."""
import collections
import unittest

import numpy
from matplotlib.path import Path
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import minimum_spanning_tree
from scipy.spatial import ConvexHull, Delaunay, Voronoi

import abacus


def clustered(dimension, count, seed):
    random = numpy.random.default_rng(seed)
    middles = random.random((12, dimension)) * 100
    return numpy.concatenate([middles[random.integers(0, 12, count)] + random.normal(size=(count, dimension)) * 4, random.random((count // 2, dimension)) * 100])


def circumradius_squared(corners):
    edges = corners[:, 1:] - corners[:, :1]
    centres = numpy.linalg.solve(edges, (edges ** 2).sum(axis=2)[..., None] / 2)[..., 0]
    return (centres ** 2).sum(axis=1)


def rings(query):
    """Rings of rows of ids and coordinates."""
    found = collections.defaultdict(list)
    for ring, *row in abacus.numbers(f"SELECT ring, vertex - 1, x, y FROM {query} ORDER BY ring, position"):
        found[int(ring)].append(row)
    return [numpy.array(ring) for ring in found.values()]


def area(ring):
    x, y = ring[:, -2], ring[:, -1]
    return (x * numpy.roll(y, -1) - numpy.roll(x, -1) * y).sum() / 2


class Cells(unittest.TestCase):
    def compare(self, dimension, seed):
        points = clustered(dimension, 600, seed)
        abacus.triangulate("cells", points)
        column = "area" if dimension == 2 else "volume"
        ours = abacus.numbers(f"SELECT bounded::int, {column} FROM abacus_voronoi('cells') ORDER BY vertex")
        theirs = Voronoi(points)
        for (bounded, size), region in zip(ours, (theirs.regions[i] for i in theirs.point_region), strict=True):
            self.assertEqual(bounded == 0, -1 in region)
            if bounded:
                self.assertAlmostEqual(size / ConvexHull(theirs.vertices[region], qhull_options="QJ").volume, 1, 6)
        self.assertGreater(ours[:, 0].sum(), 700)

    def test_in_the_plane(self):
        self.compare(2, 1)

    def test_in_space(self):
        self.compare(3, 2)

    def test_postgis(self):
        """Cells that PostGIS has whole: it cuts those at the edge of a larger box."""
        if not abacus.rows("SELECT FROM pg_available_extensions WHERE name = 'postgis'"):
            self.skipTest("PostGIS is not installed")
        abacus.triangulate("cells", clustered(2, 600, 7))
        abacus.psql("CREATE EXTENSION IF NOT EXISTS postgis")
        compared, worst = abacus.numbers("""
            WITH points AS MATERIALIZED (SELECT id, ST_MakePoint(x, y) AS point FROM cells_points),
                 theirs AS MATERIALIZED (SELECT (ST_Dump(ST_VoronoiPolygons(ST_Collect(point)))).geom AS cell FROM points),
                 box AS (SELECT ST_Extent(cell) AS box FROM theirs)
            SELECT count(*), max(abs(ST_Area(cell) / area - 1)) FROM abacus_voronoi('cells') JOIN points ON id = vertex
                JOIN theirs ON ST_Intersects(cell, point), box,
                LATERAL (SELECT min(ring[n][1]) AS x0, min(ring[n][2]) AS y0, max(ring[n][1]) AS x1, max(ring[n][2]) AS y1
                           FROM generate_series(1, array_length(ring, 1)) AS n) AS extent
            WHERE bounded AND ST_Contains(ST_Envelope(box::geometry), ST_MakeEnvelope(x0, y0, x1, y1))""")[0]
        self.assertGreater(compared, 600)
        self.assertLess(worst, 1e-6)

    def test_window_takes_the_nearest(self):
        """Places of a window are in the cells of the vertices nearest to them."""
        points = clustered(2, 600, 3)
        abacus.triangulate("cells", points)
        random = numpy.random.default_rng(4)
        lower, upper = numpy.array([20, 30]), numpy.array([50, 45])
        places = lower + random.random((2000, 2)) * (upper - lower)
        nearest = ((places[:, None] - points) ** 2).sum(axis=2).argmin(axis=1)
        cells = {int(vertex) - 1: abacus.vector(ring, 2) for vertex, ring in
                 abacus.rows("SELECT vertex, ring FROM abacus_voronoi('cells', '{20,30}', '{50,45}')")}
        self.assertAlmostEqual(sum(map(area, cells.values())), 30 * 15, 9)
        for vertex in set(nearest):
            self.assertTrue(Path(cells[vertex]).contains_points(places[nearest == vertex], radius=1e-9).all())


class Outlines(unittest.TestCase):
    def kept(self, points, is_kept):
        triangles = Delaunay(points).simplices
        return triangles[is_kept(points[triangles])]

    def border(self, triangles):
        """Edges of one triangle alone."""
        edges = numpy.sort(numpy.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
        unique, counts = numpy.unique(edges, axis=0, return_counts=True)
        return {tuple(edge) for edge in unique[counts == 1]}

    def compare(self, query, points, triangles):
        found = rings(query)
        edges = [tuple(sorted(edge)) for ring in found for edge in zip(ring[:, 0].astype(int), numpy.roll(ring[:, 0], -1).astype(int))]
        self.assertEqual(len(edges), len(set(edges)))
        self.assertEqual(set(edges), self.border(triangles))
        for ring in found:
            self.assertEqual(len(set(ring[:, 0])), len(ring), "a vertex comes twice")
            self.assertEqual(tuple(ring[0, 1:]), min(map(tuple, ring[:, 1:])))
        a, b, c = (points[triangles[:, i]] for i in range(3))
        whole = numpy.abs(numpy.cross(b - a, c - a)).sum() / 2
        self.assertAlmostEqual(sum(map(area, found)) / whole, 1, 9)
        return found

    def test_alpha_shapes(self):
        points = clustered(2, 3000, 5)
        abacus.triangulate("outline", points)
        for alpha in 0.5, 1.5, 4.0, 30.0, 1000.0:
            with self.subTest(alpha=alpha):
                triangles = self.kept(points, lambda corners: circumradius_squared(corners) <= alpha)
                found = self.compare(f"abacus_alpha_shape('outline', {alpha}, true)", points, triangles)
                self.compare_filled(found, rings(f"abacus_alpha_shape('outline', {alpha})"))

    def compare_filled(self, found, filled):
        """Without holes there are the outlines that lie in none."""
        holes = [Path(ring[:, 1:]) for ring in found if area(ring) < 0]
        expected = []
        for ring in found:
            along = ring[1, 1:] - ring[0, 1:]
            inside = ring[0, 1:] + along / 2 + numpy.array([-along[1], along[0]]) * 1e-6
            if area(ring) > 0 and not any(hole.contains_point(inside) for hole in holes):
                expected.append(tuple(map(tuple, ring)))
        self.assertEqual([tuple(map(tuple, ring)) for ring in filled], expected)

    def test_without_long_edges(self):
        points = clustered(2, 3000, 6)
        abacus.triangulate("outline", points)
        for longest in 1.0, 2.0, 5.0, 20.0:
            with self.subTest(longest=longest):
                triangles = self.kept(points, lambda corners: ((corners - numpy.roll(corners, 1, axis=1)) ** 2).sum(axis=2).max(axis=1) <= longest ** 2)
                self.compare(f"abacus_hull('outline', {longest})", points, triangles)

    def test_hulls(self):
        for dimension in 2, 3:
            points = clustered(dimension, 3000, 7)
            abacus.triangulate("outline", points, )
            vertices = abacus.numbers("SELECT DISTINCT vertex - 1 FROM abacus_hull('outline')")[:, 0]
            self.assertEqual(set(vertices), set(ConvexHull(points).vertices))

    def test_alpha_shapes_in_space(self):
        points = clustered(3, 2000, 8)
        abacus.triangulate("outline", points)
        simplices = Delaunay(points).simplices
        for alpha in 4.0, 30.0, 1000.0:
            kept = simplices[circumradius_squared(points[simplices]) <= alpha]
            facets = numpy.sort(numpy.concatenate([numpy.delete(kept, i, axis=1) for i in range(4)]), axis=1)
            unique, counts = numpy.unique(facets, axis=0, return_counts=True)
            ours = abacus.numbers(f"SELECT vertex - 1 FROM abacus_alpha_shape('outline', {alpha}) ORDER BY ring, position").reshape(-1, 3)
            self.assertEqual(sorted(map(tuple, numpy.sort(ours, axis=1))), sorted(map(tuple, unique[counts == 1])))


class Trees(unittest.TestCase):
    def compare(self, dimension, seed, settings=""):
        points = clustered(dimension, 20000, seed)
        abacus.triangulate("tree", points)
        simplices = Delaunay(points).simplices
        corners = range(dimension + 1)
        edges = numpy.unique(numpy.sort(numpy.concatenate([simplices[:, [i, j]] for i in corners for j in corners if i < j]), axis=1), axis=0)
        lengths = numpy.sqrt(((points[edges[:, 0]] - points[edges[:, 1]]) ** 2).sum(axis=1))
        theirs = minimum_spanning_tree(coo_matrix((lengths, edges.T), shape=(len(points), len(points)))).tocoo()
        # COPY does not take settings; nor does a view, but a function does.
        abacus.psql(f"CREATE OR REPLACE FUNCTION tree_edges() RETURNS TABLE (v0 bigint, v1 bigint, length float8) {settings} "
                    "LANGUAGE sql AS $$ SELECT * FROM abacus_spanning_tree('tree') $$")
        ours = abacus.numbers("SELECT v0 - 1, v1 - 1, length FROM tree_edges()")
        self.assertEqual(len(ours), len(points) - 1)
        self.assertTrue((numpy.diff(ours[:, 2]) >= 0).all())
        self.assertAlmostEqual(ours[:, 2].sum() / theirs.data.sum(), 1, 12)
        self.assertEqual(set(map(tuple, ours[:, :2].astype(int))), {(min(e), max(e)) for e in zip(theirs.row, theirs.col)})

    def test_in_the_plane(self):
        self.compare(2, 9)

    def test_in_space(self):
        self.compare(3, 10)

    def test_in_little_memory(self):
        self.compare(2, 11, "SET work_mem = '64kB'")
        self.compare(3, 12, "SET work_mem = '256kB'")


if __name__ == "__main__":
    unittest.main()
