#!/usr/bin/python3
"""Regions of a mesh against GEOS' symmetric difference of their outlines (through PostGIS), and against flooding by SciPy.

After insertions, deletions and lines that come and go, whatever the threads and the cache."""
import unittest

import numpy
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

import abacus

SETTINGS = [(1, "off", 64), (2, "on", 1), (3, "on", 64)]
# of rings, and seeds within them
CENTRES = numpy.array([(x, y) for x in range(3) for y in range(3)], dtype=float)
SEEDS = CENTRES + [0.03, 0.05]


def cells(condition=""):
    """Corners of triangles, n x 3 x 2, in the order of their ids."""
    rows = abacus.rows(f"SELECT v0, v1, v2, array_to_string(corners, ' ') FROM abacus_cells('ground'{condition}) ORDER BY v0, v1, v2")
    ids = numpy.array([row[:3] for row in rows], dtype=int).reshape(-1, 3)
    return ids, numpy.array([row[3].split() for row in rows], dtype=float).reshape(-1, 3, 2)


def ring(random, least, most, corners=24):
    """A simple ring around the origin, its corners between two distances: edges come no nearer than the cosine of 7.5 degrees of the least."""
    angles = numpy.arange(corners) * 2 * numpy.pi / corners
    return numpy.column_stack([numpy.cos(angles), numpy.sin(angles)]) * random.uniform(least, most, corners)[:, None]


