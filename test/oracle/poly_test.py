"""Triangle's .poly: points, segments, holes and regions come in, go out, and come back; files that are wrong are refused with their lines."""
import subprocess
import sys
import unittest

import abacus

CLIENT = abacus.REPOSITORY / "client"
sys.path.insert(0, str(CLIENT))
from abacus_files import apart, read  # noqa: E402
from abacus_files.plan_input import PlanInput  # noqa: E402
from abacus_files.psql import Failed  # noqa: E402

POLY = """# a square with a notch, a hole, and a segment that a point lies on
8 2 1 1
1 0 0 5 1
2 10 0 5 1
3 10 10 6 1
4 0 10 6 1
5 4 3 7 0
6 6 3 7 0
7 5 5 7 0
8 5 0 nan 1

9 1
1 1 2 3
2 2 3 3
3 3 4 3
4 4 1 3
5 1 7 2   # the diagonal
6 7 3 0
10 5 6 4
11 6 7 4
12 7 5 4
1
1 5 4
2
1 1 8 3 0.1
2 8 1 -2
"""


def run(command, *arguments):
    return subprocess.run(["/usr/bin/python3", str(CLIENT / command), *map(str, arguments)], text=True, capture_output=True)


def content(mesh):
    """All that a mesh has, as rows. Numbers of regions and positions of lines are counted anew."""
    return [abacus.rows(query) for query in (
        f"SELECT name FROM abacus_attributes('{mesh}') ORDER BY position", f"SELECT abacus_srid('{mesh}')",
        f"SELECT v0, v1, v2, corners, \"values\" FROM abacus_cells('{mesh}') ORDER BY v0, v1, v2",
        f"SELECT marker, v0, v1 FROM abacus_facets('{mesh}') ORDER BY marker, v0, v1",
        f"SELECT line, row_number() OVER (PARTITION BY line ORDER BY position), x, y, kind, part FROM abacus_lines('{mesh}')",
        f"SELECT region, triangles, area, edges FROM abacus_regions('{mesh}')",
        f"SELECT * FROM abacus_check('{mesh}')")]


