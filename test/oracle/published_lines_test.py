#!/usr/bin/python3
"""Lines on which other programs have failed in public: crashes, endless loops, wrong or missing triangles. Each case says which program, with the number of
its report. Without crossings the mesh must be CGAL's constrained triangulation, whatever comes first. With crossings the error must count all of
them, as exact arithmetic finds them, and nothing may change; with a corner at each crossing they are then accepted."""
import fractions
import itertools
import sys
import unittest

import numpy

import abacus

sys.path.append(str(abacus.REPOSITORY / "scripts"))
import psql_session  # noqa: E402
from constrained_test import canonical, ours, theirs  # noqa: E402


def ring(n, first=0):
    """The segments of a closed line of n points."""
    return [(first + i, first + (i + 1) % n) for i in range(n)]


def path(*points):
    return list(itertools.pairwise(points))


LATTICE = [(x, y) for y in range(1, 11) for x in range(2, 14)]

CASES = {
    # -- artem-ogre/CDT
    "CDT 77: overlapping edges": ([(0, 0), (1, 0), (2, 0), (3, 0), (1, 2)], [(0, 2), (1, 3)]),
    "CDT 42: a hole on the border": (
        [(0, 0), (2, 0), (2, 3), (0, 3), (0.5, 0), (1.5, 0), (1.5, 1), (0.5, 1)], ring(4) + ring(4, 4)),
    "CDT 42: holes on the border of holes": (
        [(0, 0), (2, 0), (2, 3), (0, 3), (0.5, 0), (1.5, 0), (1.5, 1), (0.5, 1), (0.75, 0), (1.25, 0), (1.25, 0.7), (0.75, 0.7),
         (0.9, 0), (1.1, 0), (1.1, 0.4), (0.9, 0.4)], ring(4) + ring(4, 4) + ring(4, 8) + ring(4, 12)),
    "CDT 65: a flat triangle": ([(1, 0), (0, 0.251), (-1, 0)], [(0, 2)]),
    "CDT 139: an edge that ends among those it crosses, and crosses": (
        [(725, 415), (855, 390), (945, 455), (1100, 373), (1215, 410), (1250, 510), (943, 540)], [(3, 5), (0, 4)]),
    "CDT 142: edges that hang twice": (
        [(2.7145555, -1.5168651), (2.5013921, -1.39569), (3.0311139, -1.6827598), (2.7610707, -1.5269606), (2.7745042, -1.5207595),
         (2.8049774, -1.4492451), (4.2982483, -2.210517), (2.8477705, -1.6077808), (2.3252072, -1.3108287)], ring(9)),
    "CDT: three points hang below a long edge": (
        [(0, 40), (20, 37), (30, 43), (40, 37), (60, 40), (30, 45), (30, 48), (30, 55)], [(0, 4)]),
    "CDT 148: edges that cross, and go on": ([(0, 0.2), (1, 0), (1, 1), (0, 1), (0.5, 0.2), (0.8, 0.5)], [(0, 2), (1, 3)]),
    "CDT: points on an edge": ([(0, 1), (2, 2), (4, 2), (2, 0), (4, 0), (6, 1), (8, 1), (10, 2), (12, 2), (10, 0), (12, 0), (14, 1)], [(0, 11)]),
    "CDT: a row of edges with rhombs": (
        [(0, 1), (2, 2), (4, 2), (2, 0), (4, 0), (6, 1), (8, 1), (10, 2), (12, 2), (10, 0), (12, 0), (14, 1)],
        [(0, 11), (0, 6), (1, 3), (2, 4), (7, 9), (8, 10)]),
    "CDT: a crack in a square": ([(0, 0), (1, 0), (1, 1), (0.5001, 1), (0.5, 0.5), (0.4999, 1), (0, 1)], ring(7)),
    "CDT: a fixed edge that a crossing must not flip": ([(2, 8), (12, 11), (12, 10), (2, 7), (12, 8), (5, 10)], [(0, 1), (0, 2), (1, 3)]),
    "CDT 204: the upright of a T ends on the bar": ([(0, 10), (10, 10), (5, 10), (5, 0)], [(0, 1), (2, 3)]),
    "CDT 220: one edge twice, with crossings": (
        [(6, -6), (7, -4), (8, -8), (7, 5), (0, 7), (-1, 3), (7, 1), (-6, -6)], [(2, 5), (1, 7), (4, 6), (0, 3), (0, 3)]),
    "CDT 200, conform: edges that touch": ([(7, 3), (0, 4), (3, 1), (0, 6), (6, 8)], [(0, 1), (0, 3)]),
    # -- spade
    "spade 98: endless location": (
        [(-20.926544189453125, 16.53529167175293), (-27.772645950317383, 4.197676658630371), (-20.03745460510254, 12.93730354309082),
         (-20.930097579956055, 11.93786907196045), (-15.576859474182129, 8.772907257080078), (-22.373262405395508, 12.348699569702148),
         (-10.038422584533691, 5.663522243499756), (-16.382625579833984, 9.09498119354248), (0, 0), (-13.11422061920166, 7.30709171295166),
         (-19.230497360229492, -3.7645812034606934), (-7.411926746368408, 3.486957311630249), (-25.072885513305664, -9.239323616027832),
         (-19.462360382080078, -1.621320366859436), (-32.41080856323242, -13.72575855255127), (-22.58626365661621, -2.076631784439087),
         (-25.57504653930664, -4.952820301055908), (-33.08932113647461, 0.31093916296958923), (-25.955543518066406, 0.18878456950187683),
         (-21.296192169189453, 9.872323036193848)],
        [(0, 1), (2, 3), (4, 5), (6, 7), (8, 9), (10, 11), (12, 13), (14, 15), (14, 16), (17, 18)]),
    "spade 107: a crossing from which no place is found": (
        [(0.9296344883099084, 0.03071359966930065), (0.26031306872107085, 0.34491289915959455), (0.7384289920396423, 0.4981747664368982),
         (0.06543525273452533, 0.34139896206401854), (0.9535295221136963, 0.9114305148801416), (0.8306091165247367, 0.08959389670590667),
         (0.5138795569454557, 0.3186272217036502)], [(0, 1), (2, 3), (4, 5)]),
    "spade 109: edges that are nearly one": (
        [(17.064112, -17.96008), (16.249594, -17.145563), (-25.290726, -24.435482), (-5.6608872, -24.435482), (17.878626, -18.774595),
         (15.435078, -16.331045), (16.331045, -21.951208), (-3.29879, -24.435482)], [(0, 1), (2, 3), (4, 5), (6, 7)]),
    "spade 113: a crossing at a vertex, in single precision": (
        [(-11.673287, -28.37192), (-16.214716, -43.81278), (7.4022045, -51.355137), (-13.92232, -36.01863)], [(0, 1), (2, 3)]),
    "spade 116: edges on one line, nearly": (
        [(15.435077667236328, 16.331045150756836), (20.322175979614258, 21.218143463134766), (18.69314193725586, 19.589109420776367),
         (19.507659912109375, 20.40362548828125), (19.507659912109375, 21.218143463134766), (17.878625869750977, 18.774595260620117)],
        [(0, 1), (2, 3), (4, 3), (5, 3)]),
    "spade: an edge from far over a heap of points": (
        [(-3.947938514986289, -8.016680534876258), (-4.016029045366132, -9.680855465455608), (-4.46653326962287, -8.462568264351527),
         (-7.033691993749462, -8.88072731817851), (-6.058360215097096, -8.644637388990939), (3.2348222581121586, -8.136734693290444),
         (-8.839844309691154, -8.930685085211245)], [(5, 6)]),
    "spade: an edge is all there is, and is split": ([(-10, -10), (20, -10), (0, -10), (5, 30)], [(0, 1)]),
    # -- CGAL
    "CGAL 3267: edges in the last bits of large coordinates": (
        [(866874.52509081131, 2025663.1385288462), (866874.52509079711, 2025663.1385288464), (866874.52509081364, 2025663.1385288467),
         (866874.52509080991, 2025663.1385288469), (866874.52509081631, 2025663.1385288464)], [(0, 2), (2, 1), (3, 4)]),
    "CGAL 2999: three lines that touch, none in a corner of both": ([(0, 0), (6, 0), (2, 0), (2, 5), (4, 0), (4, -5), (2, 3), (-1, 3)], [(0, 1), (2, 3), (4, 5), (6, 7)]),
    "CGAL 3447: a line twice": ([(0, 0), (3, 1), (5, 0), (2, 4)], path(0, 1, 2) + path(0, 1, 2)),
    "CGAL 4025: corners of a line in a row": ([(1, 0), (2, 1), (4, 2), (2, 3), (4, 4), (1, 5), (3, 0), (3, 1), (3, 2), (3, 5)], path(6, 7, 8, 9) + path(0, 1)),
    # -- poly2tri
    "poly2tri 10: corners that are level but for the last bits": (
        [(-0.61158088, 0.010423556541195089), (-0.61158088, 0.1483950316905975), (-0.57889959689876247, 0.22729462858935995), (-0.5, 0.25997591169059753),
         (0.5, 0.25997591169059753), (0.57889959689876247, 0.22729462858935995), (0.61158088, 0.1483950316905975), (0.61158088, 0.010423556541195062),
         (0.38841912, 0.010423556541195089), (0.38841912, 0.036814151690597513), (-0.38841912, 0.036814151690597527), (-0.38841912, 0.010423556541195089)], ring(12)),
    "poly2tri 39: a corner 1e-15 beside its neighbours' line": ([(0, 0), (0.5, 1e-15), (1, 0), (1, 1), (0, 1)], ring(5)),
    "poly2tri 15: a quadrilateral with a corner inside": ([(-10, -10.6426), (-28.3133, -5.98394), (19.8795, 21.6466), (18.4337, -5.02008)], ring(4)),
    "poly2tri 15: another one": ([(-4.61211, -11.3371), (-44.477, -3.90043), (25.2674, 20.9521), (23.8216, -5.71459)], ring(4)),
    "poly2tri 18: a polygon that touches itself": (
        [(1033, 309), (1032, 309.14935064935065), (1032, 331.55555555555617), (1031.9802955665025, 332), (968, 332), (968, 318.70779220779224), (879, 332),
         (1024, 512)], ring(8)),
    "poly2tri 49: a round polygon": (
        [(50, 120.5), (37.5, 118.70000457763672), (25, 113.30000305175781), (14.050000190734863, 105.1500015258789), (6.25, 95.25), (1.5500000715255737, 83.5),
         (0, 70), (1.5500000715255737, 56.45000076293945), (6.25, 44.70000076293945), (14.050000190734863, 34.79999923706055), (25, 26.649999618530273), (37.5, 21.25),
         (50, 19.450000762939453), (62.5, 21.25), (75, 26.649999618530273), (85.9000015258789, 34.79999923706055), (93.75, 44.70000076293945),
         (98.4000015258789, 56.45000076293945), (100, 70), (98.4000015258789, 83.5), (93.75, 95.25), (85.9000015258789, 105.1500015258789), (75, 113.30000305175781),
         (62.5, 118.70000457763672)], ring(24)),
    "poly2tri-cs 7: a polygon that comes twice to its corners": (
        [(0, 0), (26.1011, 0), (26.3587, 16.8932), (22.9269, 14.909), (22.5945, 1.7841), (3.3232, 1.7841), (3.3232, 15.0749), (-0.22, 17.0728)],
        path(0, 1, 2, 3, 4, 5, 6, 3, 2, 7, 0)),
    # -- Constrainautor
    "Constrainautor 2: a polygon over a lattice": (LATTICE, path(14, 20, 69, 67, 103, 98, 50, 14)),
    "Constrainautor 4: edges far between": (
        [(544, 480), (512, 192), (544, 160), (512, 384), (512, 224), (544, 320), (704, 128), (576, 352), (672, 352), (576, 128), (608, 384), (672, 96), (640, 96),
         (608, 160), (672, 160), (608, 288)], [(1, 2), (4, 5), (5, 0), (6, 8), (8, 7), (7, 9)]),
    "Constrainautor 15: an edge of length 1e-17": (
        [(0, 0), (0.05626429153399996, 0), (0.024093852080076722, 4.80267923973791e-18), (0.01379050745122589, 0.1463775332929564),
         (0.05177587092034522, 0.015468457826306506), (0.024093852080076705, -5.204170427930421e-18)], [(0, 5), (5, 2)]),
    # -- JTS, GEOS
    "JTS 826: a polygon that is split for ever": (
        [(-5.139864348491315, -1.8039338300053203), (-4.432009282175666, -1.6631749878758058), (-5.5365769064693575, -0.10992007721512209),
         (-5.469725816735179, -1.4281793732546362)], ring(4)),
    "JTS 407: a G": (
        [(153223840, 204689616), (153228864, 204689616), (153231376, 204689616), (153231376, 204687104), (153226352, 204687104), (153226352, 204682080),
         (153228864, 204682080), (153228864, 204684592), (153231376, 204684592), (153231376, 204679568), (153223840, 204679568)], ring(11)),
    "JTS 1190: a triangle alone": ([(0, 0), (1, 0), (0.3, 0.8)], ring(3)),
    # -- others
    "geogram 363: a triangle in a parallelogram, which it touches": (
        [(0, 0), (1, 2), (3, 2), (2, 0), (2, 2), (1, 1), (2, 1)], ring(4) + ring(3, 4)),
    "geogram 106: three points in a row, with the edge over them": ([(0, 0), (1, 1), (2, 2), (0, 2), (2, 0)], path(0, 1, 2) + [(0, 2)]),
    "Tinfour 35: a line that goes on behind a gap": ([(0, 0), (1, 0), (2, 0), (3, 0), (1, 1)], [(0, 1), (2, 3)]),
    "Triangle: segments on corners of others": (
        [(0, 0), (1, 1), (0, 2), (2, 0), (2, 2), (0.5, 1), (3, 0), (0, 3), (1.5, 1)], ring(3) + ring(3, 3) + ring(3, 6)),
    "SFCGAL in PostGIS: five lines by five": (
        [(i, 0) for i in range(1, 6)] + [(i, 6) for i in range(1, 6)] + [(0, i) for i in range(1, 6)] + [(6, i) for i in range(1, 6)],
        [(i, i + 5) for i in range(5)] + [(i + 10, i + 15) for i in range(5)]),
    "VTK: one of two lines that cross": ([(0, 0), (4, 4), (0, 4), (4, 0)], [(0, 1), (2, 3)]),
    "PostGIS ST_BuildArea: a ring twice": ([(0, 0), (4, 0), (4, 4), (0, 4), (2, 2)], ring(4) + ring(4)),
    "rings that overlap": ([(0, 0), (4, 0), (4, 4), (0, 4), (2, 2), (6, 2), (6, 6), (2, 6)], ring(4) + ring(4, 4)),
    "GDAL's arcs in DXF: a segment 6e-17 long": ([(0, 0), (6e-17, 0), (1, 0.5), (2, 0), (1, 3)], path(0, 1, 2, 3)),
}


