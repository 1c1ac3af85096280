"""Meshes written by abacus-export are read by meshio, VTK and numpy; what meshio writes is read by abacus-import."""
import json
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest
import xml.etree.ElementTree

import meshio
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

import abacus

CLIENT = abacus.REPOSITORY / "client"


def run(command, *arguments):
    return subprocess.run(["/usr/bin/python3", str(CLIENT / command), *map(str, arguments)], text=True, capture_output=True)


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = pathlib.Path(cls.folder.name)
        random = numpy.random.default_rng(7)
        cls.plane = random.uniform(-50, 50, (3000, 2))
        cls.height = cls.plane[:, 0] * 2 - cls.plane[:, 1]
        cls.depth = numpy.where(numpy.arange(3000) % 10 == 0, numpy.nan, cls.plane[:, 1])
        cls.space = random.uniform(0, 1, (1500, 3))
        abacus.triangulate("files_plane", cls.plane, height=cls.height, depth=cls.depth)
        abacus.triangulate("files_space", cls.space, speed=cls.space[:, 0])

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def export(self, mesh, name, *options):
        done = run("abacus-export", mesh, self.at / name, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.at / name

    def assert_same(self, points, corners, wanted_points, mesh):
        """The corners' coordinates are those of the mesh's simplices, and so is the orientation."""
        dimension = wanted_points.shape[1]
        wanted = wanted_points[abacus.simplices(mesh, dimension + 1)].tolist()
        found = points[corners][:, :, :dimension].tolist()
        self.assertEqual(sorted(found), sorted(wanted))

    def test_series(self):
        """A .pvd of three steps, each a .vtu that VTK reads; vertices without a value have none."""
        abacus.psql("CREATE TABLE files_series AS SELECT id, step / 4.0 AS at, id * 10 + step AS speed, step AS \"a \"\"b\" "
                    "FROM generate_series(1, 1500) AS id, generate_series(0, 2) AS step WHERE id % 5 > 0")
        file = self.export("files_space", "run.pvd", "--series", "TABLE files_series;")
        sets = list(xml.etree.ElementTree.parse(file).getroot().find("Collection"))
        self.assertEqual([float(entry.get("timestep")) for entry in sets], [0, 0.25, 0.5])
        for step, entry in enumerate(sets):
            reader = vtkXMLUnstructuredGridReader()
            reader.SetFileName(str(self.at / entry.get("file")))
            reader.Update()
            data = reader.GetOutput().GetPointData()
            ids, speed = (vtk_to_numpy(data.GetArray(name)) for name in ("id", "speed_"))
            self.assertEqual(len(ids), 1500)
            numpy.testing.assert_array_equal(speed, numpy.where(ids % 5 > 0, ids * 10 + step, numpy.nan))
            numpy.testing.assert_array_equal(vtk_to_numpy(data.GetArray("speed")), self.space[ids - 1, 0])
            self.assertIsNotNone(data.GetArray('a "b'))
        for query, said in (("SELECT 1 WHERE false", "no rows"), ("SELECT 1, 2", "columns"), ("SELECT id, 1, 2 FROM files_series", "more than once"), ("nonsense", "syntax error")):
            failed = run("abacus-export", "files_space", self.at / "unwritten.pvd", "--series", query)
            self.assertEqual(failed.returncode, 1)
            self.assertIn(said, failed.stderr)
        self.assertNotEqual(run("abacus-export", "files_space", self.at / "unwritten.pvd").returncode, 0)
        self.assertEqual([path.name for path in self.at.glob("unwritten*")], [])

    def test_ply(self):
        mesh = meshio.read(self.export("files_plane", "m.ply", "--z", "height"))
        self.assert_same(mesh.points, mesh.cells_dict["triangle"], self.plane, "files_plane")
        numpy.testing.assert_array_equal(mesh.points[:, 2], mesh.points[:, 0] * 2 - mesh.points[:, 1])
        numpy.testing.assert_array_equal(mesh.point_data["height"], mesh.points[:, 2])
        self.assertEqual(numpy.isnan(mesh.point_data["depth"]).sum(), 300)

    def test_obj(self):
        mesh = meshio.read(self.export("files_plane", "m.obj"))
        self.assert_same(mesh.points, mesh.cells_dict["triangle"], self.plane, "files_plane")

    def test_npz(self):
        for name, points, value in ("files_plane", self.plane, self.height), ("files_space", self.space, self.space[:, 0]):
            with numpy.load(self.export(name, "m.npz")) as arrays:
                self.assert_same(arrays["points"], arrays["simplices"], points, name)
                numpy.testing.assert_array_equal(points[arrays["ids"] - 1], arrays["points"])
                self.assertEqual(sorted(arrays["ids"]), list(range(1, len(points) + 1)))
                numpy.testing.assert_array_equal(arrays["values"][:, 0], value[arrays["ids"] - 1])
                cells = numpy.column_stack([arrays["codes"], arrays["ids"][arrays["simplices"]]])
                corners = ", ".join(f"v{n}" for n in range(points.shape[1] + 1))
                self.assertEqual(sorted(map(tuple, cells.tolist())), sorted(tuple(map(int, row)) for row in abacus.rows(
                    f"SELECT code, {corners} FROM abacus_cells('{name}')")))

    def test_vtu(self):
        for name, points, cell in ("files_plane", self.plane, "triangle"), ("files_space", self.space, "tetra"):
            file = self.export(name, "m.vtu")
            mesh = meshio.read(file)
            self.assert_same(mesh.points, mesh.cells_dict[cell], points, name)
            reader = vtkXMLUnstructuredGridReader()
            reader.SetFileName(str(file))
            reader.Update()
            grid = reader.GetOutput()
            self.assertEqual(grid.GetNumberOfCells(), len(mesh.cells_dict[cell]))
            numpy.testing.assert_array_equal(vtk_to_numpy(grid.GetPoints().GetData()), mesh.points)
            numpy.testing.assert_array_equal(vtk_to_numpy(grid.GetPointData().GetArray("id")), mesh.point_data["id"])
            self.assertEqual(grid.GetCellData().GetArray("code").GetNumberOfTuples(), grid.GetNumberOfCells())

    def test_geojson(self):
        lines = self.export("files_plane", "m.geojsonl", "--z", "height").read_text().splitlines()
        features = [json.loads(line) for line in lines]
        rings = [f["geometry"]["coordinates"][0] for f in features]
        self.assertTrue(all(ring[0] == ring[3] and len(ring) == 4 for ring in rings))
        self.assertEqual(sorted([p[:2] for p in ring[:3]] for ring in rings),
                         sorted(self.plane[abacus.simplices("files_plane")].tolist()))
        self.assertEqual({f["properties"]["depth"] is None for f in features}, {True, False})

    def test_names_that_a_file_would_have_twice(self):
        abacus.psql("SELECT abacus_triangulate('files_names', 'SELECT i, i % 3, i / 3, i, 10 + i, 20 + i, 30 + i FROM generate_series(0, 8) AS i', "
                    "attributes => '{v0_,v0,a b,a-b}')")
        for suffix, names in (".ply", ["v0_", "v0", "a_b", "a_b_"]), (".vtu", ["v0_", "v0", "a b", "a-b"]):
            data = meshio.read(self.export("files_names", "names" + suffix)).point_data
            for name, more in zip(names, (0, 10, 20, 30)):
                self.assertEqual(sorted(data[name]), [i + more for i in range(9)], name)
        feature = json.loads(self.export("files_names", "names.geojsonl").read_text().splitlines()[0])["properties"]
        self.assertAlmostEqual(feature["v0__"], feature["v0_"] + 10)
        self.assertAlmostEqual(feature["a-b"], feature["v0_"] + 30)

    def test_2dm_and_back(self):
        file = self.export("files_plane", "m.2dm", "--z", "height")
        self.check_import(file, "files_again", self.plane, 2)
        self.assertEqual(abacus.rows("SELECT name FROM abacus_attributes('files_again')"), [["z"]])

    def check_import(self, file, name, points, dimension):
        abacus.psql(f"DROP TABLE IF EXISTS {name}, {name}_vertices CASCADE")
        done = run("abacus-import", file, name)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(abacus.rows(f"SELECT count(*) FROM abacus_check('{name}')"), [["0"]])
        columns = ", ".join(f"corners[{i + 1}][{k + 1}]" for i in range(dimension + 1) for k in range(dimension))
        found = abacus.numbers(f"SELECT {columns} FROM abacus_cells('{name}')").reshape(-1, dimension + 1, dimension)
        wanted = points[abacus.simplices("files_plane" if dimension == 2 else "files_space", dimension + 1)]
        self.assertEqual(sorted(sorted(cell) for cell in found.tolist()), sorted(sorted(cell) for cell in wanted.tolist()))

    def test_vtu_and_back(self):
        file = self.export("files_space", "m.vtu")
        self.check_import(file, "files_again", self.space, 3)
        self.assertEqual(abacus.rows("SELECT name, nulls FROM abacus_attributes('files_again')"), [["speed", "0"]])
        self.assertEqual(abacus.rows("SELECT count(*) FROM abacus_vertices('files_again') a JOIN abacus_vertices('files_space') b USING (id, x, y, z, attributes)"), [["1500"]])

    def test_of_meshio(self):
        """Gmsh, TetGen, PLY and VTU as meshio writes them."""
        corners = abacus.simplices("files_space", 4)
        for suffix in ".msh", ".vtu", ".mesh", ".vtk", ".node":
            meshio.write(self.at / f"w{suffix}", meshio.Mesh(self.space, [("tetra", corners)], point_data={"speed": self.space[:, 0]}))
            self.check_import(self.at / f"w{suffix}", "files_again", self.space, 3)
        corners = abacus.simplices("files_plane", 3)
        flat = numpy.column_stack([self.plane, numpy.zeros(len(self.plane))])
        for suffix in ".ply", ".obj", ".off":
            meshio.write(self.at / f"w{suffix}", meshio.Mesh(flat, [("triangle", corners)]))
            self.check_import(self.at / f"w{suffix}", "files_again", self.plane, 2)

    def test_ended(self):
        """An export that is ended leaves no file."""
        for number, status in (signal.SIGTERM, 143), (signal.SIGHUP, 129), (signal.SIGINT, 130):
            export = subprocess.Popen(["/usr/bin/python3", str(CLIENT / "abacus-export"), "files_space", str(self.at / "ended.pvd"), "--series",
                                       "SELECT id, 1 AS step, pg_sleep(5)::text FROM generate_series(1, 2) AS id"], stderr=subprocess.PIPE, text=True,
                                      # the tests may run where a shell or nohup ignores it
                                      preexec_fn=lambda: signal.signal(number, signal.SIG_DFL))
            until = time.monotonic() + 20
            while not (self.at / "ended.pvd.part").exists() and time.monotonic() < until:
                time.sleep(0.05)
            export.send_signal(number)
            _, said = export.communicate(timeout=20)
            self.assertEqual((export.returncode, said), (status, ""))
            self.assertEqual([path.name for path in self.at.glob("ended*")], [])

    def test_refused(self):
        """A clear word, status 1, and no file left."""
        for arguments, said in (
            (("files_plane", self.at / "m.xyz"), "no format that is known by this suffix"),
            (("no_such_mesh", self.at / "n.ply"), 'relation "no_such_mesh" does not exist'),
            (("files_plane_points", self.at / "n.ply"), "is not a mesh"),
            (("files_plane'; DROP TABLE files_plane_points; --", self.at / "n.ply"), "syntax"),
            (("files_space", self.at / "n.ply"), "no tetrahedra"),
            (("files_plane", self.at / "n.npz", "--z", "height"), "--z is for other formats"),
            (("files_plane", self.at / "n.ply", "--z", "wind"), "no attribute wind"),
            (("files_plane", self.at / "n.ply", "--z", "depth"), "missing at some vertices"),
            (("files_plane", self.at / "no" / "n.ply"), "No such file or directory"),
        ):
            done = run("abacus-export", *arguments)
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertIn(said, done.stderr)
            self.assertNotIn("Traceback", done.stderr)
            self.assertEqual(list(self.at.glob("n.ply*")), [])
        self.assertEqual(len(abacus.rows("SELECT FROM files_plane_points")), 3000)
        (self.at / "bad.vtu").write_text("nothing")
        (self.at / "bad.2dm").write_text("MESH2D\nND 1 0 0 0\nE3T 1 1 2 3 1\n")
        for name in "bad.vtu", "bad.2dm", "no.ply":
            done = run("abacus-import", self.at / name, "files_bad")
            self.assertEqual(done.returncode, 1)
            self.assertIn(f"abacus-import: {self.at / name}", done.stderr)
            self.assertNotIn("Traceback", done.stderr)


if __name__ == "__main__":
    unittest.main()