class Poly(abacus.InFolder):
    def imported(self, path, mesh):
        abacus.psql(f"DROP TABLE IF EXISTS {mesh} CASCADE")
        done = run("abacus-import", path, mesh)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr.replace(f"abacus-import: {path}: ", "").splitlines()

    def refused(self, said, *changes, text=POLY):
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        path = self.file("broken.poly", text)
        with self.assertRaisesRegex(Failed, said):
            grid = read.read_here(str(path), keep_apart=False)
            grid.check()
            PlanInput(grid)

    def test_in(self):
        said = self.imported(self.file("a.poly", POLY), "poly_in")
        self.assertEqual(said, ["left out: 1 greatest area of triangles (a mesh gets no other points than those of the file)"])
        self.assertEqual(abacus.rows("SELECT id, attributes FROM abacus_vertices('poly_in') ORDER BY id")[-1], ["8", "{NULL,1}"])
        self.assertEqual(abacus.rows("SELECT line, array_agg(point ORDER BY position) FROM abacus_lines('poly_in') WHERE line IN (1, 10) GROUP BY line ORDER BY line"),
                         [["1", "{1,2}"], ["10", "{5,6}"]])
        # segment 1 is two edges, and both have its marker
        self.assertEqual(abacus.rows("SELECT marker, count(*) FROM abacus_facets('poly_in') GROUP BY marker ORDER BY marker"), [["2", "1"], ["3", "5"], ["4", "3"]])
        self.assertEqual(abacus.rows("SELECT region, area FROM abacus_regions('poly_in') ORDER BY region"), [["-2", "48"], ["3", "50"], ["hole", "2"]])
        self.assertEqual(abacus.rows("SELECT * FROM abacus_check('poly_in')"), [])

    def test_out_and_back(self):
        self.imported(self.file("a.poly", POLY), "poly_first")
        done = run("abacus-export", "poly_first", self.at / "b.poly", "--strict")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        text = (self.at / "b.poly").read_text()
        self.assertIn('# abacus region "3"\n2 1.0 8.0 3 -1\n', text)
        self.assertEqual(self.imported(self.at / "b.poly", "poly_again"), [])
        self.assertEqual(content("poly_again"), content("poly_first"))

    def test_all_that_a_mesh_has(self):
        """Ids that are not numbers of points, soft lines, parts, outlines, markers within lines of several segments, an SRID."""
        abacus.psql("DROP TABLE IF EXISTS poly_shire CASCADE")
        abacus.psql("SELECT abacus_triangulate('poly_shire', 'SELECT 7 * (10 * x + y) - 30 AS id, x, y, x + 2 * y AS height FROM generate_series(0, 9) AS x, generate_series(0, 9) AS y')")
        abacus.psql("SELECT abacus_constrain('poly_shire', $$SELECT line, at AS position, NULL::bigint AS point, x, y FROM (VALUES (1, 1, 1, 1), (1, 2, 7, 1), (1, 3, 7, 7), (1, 4, 1, 7), "
                    "(1, 5, 1, 1), (-2, 1, 3, 3), (-2, 2, 5, 3), (-2, 3, 5, 5), (-2, 4, 3, 5), (-2, 5, 3, 3)) AS l (line, at, x, y)$$)")
        abacus.psql("SELECT abacus_constrain('poly_shire', $$SELECT line, at AS position, NULL::bigint AS point, x, y, part FROM (VALUES (3, 1, 0, 0, 0), (3, 2, 0, 9, 0), (3, 3, 8, 0, 1), "
                    "(3, 4, 9, 0, 1)) AS l (line, at, x, y, part)$$, kind => 'soft')")
        abacus.psql("SELECT abacus_region('poly_shire', $$VALUES ('the \"farm\"', 1), ('the \"farm\"', -2)$$)")
        abacus.psql("SELECT abacus_region('poly_shire', $$VALUES ('hole', 4.5, 4.5)$$)")
        abacus.psql("SELECT abacus_set_srid('poly_shire', 25832)")
        mark = """SELECT abacus_mark('poly_shire', $$SELECT code, v0, v1, v2, f, {0} FROM abacus_cells('poly_shire'), generate_series(0, 2) AS f
                  WHERE (corners[(f + 1) % 3 + 1][1] + corners[(f + 2) % 3 + 1][1] = 0) OR ({1})$$)"""
        abacus.psql(mark.format(7, "corners[(f + 1) % 3 + 1][2] = 1 AND corners[(f + 2) % 3 + 1][2] = 1 AND corners[(f + 1) % 3 + 1][1] BETWEEN 1 AND 7 "
                                   "AND corners[(f + 2) % 3 + 1][1] BETWEEN 1 AND 7"))
        done = run("abacus-export", "poly_shire", self.at / "shire.poly", "--strict")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.imported(self.at / "shire.poly", "poly_shire_again")
        self.assertEqual(content("poly_shire_again"), content("poly_shire"))
        self.assertEqual(len(abacus.rows("SELECT * FROM abacus_facets('poly_shire_again')")), 15)

    def test_what_is_lost(self):
        self.imported(self.file("a.poly", POLY), "poly_lost")
        abacus.psql("SELECT abacus_mark('poly_lost', $$SELECT code, v0, v1, v2, facet, 8 FROM abacus_cells('poly_lost'), LATERAL (VALUES (0, v1, v2), (1, v0, v2), (2, v0, v1)) "
                    "AS side (facet, p, q) WHERE least(p, q) = 1 AND greatest(p, q) = 8$$)")
        path = self.at / "lost.poly"
        lost = "markers of 2 edges (only whole segments of lines have markers)"
        done = run("abacus-export", "poly_lost", path)
        self.assertEqual((done.returncode, done.stderr), (0, f"abacus-export: {path} does not hold {lost}\n"))
        path.unlink()
        done = run("abacus-export", "poly_lost", path, "--strict")
        self.assertEqual((done.returncode, done.stderr), (1, f"abacus-export: {path} would not hold {lost}\n"))
        self.assertEqual([entry.name for entry in self.at.glob("lost*")], [])
        done = run("abacus-export", "poly_lost", self.at / "lost.ply")
        self.assertIn("lines, which fix 10 edges; regions (", done.stderr)

    def test_a_loaded_mesh_has_other_triangles(self):
        abacus.psql("DROP TABLE IF EXISTS poly_loaded, poly_loaded_vertices")
        abacus.psql("SELECT abacus_load('poly_loaded', 'VALUES (1, 0, 0), (2, 9, 1), (3, 10, 9), (4, 0, 1)', 'VALUES (1, 2, 3), (1, 3, 4)')")
        self.assertIn("its triangles (2): its points and lines make others", run("abacus-export", "poly_loaded", self.at / "loaded.poly").stderr)

    def test_points_beside_it(self):
        head, _, tail = POLY.partition("\n\n")
        self.file("c.node", head)
        said = self.imported(self.file("c.poly", "0 2 1 1\n" + tail), "poly_beside")
        self.assertEqual(said[1:], ["the points were read from c.node"])
        self.imported(self.file("a.poly", POLY), "poly_in")
        self.assertEqual(content("poly_beside"), content("poly_in"))
        self.refused(r"line 1: says that its points are in broken.node, which is not there", text="0 2 0 0\n0 0\n0\n")

    def test_numbers_from_0(self):
        self.imported(self.file("zero.poly", "4 2 0 0\n0 0 0\n1 4 0\n2 4 3\n3 0 3\n1 0\n0 1 3\n0\n"), "poly_zero")
        self.assertEqual(abacus.rows("SELECT v0, v1, lines FROM abacus_edges('poly_zero', fixed => true)"), [["1", "3", "{0}"]])

    def test_no_segments(self):
        said = self.imported(self.file("none.poly", "3 2 0 0\n1 0 0\n2 4 0\n3 4 3\n0 0\n1\n1 3 1\n"), "poly_none")
        self.assertEqual(said, ["regions and holes are left out: the file has no segments at which they could end"])

    def test_what_the_server_refuses(self):
        """Nothing is left behind, and the message names the line."""
        abacus.psql("DROP TABLE IF EXISTS poly_crossed CASCADE")
        done = run("abacus-import", self.file("crossed.poly", "4 2 0 0\n1 0 0\n2 4 0\n3 4 3\n4 0 3\n2 0\n1 1 3\n2 2 4\n0\n"), "poly_crossed")
        self.assertEqual(done.returncode, 1)
        self.assertIn("Line 1 after position 1 crosses line 2 after position 1", done.stderr)
        self.assertEqual(abacus.rows("SELECT to_regclass('poly_crossed')"), [["NULL"]])
        done = run("abacus-import", self.file("leak.poly", POLY.replace("\n4 4 1 3\n", "\n").replace("9 1\n1 1", "8 1\n1 1")), "poly_crossed")
        self.assertIn('region "3" leaks to the hull', done.stderr)
        self.assertNotIn("Traceback", done.stderr)

    def test_refused(self):
        self.refused("line 3: 4 numbers, where points have 5", ("1 0 0 5 1", "1 0 0 5"))
        self.refused("line 3: zero is not a number", ("1 0 0 5 1", "1 zero 0 5 1"))
        self.refused("line 5: two points have the number 2", ("3 10 10", "2 10 10"))
        self.refused("point 1 has a coordinate that is not finite", ("1 0 0 5 1", "1 inf 0 5 1"))
        self.refused("line 12: the file says that it has -9 segments", ("9 1\n1 1", "-9 1\n1 1"))
        self.refused("line 13: a segment names point 12, which is not there", ("1 1 2 3", "1 1 12 3"))
        self.refused("line 13: a segment has the same point at both ends", ("1 1 2 3", "1 2 2 3"))
        self.refused("line 14: two segments have the number 1", ("2 2 3 3", "1 2 3 3"))
        self.refused("line 13: 1.5 is not a whole number", ("1 1 2 3", "1 1 2 1.5"))
        self.refused("does not fit 32 bits", ("1 1 2 3", f"1 1 2 {1 << 31}"))
        self.refused("line 23: 2 numbers, where holes have 3", ("1 5 4\n", "1 5\n"))
        self.refused("line 26: there is more than 1 region", ("2\n1 1 8", "1\n1 1 8"))
        self.refused("line 25: 1 number, where regions have 4", ("1 1 8 3 0.1", "1"))
        self.refused("line 12: the comment", ("9 1\n1 1 2 3", "# abacus srid 99999999\n9 1\n1 1 2 3"))
        self.refused("line 25: 3 numbers, where regions have 4", ("1 1 8 3 0.1\n", "1 1 8\n"))
        self.refused("line 26: not all of these are numbers: 2 8 y -2", ("2 8 1 -2", "2 8 y -2"))
        self.refused("line 26: the file ends before all regions are there \\(2 of 3\\)", ("2\n1 1 8", "3\n1 1 8"))
        self.refused("points in space", text="4 3 0 0\n1 0 0 0\n2 4 0 0\n3 4 3 0\n4 0 3 9\n0 0\n0\n")
        self.refused("fewer than three points", text="2 2 0 0\n1 0 0\n2 4 0\n0 0\n0\n")
        for said, comment in (("line 12: the comment is not as abacus-export writes it", "line one"), ("line 12: the comment", "region farm"),
                              ("has 2 attributes, but a comment names 1", 'attributes ["h"]'), ("line 12: the comment", "attributes 5"),
                              ("line 15: the segment of line 4 does not begin where the one above it ends", "line 4")):
            self.refused(said, ("9 1\n1 1 2 3\n2 2 3 3", f"# abacus {comment}\n9 1\n1 1 2 3\n2 3 4 3"))

    def test_cut_off(self):
        """A file that is cut off anywhere is an error of one line, or what is there is whole: the line that counts the regions may be missing, that of the holes not."""
        holes = POLY.index("1\n1 5 4\n")
        for size in (*range(0, len(POLY), 3), holes):
            path = self.file("cut.poly", POLY[:size])
            try:
                grid = read.read_here(str(path), keep_apart=False)
                grid.check()
                PlanInput(grid)
            except Failed as error:
                self.assertNotIn("\n", str(error))
            else:
                self.assertGreater(size, holes + len("1\n1 5"))
        self.refused("line 21: the file ends before the number of holes", text=POLY[:holes])
        self.refused("line 21: the file ends before the number of holes", text=POLY[:holes] + "# nothing else\n")
        self.assertEqual(read.read_here(str(self.file("cut.poly", POLY[: holes + len("1\n1 5 4\n")])), keep_apart=False).plan.regions, [["hole", None, 5.0, 4.0]])

    def test_through_the_process_apart(self):
        grid = apart.read(str(self.file("a.poly", POLY)), keep_apart=False)
        self.assertEqual(len(grid.plan.line), 18)
        self.assertEqual(grid.plan.regions[0], ["hole", None, 5.0, 4.0])


if __name__ == "__main__":
    unittest.main()