def exact(points):
    return [tuple(map(fractions.Fraction, place)) for place in points]


def side(a, b, c):
    value = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return (value > 0) - (value < 0)


def crossings(points, lines):
    """Pairs of segments of lines that cross elsewhere than in a vertex, by exact arithmetic; a segment is a line and a position."""
    places = exact(points)
    vertices = set(places)
    segments = [(n, k, places[a], places[b]) for n, line in enumerate(lines) for k, (a, b) in enumerate(zip(line, line[1:]))]
    found = []
    for (m, j, a, b), (n, k, c, d) in itertools.combinations(segments, 2):
        if side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0:
            t = ((c[0] - a[0]) * (d[1] - c[1]) - (c[1] - a[1]) * (d[0] - c[0])) / ((b[0] - a[0]) * (d[1] - c[1]) - (b[1] - a[1]) * (d[0] - c[0]))
            if tuple(p + t * (q - p) for p, q in zip(a, b)) not in vertices:
                found.append((m, j, n, k))
    return sorted(found)


class Published(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """One session, since a psql for each of a thousand statements takes longer than they do."""
        cls.session, cls.psql = psql_session.Session(), staticmethod(abacus.psql)
        abacus.psql = cls.in_session

    @classmethod
    def tearDownClass(cls):
        abacus.psql("DROP TABLE IF EXISTS corners, meeting, reported CASCADE")
        abacus.psql = cls.psql
        cls.session.close()

    @classmethod
    def in_session(cls, sql, sent=""):
        if sent:
            return cls.psql(sql, sent)
        try:
            printed = cls.session.run(sql + ";")
            return printed + "\n" if printed else ""
        except psql_session.Failure as failure:
            raise abacus.Refused(str(failure)) from failure

    def rows(self, points, lines, ids=True):
        """Rows of lines as SQL: with ids that count from 1, or with places alone."""
        return ", ".join(f"({n}, {k}, {i + 1 if ids else 'NULL'}::bigint, {points[i][0]!r}::float8, {points[i][1]!r}::float8)"
                         for n, line in enumerate(lines) for k, i in enumerate(line))

    def make(self, points, first=None):
        """The mesh of the points, or of the first of them."""
        abacus.store("reported_points", ["x", "y"], points)
        abacus.psql(f"DROP TABLE IF EXISTS reported CASCADE; SELECT abacus_triangulate('reported', 'SELECT * FROM reported_points WHERE id <= {first or len(points)}')")

    def compare(self, points, lines, expected):
        self.assertEqual(abacus.rows("SELECT * FROM abacus_check('reported')"), [])
        found, fixed, _ = ours("reported")
        numpy.testing.assert_array_equal(fixed, expected[1])
        numpy.testing.assert_array_equal(found, canonical(expected[0]))

    def accepted(self, points, lines):
        """Equal to CGAL's: all at once, lines before other points, line by line, and when they have gone and come again."""
        segments = numpy.array([pair for line in lines for pair in zip(line, line[1:])], dtype=int)
        expected = theirs(points, segments)
        values = self.rows(points, lines)
        self.make(points)
        abacus.psql(f"SELECT abacus_constrain('reported', 'VALUES {values}')")
        self.compare(points, lines, expected)
        abacus.psql("SELECT abacus_unconstrain('reported', 'SELECT line FROM abacus_lines(''reported'') WHERE line % 2 = 0')")
        self.assertEqual(abacus.rows("SELECT * FROM abacus_check('reported')"), [])
        abacus.psql(f"SELECT abacus_constrain('reported', 'SELECT * FROM (VALUES {values}) AS v (line) WHERE line % 2 = 0')")
        self.compare(points, lines, expected)
        # lines first: a mesh without triangles, where they wait; then the points that no line names, one by one
        abacus.psql(f"DROP TABLE reported; SELECT abacus_create('reported', 2); SELECT abacus_constrain('reported', 'VALUES {values}')")
        named = set(segments.ravel())
        abacus.psql("; ".join(f"SELECT abacus_insert('reported', 'SELECT * FROM reported_points WHERE id = {n + 1}')"
                              for n in range(len(points)) if n not in named))
        self.compare(points, lines, expected)
        # points that no line names go
        kept = [i for i in range(len(points)) if i in named]
        if 2 < len(kept) < len(points):
            abacus.psql(f"SELECT abacus_delete('reported', 'SELECT * FROM reported_points WHERE id <> ALL (ARRAY{[i + 1 for i in kept]})')")
            if int(abacus.rows("SELECT value FROM abacus_stats('reported') WHERE name = 'simplices'")[0][0]):
                number = {old: new for new, old in enumerate(kept)}
                triangles, edges, _ = theirs(points[kept], numpy.vectorize(number.get)(segments))
                self.compare(points, lines, (numpy.array(kept)[triangles], numpy.sort(numpy.array(kept)[edges])))

    def refused(self, points, lines, expected):
        """All crossings are counted, nothing changes; with a corner at each, however often that must be done, they are accepted."""
        values = self.rows(points, lines)
        self.make(points)
        before = abacus.rows("SELECT v0, v1, v2 FROM abacus_simplices('reported')")
        with self.assertRaisesRegex(abacus.Refused, "lines cross") as error:
            abacus.psql(f"SELECT abacus_constrain('reported', 'VALUES {values}')")
        if len(expected) > 1:
            self.assertIn(f"There are {len(expected)} crossings", str(error.exception))
        self.assertEqual(abacus.rows("SELECT v0, v1, v2 FROM abacus_simplices('reported')"), before)
        self.assertEqual(abacus.rows("SELECT * FROM abacus_lines('reported')"), [])
        listed = abacus.rows(f"SELECT line_a, position_a, line_b, position_b FROM abacus_crossings('reported', 'VALUES {values}')")
        self.assertEqual(sorted(tuple(map(int, row)) for row in listed), expected)
        abacus.psql(f"DROP TABLE IF EXISTS corners; CREATE TABLE corners AS SELECT * FROM (VALUES {values}) AS v (line, position, point, x, y)")
        for _ in range(10):
            abacus.psql("""DROP TABLE IF EXISTS meeting; CREATE TABLE meeting AS SELECT DISTINCT line, position, x, y
                FROM abacus_crossings('reported', 'SELECT line, position, x, y FROM corners'), LATERAL (VALUES (line_a, position_a), (line_b, position_b)) AS s (line, position);
                CREATE TABLE more AS SELECT line, row_number() OVER (PARTITION BY line ORDER BY position, along) AS position, point, x, y FROM
                (SELECT *, lag(x) OVER w AS x0, lag(y) OVER w AS y0 FROM
                (SELECT *, -1::float8 AS along FROM corners UNION ALL SELECT line, position, NULL, m.x, m.y, (m.x - c.x) ^ 2 + (m.y - c.y) ^ 2 FROM meeting AS m JOIN corners AS c USING (line, position)) AS c
                WINDOW w AS (PARTITION BY line ORDER BY position, along)) AS s WHERE (x, y) IS DISTINCT FROM (x0, y0);
                DROP TABLE corners; ALTER TABLE more RENAME TO corners""")
            if abacus.rows("SELECT count(*) FROM meeting") == [["0"]]:
                break
        else:
            self.fail("crossings remain")
        abacus.psql("SELECT abacus_constrain('reported', 'SELECT line, position, point, x, y FROM corners')")
        self.assertEqual(abacus.rows("SELECT * FROM abacus_check('reported')"), [])
        vertices = {int(row[0]): n for n, row in enumerate(abacus.rows("SELECT id FROM abacus_vertices('reported') ORDER BY id"))}
        places = abacus.numbers("SELECT x, y FROM abacus_vertices('reported') ORDER BY id")
        ends = abacus.numbers("SELECT a.id, b.id FROM abacus_lines('reported') AS p JOIN abacus_lines('reported') AS q ON q.line = p.line AND q.position = p.position + 1"
                              " JOIN abacus_vertices('reported') AS a ON a.x = p.x AND a.y = p.y JOIN abacus_vertices('reported') AS b ON b.x = q.x AND b.y = q.y").astype(int)
        triangles, edges, _ = theirs(places, numpy.vectorize(vertices.get)(ends))
        found, fixed, _ = ours("reported")
        back = numpy.array(sorted(vertices))
        numpy.testing.assert_array_equal(fixed, sorted(map(sorted, (back[edges] - 1).tolist())))
        numpy.testing.assert_array_equal(found, canonical(back[triangles] - 1))

    def test_cases(self):
        for name, (points, segments) in CASES.items():
            with self.subTest(name):
                points = numpy.array(points, dtype=float)
                lines = [list(segment) for segment in segments]
                found = crossings(points, lines)
                if found:
                    self.refused(points, lines, found)
                else:
                    self.accepted(points, lines)


if __name__ == "__main__":
    unittest.main()
