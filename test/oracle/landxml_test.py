"""LandXML: surfaces come in, with faces, breaklines and boundaries; go out; and come back. Files that are wrong are refused with their lines."""
import re
import subprocess
import sys
import unittest
import xml.etree.ElementTree

import numpy

import abacus

CLIENT = abacus.REPOSITORY / "client"
sys.path.insert(0, str(CLIENT))
from abacus_files import read  # noqa: E402
from abacus_files.plan_input import PlanInput  # noqa: E402
from abacus_files.psql import Failed  # noqa: E402

NAMESPACE = {"l": "http://www.landxml.org/schema/LandXML-1.2"}
# A field of 8 x 4 with a pond; northing comes first. The outer boundary is not closed, the breakline has a point of its own.
FIELD = """<?xml version="1.0"?>
<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2" version="1.2" date="2026-01-01" time="00:00:00">
<Units><Imperial linearUnit="USSurveyFoot" areaUnit="squareFoot" volumeUnit="cubicYard"/></Units>
<CoordinateSystem epsgCode="2227"/>
<Surfaces><Surface name="field">
<SourceData>
<DataPoints><PntList3D>0 0 5 0 10 5 6 10 7
  6 0 9</PntList3D></DataPoints>
<Breaklines>
<Breakline brkType="standard" name="7"><PntList3D>1 0.5 5 1 3 6 1 9 5</PntList3D></Breakline>
<Breakline brkType="wall" name="kerb"><PntList2D>0 0 0 10</PntList2D></Breakline>
</Breaklines>
<Contours><Contour elev="8"><PntList2D>5.5 1 5.5 9</PntList2D></Contour></Contours>
<Boundaries>
<Boundary bndType="outer" edgeTrim="true"><PntList2D>0 0 0 10 6 10 6 0</PntList2D></Boundary>
<Boundary bndType="void"><PntList3D>2 2 4 2 4 4 4 4 4 4 2 4 2 2 4</PntList3D></Boundary>
<Boundary bndType="island"><PntList3D>2.5 2.5 4 2.5 3.5 4 3.5 3.5 4 3.5 2.5 4 2.5 2.5 4</PntList3D></Boundary>
</Boundaries>
</SourceData>
</Surface></Surfaces>
</LandXML>
"""
# An L of three faces, and one that is not shown, in the notch
FACES = """<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2" version="1.2"><Surfaces>
<Surface name="other"><Definition surfType="TIN"><Pnts/></Definition></Surface>
<Surface name="step"><SourceData>{}</SourceData><Definition surfType="TIN"><Pnts>
<P id="11">0 0 1</P>
<P id="12">0 4 1</P>
<P id="13">2 4 1</P>
<P id="14">2 2 3</P>
<P id="15">5 0 1</P>
</Pnts><Faces>
<F n="2 0 0">11 12 14</F>
<F>12 13 14</F>
<F>11 14 15</F>
<F i="1">14 13 15</F>
</Faces></Definition></Surface></Surfaces></LandXML>
"""
OUTER = '<Boundaries><Boundary bndType="outer"><PntList2D>0 0 0 4 2 4 2 2 5 0</PntList2D></Boundary></Boundaries>'
LINE = '<Breaklines><Breakline name="5"><PntList2D>{}</PntList2D></Breakline></Breaklines>'
BORDER = '<Boundaries><Boundary bndType="outer"><PntList2D>{}</PntList2D></Boundary></Boundaries>'
GRID = ('<LandXML><Surfaces><Surface name="grid"><SourceData>{}</SourceData><Definition surfType="TIN"><Pnts>'
        + "".join(f'<P id="{3 * north + east + 1}">{north} {east} {east}</P>' for north in range(3) for east in range(3))
        + "</Pnts><Faces>{}</Faces></Definition></Surface></Surfaces></LandXML>")


def run(command, *arguments):
    return subprocess.run(["/usr/bin/python3", str(CLIENT / command), *map(str, arguments)], text=True, capture_output=True)


def content(mesh, z="z"):
    """All that a file holds, as rows. Triangles by their corners, from the least on."""
    return [sorted(abacus.rows(query)) for query in (
        f"SELECT abacus_srid('{mesh}')", f"SELECT id, x, y, abacus_interpolate('{mesh}', x, y, '{z}') FROM abacus_vertices('{mesh}')",
        f"SELECT (SELECT array_agg(v ORDER BY v) FROM unnest(ARRAY[v0, v1, v2]) AS v) FROM abacus_simplices('{mesh}')",
        f"SELECT line, row_number() OVER (PARTITION BY line ORDER BY position), x, y, kind, part FROM abacus_lines('{mesh}')",
        f"SELECT region, triangles, area, edges FROM abacus_regions('{mesh}')", f"SELECT * FROM abacus_check('{mesh}')")]


