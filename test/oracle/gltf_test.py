"""Surfaces written as glTF: compared with SQL, and read by VTK. Khronos' validator checks them in test/viewer."""
import json
import struct
import subprocess

import numpy
from vtkmodules.vtkIOGeometry import vtkGLTFReader

import abacus

TYPES = {5123: ("<u2", 65535), 5125: ("<u4", 1), 5126: ("<f4", 1)}
PARTS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


class Glb:
    """A file in memory: `json`, and meshes as dicts of arrays."""

    def __init__(self, path):
        self.bytes = path.read_bytes()
        magic, version, size, length, kind = struct.unpack_from("<4sIIII", self.bytes)
        assert (magic, version, size, kind) == (b"glTF", 2, len(self.bytes), 0x4E4F534A)
        self.json = json.loads(self.bytes[20: 20 + length])
        self.binary = self.bytes[28 + length:]
        self.origin = numpy.array(self.json["asset"]["extras"]["origin"])
        self.meshes = [self.mesh(mesh) for mesh in self.json["meshes"]]

    def array(self, number):
        accessor = self.json["accessors"][number]
        view = self.json["bufferViews"][accessor["bufferView"]]
        dtype, _ = TYPES[accessor["componentType"]]
        found = numpy.frombuffer(self.binary, dtype, accessor["count"] * PARTS[accessor["type"]], view["byteOffset"])
        return found.reshape(-1, PARTS[accessor["type"]])

    def mesh(self, mesh):
        primitive, = mesh["primitives"]
        arrays = {name: self.array(number) for name, number in primitive["attributes"].items()}
        arrays["triangles"] = self.array(primitive["indices"]).reshape(-1, 3).astype(int)
        arrays["points"] = arrays["POSITION"].astype(float) + self.origin
        return arrays


def volume(mesh):
    """Enclosed by the surface, positive if normals point outwards."""
    corners = mesh["points"][mesh["triangles"]] - mesh["points"].mean(axis=0)
    return numpy.einsum("ij,ij->i", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])).sum() / 6


def edges(mesh):
    """How often each edge comes in each direction."""
    t = mesh["triangles"]
    return numpy.unique(numpy.concatenate([t[:, [n, (n + 1) % 3]] for n in range(3)]), axis=0, return_counts=True)