class Regions(unittest.TestCase):
    def make(self, points, rings, setting):
        threads, tiny, cache = setting
        corners = numpy.concatenate(rings)
        abacus.store("ground_points", ["x", "y"], numpy.concatenate([corners, points]))
        starts = numpy.cumsum([0] + [len(ring) for ring in rings])
        lines = "".join(f"{n},{k},{starts[n] + k % len(ring) + 1}\n" for n, ring in enumerate(rings) for k in range(len(ring) + 1))
        abacus.psql("DROP TABLE IF EXISTS ground_rows CASCADE; CREATE TABLE ground_rows (line bigint, k int, id bigint)")
        abacus.psql("COPY ground_rows FROM STDIN (FORMAT csv)", lines)
        count = len(corners) + len(points)
        abacus.psql(f"""DROP TABLE IF EXISTS ground, ground_vertices, ground_lines, ground_regions CASCADE;
            SET abacus.threads = {threads}; SET abacus.cache_size = '{cache}MB';
            SELECT abacus_triangulate('ground', 'SELECT id, x, y FROM ground_points WHERE id <= {count // 2 + len(corners)}');
            -- with tiny intervals many points are slow
            SET abacus.tiny_intervals = {tiny};
            SELECT abacus_constrain('ground', 'TABLE ground_rows')""")
        return count

    def change(self, corners, count, setting):
        """Half of the points come, and a third of them goes, but for corners of rings."""
        threads, tiny, cache = setting
        abacus.psql(f"""SET abacus.threads = {threads}; SET abacus.cache_size = '{cache}MB'; SET abacus.tiny_intervals = {tiny};
            SELECT abacus_insert('ground', 'SELECT id, x, y FROM ground_points WHERE id > {count // 2 + corners}');
            SELECT abacus_delete('ground', 'SELECT id, x, y FROM ground_points WHERE id > {corners} AND id % 3 = 0')""")

    def expect(self, names):
        """The triangles of each region are those whose middle is in the symmetric difference of its rings."""
        self.assertEqual(abacus.rows("SELECT * FROM abacus_check('ground')"), [])
        self.assertEqual(abacus.rows("""SELECT name, c.code, c.within, ST_Contains(area, middle)
            FROM areas, LATERAL (SELECT code, ST_Centroid(ST_MakePolygon(ST_MakeLine(ARRAY[ST_Point(corners[1][1], corners[1][2]), ST_Point(corners[2][1], corners[2][2]),
                                                             ST_Point(corners[3][1], corners[3][2]), ST_Point(corners[1][1], corners[1][2])]))) AS middle, inside.v0 IS NOT NULL AS within
                                 FROM abacus_cells('ground', ARRAY[ST_XMin(area), ST_YMin(area)], ARRAY[ST_XMax(area), ST_YMax(area)]) AS c
                                 LEFT JOIN abacus_simplices('ground', name) AS inside USING (code, v0, v1, v2)) AS c
            WHERE c.within <> ST_Contains(area, middle)"""), [])
        self.assertEqual(abacus.rows("""SELECT region FROM abacus_regions('ground') JOIN areas ON name = region
            WHERE abs(abacus_regions.area / ST_Area(areas.area) - 1) > 1e-12 OR triangles = 0 OR edges = 0"""), [])
        self.assertEqual(int(abacus.rows("SELECT count(*) FROM abacus_regions('ground')")[0][0]), len(set(names)))

    def test_outlines(self):
        for seed, setting in enumerate(SETTINGS):
            with self.subTest(setting=setting):
                random = numpy.random.default_rng(seed)
                rings, names = [], []
                for n, centre in enumerate(numpy.array([(x, y) for x in range(4) for y in range(4)], dtype=float)):
                    # a hole, and an island in it; the corners of each are farther out than those of the next
                    rings += [centre + ring(random, *reach) for reach in ((0.35, 0.49), (0.15, 0.2), (0.04, 0.07))]
                    names += [f"area {n}"] * 3
                count = self.make(random.random((4000, 2)) * 5 - 1, rings, setting)
                abacus.psql("""SET client_min_messages = warning; CREATE EXTENSION IF NOT EXISTS postgis;
                    DROP TABLE IF EXISTS rings, areas; CREATE TABLE rings (line bigint, name text)""")
                abacus.psql("COPY rings FROM STDIN (FORMAT csv)", "".join(f"{n},{name}\n" for n, name in enumerate(names)))
                abacus.psql("""CREATE TABLE areas AS WITH made AS (
                        SELECT name, line, ST_MakePolygon(ST_MakeLine(ST_Point(x, y) ORDER BY k)) AS ring FROM rings JOIN ground_rows USING (line) JOIN ground_points USING (id) GROUP BY name, line)
                    SELECT a.name, ST_SymDifference(ST_SymDifference(a.ring, b.ring), c.ring) AS area FROM made AS a JOIN made AS b ON b.line = a.line + 1 JOIN made AS c ON c.line = a.line + 2
                    WHERE a.line % 3 = 0""")
                self.assertEqual(abacus.rows("SELECT abacus_region('ground', 'SELECT name, line FROM rings')"), [["16"]])
                self.expect(names)
                self.change(sum(map(len, rings)), count, setting)
                self.expect(names)

    def expect_flooded(self):
        """Each region is the connected component, across free edges, of the triangle at its seed."""
        self.assertEqual(abacus.rows("SELECT * FROM abacus_check('ground')"), [])
        ids, corners = cells()
        edges = {}
        for number, triangle in enumerate(ids):
            for i in range(3):
                edges.setdefault(frozenset((triangle[i - 1], triangle[i - 2])), []).append(number)
        fixed = {frozenset((int(a), int(b))) for a, b in abacus.rows("SELECT v0, v1 FROM abacus_edges('ground', fixed => true)")}
        free = numpy.array([pair for edge, pair in edges.items() if len(pair) == 2 and edge not in fixed])
        _, component = connected_components(coo_matrix((numpy.ones(len(free)), free.T), (len(ids), len(ids))), directed=False)
        number = {tuple(triangle): n for n, triangle in enumerate(ids)}
        for n, seed in enumerate(SEEDS):
            within, _ = cells(f", within => 'seed {n}'")
            ahead = numpy.roll(corners, -1, axis=1) - corners
            aside = seed - corners
            (at_seed,) = numpy.flatnonzero((ahead[:, :, 0] * aside[:, :, 1] > ahead[:, :, 1] * aside[:, :, 0]).all(axis=1))
            self.assertEqual(sorted(number[tuple(triangle)] for triangle in within), numpy.flatnonzero(component == component[at_seed]).tolist())

    def test_seeds(self):
        random = numpy.random.default_rng(5)
        rings = [centre + ring(random, 0.2, 0.49) for centre in CENTRES]
        count = self.make(random.random((3000, 2)) * 4 - 1, rings, SETTINGS[1])
        abacus.psql("SELECT abacus_region('ground', $$VALUES " + ", ".join(f"('seed {n}', {x}, {y})" for n, (x, y) in enumerate(SEEDS)) + "$$)")
        self.expect_flooded()
        self.change(sum(map(len, rings)), count, SETTINGS[1])
        self.expect_flooded()
        # from the centre of each ring a line to a corner; of each second one, another: they part the region
        rows = [(100 + corner + 2 * n, *row) for n, centre in enumerate(CENTRES) for corner in (0, 1)[:1 + n % 2]
                for row in ((1, *centre), (2, *rings[n][12 * corner]))]
        whole = abacus.rows("SELECT region, area FROM abacus_regions('ground')")
        abacus.psql("SELECT abacus_constrain('ground', $$SELECT line, k, NULL::bigint, x, y FROM (VALUES " +
                    ", ".join(f"({line}, {k}, float8 '{x!r}', float8 '{y!r}')" for line, k, x, y in ((*row[:2], *map(float, row[2:])) for row in rows)) + ") AS v (line, k, x, y)$$)")
        self.expect_flooded()
        parted = abacus.rows("SELECT region, area FROM abacus_regions('ground')")
        self.assertEqual([float(now[1]) < float(was[1]) for was, now in zip(whole, parted)], [n % 2 == 1 for n in range(len(CENTRES))])
        abacus.psql("SELECT abacus_unconstrain('ground', $$VALUES " + ", ".join(f"({100 + 2 * n})" for n in range(0, len(CENTRES), 2)) + "$$)")
        self.expect_flooded()
        with self.assertRaisesRegex(abacus.Refused, "region"):
            abacus.psql("SELECT abacus_unconstrain('ground', 'VALUES (102)')")
        self.expect_flooded()


if __name__ == "__main__":
    unittest.main()
