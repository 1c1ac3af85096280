#!/usr/bin/python3
"""The page docs/cookbook/crossing-lines.md at real size: its own statements, with contours of the Jacksboro fault, and the border of Kentucky and
Tennessee and the rivers there. ABACUS_LARGE=1 takes all points of the terrain, and a contour every 10 m. Skipped without PostGIS."""
import os
import pathlib
import re
import sys
import unittest

import numpy

import abacus

sys.path.append(str(abacus.REPOSITORY / "scripts"))
import gshhg_points  # noqa: E402
import terrain_points  # noqa: E402

PAGE = abacus.REPOSITORY / "docs/cookbook/crossing-lines.md"
LARGE = bool(os.environ.get("ABACUS_LARGE"))
FIRST_ROAD = 1000001


def terrain():
    """The elevation model: the rows of terrain_points.py, thinned in the usual size; what turns degrees into its metres."""
    with numpy.load(terrain_points.FILE) as data:
        heights = data["elevation"].astype(float)
        west, south = float(data["xmin"]), min(float(data["ymin"]), float(data["ymax"]))
        degrees = numpy.array([float(data["dx"]), float(data["dy"])])
        middle = numpy.radians((float(data["ymin"]) + float(data["ymax"])) / 2)
    metres = numpy.round(degrees * terrain_points.METRES_PER_DEGREE * [numpy.cos(middle), 1])
    step = 1 if LARGE else 3
    rows, columns = numpy.mgrid[0:heights.shape[0]:step, 0:heights.shape[1]:step]
    points = numpy.column_stack([columns.ravel() * metres[0], (heights.shape[0] - 1 - rows.ravel()) * metres[1]])
    return points, heights[rows.ravel(), columns.ravel()], lambda places: (places - [west, south]) / degrees * metres


def lines_over(corner, to_metres):
    """Borders and rivers within the box from the origin to a corner, as lists of places in metres."""
    lines = []
    for kind in ("border", "river"):
        lon, lat, first = gshhg_points.contents_of(f"{gshhg_points.FOLDER}/binned_{kind}_f.nc")
        places = to_metres(numpy.column_stack([lon, lat]))
        inside = ((places > 0) & (places < corner)).all(axis=1)
        line = numpy.repeat(numpy.arange(len(first)), numpy.diff(numpy.append(first, len(lon))))
        numbers = numpy.flatnonzero(inside)
        for part in numpy.split(numbers, numpy.flatnonzero((numpy.diff(numbers) > 1) | (numpy.diff(line[numbers]) != 0)) + 1):
            part = places[part].round()
            part = part[numpy.append(True, (numpy.diff(part, axis=0) != 0).any(axis=1))] if len(part) else part
            if len(part) > 1:
                lines.append(part)
    return lines


def make_tables():
    """The tables `contours` and `roads` of the page."""
    points, heights, to_metres = terrain()
    abacus.psql("DROP TABLE IF EXISTS contours, roads, crossing, all_crossings, corners, meeting, noded, pieces, star, place, ground, ground_vertices, ground_lines CASCADE")
    abacus.triangulate("terrain", points, height=heights)
    abacus.psql(f"""SET client_min_messages = warning; CREATE EXTENSION IF NOT EXISTS abacus_postgis CASCADE;
        CREATE TABLE contours AS SELECT id, ST_Force3DZ(geom, value) AS geom FROM abacus_contours_geom('terrain', {10 if LARGE else 50});
        CREATE TABLE roads (id bigint, geom geometry(LineStringZ))""")
    for number, line in enumerate(lines_over(points.max(axis=0), to_metres)):
        text = ",".join(f"{x} {y}" for x, y in line)
        abacus.psql(f"INSERT INTO roads VALUES ({FIRST_ROAD + number}, abacus_drape('terrain', 'LINESTRING({text})'))")


def run_page():
    """What psql prints for the blocks of the page, but for the first part of it, which makes the tables. Where the page says so, crossings that come
    of rounding are treated as the first ones."""
    blocks = re.findall(r"^```sql\n(.*?)^```", PAGE.read_text(), re.M | re.S)
    blocks[0] = blocks[0][blocks[0].index("SELECT abacus_create"):]
    printed = ""
    for block in blocks:
        printed += abacus.script(block)
        if "CREATE TABLE noded" not in block:
            continue
        abacus.psql("CREATE TABLE all_crossings AS TABLE crossing")
        for _ in range(10):
            if abacus.rows("SELECT count(*) FROM abacus_crossings('ground', 'SELECT line, position, x, y FROM noded')") == [["0"]]:
                break
            abacus.psql("""DROP TABLE crossing, meeting, corners; ALTER TABLE noded RENAME TO corners;
                CREATE TABLE crossing AS SELECT * FROM abacus_crossings('ground', 'SELECT line, position, x, y FROM corners');
                INSERT INTO all_crossings TABLE crossing""")
            abacus.psql(block[block.index("CREATE TABLE meeting"):])
    abacus.psql("DROP TABLE crossing; ALTER TABLE all_crossings RENAME TO crossing")
    return printed


def places(query):
    """How many different places a query of x and y has, as numbers that are equal only if all bits are."""
    return {tuple(row) for row in abacus.rows(query)}