class Gltf(abacus.InFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        random = numpy.random.default_rng(61)
        cls.points = random.uniform(-1, 1, (2500, 3))
        cls.radius = numpy.sqrt((cls.points ** 2).sum(axis=1))
        cls.far = numpy.array([512000.0, 5400000.0, -300.0])
        some = numpy.where(numpy.arange(2500) % 7 == 0, numpy.nan, cls.points[:, 2])
        abacus.triangulate("gltf_ball", 100 * cls.points + cls.far, radius=cls.radius, height=cls.points[:, 2], patchy=some)
        abacus.psql("SELECT abacus_label('gltf_ball', $$SELECT code, v0, v1, v2, v3, 1 + ((corners[1][1] + corners[2][1]) / 2 > 512000)::int AS rock "
                    "FROM abacus_cells('gltf_ball') WHERE (corners[1][3] + corners[4][3]) / 2 < -260$$)")

    def export(self, mesh, name, *options, code=0):
        path = self.at / name
        done = subprocess.run(["/usr/bin/python3", str(abacus.REPOSITORY / "client/abacus-export"), mesh, str(path), *options], text=True, capture_output=True)
        self.assertEqual(done.returncode, code, done.stderr)
        self.said = done.stderr
        return Glb(path) if code == 0 else None

    def assert_closed(self, mesh):
        """Each edge comes as often in one direction as in the other."""
        found, counts = edges(mesh)
        there = dict(zip(map(tuple, found.tolist()), counts.tolist()))
        self.assertEqual([edge for edge, count in there.items() if there.get(edge[::-1]) != count], [])

    def test_isosurface(self):
        file = self.export("gltf_ball", "iso.glb", "--isosurface", "radius=0.6")
        mesh, = file.meshes
        self.assert_closed(mesh)
        self.assertAlmostEqual(volume(mesh) / (4 / 3 * numpy.pi * 60 ** 3), -1, delta=0.1)  # normals point to lesser values, which are inside
        rows = abacus.rows("SELECT v0, v1, v2, corners FROM abacus_isosurface('gltf_ball', 0.6, 'radius')")
        places = {}
        for *numbers, corners in rows:
            places.update(zip(numbers, map(tuple, abacus.vector(corners, 3).tolist())))
        self.assertEqual((len(mesh["triangles"]), len(mesh["points"])), (len(rows), len(places)))
        wanted, found = (numpy.array(sorted(map(tuple, p))) for p in (places.values(), mesh["points"].tolist()))
        numpy.testing.assert_allclose(numpy.sort(found, axis=0), numpy.sort(wanted, axis=0), rtol=0, atol=1e-5)
        radial = (mesh["points"] - self.far) / 60
        self.assertLess((radial * mesh["NORMAL"]).sum(axis=1).mean(), -0.9)
        numpy.testing.assert_allclose((mesh["NORMAL"] ** 2).sum(axis=1), 1, atol=1e-5)
        numpy.testing.assert_allclose(mesh["_HEIGHT"][:, 0], (mesh["points"][:, 2] + 300) / 100, atol=1e-6)  # linear, so exact but for rounding
        self.assertNotIn("_PATCHY", mesh)
        self.assertIn("attributes with a value that is missing or beyond floats (patchy)", self.said)
        self.assertIn("labels of cells (rock)", self.said)
        self.assertIn("coordinates, which are rounded by up to", self.said)

    def test_bodies(self):
        file = self.export("gltf_ball", "rock.glb", "--label", "rock")
        self.assertEqual([mesh["extras"]["value"] for mesh in file.json["meshes"]], [1, 2])
        wanted = dict(abacus.numbers("SELECT labels[1], sum(abs((corners[2][1] - a[1]) * ((corners[3][2] - a[2]) * (corners[4][3] - a[3]) - (corners[3][3] - a[3]) * (corners[4][2] - a[2])) "
                                     "- (corners[2][2] - a[2]) * ((corners[3][1] - a[1]) * (corners[4][3] - a[3]) - (corners[3][3] - a[3]) * (corners[4][1] - a[1])) "
                                     "+ (corners[2][3] - a[3]) * ((corners[3][1] - a[1]) * (corners[4][2] - a[2]) - (corners[3][2] - a[2]) * (corners[4][1] - a[1])))) / 6 "
                                     "FROM abacus_cells('gltf_ball'), LATERAL (SELECT ARRAY[corners[1][1], corners[1][2], corners[1][3]] AS a) AS first WHERE labels[1] IS NOT NULL GROUP BY 1"))
        for value, mesh in zip((1, 2), file.meshes):
            self.assert_closed(mesh)
            self.assertAlmostEqual(volume(mesh) / wanted[value], 1, delta=1e-5)
        self.assertNotIn("labels", self.said)
        one, = self.export("gltf_ball", "one.glb", "--label", "rock=2").meshes
        for name, array in one.items():
            self.assertEqual(len(array), len(file.meshes[1][name]), name)

    def test_border(self):
        mesh, = self.export("gltf_ball", "border.glb").meshes
        self.assert_closed(mesh)
        rings = abacus.numbers("SELECT x, y, z FROM abacus_hull('gltf_ball')")
        self.assertEqual(len(mesh["triangles"]), len(rings) // 3)
        numpy.testing.assert_allclose(numpy.sort(mesh["points"], axis=0), numpy.sort(numpy.unique(rings, axis=0), axis=0), rtol=0, atol=1e-5)
        reader = vtkGLTFReader()
        reader.SetFileName(str(self.at / "border.glb"))
        reader.Update()
        found = reader.GetOutput()
        while not hasattr(found, "GetNumberOfCells") or not hasattr(found, "GetPoint") :
            found = found.GetBlock(0)
        self.assertEqual((found.GetNumberOfPoints(), found.GetNumberOfCells()), (len(mesh["points"]), len(mesh["triangles"])))

    def test_the_same_for_another_order(self):
        for name, order in ("gltf_first", "id"), ("gltf_second", "id * 7919 % 2503"):
            abacus.psql(f"SELECT abacus_triangulate('{name}', $$SELECT id, x, y, z, radius, height FROM gltf_ball_points ORDER BY {order}$$, "
                        "'{radius,height}', dimension => 3)")
        for options in ["--isosurface", "radius=0.5", "--colour", "height"], ["--colour", "radius"]:
            first, second = (self.export(name, "order.glb", *options) for name in ("gltf_first", "gltf_second"))
            self.assertEqual(first.binary, second.binary)

    def test_colours(self):
        file = self.export("gltf_ball", "colours.glb", "--colour", "height", "--isosurface", "radius=0.7")
        mesh, = file.meshes
        self.assertEqual(file.json["meshes"][0]["extras"]["colour"]["attribute"], "height")
        low, high = mesh["_HEIGHT"].argmin(), mesh["_HEIGHT"].argmax()
        for at, colour in (low, (0x44, 0x01, 0x54)), (high, (0xFD, 0xE7, 0x25)):
            part = numpy.array(colour) / 255
            linear = numpy.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)
            numpy.testing.assert_allclose(mesh["COLOR_0"][at] / 65535, [*linear, 1], atol=1e-4)

    def test_terrain(self):
        plane = numpy.random.default_rng(5).integers(0, 4096, (800, 2)) / 4.0
        abacus.triangulate("gltf_terrain", plane, height=numpy.floor(plane[:, 0] / 2 - plane[:, 1]))
        mesh, = self.export("gltf_terrain", "terrain.glb", "--z", "height").meshes
        self.assertIn("ids of points", self.said)
        self.assertNotIn("digits", self.said)  # all of them fit floats
        wanted = abacus.numbers("SELECT x, y, attributes[1] FROM abacus_numbered_vertices('gltf_terrain')")
        numpy.testing.assert_array_equal(mesh["points"], wanted)
        numpy.testing.assert_array_equal(mesh["triangles"], abacus.numbers("SELECT n0, n1, n2 FROM abacus_numbered_simplices('gltf_terrain')"))
        self.assertGreater(mesh["NORMAL"][:, 2].min(), 0)

    def test_a_surface_through_vertices(self):
        """Corners at one place are one vertex, and no triangle is without an area."""
        abacus.psql("SELECT abacus_triangulate('gltf_grid', 'SELECT 100 * x + 10 * y + z, x, y, z, z AS level FROM generate_series(0, 5) AS x, generate_series(0, 5) AS y, generate_series(0, 5) AS z', "
                    "dimension => 3)")
        mesh, = self.export("gltf_grid", "grid.glb", "--isosurface", "level=3").meshes
        self.assertEqual((len(mesh["points"]), len(mesh["triangles"])), (36, 50))
        numpy.testing.assert_array_equal(numpy.abs(mesh["NORMAL"]), numpy.tile([0, 0, 1], (36, 1)))

    def test_refusals(self):
        abacus.psql("SELECT abacus_triangulate('gltf_vast', 'VALUES (1, 0.0, 0.0), (2, 1e39, 0), (3, 0, 1e39)')")
        for mesh, options, said in (
            ("gltf_ball", ["--isosurface", "radius"], "radius is not"), ("gltf_ball", ["--isosurface", "depth=3"], "no attribute depth; it has: radius, height, patchy"),
            ("gltf_ball", ["--isosurface", "radius=nan"], "radius=nan is not"), ("gltf_ball", ["--isosurface", "radius=99"], "no triangle of this surface"),
            ("gltf_ball", ["--label", "soil"], "no label soil; it has: rock"), ("gltf_ball", ["--label", "rock=7"], "no triangle of this surface"),
            ("gltf_ball", ["--colour", "depth"], "no attribute depth"), ("gltf_vast", [], "floats, which end at 3.4e+38"), ("gltf_ball", ["--strict"], "would not hold"),
            ("gltf_ball", ["--z", "height"], "--z is for meshes in the plane"),
        ):
            with self.subTest(options=options):
                self.export(mesh, "unwritten.glb", *options, code=1)
                self.assertIn(said, self.said)
        for options in ["--isosurface", "radius=1"], ["--label", "rock"], ["--colour", "radius"]:
            done = subprocess.run(["/usr/bin/python3", str(abacus.REPOSITORY / "client/abacus-export"), "gltf_ball", str(self.at / "unwritten.vtu"), *options], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2)
        self.assertEqual(list(self.at.glob("unwritten*")), [])
