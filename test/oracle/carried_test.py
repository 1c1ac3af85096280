"""What a mesh carries: labels, markers, split nodes, ids and attributes go into files, VTK and meshio find them there, and they come back."""
import os
import pathlib
import pty
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import meshio
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

import abacus

CLIENT = abacus.REPOSITORY / "client"
sys.path.insert(0, str(CLIENT))
from abacus_files.progress import Progress, span  # noqa: E402

# Both have a fault (2, 5 and 12, 15; 2, 3, 4 and 12, 13, 14), simplices without a label, a negative marker, a value that is missing.
PLANE = """SELECT abacus_load('carried_plane',
    'VALUES (1, 0, 0, 0, 7), (2, 2, 0, 0, 7), (4, 0, 2, 0, NULL), (5, 2, 2, 0, 7), (12, 2, 0, 1, 7), (3, 4, 0, 1, 7), (6, 4, 2, 1, 7), (15, 2, 2, 1, 7.5)',
    'VALUES (1, 2, 5, 3, NULL), (1, 5, 4, 4, 0.5), (12, 3, 6, NULL, NULL), (12, 6, 15, 5, -1e300)', '{slip,"a b"}', labels => '{material,"wet ä"}',
    facets => 'VALUES (2, 5, 7), (12, 15, 8), (1, 2, -2147483648), (1, 5, 2147483647)', split_nodes => true)"""
SPACE = """SELECT abacus_load('carried_space', $$VALUES (1, 0, 0, -1, 0), (2, 0, 0, 0, 0), (3, 1, 0, 0, NULL), (4, 0, 1, 0, 0),
    (12, 0, 0, 0, 1), (13, 1, 0, 0, 1), (14, 0, 1, 0, 1), (9007199254740993, 0.1, 0.1, 1, 1)$$,
    'VALUES (1, 2, 3, 4, 3, NULL), (12, 13, 14, 9007199254740993, NULL, 0.5)', '{slip}', labels => '{material,marker}',
    facets => 'VALUES (2, 3, 4, 7), (12, 13, 14, 8), (1, 2, 3, -3)', split_nodes => true)"""


def run(command, *arguments):
    return subprocess.run(["/usr/bin/python3", str(CLIENT / command), *map(str, arguments)], text=True, capture_output=True)