class LandXML(abacus.InFolder):
    def imported(self, text, mesh, *options):
        path = self.file(f"{mesh}.xml", text)
        abacus.psql(f"DROP TABLE IF EXISTS {mesh} CASCADE")
        done = run("abacus-import", path, mesh, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr.replace(f"abacus-import: {path}: ", "").splitlines()

    def refused(self, said, text, old="", new="", **options):
        self.assertIn(old, text)
        path = self.file("broken.xml", text.replace(old, new) if old else text)
        with self.assertRaisesRegex(Failed, said):
            grid = read.read_here(str(path), keep_apart=False, **options)
            grid.check()
            PlanInput(grid)

    def test_lines_and_boundaries(self):
        self.assertEqual(self.imported(FIELD, "landxml_field"), [
            "coordinates are in the unit USSurveyFoot, and stay so", "types of breaklines are left out: wall; all become fixed edges",
            "left out: 1 name of a breakline or contour (only whole numbers that differ are kept)"])
        self.assertEqual(abacus.rows("SELECT line, array_agg(x || ' ' || y ORDER BY position) FROM abacus_lines('landxml_field') GROUP BY line ORDER BY line"), [
            ["7", '{"0.5 1","3 1","9 1"}'], ["8", '{"0 0","10 0"}'], ["9", '{"1 5.5","9 5.5"}'], ["10", '{"0 0","10 0","10 6","0 6","0 0"}'],
            ["11", '{"2 2","4 2","4 4","2 4","2 2"}'], ["12", '{"2.5 2.5","3.5 2.5","3.5 3.5","2.5 3.5","2.5 2.5"}']])
        self.assertEqual(abacus.rows("SELECT region, area FROM abacus_regions('landxml_field')"), [["field", "57"]])
        self.assertEqual(abacus.rows("SELECT abacus_srid('landxml_field'), abacus_interpolate('landxml_field', 10, 6, 'z'), abacus_interpolate('landxml_field', 5, 5.5, 'z')"),
                         [["2227", "7", "8"]])
        self.assertEqual(abacus.rows("SELECT * FROM abacus_check('landxml_field')"), [])

    def test_out_and_back(self):
        """Faces that are those of the points and lines come with both."""
        self.imported(FIELD, "landxml_field")
        path = self.at / "field.landxml"
        done = run("abacus-export", "landxml_field", path, "--z", "z", "--strict")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(self.imported(path.read_text(), "landxml_again"), [])
        self.assertEqual(content("landxml_again"), content("landxml_field"))
        root = xml.etree.ElementTree.parse(path).getroot()
        self.assertEqual(root.find("l:CoordinateSystem", NAMESPACE).get("epsgCode"), "2227")
        self.assertEqual([entry.get("bndType") for entry in root.iterfind(".//l:Boundary", NAMESPACE)], ["outer", "void", "outer"])
        places = {int(p.get("id")): [float(word) for word in p.text.split()] for p in root.iterfind(".//l:P", NAMESPACE)}
        wanted = abacus.numbers("SELECT id, y, x FROM abacus_vertices('landxml_field')")
        self.assertEqual({int(id_): place.tolist() for id_, *place in wanted for place in [numpy.array(place)]}, {id_: place[:2] for id_, place in places.items()})

    def test_all_that_a_mesh_has(self):
        """Seeds, soft lines, parts, an attribute of another name, outlines of several lines; and what is lost."""
        abacus.psql("DROP TABLE IF EXISTS landxml_shire CASCADE")
        abacus.psql("SELECT abacus_triangulate('landxml_shire', 'SELECT 10 * x + y + 1 AS id, x, y, x + 2 * y AS ground, x AS wet FROM generate_series(0, 9) AS x, generate_series(0, 9) AS y')")
        abacus.psql("SELECT abacus_constrain('landxml_shire', 'VALUES (1, 1, 12), (1, 2, 72), (1, 3, 78), (4, 1, 78), (4, 2, 18), (4, 3, 12), (2, 1, 34), (2, 2, 54), (2, 3, 56), (2, 4, 36), (2, 5, 34)')")
        abacus.psql("SELECT abacus_constrain('landxml_shire', 'SELECT l AS line, at AS position, p AS point, part FROM (VALUES (-3, 1, 1, 0), (-3, 2, 10, 0), (-3, 3, 81, 1), (-3, 4, 91, 1)) AS l (l, at, p, part)', kind => 'soft')")
        abacus.psql("SELECT abacus_region('landxml_shire', $$VALUES ('a & \"b\"', 1), ('a & \"b\"', 2), ('a & \"b\"', 4)$$); SELECT abacus_region('landxml_shire', $$VALUES ('lake', 4.5, 4.5)$$)")
        path = self.at / "shire.xml"
        done = run("abacus-export", "landxml_shire", path, "--z", "ground")
        self.assertEqual((done.returncode, done.stderr), (0, f"abacus-export: {path} does not hold attributes of points (wet)\n"))
        self.assertEqual(self.imported(path.read_text(), "landxml_shire_again"), [])
        self.assertEqual(content("landxml_shire_again", "ground"), content("landxml_shire", "ground"))
        path.unlink()
        done = run("abacus-export", "landxml_shire", path, "--strict")
        self.assertEqual((done.returncode, done.stderr), (1, f"abacus-export: {path} would not hold attributes of points (ground, wet)\n"))
        self.assertFalse(path.exists())

    def test_faces(self):
        """Faces that are not those of their points are loaded; within a boundary they may be those of the region."""
        said = self.imported(FACES.format(""), "landxml_step", "--surface", "step")
        self.assertEqual(said[0], "left out: 1 face that the file does not show (i=1)")
        self.assertIn("the triangles of the file are loaded as they are: its points make other triangles", said[1])
        self.assertEqual(abacus.rows("SELECT (SELECT count(*) FROM abacus_simplices('landxml_step')), (SELECT value FROM abacus_stats('landxml_step') WHERE name = 'changeable')"), [["3", "0"]])
        self.assertEqual(self.imported(FACES.format(OUTER), "landxml_step", "--surface", "step"), ["left out: 1 face that the file does not show (i=1)"])
        self.assertEqual(abacus.rows("SELECT region, triangles, area FROM abacus_regions('landxml_step')"), [["step", "3", "11"]])
        self.assertEqual(abacus.rows("SELECT value FROM abacus_stats('landxml_step') WHERE name = 'changeable'"), [["1"]])
        crossed = '<Breaklines><Breakline><PntList2D>0 0 2 4</PntList2D></Breakline><Breakline><PntList2D>0 4 2 2</PntList2D></Breakline></Breaklines>'
        said = self.imported(FACES.format(crossed), "landxml_step", "--surface", "step")
        self.assertIn("loaded as they are, without 2 lines: lines cross", said[1])
        said = self.imported(FACES.format(OUTER), "landxml_step", "--surface", "step", "--retriangulate")
        self.assertEqual(abacus.rows("SELECT count(*) FROM abacus_simplices('landxml_step')"), [["4"]])

    def test_ties(self):
        """Where points lie on one circle, the file may have other diagonals. Lines and regions stay, and the mesh can be changed."""
        falling, rising = ["1 2 5", "1 5 4", "2 3 6", "2 6 5", "4 5 7", "5 8 7", "5 6 8", "6 9 8"], ["1 2 4", "2 5 4", "2 3 5", "3 6 5", "4 5 8", "4 8 7", "5 6 9", "5 9 8"]
        triangles = lambda: {tuple(sorted(map(int, row))) for row in abacus.rows("SELECT v0, v1, v2 FROM abacus_simplices('landxml_ties')")}
        self.assertTrue(self.tied("", falling))
        own = triangles()
        self.assertTrue(self.tied("", rising))
        self.assertEqual(triangles(), own)
        for faces, diagonal in (falling, "0 0 1 1"), (rising, "0 1 1 0"):
            self.assertTrue(self.tied(LINE.format(diagonal) + BORDER.format("0 0 0 2 2 2 2 0"), faces))
            self.assertEqual(abacus.rows("SELECT x, y FROM abacus_lines('landxml_ties') WHERE line = 5 ORDER BY y"), [diagonal.split()[1::-1], diagonal.split()[3:1:-1]])
            self.assertEqual(abacus.rows("SELECT region, triangles FROM abacus_regions('landxml_ties')"), [["grid", "8"]])
            self.assertTrue(self.tied(LINE.format(diagonal) + BORDER.format("0 0 0 2 1 2 1 1 2 1 2 0"), faces[:6]))
            self.assertEqual(abacus.rows("SELECT region, triangles, area FROM abacus_regions('landxml_ties')"), [["grid", "6", "3"]])
        self.assertFalse(self.tied(LINE.format("0 1 1 0"), falling))  # across a triangle
        self.assertFalse(self.tied("", [*rising[:4], "4 5 9", "4 9 8", "4 8 7", "5 6 9"]))  # within a circle
        self.assertEqual(abacus.rows("SELECT relname FROM pg_class WHERE relname LIKE 'abacus_import%'"), [])

    def tied(self, source, faces):
        """Whether the mesh of these faces can be changed."""
        said = self.imported(GRID.format(source, "".join(f"<F>{face}</F>" for face in faces)), "landxml_ties")
        self.assertEqual(abacus.rows("SELECT * FROM abacus_check('landxml_ties')"), [])
        (changeable,), = abacus.rows("SELECT value FROM abacus_stats('landxml_ties') WHERE name = 'changeable'")
        self.assertEqual([row for row in said if "are loaded as they are" in row] == [], changeable == "1", said)
        return changeable == "1"

    def test_heights_of_one_place(self):
        """Two heights at one place are an error, wherever they stand. A point without a height has that of another."""
        line, border, ours = "<Breaklines><Breakline>{}</Breakline></Breaklines>", "<Boundaries><Boundary>{}</Boundary></Boundaries>", "northing 0, easting 0 has the height"
        list_ = "<PntList3D>0 4 1\n0 0 {}</PntList3D>"
        for source, said in ((line.format(list_.format(99)), f"line 4: the point at {ours} 99, but in line 5 it has the height 1"),
                             ('<Contours><Contour elev="2.5"><PntList2D>5 0 0 0</PntList2D></Contour></Contours>', "line 3: the point at northing 5, easting 0 has the height 2.5"),
                             (border.format(list_.format(-3)), f"line 4: the point at {ours} -3"), (f"<DataPoints>{list_.format(7)}</DataPoints>", f"line 4: the point at {ours} 7"),
                             (line.format("<PntList3D>9 9 1 8 8 1</PntList3D>") + border.format("<PntList3D>7 7 1 7 9 1\n9 9 2</PntList3D>"),
                              "line 4: the point at northing 9, easting 9 has the height 2, but in line 3 it has the height 1")):
            with self.subTest(source):
                self.refused(said, FACES.format(source), surface="step")
        self.refused("line 7: the point at northing 2, easting 4 has the height 3, but in line 6", FACES.format(""), "2 2 3<", "2 4 3<", surface="step")
        self.imported(FACES.format("<DataPoints><PntList3D>2 2 3</PntList3D></DataPoints>" + line.format(list_.format("1.0"))).replace("0 4 1<", "0 4<"),
                      "landxml_heights", "--surface", "step")
        self.assertEqual(abacus.rows("SELECT id, attributes FROM abacus_vertices('landxml_heights') ORDER BY id LIMIT 2"), [["11", "{1}"], ["12", "{1}"]])

    def test_what_is_left_out_is_said(self):
        said = self.imported(FIELD.replace('<Boundary bndType="void"', '<Boundary name="pond" bndType="void"').replace('elev="8"', 'elev="8" desc="high" name="8"'), "landxml_names")
        self.assertIn("left out: 1 name of a boundary (together they are the region field)", said)
        self.assertIn("left out: 1 desc of Contour", said)
        said = self.imported(FIELD.replace("<Boundary ", '<Boundary name="pond" '), "landxml_names")
        self.assertIn("left out: 3 names of boundaries (together they are the region field)", said)
        said = self.imported(FACES.format("<DataPoints><PntList3D>2 2 3 7 7 7</PntList3D></DataPoints>").replace('id="11"', 'id="11" code="a"'), "landxml_names", "--surface", "step")
        self.assertIn("left out: 1 point of the source data (the surface has points of its own)", said)
        self.assertIn("left out: 1 code of P", said)

    def test_prefix_of_the_namespace(self):
        plain, prefixed = FIELD, re.sub(r"<(/?)(?=[A-Z])", r"<\1lx:", FIELD).replace("xmlns=", "xmlns:lx=")
        self.assertIn("<lx:LandXML", prefixed)
        self.assertEqual(self.imported(prefixed, "landxml_prefixed"), self.imported("<!--" + 9999 * "." + "-->" + plain.partition("\n")[2], "landxml_field"))
        self.assertEqual(content("landxml_prefixed"), [*map(sorted, content("landxml_field"))])

    def test_codes_of_epsg(self):
        for code, srid in ("EPSG:25832", "25832"), ("urn:ogc:def:crs:EPSG::2227", "2227"), (" 4326 ", "4326"), ("99999999", "0"), ("local", "0"):
            said = self.imported(FIELD.replace("2227", code), "landxml_epsg")
            self.assertEqual(abacus.rows("SELECT abacus_srid('landxml_epsg')"), [[srid]])
            self.assertEqual(f"the coordinate system {code} is left out: it is not a code of EPSG, so the mesh has no SRID" in said, srid == "0", said)

    def test_only_voids_are_holes(self):
        self.imported(FIELD.replace("outer", "void", 1).replace('<Boundary bndType="island">', '<Boundary bndType="void">'), "landxml_voids")
        self.assertEqual(abacus.rows("SELECT region FROM abacus_regions('landxml_voids')"), [["hole"]])

    def test_refused(self):
        for said, old, new in (
                ("line 20: is not XML, or is cut off", "</Surface></Surfaces>\n", ""), ("line 8: nine is not a number", "6 0 9</P", "6 0 nine</P"),
                ("line 7: a list of points has 11 numbers, which is not a multiple of 3", "6 0 9<", "6 0<"), ("line 16: a list", "2 2 4</P", "2 2</P"),
                ("line 10: a Breakline without points", "<PntList3D>1 0.5 5 1 3 6 1 9 5</PntList3D>", ""), ("line 10: a line has fewer than two points", "1 0.5 5 1 3 6 1 9 5", "1 0.5 5"),
                ("line 13: high is not a number", 'elev="8"', 'elev="high"'), ("line 2: is not LandXML, but LandXML2", "<LandXML ", "<LandXML2 "),
                ("line 2: has a DOCTYPE or entities", '<LandXML xmlns', '<!DOCTYPE LandXML [<!ENTITY a SYSTEM "/etc/passwd">]><LandXML xmlns')):
            with self.subTest(said):
                self.refused(said, FIELD, old, new)
        step = {"surface": "step"}
        for said, old, new in (
                ("line 10: a face has 4 corners", "11 12 14<", "11 12 14 13<"), ("a face names point 19, which is not there", "12 13 14<", "12 13 19<"),
                ("line 7: two points have the number 13", 'id="14"', 'id="13"'), ("line 4: a point has 1 number;", "0 0 1<", "0<"), ("line 5: x is not a whole", 'id="12"', 'id="x"'),
                ("line 5: point 12 has a coordinate that is not finite", "0 4 1<", "inf 4 1<"), ("line 3: the surface is a grid", 'name="step"><SourceData>', 'name="step"><Definition surfType="grid"/><SourceData>')):
            with self.subTest(said):
                self.refused(said, FACES.format(""), old, new, **step)
        self.refused("several surfaces; name one by --surface: other, step", FACES.format(""))
        self.refused("has no surface lake; it has: other, step", FACES.format(""), surface="lake")
        with self.assertRaisesRegex(Failed, "has no surfaces: --surface is for LandXML"):
            read.read_here(str(self.file("a.vtu", "<VTKFile/>")), keep_apart=False, surface="lake")
        self.refused("line 4: a point has no number", FACES.format(""), '<P id="11">', "<P>", **step)
        for said, text in (("line 1: is not LandXML, but html", "<html/>"), ("line 2: is not LandXML, but html", "<!-- a page -->\n<!DOCTYPE html>\n<html><br></html>"),
                           ("line 1: is not LandXML, but VTKFile", "<VTKFile/>"), ("line 1: is not XML", "a text"), ("line 1: is not XML", "")):
            self.refused(said, text)

    def test_cut_off(self):
        for size in range(0, len(FIELD) - 12, 97):
            with self.assertRaises(Failed) as caught:
                read.read_here(str(self.file("cut.landxml", FIELD[:size])), keep_apart=False)
            self.assertRegex(str(caught.exception), r"^line \d+: ")


if __name__ == "__main__":
    unittest.main()
