"""A region exported alone, and the region of each triangle as its label."""
import pathlib
import subprocess
import tempfile
import unittest

import meshio
import numpy

import abacus

CLIENT = abacus.REPOSITORY / "client"


def run(command, *arguments):
    return subprocess.run(["/usr/bin/python3", str(CLIENT / command), *map(str, arguments)], text=True, capture_output=True)


def corners(points, cells):
    """Triangles by their places, from the least corner on."""
    return sorted(sorted(points[cell][:, :2].tolist()) for cell in cells)


class Within(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = pathlib.Path(cls.folder.name)
        abacus.psql("DROP TABLE IF EXISTS within_shire CASCADE")
        abacus.psql("SELECT abacus_triangulate('within_shire', 'SELECT 10 * x + y + 1 AS id, x, y, x + 2 * y AS height FROM generate_series(0, 9) AS x, generate_series(0, 9) AS y')")
        abacus.psql("SELECT abacus_constrain('within_shire', 'VALUES (1, 1, 12), (1, 2, 72), (1, 3, 78), (1, 4, 18), (1, 5, 12), (2, 1, 34), (2, 2, 54), (2, 3, 56), (2, 4, 36), (2, 5, 34), (3, 1, 21), (3, 2, 24)')")
        abacus.psql("SELECT abacus_region('within_shire', $$VALUES ('farm', 1), ('farm', 2)$$); SELECT abacus_region('within_shire', $$VALUES ('lake', 4.5, 4.5)$$)")
        abacus.psql("SELECT abacus_mark('within_shire', $$SELECT code, v0, v1, v2, f, 7 FROM abacus_simplices('within_shire'), generate_series(0, 2) AS f "
                    "WHERE 12 IN (v0, v1, v2) AND (ARRAY[v0, v1, v2])[f + 1] <> 12$$)")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def export(self, name, *options, mesh="within_shire"):
        done = run("abacus-export", mesh, self.at / name, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.at / name, done.stderr.strip().partition(" does not hold ")[2]

    def wanted(self, region):
        table = abacus.numbers(" UNION ALL ".join(f"SELECT {', '.join(f'corners[{i}][{k}]' for i in (1, 2, 3) for k in (1, 2))} FROM abacus_cells('within_shire', within => '{name}')"
                                                  for name in region)).reshape(-1, 3, 2)
        return sorted(sorted(triangle) for triangle in table.tolist())

    def test_triangles(self):
        for name in "a.vtu", "a.xdmf", "a.obj", "a.npz":
            path, _ = self.export(name, "--within", "farm")
            if name == "a.npz":
                with numpy.load(path) as arrays:
                    points, cells, ids = arrays["points"], arrays["simplices"], arrays["ids"]
                    self.assertEqual(len(arrays["facets"]), len(arrays["markers"]))
                    marked = {tuple(sorted(ids[facet].tolist())) for facet in arrays["facets"]}
            else:
                found = meshio.read(path)
                points, cells = found.points, found.cells_dict["triangle"]
            self.assertEqual(corners(points, cells), self.wanted(["farm"]))
            self.assertEqual(len(points), len(numpy.unique(cells)))
        edges = {tuple(sorted(map(int, row))) for row in abacus.rows("SELECT v0, v1 FROM abacus_edges('within_shire', within => 'farm')")}
        facets = {tuple(sorted(map(int, row))) for row in abacus.rows("SELECT v0, v1 FROM abacus_facets('within_shire')")}
        self.assertEqual(marked, edges & facets)
        self.assertNotEqual(marked, facets)

    def test_it_is_a_mesh_again(self):
        path, _ = self.export("b.vtu", "--within", "farm")
        abacus.psql("DROP TABLE IF EXISTS within_again, within_again_vertices")
        done = run("abacus-import", path, "within_again")
        self.assertEqual(done.returncode, 0, done.stderr)
        wanted = "SELECT v0, v1, v2 FROM abacus_simplices('{}'{}) ORDER BY 1, 2, 3"
        key = lambda rows: sorted(sorted(row) for row in rows)
        self.assertEqual(key(abacus.rows(wanted.format("within_again", ""))), key(abacus.rows(wanted.format("within_shire", ", within => 'farm'"))))

    def test_lines(self):
        """LandXML has the lines that lie in the region, and names those that go on."""
        path, lost = self.export("c.xml", "--within", "farm", "--z", "height")
        self.assertIn("1 line extending beyond the region", lost)
        abacus.psql("DROP TABLE IF EXISTS within_again, within_again_vertices CASCADE")
        done = run("abacus-import", path, "within_again")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(abacus.rows("SELECT DISTINCT line FROM abacus_lines('within_again') ORDER BY line"), [["1"], ["2"]])
        self.assertEqual(abacus.rows("SELECT region, triangles, area FROM abacus_regions('within_again')"),
                         abacus.rows("SELECT region, triangles, area FROM abacus_regions('within_shire') WHERE region = 'farm'"))

    def test_regions_are_a_label(self):
        path, lost = self.export("d.vtu")
        self.assertIn("regions (farm: 1, lake: 2), but for their numbers, which are the label region", lost)
        found = meshio.read(path)
        region = numpy.concatenate([values.reshape(-1) for values, block in zip(found.cell_data["region"], found.cells) if block.type == "triangle"])
        for name, number in ("farm", 1), ("lake", 2):
            self.assertEqual(corners(found.points, found.cells_dict["triangle"][region == number]), self.wanted([name]))
        self.assertEqual(len(abacus.simplices("within_shire")), len(region))
        path, _ = self.export("d.geojsonl")
        self.assertEqual(path.read_text().count('"region": 1.0'), int((region == 1).sum()))
        _, lost = self.export("d.obj")
        self.assertIn("regions (farm, lake)", lost)

    def test_a_polygon(self):
        polygon = "POLYGON((1.5 1.5, 6.5 2, 4 7.5, 1.5 1.5))"
        done = run("abacus-export", "within_shire", self.at / "polygon.vtu", "--within", polygon)
        self.assertEqual(done.returncode, 0, done.stderr)
        triangles = meshio.read(self.at / "polygon.vtu").cells_dict["triangle"]
        self.assertEqual([[str(len(triangles))]], abacus.rows(f"SELECT count(*) FROM abacus_cells('within_shire', within => '{polygon}')"))
        done = run("abacus-export", "within_shire", self.at / "polygon.xml", "--within", polygon)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr, "abacus-export: LandXML has the border of a region, so --within is the name of a region here; other formats take a polygon\n")
        self.assertFalse((self.at / "polygon.xml").exists())

    def test_no_triangles(self):
        """A polygon beside the mesh."""
        beside = "POLYGON((20 20, 30 20, 30 30, 20 20))"
        for suffix in "vtu", "ply", "geojsonl", "npz":
            path = self.at / f"none.{suffix}"
            done = run("abacus-export", "within_shire", path, "--within", beside)
            self.assertEqual((done.returncode, done.stdout), (0, f"{path}: 0 vertices, 0 simplices\n"), done.stderr)
            self.assertIn(f"abacus-export: {path} has no triangles: none lies within {beside}\n", done.stderr)
        self.assertNotIn("has no triangles", run("abacus-export", "within_shire", path, "--within", "farm").stderr)

    def test_refused(self):
        for mesh, options, said in (("within_shire", ["--within", "nope"], 'has no region "nope"'), ("within_shire", ["--within", ""], 'has no region ""')):
            done = run("abacus-export", mesh, self.at / "no.vtu", *options)
            self.assertEqual(done.returncode, 1)
            self.assertIn(said, done.stderr)
            self.assertEqual(list(self.at.glob("no.*")), [])
        self.assertEqual(run("abacus-export", "within_shire", self.at / "no.poly", "--within", "farm").stderr,
                         "abacus-export: .poly has no triangles, so none of a region: leave out --within\n")
        abacus.triangulate("within_solid", numpy.random.default_rng(1).uniform(0, 1, (9, 3)))
        self.assertIn("--within is for meshes in the plane", run("abacus-export", "within_solid", self.at / "no.vtu", "--within", "farm").stderr)


if __name__ == "__main__":
    unittest.main()
