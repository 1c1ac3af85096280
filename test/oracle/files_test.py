"""Meshes written by abacus-export are read by meshio, VTK and numpy; what meshio writes is read by abacus-import."""
import json
import pathlib
import signal
import subprocess
import sys
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
sys.path.insert(0, str(CLIENT))
from abacus_files.psql import Failed  # noqa: E402
from abacus_files.series import Series  # noqa: E402
from abacus_files.session import Session  # noqa: E402


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
        for query, said in (
            ("SELECT 1 WHERE false", "no rows"), ("SELECT 1, 2", "columns"), ("SELECT id, 1, 2 FROM files_series", "more than once"), ("nonsense", "syntax error"),
            ("SELECT 1, 2, 'open", "unterminated quoted string"),
        ):
            failed = run("abacus-export", "files_space", self.at / "unwritten.pvd", "--series", query)
            self.assertEqual(failed.returncode, 1)
            self.assertIn(said, failed.stderr)
        self.assertNotEqual(run("abacus-export", "files_space", self.at / "unwritten.pvd").returncode, 0)
        self.assertEqual([path.name for path in self.at.glob("unwritten*")], [])

    def test_series_that_are_none(self):
        """psql would wait for what ends most of these."""
        for query, said in (
            ("SELECT 1, NULL, 2", "no steps"), ("SELECT 1, 'NaN'::float8, 2", "NaN or infinite"), ("SELECT 1, 2, $$open", "unterminated dollar-quoted"),
            ('SELECT 1, 2, "open', "unterminated quoted identifier"), ("SELECT 1, 2, (3", "syntax error"), ("SELECT 1, 2, 3 /* open", "unterminated /[*] comment"),
            ("SELECT 1) TO STDOUT; SELECT (1", "syntax error"), ("SELECT 1, 2, 3; SELECT 1, 2, 3", "syntax error"), ("", "syntax error"), ("\\!", "syntax error"),
        ):
            with self.subTest(query=query), self.assertRaisesRegex(Failed, said), Session(None) as session:
                Series(session, query)
        with self.assertRaisesRegex(Failed, "rows in an unexpected form"), Session(None) as session:
            session.all("SELECT NULL::int8, 1::int8", ["int8"] * 2)

    def test_comment_in_series(self):
        self.export("files_space", "comment.pvd", "--series", "SELECT 1, 2 AS at, 3.0 AS speed -- of one vertex")

    def test_warnings_in_series(self):
        """More of them than a pipe has room for; they are shown, and stop nothing."""
        abacus.psql("CREATE FUNCTION files_warns(n int) RETURNS int LANGUAGE plpgsql AS $$ BEGIN RAISE WARNING '%', repeat('w', 1000); RETURN n; END $$")
        done = run("abacus-export", "files_space", self.at / "warned.pvd", "--series", "SELECT files_warns(n), 2 AS at, 3.0 AS speed FROM generate_series(1, 50) AS n")
        self.assertEqual(done.returncode, 0)
        self.assertGreater(len(done.stderr), 100000)

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

    def test_geojson_has_no_infinite_numbers(self):
        abacus.psql("SELECT abacus_triangulate('files_infinite', "
                    "'VALUES (1, 0, 0, ''Infinity''::float8, 1e308), (2, 4, 0, 1, 1e308), (3, 0, 3, 2, 1e308)', attributes => '{a,b}')")
        done = run("abacus-export", "files_infinite", self.at / "i.geojsonl")
        self.assertEqual(done.returncode, 0)
        self.assertIn("does not hold attributes of points (a, b), of which a triangle has the means", done.stderr)
        text = (self.at / "i.geojsonl").read_text()
        properties = json.loads(text, parse_constant=self.fail)["properties"]
        self.assertEqual((properties["a"], properties["b"]), (None, None))
        for suffix in "geojsonl", "obj":
            self.assertIn("a is missing or infinite", run("abacus-export", "files_infinite", self.at / f"i.{suffix}", "--z", "a").stderr)

    def test_geojson_places(self):
        """Readers take coordinates as longitude and latitude: it is said where they are none, and PostGIS makes them of a mesh with an SRID."""
        triangle = "VALUES (1, 500000, 5500000), (2, 500100, 5500000), (3, 500000, 5500100)"
        abacus.psql(f"SELECT abacus_triangulate('files_places', '{triangle}')")
        self.assertIn("not longitudes and latitudes", run("abacus-export", "files_places", self.at / "p.geojsonl").stderr)
        abacus.psql("SELECT abacus_set_srid('files_places', 25832)")
        self.assertIn("are those of SRID 25832", run("abacus-export", "files_places", self.at / "p.geojsonl").stderr)
        abacus.psql('CREATE SCHEMA "files gis"; CREATE EXTENSION postgis SCHEMA "files gis"')
        try:
            self.assertIn("projected from SRID 25832", run("abacus-export", "files_places", self.at / "p.geojsonl").stderr)
            ring = numpy.array(json.loads((self.at / "p.geojsonl").read_text())["geometry"]["coordinates"][0])
        finally:
            abacus.psql('DROP EXTENSION postgis; DROP SCHEMA "files gis"')
        numpy.testing.assert_allclose(ring[:, 0], 9, atol=0.01)  # the central meridian
        numpy.testing.assert_allclose(ring[:, 1], 49.65, atol=0.01)

    def test_names_that_a_file_would_have_twice(self):
        abacus.psql("SELECT abacus_triangulate('files_names', 'SELECT i, i % 3, i / 3, i, 10 + i, 20 + i, 30 + i FROM generate_series(0, 8) AS i', "
                    "attributes => '{v0_,v0,a b,a-b}')")
        for suffix, names in (".ply", ["v0_", "v0", "a_b", "a_b_"]), (".vtu", ["v0_", "v0", "a b", "a-b"]):
            data = meshio.read(self.export("files_names", "names" + suffix)).point_data
            for name, more in zip(names, (0, 10, 20, 30)):
                self.assertEqual(sorted(data[name]), [i + more for i in range(9)], name)
        abacus.psql("SELECT abacus_triangulate('files_id', 'VALUES (101, 0, 0, 3), (102, 1, 0, 2), (103, 0, 1, 1)', attributes => '{id}')")
        data = meshio.read(self.export("files_id", "id.ply")).point_data  # not read as ids later
        self.assertEqual((list(data), sorted(data["id_"]), sorted(data["id"])), (["id_", "id"], [1, 2, 3], [101, 102, 103]))
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

    def test_attributes_and_back(self):
        """Every value comes back under its name: 200 points and 5 attributes, which meshio mixes up; names that SQL would fold or cut, and z beside z."""
        names = ["z", "a b", 'say "it\'s"', "ä" * 31, "\\"]
        listed = "ARRAY[" + ", ".join("$a$" + name + "$a$" for name in names) + "]"
        abacus.psql("SELECT abacus_triangulate('files_many', 'SELECT i, (i * 0.7548776662466927) % 1, (i * 0.5698402909980532) % 1, "
                    "i + 1000, i + 2000, i + 3000, i + 4000, i + 5000 "
                    f"FROM generate_series(1, 200) AS i', attributes => {listed})")
        for options, wanted in ((), names), (("--z", "z"), ["z", "z_", *names[1:]]):
            abacus.psql("DROP TABLE IF EXISTS files_again, files_again_vertices")
            done = run("abacus-import", self.export("files_many", "many.vtu", *options), "files_again")
            self.assertEqual((done.returncode, done.stdout), (0, done.stdout), done.stderr)
            self.assertEqual([name for name, in abacus.rows("SELECT name FROM abacus_attributes('files_again') ORDER BY position")], wanted)
            first = len(wanted) - 4
            self.assertEqual(abacus.rows("SELECT count(*) FROM abacus_vertices('files_many') AS a JOIN abacus_vertices('files_again') AS b USING (id, x, y) "
                                         f"WHERE a.attributes[1] = b.attributes[1] AND a.attributes[1] = b.attributes[{first}] "
                                         f"AND a.attributes[2:5] = b.attributes[{first + 1}:{first + 4}]"), [["200"]])

    def test_gmsh(self):
        """Ids, materials and markers as Gmsh has them; with --retriangulate those of what is left."""
        (self.at / "g.msh").write_text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n10 0 0 0\n20 1 0 0\n30 0 1 0\n40 1 1 0\n50 2 0.5 0\n$EndNodes\n"
                                       "$Elements\n5\n1 1 2 77 1 10 20\n2 1 2 77 1 20 50\n3 2 2 5 1 10 20 30\n4 2 2 5 1 20 40 30\n5 2 2 0 2 20 50 40\n$EndElements\n")
        done = run("abacus-import", self.at / "g.msh", "files_gmsh")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(abacus.rows("SELECT marker, v0, v1 FROM abacus_facets('files_gmsh') ORDER BY v0"), [["77", "10", "20"], ["77", "20", "50"]])
        self.assertEqual(abacus.rows("SELECT abacus_labels('files_gmsh'), labels, count(*) FROM abacus_cells('files_gmsh') GROUP BY labels ORDER BY labels"),
                         [["{material}", "{0}", "1"], ["{material}", "{5}", "2"]])
        (self.at / "f.msh").write_text((self.at / "g.msh").read_text().replace("40 1 1 0", "40 0.9 0.9 0"))  # the diagonal has to be flipped
        for options, inherited in ([], "NULL"), (["--inherit"], "5"):
            done = run("abacus-import", "--retriangulate", *options, self.at / "f.msh", "files_gmsh_anew")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("Of 3 triangles with labels the new one lacks 2. Of 2 facets with markers it lacks 0.", done.stderr)
            self.assertEqual(abacus.rows("SELECT labels, count(*) FROM abacus_cells('files_gmsh_anew') GROUP BY labels ORDER BY labels"),
                             sorted([["{0}", "1"], [f"{{{inherited}}}", "2"]]))
            self.assertEqual(abacus.rows("SELECT marker, v0, v1 FROM abacus_facets('files_gmsh_anew') ORDER BY v0"), [["77", "10", "20"], ["77", "20", "50"]])
            abacus.psql("DROP TABLE files_gmsh_anew")
        self.assertIn("--inherit is for --retriangulate", run("abacus-import", "--inherit", self.at / "g.msh", "files_gmsh_anew").stderr)

    def test_split_nodes_and_back(self):
        abacus.psql("SELECT abacus_load('files_fault', 'VALUES (1, 0, 0, 0), (2, 2, 0, 0), (4, 0, 2, 0), (5, 2, 2, 0), (12, 2, 0, 1), (3, 4, 0, 1), (6, 4, 2, 1), (15, 2, 2, 1)', "
                    "'VALUES (1, 2, 5), (1, 5, 4), (12, 3, 6), (12, 6, 15)', '{slip}', split_nodes => true)")
        file = self.export("files_fault", "fault.vtu")
        self.assertIn("same coordinates", run("abacus-import", file, "files_fault_again").stderr)
        done = run("abacus-import", "--split-nodes", file, "files_fault_again")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(abacus.rows("SELECT count(*) FROM abacus_cells('files_fault') AS a JOIN abacus_cells('files_fault_again') AS b "
                                     "USING (v0, v1, v2, corners, \"values\")"), [["4"]])

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

    def sessions(self, text):
        return [state for state, in abacus.rows("SELECT state FROM pg_stat_activity "
                                                f"WHERE query LIKE '%{text}%' AND pid <> pg_backend_pid() AND state <> 'idle'")]

    def wait(self, condition):
        until = time.monotonic() + 100  # in case the machine is busy
        while not condition() and time.monotonic() < until:
            time.sleep(0.05)
        self.assertTrue(condition())

    def end(self, number, text, *command):
        """Ends a client while its session works; its session is gone soon, and works no longer."""
        client = subprocess.Popen(["/usr/bin/python3", str(CLIENT / command[0]), *map(str, command[1:])], stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                  # a shell or nohup around the tests may ignore it
                                  preexec_fn=None if number == signal.SIGKILL else lambda: signal.signal(number, signal.SIG_DFL))
        try:
            self.wait(lambda: self.sessions(text))
            client.send_signal(number)
            _, said = client.communicate(timeout=100)
            self.wait(lambda: not self.sessions(text))  # it would sleep or wait longer
        finally:
            client.kill()
        return client.returncode, said

    def test_ended(self):
        """An export that is ended leaves no file, and no session even if it is killed."""
        for number, status in (signal.SIGTERM, 143), (signal.SIGHUP, 129), (signal.SIGINT, 130), (signal.SIGKILL, -9):
            ended = self.end(number, "FROM generate_series(1, 2) AS slowly", "abacus-export", "files_space", self.at / "ended.pvd", "--series",
                             "SELECT id, 1 AS step, pg_sleep(1000)::text FROM generate_series(1, 2) AS slowly (id)")
            self.assertEqual(ended, (status, ""))
            self.assertEqual([path.name for path in self.at.glob("ended*")], [] if number != signal.SIGKILL else ["ended.pvd.part"])

    def test_ended_beside(self):
        """So it is with the arrays beside an XDMF."""
        ended = self.end(signal.SIGTERM, "FROM generate_series(1, 2) AS slow_step", "abacus-export", "files_space", self.at / "beside.xdmf", "--series",
                         "SELECT id, 1 AS step, pg_sleep(1000)::text FROM generate_series(1, 2) AS slow_step (id)")
        self.assertEqual(ended, (143, ""))
        self.assertEqual(list(self.at.glob("beside*")), [])

    def test_import_ended(self):
        """So it is with an import that waits for a lock, and there is no mesh."""
        (self.at / "one.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        for number, status in (signal.SIGTERM, 143), (signal.SIGINT, 130), (signal.SIGKILL, -9):
            holder = subprocess.Popen(["psql", "-X", "-q"], stdin=subprocess.PIPE, text=True)
            holder.stdin.write("BEGIN; CREATE TABLE files_waits ();\n")
            holder.stdin.flush()
            try:
                self.wait(lambda: self.sessions("CREATE TABLE files_waits") == ["idle in transaction"])
                found, said = self.end(number, "abacus_load", "abacus-import", self.at / "one.off", "files_waits")
            finally:
                holder.communicate()
            self.assertEqual(found, status, said)
            self.assertNotIn("Traceback", said)
            self.assertEqual(abacus.rows("SELECT to_regclass('files_waits')"), [["NULL"]])

    def test_refused(self):
        """A clear word, status 1, and no file left."""
        (self.at / "folder.ply").mkdir()
        for arguments, said in (
            (("files_plane", self.at / "m.xyz"), "the suffix is not that of a known format"),
            (("no_such_mesh", self.at / "n.ply"), "abacus-export: there is no mesh no_such_mesh\n"),
            (("files_plane_points", self.at / "n.ply"), "is not a mesh"),
            (("files_plane'; DROP TABLE files_plane_points; --", self.at / "n.ply"), "syntax"),
            (("files_space", self.at / "n.ply"), "no tetrahedra"),
            (("files_plane", self.at / "n.npz", "--z", "height"), "--z is for other formats"),
            (("files_plane", self.at / "n.ply", "--z", "wind"), "no attribute wind"),
            (("files_plane", self.at / "n.ply", "--z", "depth"), "missing or infinite at some vertices"),
            (("files_plane", self.at / "no" / "n.ply"), f"abacus-export: {self.at}/no/n.ply: there is no folder {self.at}/no\n"),
            (("files_plane", self.at / "folder.ply"), f"abacus-export: {self.at}/folder.ply is a folder\n"),
            (("-d", "template1", "files_plane", self.at / "n.ply"), "the database does not have the extension abacus"),
        ):
            done = run("abacus-export", *arguments)
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertIn(said, done.stderr)
            for other in "Traceback", "SELECT", ".part", "does not hold":
                self.assertNotIn(other, done.stderr)
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