def of_vtk(path):
    """A VTU as VTK reads it: places, types, corners of each cell, arrays of points and of cells."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    cells = [[grid.GetCell(n).GetPointId(k) for k in range(grid.GetCell(n).GetNumberOfPoints())] for n in range(grid.GetNumberOfCells())]
    arrays = [{data.GetArrayName(n): vtk_to_numpy(data.GetArray(n)) for n in range(data.GetNumberOfArrays())}
              for data in (grid.GetPointData(), grid.GetCellData())]
    return vtk_to_numpy(grid.GetPoints().GetData()), [grid.GetCellType(n) for n in range(len(cells))], cells, *arrays


class Carried(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = pathlib.Path(cls.folder.name)
        abacus.psql("DROP TABLE IF EXISTS carried_plane, carried_plane_vertices, carried_space, carried_space_vertices; " + PLANE + "; " + SPACE)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def export(self, mesh, name, *options, lost=""):
        done = run("abacus-export", mesh, self.at / name, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr.strip(), f"abacus-export: {self.at / name} does not hold {lost}" if lost else "")
        return self.at / name

    def content(self, mesh):
        """All that a mesh has, as rows."""
        return [abacus.rows(query) for query in (
            f"SELECT name FROM abacus_attributes('{mesh}') ORDER BY position", f"SELECT abacus_labels('{mesh}')",
            f"SELECT v0, v1, v2, v3, corners, \"values\", labels FROM abacus_cells('{mesh}') ORDER BY v0, v1, v2, v3",
            f"SELECT marker, v0, v1, v2, corners FROM abacus_facets('{mesh}') ORDER BY marker")]

    def comes_back(self, file, mesh):
        abacus.psql("DROP TABLE IF EXISTS carried_again, carried_again_vertices")
        done = run("abacus-import", file, "carried_again", "--split-nodes")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.content("carried_again"), self.content(mesh))
        self.assertNotIn("abacus-import:", done.stderr)  # nothing is left out

    def expected(self, mesh):
        """{sorted ids of the corners: labels} and {sorted ids: marker}"""
        cells = {tuple(sorted(map(int, row[:-1]))): abacus.vector(row[-1]).tolist() for row in abacus.rows(
            f"SELECT {'v0, v1, v2, v3' if mesh.endswith('space') else 'v0, v1, v2'}, labels FROM abacus_cells('{mesh}')")}
        facets = {tuple(sorted(map(int, row[1:]))): int(row[0]) for row in abacus.rows(
            f"SELECT marker, {'v0, v1, v2' if mesh.endswith('space') else 'v0, v1'} FROM abacus_facets('{mesh}')")}
        return cells, facets

    def assert_cells(self, mesh, ids, cells, labels, markers):
        """Cells of a file, simplices and facets together."""
        wanted, facets = self.expected(mesh)
        size = len(next(iter(wanted)))
        have = {tuple(sorted(ids[cell].tolist())): [values[n] for values in labels] for n, cell in enumerate(cells) if len(cell) == size}
        numpy.testing.assert_equal(have, wanted)
        self.assertEqual({tuple(sorted(ids[cell].tolist())): markers[n] for n, cell in enumerate(cells) if len(cell) < size}, facets)
        self.assertEqual({int(markers[n]) for n, cell in enumerate(cells) if len(cell) == size}, {0})

    def test_vtu(self):
        for mesh, names, marker, types in (("carried_plane", ["material", "wet ä"], "marker", {3, 5}), ("carried_space", ["material", "marker"], "marker_", {5, 10})):
            file = self.export(mesh, "m.vtu", "--strict")
            points, kinds, cells, data, cell_data = of_vtk(file)
            self.assertEqual(set(kinds), types)
            self.assert_cells(mesh, data["id"], cells, [cell_data[name] for name in names], cell_data[marker])
            found = meshio.read(file)
            numpy.testing.assert_array_equal(found.point_data["slip"], data["slip"])
            numpy.testing.assert_array_equal(numpy.concatenate([block.reshape(-1) for block in found.cell_data["material"]]), cell_data["material"])
            self.comes_back(file, mesh)

    def test_xdmf(self):
        for mesh, names, marker in ("carried_plane", ["material", "wet ä"], "marker"), ("carried_space", ["material", "marker"], "marker_"):
            file = self.export(mesh, "m.xdmf", "--strict")
            found = meshio.read(file)
            cells = [cell for block in found.cells for cell in block.data.tolist()]
            of = {name: numpy.concatenate([numpy.asarray(block).reshape(-1) for block in found.cell_data[name]]) for name in (*names, marker)}
            self.assert_cells(mesh, found.point_data["id"], cells, [of[name] for name in names], of[marker])
            self.comes_back(file, mesh)

    def test_npz(self):
        for mesh in "carried_plane", "carried_space":
            file = self.export(mesh, "m.npz", "--strict")
            with numpy.load(file) as arrays:
                cells = arrays["simplices"].tolist() + arrays["facets"].tolist()
                labels = numpy.concatenate([arrays["labels"], numpy.full((len(arrays["facets"]), 2), numpy.nan)])
                self.assert_cells(mesh, arrays["ids"], cells, labels.T, [0] * len(arrays["simplices"]) + arrays["markers"].tolist())
            self.comes_back(file, mesh)

    def test_ply(self):
        file = self.export("carried_plane", "m.ply", lost="names, which are changed (a b: a_b, wet ä: wet__)")
        self.assertIn(b"element edge 4\nproperty int vertex1\nproperty int vertex2\nproperty int marker\n", file.read_bytes())
        before = self.content("carried_plane")
        abacus.psql("DROP TABLE IF EXISTS carried_again, carried_again_vertices")
        self.assertEqual(run("abacus-import", file, "carried_again", "--split-nodes").returncode, 0)
        after = self.content("carried_again")
        self.assertEqual(after[:2], [[["slip"], ["a_b"]], [["{material,wet__}"]]])
        self.assertEqual(after[2:], before[2:])

    def test_2dm(self):
        """Materials and ids; the rest is named."""
        abacus.psql("SELECT abacus_load('carried_2dm', 'VALUES (10, 0, 0), (2, 2, 0), (30, 2, 2), (40, 0, 2)', 'VALUES (10, 2, 30, 1), (10, 30, 40, 1)', "
                    "labels => '{material}', facets => 'VALUES (10, 30, 5)')")
        file = self.export("carried_2dm", "m.2dm", lost="markers of 1 facet")
        self.assertEqual(sorted(sorted(line.split()[2:5]) + line.split()[5:] for line in file.read_text().splitlines() if line.startswith("E3T")),
                         [["10", "2", "30", "1"], ["10", "30", "40", "1"]])
        abacus.psql("SELECT abacus_mark('carried_2dm', 'SELECT code, v0, v1, v2, f, NULL::int FROM abacus_simplices(''carried_2dm'') s, generate_series(0, 2) f')")
        self.comes_back(file, "carried_2dm")
        self.export("carried_plane", "n.2dm", lost="attributes of points (slip, a b); labels of cells (wet ä); missing values of material: 1 triangle gets 0; markers of 4 facets")

    def test_strict(self):
        """What a format cannot hold is an error, and no file is left; what no format holds, too."""
        abacus.psql("SELECT abacus_triangulate('carried_lines', 'VALUES (1, 0, 0), (2, 4, 0), (3, 0, 4), (4, 4, 4), (5, 0, 0)')")
        abacus.psql("SELECT abacus_set_srid('carried_lines', 25832); SELECT abacus_stage('carried_lines', 'SELECT 9, 1, 1')")
        for mesh, suffix, said in (("carried_plane", "obj", "ids of points; attributes of points (slip, a b); labels of cells (material, wet ä); markers of 4 facets"),
                                   ("carried_plane", "geojsonl", "of which a triangle has the means; markers"),
                                   ("carried_lines", "vtu", "1 point at the place of a vertex; 1 point waiting to be inserted; the SRID 25832")):
            done = run("abacus-export", mesh, self.at / f"strict.{suffix}", "--strict")
            self.assertEqual((done.returncode, list(self.at.glob("strict*"))), (1, []))
            self.assertIn("would not hold", done.stderr)
            self.assertIn(said, done.stderr)

    def test_series(self):
        """XDMF has the mesh once, and meshio finds each step; the first one comes back."""
        abacus.psql("CREATE TABLE carried_series AS SELECT id, step / 4.0 AS at, id * 10 + step AS speed FROM generate_series(1, 5) AS id, generate_series(0, 2) AS step")
        file = self.export("carried_plane", "run.xdmf", "--series", "TABLE carried_series")
        grids = xml.etree.ElementTree.parse(file).findall("Domain/Grid/Grid")
        self.assertEqual([grid.find("Time").get("Value") for grid in grids], ["0.0", "0.25", "0.5"])
        self.assertEqual({grid.find("Geometry/DataItem").text for grid in grids}, {"run.h5:/mesh/points"})
        self.assertEqual({grid.find("Topology/DataItem").text for grid in grids}, {"run.h5:/mesh/cells"})
        import h5py
        with h5py.File(self.at / "run.h5") as store:
            ids = store["mesh/id"][()]
            for step in range(3):
                numpy.testing.assert_array_equal(store[f"step{step}/point0"][()], numpy.where(ids < 6, ids * 10.0 + step, numpy.nan))
        abacus.psql("DROP TABLE IF EXISTS carried_again, carried_again_vertices")
        done = run("abacus-import", file, "carried_again", "--split-nodes")
        self.assertIn("a series of 3 steps, of which the first is taken", done.stderr)
        self.assertEqual(abacus.rows("SELECT count(*), sum(attributes[3]) FROM abacus_vertices('carried_again') WHERE attributes[3] = id * 10"), [["5", "150"]])
        failed = run("abacus-export", "carried_plane", self.at / "none.xdmf", "--series", "SELECT 1, 2")
        self.assertEqual((failed.returncode, list(self.at.glob("none*"))), (1, []))

    def test_octree(self):
        """Quadrangles and hexahedra that fill the domain, with levels, attributes, and the nodes between which one hangs."""
        for dimension, kind, corners in (2, 9, 4), (3, 12, 8):
            name = f"carried_octree{dimension}"
            abacus.psql(f"SELECT abacus_octree_create('{name}', {dimension}, '{{{','.join('0' * dimension)}}}', '{{{','.join('8' * dimension)}}}', attributes => '{{vs}}'); "
                        f"SELECT abacus_octree_refine('{name}', 'SELECT 3, {', '.join(['5'] * dimension)}'); SELECT abacus_octree_balance('{name}'); "
                        f"SELECT abacus_octree_update('{name}', 'SELECT code, lower[1] FROM abacus_octants(''{name}'') WHERE level > 1')")
            points, kinds, cells, data, cell_data = of_vtk(self.export(name, "o.vtu", "--strict"))
            self.assertEqual((set(kinds), {len(cell) for cell in cells}), ({kind}, {corners}))
            sizes = numpy.array([numpy.ptp(points[cell], axis=0)[:dimension] for cell in cells])
            self.assertEqual(sizes.prod(axis=1).sum(), 8.0 ** dimension)
            numpy.testing.assert_array_equal(cell_data["level"], 3 - numpy.log2(sizes[:, 0]))
            numpy.testing.assert_array_equal(cell_data["vs"], [points[cell, 0].min() if level > 1 else numpy.nan for cell, level in zip(cells, cell_data["level"])])
            if dimension == 2:  # the corners go around
                x, y = points[numpy.array(cells)][:, :, 0], points[numpy.array(cells)][:, :, 1]
                numpy.testing.assert_array_equal((x * numpy.roll(y, -1, axis=1) - numpy.roll(x, -1, axis=1) * y).sum(axis=1) / 2, sizes.prod(axis=1))
            hangs = numpy.flatnonzero(data["hanging"])
            self.assertGreater(len(hangs), 0)
            for n in hangs:
                anchors = [int(data[f"anchor_{k + 1}"][n]) for k in range(int(data["hanging"][n]))]
                numpy.testing.assert_array_equal(points[n], points[anchors].mean(axis=0))
            leaves = f"SELECT code, level, lower, upper, attributes FROM abacus_octants('{name}%s') ORDER BY code"
            for suffix in (".vtu", ".npz", ".xdmf") if dimension == 3 else (".vtu",):
                abacus.psql(f"DROP TABLE IF EXISTS {name}_again, {name}_again_vertices")
                done = run("abacus-import", self.export(name, "o" + suffix), f"{name}_again")
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                self.assertEqual(abacus.rows(leaves % "_again"), abacus.rows(leaves % ""))
        abacus.psql("SELECT abacus_octree_create('carried_coarse', 2, '{0,0}', '{1,1}', levels => 5)")
        self.export("carried_coarse", "c.vtu", lost="that its leaves may have the level 5 at most")
        done = run("abacus-import", self.export("carried_octree2", "o.ply"), "carried_none")  # PLY has no codes
        self.assertIn("quad: ", done.stderr)
        with numpy.load(self.at / "o.npz") as arrays:
            numpy.savez(self.at / "moved.npz", **{**arrays, "codes": arrays["codes"][::-1]})
        self.assertIn("is not there in the octree", run("abacus-import", self.at / "moved.npz", "carried_none").stderr)
        abacus.psql("SELECT abacus_octree_create('carried_torn', 2, '{0,0}', '{1,1}'); SELECT abacus_octree_refine('carried_torn', 'SELECT 5, 0.49, 0.49')")
        done = run("abacus-export", "carried_torn", self.at / "torn.vtu")
        self.assertEqual((done.returncode, list(self.at.glob("torn*"))), (1, []))
        self.assertIn("not balanced", done.stderr)

    def test_groups(self):
        """The names of Gmsh's physical groups as a table."""
        (self.at / "g.msh").write_text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 77 \"in; \"\n2 5 \"o'clay\"\n$EndPhysicalNames\n$Nodes\n3\n10 0 0 0\n"
                                       "20 1 0 0\n30 0 1 0\n$EndNodes\n$Elements\n2\n1 1 2 77 1 10 20\n2 2 2 -5 1 10 20 30\n$EndElements\n")
        done = run("abacus-import", self.at / "g.msh", "carried_groups", "--groups", 'public."the groups"')
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(abacus.rows('SELECT * FROM "the groups" ORDER BY 1'), [["1", "77", "in; "], ["2", "5", "o'clay"]])
        self.assertEqual(abacus.rows("SELECT labels FROM abacus_cells('carried_groups')"), [["{5}"]])
        self.assertEqual(run("abacus-import", self.at / "g.msh", "carried_other", "--groups", "x; DROP TABLE x").returncode, 1)
        self.assertEqual(abacus.rows("SELECT to_regclass('carried_other')"), [["NULL"]])

    def test_progress(self):
        """A line on a terminal, none in a pipe."""
        leader, follower = pty.openpty()
        with os.fdopen(leader, "rb") as shown, os.fdopen(follower, "w") as terminal:
            with Progress("m.vtu", 400, after=0, stream=terminal) as progress:
                progress.begun -= 3
                progress.add(100, 2500000)
                said = shown.read1().decode()
                progress.say("done")
            self.assertEqual(said, "\rm.vtu: 100 of 400 rows, 2.5 MB, 9 s left")
            self.assertEqual(shown.read1().decode().replace(" ", ""), "\rdone\r\n")
        with tempfile.TemporaryFile("w+") as file:
            with Progress("m.vtu", 400, after=0, stream=file) as progress:
                progress.add(100, 2500000)
            self.assertEqual(file.tell(), 0)
        self.assertEqual([span(seconds) for seconds in (3, 83, 7380)], ["3 s", "1 min 23 s", "2 h 03 min"])


if __name__ == "__main__":
    unittest.main()