class CrossingLines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not abacus.rows("SELECT FROM pg_available_extensions WHERE name = 'postgis'"):
            raise unittest.SkipTest("PostGIS is not installed")
        make_tables()
        cls.printed = run_page()

    @classmethod
    def tearDownClass(cls):
        abacus.psql("DROP TABLE IF EXISTS contours, roads, crossing, corners, meeting, noded, pieces, star CASCADE; DROP TABLE IF EXISTS ground, terrain, place CASCADE; "
                    "DROP EXTENSION abacus_postgis, postgis CASCADE")

    def test_refused_first(self):
        """Lines that cross are refused, and the error counts what abacus_crossings returned: as many as PostGIS finds."""
        count = int(re.search(r"There are (\d+) crossings; these are the first ten:", self.printed)[1])
        self.assertGreater(count, 500 if LARGE else 100)
        theirs = abacus.rows("""WITH corner AS MATERIALIZED (SELECT ST_X(d.geom) AS x, ST_Y(d.geom) AS y FROM (TABLE contours UNION ALL TABLE roads) AS c, ST_DumpPoints(c.geom) AS d)
            SELECT count(*) FROM (TABLE contours UNION ALL TABLE roads) AS c JOIN roads AS r ON c.geom && r.geom AND c.id < r.id,
            LATERAL (SELECT (ST_Dump(ST_Intersection(c.geom, r.geom))).geom) AS p WHERE ST_Dimension(p.geom) = 0
            AND NOT EXISTS (SELECT FROM corner AS k WHERE ST_X(p.geom) = k.x AND ST_Y(p.geom) = k.y)""")
        self.assertEqual(count, int(theirs[0][0]))

    def test_one_height_at_each(self):
        """Each crossing is a vertex with the height of its contour, on lines of both sets; the mesh is right."""
        self.assertEqual(abacus.rows("SELECT * FROM abacus_check('ground')"), [])
        self.assertEqual(places("SELECT x, y FROM crossing"), places(f"""SELECT v.x, v.y FROM crossing AS c JOIN abacus_vertices('ground') AS v ON v.x = c.x AND v.y = c.y
            LEFT JOIN contours ON contours.id = c.line_a WHERE c.line_a >= {FIRST_ROAD} OR attributes[1] = ST_Z(ST_StartPoint(geom))"""))
        missing = abacus.rows("""SELECT c.* FROM crossing AS c CROSS JOIN LATERAL (VALUES (line_a), (line_b)) AS s (line)
            LEFT JOIN abacus_lines('ground') AS k ON k.line = s.line AND k.x = c.x AND k.y = c.y WHERE k.line IS NULL""")
        self.assertEqual(missing, [])
        self.assertEqual(abacus.rows("SELECT count(DISTINCT line) FROM abacus_lines('ground')"),
                         abacus.rows("SELECT (SELECT count(*) FROM contours) + (SELECT count(*) FROM roads)"))
        # nothing else about a contour has changed
        self.assertEqual(abacus.rows("""SELECT count(*) FROM abacus_lines('ground') JOIN abacus_vertices('ground') AS v USING (x, y)
            JOIN (SELECT id AS line, ST_Z(ST_StartPoint(geom)) AS level FROM contours OFFSET 0) AS c USING (line) WHERE attributes[1] <> level"""), [["0"]])

    def test_noded_by_postgis(self):
        """ST_Node gives most crossings a height that no contour has. Where it leaves two at one place, the error names both."""
        changed, = abacus.numbers("""SELECT count(*), max(abs(ST_Z(p) - ST_Z(ST_StartPoint(c.geom))))
            FROM crossing JOIN contours AS c ON c.id = line_a, (SELECT DISTINCT ST_StartPoint(geom) AS p FROM pieces) AS s
            WHERE round(ST_X(p)::numeric, 3) = round(x::numeric, 3) AND round(ST_Y(p)::numeric, 3) = round(y::numeric, 3) AND ST_Z(p) <> ST_Z(ST_StartPoint(c.geom))""")
        self.assertGreater(changed[0], 50)
        self.assertGreater(changed[1], 10)
        doubled = abacus.rows("""SELECT ST_X(p.geom), ST_Y(p.geom), min(ST_Z(p.geom)), max(ST_Z(p.geom)) FROM pieces, ST_DumpPoints(pieces.geom) AS p
            GROUP BY 1, 2 HAVING min(ST_Z(p.geom)) <> max(ST_Z(p.geom)) ORDER BY 1, 2""")
        print(f"{len(doubled)} places with two heights, {changed[0]:.0f} changed by up to {changed[1]:.1f} m")
        self.assertGreater(len(doubled), 0)
        abacus.psql("DROP TABLE IF EXISTS pieced CASCADE; SELECT abacus_create('pieced', 2, '{height}')")
        x, y, least, most = doubled[0]
        with self.assertRaises(abacus.Refused) as refused:
            abacus.psql("SELECT abacus_constrain('pieced', 'SELECT id, geom FROM pieces', z => 'height')")
        self.assertIn(f'attribute "height" has two values at ({x}, {y})', str(refused.exception))
        self.assertRegex(str(refused.exception), rf"It is {re.escape(least)} at .*, and {re.escape(most)} at ")
        abacus.psql("""SELECT abacus_constrain('pieced', $$ SELECT id, path[1], NULL, ST_X(p.geom), ST_Y(p.geom),
            avg(ST_Z(p.geom)) OVER (PARTITION BY ST_X(p.geom), ST_Y(p.geom)) AS height FROM pieces, ST_DumpPoints(pieces.geom) AS p $$)""")
        self.assertEqual(abacus.rows("SELECT * FROM abacus_check('pieced')"), [])
        abacus.psql("DROP TABLE pieced")


if __name__ == "__main__":
    unittest.main()
