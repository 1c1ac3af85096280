"""What abacus-import reads, without a database: files that VTK and meshio write, files by hand, and files that are cut off or wrong."""
import itertools
import struct
import sys
import time
import unittest

import meshio
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

import abacus

sys.path.insert(0, str(abacus.REPOSITORY / "client"))
from abacus_files import apart, read  # noqa: E402
from abacus_files.psql import Failed  # noqa: E402

PLY = """ply
format ascii 1.0
comment made by hand
element vertex 4
property float quality
property double y
property double x
element face 2
property list uchar float texcoord
property list uchar int vertex_index
property uchar red
element edge 1
property int vertex1
end_header
0.5 0 0
1.5 0 4
2.5 3 0
3.5 3 4
6 0 0 0 0 0 0 3 0 1 2 255
0 3 1 3 2 7
0
"""
CELLS = [[0, 1, 2], [1, 3, 2]]


def piece_of(piece, at, shift):
    """A piece of a VTU with one triangle."""
    points = " ".join(f"{x + shift} {y} 0" for x, y in at)
    return ('<Piece NumberOfPoints="3" NumberOfCells="1"><PointData>'
            f'<DataArray type="Float64" Name="h" format="ascii">{piece} {piece} {piece}</DataArray></PointData>'
            f'<Points><DataArray type="Float64" Name="Points" NumberOfComponents="3" format="ascii">{points}</DataArray></Points><Cells>'
            '<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2</DataArray><DataArray type="Int64" Name="offsets" format="ascii">3</DataArray>'
            '<DataArray type="UInt8" Name="types" format="ascii">5</DataArray></Cells></Piece>')


def vtu_of(*pieces):
    return ('<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64"><UnstructuredGrid>'
            + "".join(pieces) + "</UnstructuredGrid></VTKFile>")


class Import(abacus.InFolder):
    def file(self, name, content):
        path = self.at / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return str(path)

    def read(self, path, **options):
        grid = read.read_here(str(path), **{"keep_apart": False, **options})
        grid.check()
        return read.Input(grid)

    def assert_mesh(self, found, points, simplices):
        numpy.testing.assert_array_equal(found.points, points)
        numpy.testing.assert_array_equal(found.simplices, simplices)

    def refused(self, name, content, said):
        with self.assertRaisesRegex(Failed, said):
            self.read(self.file(name, content))

    def test_vtu_of_vtk(self):
        """Every way in which VTK writes arrays; 5 attributes and 200 points, which meshio 5 mixes up."""
        random = numpy.random.default_rng(3)
        points = random.uniform(0, 1, (200, 3))
        cells = [random.permutation(200)[:4].tolist() for _ in range(150)]
        grid = vtkUnstructuredGrid()
        at = vtkPoints()
        at.SetData(numpy_to_vtk(points, deep=True))
        grid.SetPoints(at)
        for cell in cells:
            grid.InsertNextCell(10, 4, cell)
        values = {f"a {n}": random.uniform(0, 1, 200).astype(kind) for n, kind in enumerate(("f8", "f8", "f4", "f8", "f8"))}
        for name, data in {**values, "id": numpy.arange(200) * 7 - 3, "wind": points}.items():
            array = numpy_to_vtk(data, deep=True)
            array.SetName(name)
            grid.GetPointData().AddArray(array)
        path = self.at / "vtk.vtu"
        for mode, encode, compressor, header, order in itertools.product(
                ("Ascii", "Binary", "Appended"), (True, False), ("None", "ZLib", "LZMA"), ("32", "64"), ("BigEndian", "LittleEndian")):
            if mode != "Appended" and not encode or mode == "Ascii" and (compressor, header, order) != ("None", "32", "BigEndian"):
                continue
            with self.subTest(mode=mode, encode=encode, compressor=compressor, header=header, order=order):
                writer = vtkXMLUnstructuredGridWriter()
                writer.SetFileName(str(path))
                writer.SetInputData(grid)
                getattr(writer, f"SetDataModeTo{mode}")()
                writer.SetEncodeAppendedData(encode)
                getattr(writer, f"SetCompressorTypeTo{compressor}")()
                getattr(writer, f"SetHeaderTypeToUInt{header}")()
                getattr(writer, f"SetByteOrderTo{order}")()
                writer.SetBlockSize(1024)
                writer.Write()
                found = self.read(path)
                close = numpy.testing.assert_allclose if mode == "Ascii" else numpy.testing.assert_array_equal
                close(found.points, points)
                numpy.testing.assert_array_equal(found.simplices, cells)
                numpy.testing.assert_array_equal(found.ids, numpy.arange(200) * 7 - 3)
                self.assertEqual(found.names, [*values, "wind_x", "wind_y", "wind_z"])
                for have, wanted in zip(found.values, [*values.values(), *points.T]):
                    close(have, wanted)
                self.assertEqual(found.notes, ["left out: 13 points of no tetrahedron"])

    def test_pieces(self):
        """Pieces are joined, and points that they share are one; with split nodes they are two."""
        first, second = piece_of(1, ((0, 0), (4, 0), (0, 3)), 0), piece_of(2, ((4, 0), (4, 3), (0, 3)), 0)
        path = self.file("pieces.vtu", vtu_of(first, second))
        found = self.read(path)
        self.assert_mesh(found, [[0, 0], [4, 0], [0, 3], [4, 3]], [[0, 1, 2], [1, 3, 2]])
        self.assertEqual(found.values[0].tolist(), [1, 1, 1, 2])
        self.assertIn("2 points that several pieces have", found.notes[0])
        self.assertIn("differ from piece to piece in h", found.notes[1])
        self.assertEqual(len(self.read(path, keep_apart=True).points), 6)
        self.assertEqual(len(self.read(self.file("apart.vtu", vtu_of(first, piece_of(2, ((4, 0), (4, 3), (0, 3)), 9)))).simplices), 2)

    def test_vtu_refused(self):
        piece = piece_of(1, ((0, 0), (4, 0), (0, 3)), 0)
        for old, new, said in (("0 1 2<", "0 1 3<", "names a point that its piece does not have"), ("0 1 2<", "0 1<", "offsets of cells end at 3"),
                               ("0 1 2<", "0 -1 2<", "names a point"), ('NumberOfPoints="3"', 'NumberOfPoints="4"', "has 9 numbers, but should have 4 times 3"),
                               ('NumberOfCells="1"', 'NumberOfCells="2"', "has 1 number, but should have 2 times 1"), ("</Cells>", "", "is not XML, or is cut off"),
                               (">5<", ">9<", "quad"), (">5<", ">22<", "triangle6"), (">5<", ">99<", "type 99"),
                               (' format="ascii">1 1 1', ' format="odd">1', "format odd")):
            self.refused("wrong.vtu", vtu_of(piece).replace(old, new, 1), said)
        self.refused("wrong.vtu", vtu_of(), "has no piece")
        self.refused("wrong.vtu", vtu_of(piece).replace("UnstructuredGrid", "PolyData"), "is not an unstructured grid")

    def test_ply(self):
        """Lists beside that of the corners, `vertex_index`, any order of properties; the same in binary."""
        found = self.read(self.file("m.ply", PLY))
        self.assert_mesh(found, [[0, 0], [4, 0], [0, 3], [4, 3]], CELLS)
        self.assertEqual((found.names, found.values[0].tolist()), (["quality"], [0.5, 1.5, 2.5, 3.5]))
        self.assertEqual(found.notes, ["left out: face texcoord, edge vertex1"])
        self.assertEqual((found.label_names, found.labels[0].tolist()), (["red"], [255, 7]))
        for order, name in ("<", "little"), (">", "big"):
            head = PLY.partition("end_header\n")[0].replace("ascii", f"binary_{name}_endian") + "end_header\n"
            rows = b"".join(struct.pack(order + "fdd", *row) for row in ((0.5, 0, 0), (1.5, 0, 4), (2.5, 3, 0), (3.5, 3, 4)))
            faces = struct.pack(order + "B6fB3iB", 6, *[0] * 6, 3, 0, 1, 2, 255) + struct.pack(order + "BB3iB", 0, 3, 1, 3, 2, 7)
            whole = head.encode() + rows + faces + struct.pack(order + "i", 0)
            self.assert_mesh(self.read(self.file("m.ply", whole)), [[0, 0], [4, 0], [0, 3], [4, 3]], CELLS)
            self.refused("cut.ply", whole[:-7], "ends before")
        self.refused("n.ply", PLY.replace("3 1 3 2 7", "3 1 -1 2 7"), "corner -1, but points are numbered from 0 to 3")
        self.refused("n.ply", PLY.replace("3 1 3 2 7", "3 1 4 2 7"), "corner 4, but points are numbered from 0 to 3")
        self.refused("n.ply", PLY.replace("3 1 3 2 7", "4 1 3 2 0 7"), "quad")
        self.refused("n.ply", PLY.replace("vertex_index", "others"), "no faces with vertex_indices")

    def test_obj(self):
        """Relative corners, and texture places and normals in other numbers than vertices."""
        head = "v 0 0 0\nv 4 0 0 # a comment\nv 0 3 0\nvt 0 0\nvn 0 0 1\n"
        found = self.read(self.file("m.obj", head + "f -3/1/1 -2/1 -1//1\nv 4 3 0\nf 2 4 3\n"))
        self.assert_mesh(found, [[0, 0], [4, 0], [0, 3], [4, 3]], CELLS)
        self.assertEqual(found.notes, ["left out: places in textures, normals"])
        for faces, said in (("f 1 2 0\n", "corner 0"), ("f 1 2 -4\n", "corner -4"), ("f 1 2 4\n", "corner 3, but points are numbered from 0 to 2"),
                            ("f 1 2 3 1\n", "quad"), ("", "neither triangles"), ("f 1 2 x\n", "line 6: x is not a corner"),
                            ("f 1 \\\n2 \\\n3\nf 1 2 x\n", "line 9: x is not a corner"),
                            ("f 1 2 99999999999999999999\n", "line 6: 99999999999999999999 is not a corner"), ("f 1 2 -99999999999999999999\n", "line 6: .* is not a corner")):
            self.refused("m.obj", head + faces, said)

    def test_off(self):
        points = "0 0 0\n4 0 0 # a comment\n0 3 0\n\n4 3 0\n"
        for head in "OFF\n4 2 0\n", "OFF 4 2 0\n", "# made by hand\nCOFF\n4 2\n":
            colours = points.replace("0\n", "0 1 0 0 1\n") if head.startswith("#") else points
            found = self.read(self.file("m.off", head + colours + "3 0 1 2\n3 1 3 2 255 0 0\n"))
            self.assert_mesh(found, [[0, 0], [4, 0], [0, 3], [4, 3]], CELLS)
            more = "colours, normals and the like of vertices, " if head.startswith("#") else ""
            self.assertEqual(found.notes, [f"left out: {more}colours of faces"])
        for faces, said in (("3 0 1 2\n3 0 2 -1\n", "corner -1"), ("3 0 1 2\n3 0 2 4\n", "corner 4"), ("3 0 1 2\n", "ends after 5 lines"),
                            ("3 0 1 2\n3 0 1\n", "fewer corners"), ("3 0 1 2\n4 0 1 3 2\n", "quad")):
            self.refused("n.off", "OFF\n4 2 0\n" + points + faces, said)
        self.refused("n.off", "", "does not begin with OFF")
        self.refused("n.off", "OFF\n", "does not say how many")

    def test_tetgen_and_triangle(self):
        space = "5 3 1 1\n# a comment\n10 0 0 0 0.5 7\n11 1 0 0 1 0\n12 0 1 0 2 0\n13 0 0 1 3 0\n14 0 0 -1 4 0\n"
        self.file("r.node", space)
        found = self.read(self.file("r.ele", "2 4 1\n0 10 11 12 13 0.5\n1 10 12 11 14 1.5\n"))
        self.assertEqual(found.ids.tolist(), [10, 11, 12, 13, 14])
        self.assertEqual(found.simplices.tolist(), [[0, 1, 2, 3], [0, 2, 1, 4]])
        self.assertEqual((found.names, found.values[0].tolist()), (["tetgen:attr1", "tetgen:ref"], [0.5, 1, 2, 3, 4]))
        self.refused("r.ele", "2 4 0\n0 10 11 12 13\n", "r.ele: line 2: the file ends after 1 of 2 cells")
        self.refused("r.ele", "1 4 0\n0 10 11 12 15\n", "names point 15, which is not there")
        found = self.read(self.file("r.ele", "1 10 0\n0 10 11 12 13 10 11 12 13 10 11\n"))
        self.assertEqual((found.simplices.tolist(), found.notes[0]), ([[0, 1, 2, 3]], "only the corners are taken of cells of higher order: tetra10"))
        self.refused("r.ele", "", "r.ele: line 1: the file ends before its first line")
        self.file("p.ele", "2 3 0\n1 1 2 3\n2 2 4 3\n")
        self.assert_mesh(self.read(self.file("p.node", "4 2 0 1\n1 0 0 1\n2 4 0 1\n3 0 3 1\n4 4 3 0\n")), [[0, 0], [4, 0], [0, 3], [4, 3]], CELLS)

    def test_tetgen_facets(self):
        """.face beside them, with inner marked faces; several regions; an .edge has markers of a mesh in the plane."""
        self.file("f.node", "5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 0 0 -1\n")
        self.file("f.ele", "2 4 2\n0 0 1 2 3 7 0.5\n1 0 2 1 4 8 1.5\n")
        self.file("f.edge", "1 1\n0 0 1 9\n")
        for first in 0, 1:
            if first:
                self.file("f.node", "5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0 0 -1\n")
                self.file("f.ele", "2 4 2\n1 1 2 3 4 7 0.5\n2 1 3 2 5 8 1.5\n")
                self.file("f.edge", "1 1\n1 1 2 9\n")
            rows = ((0, 1, 2, 5), (0, 1, 3, 0), (2, 1, 4, -6))
            path = self.file("f.face", "3 1\n" + "".join(f"{n} {a + first} {b + first} {c + first} {marker}\n" for n, (a, b, c, marker) in enumerate(rows)))
            for name in "f.face", "f.node", "f.ele":
                found = self.read(str(self.at / name))
                self.assertEqual((found.ids.tolist(), found.simplices.tolist()), (list(range(first, 5 + first)), [[0, 1, 2, 3], [0, 2, 1, 4]]))
                self.assertEqual((found.facets.tolist(), found.markers.tolist()), ([[0, 1, 2], [1, 2, 4]], [5, -6]))
                self.assertEqual((found.label_names, [values.tolist() for values in found.labels]), (["material", "material_2"], [[7, 8], [0.5, 1.5]]))
                self.assertIn("1 of the kind line", found.notes[-1])
        for content, said in (("2 1\n0 1 2 3 5\n", "f.face: line 2: the file ends after 1 of 2 facets"), ("1 1\n0 1 2 3 x\n", "f.face: line 2: x is not a whole number"),
                              ("1 1\n# none\n0 1 2 9 5\n", "f.face: line 3: a cell names point 9"), ("1 1\n0 1 2 3\n", "f.face: line 2: 4 numbers; 5 or 7 or 8 or 10")):
            self.file("f.face", content)
            self.refused("f.ele", (self.at / "f.ele").read_text(), said)
        self.file("t.node", "4 2 0 0\n1 0 0\n2 4 0\n3 0 3\n4 4 3\n")
        self.file("t.edge", "3 1\n1 1 2 1\n2 2 3 4\n3 4 3 0\n")
        found = self.read(self.file("t.ele", "2 6 1\n1 1 2 3 1 1 1 5\n2 2 4 3 1 1 1 6\n"))
        self.assertEqual((found.facets.tolist(), found.markers.tolist(), found.labels[0].tolist()), ([[0, 1], [1, 2]], [1, 4], [5, 6]))
        (self.at / "t.edge").unlink()
        self.file("t.poly", "0 2 0 1\n3 1\n1 1 2 1\n2 2 3 4\n3 4 3 0\n0\n")
        found = self.read(str(self.at / "t.node"))
        self.assertEqual((found.facets.tolist(), found.markers.tolist(), found.notes[0]), ([[0, 1], [1, 2]], [1, 4], "t.poly was read, too: 3 facets"))
        (self.at / "t.ele").unlink()
        with self.assertRaisesRegex(Failed, "t.ele: is needed beside it"):
            self.read(str(self.at / "t.node"))

    def test_medit(self):
        text = ("MeshVersionFormatted 2\nDimension 3\n# by hand\nVertices\n5\n0 0 0 0\n1 0 0 3\n0 1 0 0\n0 0 1 0\n0 0 -1 0\n"
                "Triangles\n2\n1 2 3 -7\n1 2 4 0\nTetrahedra\n2\n1 2 3 4 5\n1 3 2 5 6\nRequiredVertices\n1\n2\nEnd\n")
        found = self.read(self.file("m.mesh", text))
        self.assertEqual((found.ids.tolist(), found.simplices.tolist()), ([1, 2, 3, 4, 5], [[0, 1, 2, 3], [0, 2, 1, 4]]))
        self.assertEqual((found.labels[0].tolist(), found.facets.tolist(), found.markers.tolist()), ([5, 6], [[0, 1, 2]], [-7]))
        self.assertEqual((found.names, found.values[0].tolist(), found.notes[0]), (["medit:ref"], [0, 3, 0, 0, 0], "left out: RequiredVertices"))
        for version in (1, 2, 3, 4):
            for order in "<>":
                found = self.read(self.file("m.meshb", self.meshb(version, order)))
                self.assertEqual((found.points.tolist(), found.simplices.tolist()), ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2, 3]]))
                self.assertEqual((found.labels[0].tolist(), found.markers.tolist()), ([9], [4]))
        whole = self.meshb(2, "<")
        for size in range(4, len(whole) - 8, 5):
            self.refused("cut.meshb", whole[:size], "byte|has no Vertices|End|neither")
        for old, new, said in (("0 1 0 0", "0 1 x 0", "line 8: x is not a number"), ("1 2 4 0", "1 2 6 0", r"line 14: Triangles: the points \[1, 2, 6\]"),
                               ("Tetrahedra\n2", "Tetrahedra\n1", "line 18: more numbers than 1 Tetrahedra have"), ("Dimension 3", "Dimension 4", "line 2: the dimension is 4"),
                               ("Vertices\n5", "Vertices\n500", "line 22: the file ends before all Vertices"), ("1 2 3 4 5", "1 2 3 4 5.5", "line 17: 5.5 is not a whole number"),
                               ("Tetrahedra\n2\n1 2 3 4 5\n1 3 2 5 6", "Quadrilaterals\n1\n1 2 3 4 0", "quad: 1")):
            self.assertIn(old, text)
            self.refused("m.mesh", text.replace(old, new, 1), said)

    def meshb(self, version, order):
        """One tetrahedron of material 9, and a triangle marked 4, in binary."""
        real, whole, place = "f" if version == 1 else "d", "q" if version == 4 else "i", "q" if version > 2 else "i"
        parts, at = [struct.pack(order + "ii", 1, version)], 8
        body = [(3, struct.pack(order + "i", 3)),
                (4, struct.pack(order + whole, 4) + b"".join(struct.pack(order + "3" + real + whole, *p, 0) for p in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)))),
                (6, struct.pack(order + "5" + whole, 1, 1, 2, 3, 4)), (8, struct.pack(order + "6" + whole, 1, 1, 2, 3, 4, 9)), (54, b"")]
        for code, data in body:
            at += 4 + struct.calcsize("=" + place) + len(data)
            parts.append(struct.pack(order + "i" + place, code, 0 if code == 54 else at) + data)
        return b"".join(parts)

    def test_vtu_cells(self):
        """Which arrays of cells are labels and which are markers; second order; ids that tell points at one place apart."""
        def grid(*arrays, ids="1 2 3 4"):
            return vtu_of('<Piece NumberOfPoints="4" NumberOfCells="4"><PointData GlobalIds="n">' + f'<DataArray type="Int64" Name="n" format="ascii">{ids}</DataArray></PointData>'
                          '<CellData>' + "".join(f'<DataArray type="{kind}" Name="{name}" format="ascii">{values}</DataArray>' for kind, name, values in arrays) + '</CellData>'
                          '<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 4 0 0 0 3 0 4 3 0</DataArray></Points><Cells>'
                          '<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 1 3 2 0 1 1 3</DataArray>'
                          '<DataArray type="Int64" Name="offsets" format="ascii">3 6 8 10</DataArray><DataArray type="UInt8" Name="types" format="ascii">5 5 3 3</DataArray></Cells></Piece>')
        for arrays, labels, markers, said in (
                ((("Int32", "tag", "5 6 77 0"),), {"tag": [5, 6]}, [77], ""),
                ((("Int32", "tag", "0 0 77 78"),), {}, [77, 78], ""),
                ((("Int32", "tag", "5 6 0 0"), ("Int32", "bc", "0 0 77 78")), {"tag": [5, 6]}, [77, 78], ""),
                ((("Int32", "tag", "5 6 1 1"), ("Int32", "bc", "0 0 77 78")), {"tag": [5, 6], "bc": [0, 0]}, [], "an array named marker would give markers"),
                ((("Int32", "tag", "5 6 1 1"), ("Int32", "marker", "0 0 77 78")), {"tag": [5, 6]}, [77, 78], "left out: tag"),
                ((("Float64", "k", "0.5 nan 7 8"),), {"k": [0.5, numpy.nan]}, [], "neither triangles nor marked facets")):
            found = self.read(self.file("c.vtu", grid(*arrays)))
            self.assertEqual(found.label_names, list(labels))
            numpy.testing.assert_array_equal(found.labels, list(labels.values()))
            self.assertEqual((found.markers.tolist(), found.ids.tolist()), (markers, [1, 2, 3, 4]))
            self.assertIn(said, "; ".join(found.notes))
        self.refused("c.vtu", grid(("Int64", "marker", "0 0 3000000000 1")), "does not fit 32 bits")
        self.refused("c.vtu", grid(("Int32", "marker", "0 0\n 1 x")), "line 2: x is not a whole number")
        whole = grid(ids="1 2 3 9007199254740993").split("<UnstructuredGrid>")[1].split("</UnstructuredGrid>")[0]
        other = whole.replace("1 2 3 9007199254740993", "1 2 33 9007199254740992")
        found = self.read(self.file("c.vtu", vtu_of(whole, other)), keep_apart=True)
        self.assertEqual(found.ids.tolist(), [1, 2, 3, 9007199254740993, 33, 9007199254740992])
        self.assertIn("2 points that several pieces have were taken once", found.notes)

    def test_xdmf(self):
        """Numbers in text and in a binary file, as other programs write them; a mixed topology; grids of a collection; xi:include."""
        numpy.array([[0, 1, 2], [1, 3, 2]], dtype=">i4").tofile(self.at / "cells.bin")
        geometry = '<Geometry GeometryType="XY"><DataItem Dimensions="4 2" Format="XML">0 0 4 0\n0 3 4 3</DataItem></Geometry>'
        triangles = ('<Topology TopologyType="Triangle" NumberOfElements="2"><DataItem Dimensions="2 3" NumberType="Int" Precision="4" Format="Binary" '
                     'Endian="Big">cells.bin</DataItem></Topology>')
        mixed = '<Topology TopologyType="Mixed" NumberOfElements="3"><DataItem Dimensions="12" DataType="Int">4 0 1 2 2 2 0 1 4 1 3 2</DataItem></Topology>'
        values = '<Attribute Name="h" Center="Node"><DataItem Dimensions="4">1 2 3 4</DataItem></Attribute>'
        def file(*grids):
            return '<?xml version="1.0"?>\n<Xdmf xmlns:xi="http://www.w3.org/2003/XInclude"><Domain>' + "".join(grids) + "</Domain></Xdmf>"
        found = self.read(self.file("x.xdmf", file(f'<Grid Name="m">{geometry}{triangles}{values}</Grid>')))
        self.assert_mesh(found, [[0, 0], [4, 0], [0, 3], [4, 3]], CELLS)
        self.assertEqual((found.names, found.values[0].tolist()), (["h"], [1, 2, 3, 4]))
        tags = '<Attribute Name="tag" Center="Cell"><DataItem Dimensions="3" DataType="Int">5 77 6</DataItem></Attribute>'
        found = self.read(self.file("x.xdmf", file(f'<Grid Name="m">{geometry}{mixed}{tags}</Grid>')))
        self.assertEqual((found.simplices.tolist(), found.labels[0].tolist(), found.markers.tolist()), (CELLS, [5, 6], [77]))
        include = "<xi:include xpointer=\"xpointer(//Grid[@Name='m']/*[self::Topology or self::Geometry])\"/>"
        series = f'<Grid GridType="Collection" CollectionType="Temporal"><Grid>{include}{values}</Grid><Grid>{include}</Grid></Grid>'
        found = self.read(self.file("x.xdmf", file(series, f'<Grid Name="m">{geometry}{triangles}</Grid>')))
        self.assertEqual((found.names, found.simplices.tolist(), found.notes), (["h"], CELLS, ["a series of 2 steps, of which the first is taken"]))
        right = geometry.replace("0 0 4 0\n0 3 4 3", "4 0 8 0\n4 3 8 3")
        spatial = f'<Grid GridType="Collection" CollectionType="Spatial"><Grid>{geometry}{triangles}</Grid><Grid>{right}{triangles}</Grid></Grid>'
        found = self.read(self.file("x.xdmf", file(spatial)))
        self.assertEqual((len(found.points), len(found.simplices)), (6, 4))
        binary = file(f'<Grid Name="m">\n{geometry}\n{triangles}</Grid>')
        for old, new, said in (('Dimensions="2 3"', 'Dimensions="99999999999 3"', "line 5: the DataItem has 6 numbers"), ('Dimensions="2 3"', 'Dimensions="4294967296 4294967296"', "line 5: the DataItem has 6"),
                               ('Format="Binary"', 'Format="Binary" Seek="99999999999999999999"', "line 5: .* cannot be read"), ('Format="Binary"', 'Format="Binary" Seek="-1"', "line 5: .* cannot be read"),
                               ("cells.bin", "no.bin", "line 5: .*no.bin cannot be read")):
            self.refused("x.xdmf", binary.replace(old, new), said)
        whole = file(f'<Grid Name="m">\n{geometry}\n{mixed}{tags}</Grid>')
        for old, new, said in (("4 1 3 2<", "4 1 3 9<", "line 5: a triangle names a point"), ("4 1 3 2<", "70 1 3 2<", "line 5: the mixed topology"), ("0 3 4 3", "0 3 4", "line 3: the DataItem has 7"),
                               ("5 77 6", "5 7.7 6", "line 5: 7.7 is not a whole number"), ("</Grid>", "", "is not XML, or is cut off"), ("Mixed", "Odd", "line 5: cells Odd"),
                               ('NumberOfElements="3"', 'NumberOfElements="4"', "line 5: it says that it has 4 cells"), ('"12" D', '"12" Format="HDF" D', "cannot be read")):
            self.assertIn(old, whole)
            self.refused("x.xdmf", whole.replace(old, new, 1), said)

    def test_npz(self):
        numpy.savez(self.at / "n.npz", points=[[0.0, 0], [4, 0], [0, 3]], simplices=[[0, 1, 2]], values=[[1.0], [2], [3]], wind=[1])
        found = self.read(self.at / "n.npz")
        self.assertEqual((found.names, found.simplices.tolist(), found.notes), (["value1"], [[0, 1, 2]], ["left out: wind"]))
        whole = (self.at / "n.npz").read_bytes()
        for size in range(0, len(whole), 101):
            self.refused("cut.npz", whole[:size], "npz|archive|array|read")
        for arrays, said in (({"points": [[0.0, 0]]}, "no arrays points and simplices"), ({"points": [[0.0, 0]], "simplices": [[0, 1, 2, 3]]}, "quad"),
                             ({"points": [0.0, 0], "simplices": [[0, 1, 2]]}, "shape"), ({"points": [["a", "b"]], "simplices": [[0, 0, 0]]}, "type"),
                             ({"points": [[0.0, 0]], "simplices": [[0, 1, 2]]}, "corner 1, but points are numbered from 0 to 0")):
            numpy.savez(self.at / "w.npz", **arrays)
            with self.assertRaisesRegex(Failed, said):
                self.read(self.at / "w.npz")

    def test_2dm(self):
        for text, said in (("MESH2D\n", "no nodes"), ("MESH2D\nND 1 0 0 0\n", "no triangles"), ("ND 1 0 0 0\nE3T 1 1 2 3 1\n", "names point 2"),
                           ("ND 1 0 0\nE3T 1 1 1 1 1\n", "cut off"), ("ND 1 0 0 0\nE3T 1 1 2\n", "cut off"),
                           ("ND 1 0 0 0\nND 1 1 0 0\nE3T 1 1 1 1 1\n", "two points have the number 1"),
                           ("ND 1 0 0 0\nE4Q 1 1 1 1 1 1\n", "quad: 1")):
            self.refused("m.2dm", text, said)

    def test_msh(self):
        """All versions, in text and binary: the ids, materials and markers of Gmsh."""
        points = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [2, 0.5, 0]], float)
        cells = [("line", numpy.array([[0, 1], [1, 4]])), ("triangle", numpy.array([[0, 1, 2], [1, 3, 2]])), ("triangle", numpy.array([[1, 4, 3]]))]
        groups = [numpy.array([77, 77]), numpy.array([5, 5]), numpy.array([6])]
        for version, binary in itertools.product(("2.2", "4.0", "4.1"), (False, True)):
            with self.subTest(version=version, binary=binary):
                # in version 4, meshio writes groups and cells of several kinds only with the entities of a file that it has read
                several = version == "2.2"
                mesh = meshio.Mesh(points, cells if several else [("triangle", numpy.concatenate([triangles for _, triangles in cells[1:]]))], point_data={"h": points[:, 0] + 0.5},
                                   cell_data={"gmsh:physical": groups, "gmsh:geometrical": groups} if several else {})
                meshio.gmsh.write(self.at / "m.msh", mesh, version, binary=binary)
                found = self.read(self.at / "m.msh")
                self.assert_mesh(found, points[:, :2], [[0, 1, 2], [1, 3, 2], [1, 4, 3]])
                self.assertEqual(found.ids.tolist(), [1, 2, 3, 4, 5])
                self.assertEqual((found.names, found.values[0].tolist()), (["h"], (points[:, 0] + 0.5).tolist()))
                if several:
                    self.assertEqual((found.labels[0].tolist(), found.facets.tolist(), found.markers.tolist()), ([5, 5, 6], [[0, 1], [1, 4]], [77, 77]))
                whole = (self.at / "m.msh").read_bytes()
                for size in range(0, len(whole) - 160, 97):
                    self.refused("cut.msh", whole[:size], "")

    def test_msh_of_gmsh(self):
        """Groups by way of entities, sparse and unordered tags of nodes, places on a curve."""
        text = ("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 1 2 0\n1 0 0 0 1 0 0 1 77 0\n1 0 0 0 1 1 0 1 -5 1 1\n2 0 0 0 1 1 0 0 1 1\n$EndEntities\n"
                "$Nodes\n2 4 10 40\n1 1 1 2\n20\n10\n1 0 0 0.5\n0 0 0 0.25\n2 1 0 2\n40\n30\n1 1 0\n0 1 0\n$EndNodes\n"
                "$Elements\n3 3 1 3\n1 1 1 1\n1 10 20\n2 1 2 1\n2 10 20 30\n2 2 2 1\n3 20 40 30\n$EndElements\n")
        found = self.read(self.file("g.msh", text))
        self.assertEqual(found.ids.tolist(), [20, 10, 40, 30])
        self.assert_mesh(found, [[1, 0], [0, 0], [1, 1], [0, 1]], [[1, 0, 3], [0, 2, 3]])
        self.assertEqual((found.labels[0].tolist(), found.facets.tolist(), found.markers.tolist()), ([5, 0], [[0, 1]], [77]))
        self.assertEqual(found.notes, [])
        found = self.read(self.file("g.msh", text.replace("1 -5 1 1", "2 -5 9 1 1")))
        self.assertEqual(([values.tolist() for values in found.labels], found.label_names, found.notes), ([[5, 0], [9, 0]], ["material", "material_2"], []))
        for old, new, said in (("2 10 20 30", "2 10 20 50", "names point 50"), ("3 3 1 3", "3 4 1 3", "says that it has 4 elements"),
                               ("2 4 10 40", "2 5 10 40", "says that it has 5 nodes"),
                               ("2 2 2 1\n3", "2 2 9 1\n3", "more numbers|ends before"),
                               ("4.1 0", "3 0", "version 3"), ("20\n10\n", "20\n20\n", "two points have the number 20")):
            self.refused("g.msh", text.replace(old, new, 1), said)
        nodes = "".join(f"{n} {n % 3} {n // 3} 0\n" for n in range(6))
        second = f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n{nodes}$EndNodes\n$Elements\n1\n1 9 2 1 1 0 1 2 3 4 5\n$EndElements\n"
        found = self.read(self.file("g.msh", second))
        self.assertEqual((found.simplices.tolist(), found.notes), ([[0, 1, 2]], ["only the corners are taken of cells of higher order: triangle6",
                                                                                 "left out: 3 points of no triangle"]))
        for tag in ("1.5", "nan", "1e0"):
            self.refused("g.msh", second.replace("\n1 1 0 0\n", f"\n{tag} 1 0 0\n"), f"line 7: {tag} is not a whole number")
        great = second.replace("\n4 1 1 0\n5 2", "\n9007199254740992 1 1 0\n9007199254740993 2").replace(" 4 5\n", " 9007199254740992 9007199254740993\n")
        self.assertEqual(self.read(self.file("g.msh", great)).ids.tolist(), [0, 1, 2, 3, 9007199254740992, 9007199254740993])

    def test_xml_of_fenics(self):
        """Its suffix is that of LandXML, too."""
        meshio.write(self.at / "f.xml", meshio.Mesh(numpy.eye(4, 3), [("tetra", numpy.array([[0, 1, 2, 3]]))]), "dolfin-xml")
        self.assertEqual(self.read(self.at / "f.xml").simplices.tolist(), [[0, 1, 2, 3]])

    def test_of_meshio_counts(self):
        """Formats that meshio reads are compared with their own counts."""
        mesh = meshio.Mesh(numpy.eye(4, 3), [("tetra", numpy.array([[0, 1, 2, 3]]))])
        for suffix in ".mesh", ".vtk":
            meshio.write(self.at / f"c{suffix}", mesh)
            self.assertEqual(self.read(self.at / f"c{suffix}").simplices.tolist(), [[0, 1, 2, 3]])
        text = "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\nTetrahedra\n1\n1 2 3 4 0\nEnd\n"
        self.assertEqual(len(self.read(self.file("t.mesh", text)).simplices), 1)
        with self.assertRaises(Exception):
            self.read(self.file("t.mesh", text.replace("Tetrahedra\n1", "Tetrahedra\n2")))

    def test_damaged(self):
        """Files of which a part is lost, twice there or replaced: an error that says what is wrong, never another exception."""
        random = numpy.random.default_rng(11)
        words = [b"x", b"-1", b"99999999999", b"1e400", b"", b"0", b"1_0", b"nan"]
        seeds = {"d.ply": PLY.encode(), "d.vtu": vtu_of(piece_of(1, ((0, 0), (4, 0), (0, 3)), 0)).replace("><", ">\n<").encode(), "d.meshb": self.meshb(2, "<"),
                 "d.mesh": b"MeshVersionFormatted 2\nDimension 2\nVertices\n3\n0 0 0\n1 0 0\n0 1 0\nTriangles\n1\n1 2 3 5\nEnd\n",
                 "d.obj": b"v 0 0 0\nv 4 0 0\nv 0 3 0\nvt 0 0\nf -3/1/1 -2/1 -1//1\n", "d.off": b"OFF\n3 1 0\n0 0 0\n4 0 0\n0 3 0\n3 0 1 2\n",
                 "d.2dm": b"MESH2D\nE3T 1 1 2 3 1\nND 1 0 0 0\nND 2 4 0 0\nND 3 0 3 0\n", "d.node": b"3 2 1 1\n1 0 0 5 1\n2 4 0 5 0\n3 0 3 5 1\n",
                 "d.msh": b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 0\n1 0 0 0 1 1 0 1 5 0\n$EndEntities\n$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n"
                          b"0 0 0\n1 0 0\n0 1 0\n$EndNodes\n$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n"}
        self.file("d.ele", "1 3 1\n1 1 2 3 7\n")
        refused = 0
        for name, whole in seeds.items():
            self.read(self.file(name, whole))
            for n in range(150):
                parts = whole.split((b" ", b"\n")[n % 2])
                at, kind = random.integers(len(parts)), random.integers(4)
                parts[at: at + (kind > 0)] = [parts[random.integers(len(parts))], b"", words[random.integers(len(words))], parts[at][: len(parts[at]) // 2]][kind: kind + 1]
                damaged = (b" ", b"\n")[n % 2].join(parts) if n % 5 else whole[: random.integers(1, len(whole))]
                try:
                    self.read(self.file(name, damaged))
                except Failed as error:
                    refused += 1
                    self.assertTrue(str(error))
        self.assertGreater(refused, 500)

    def test_names(self):
        """An attribute z beside z gets a _; a name that is too long is cut; ids that are not all different are said to be."""
        piece = piece_of(1, ((0, 0), (4, 0), (0, 3)), 0).replace("4 0 0", "4 0 2").replace('Name="h"', 'Name="z"')
        self.assertEqual(self.read(self.file("z.vtu", vtu_of(piece))).names, ["z", "z_"])
        found = self.read(self.file("z.vtu", vtu_of(piece.replace('Name="z"', f'Name="{"ä" * 40}"'))))
        self.assertEqual((found.names, len(found.notes)), (["z", "ä" * 30], 1))
        found = self.read(self.file("z.vtu", vtu_of(piece.replace('Name="z"', 'Name="id"'))))
        self.assertEqual(found.ids.tolist(), [0, 1, 2])
        self.assertTrue(any("at several places" in note for note in found.notes))

    def test_apart(self):
        """What is read in a process of its own comes whole; a reader that never ends, takes all memory or crashes ends with an error."""
        path = self.file("a.ply", PLY)
        grid = apart.read(path, keep_apart=False)
        self.assertEqual((grid.cells["triangle"].tolist(), grid.notes), (CELLS, ["left out: face texcoord, edge vertex1"]))
        with self.assertRaisesRegex(Failed, "No such file"):
            apart.read(path + "x", keep_apart=False)
        with self.assertRaisesRegex(Failed, "is not a file"):
            apart.read(str(self.at), keep_apart=False)
        reader = self.at / "reader"
        reader.mkdir()
        self.addCleanup(sys.path.remove, str(reader))
        sys.path.insert(0, str(reader))  # a harmful library named meshio
        began = time.monotonic()
        for does, said in (("while True: pass", "not read within"), ("bytearray(1 << 50)", "more memory"), ("import os; os.abort()", "status -6"),
                           ("raise SystemExit(1)", "is not a file that meshio can read"), ("1 / 0", "cannot be read: division by zero")):
            (reader / "meshio.py").write_text(f"import resource\nresource.setrlimit(resource.RLIMIT_CPU, (2, 2))\ndef read(path):\n    {does}\n")
            with self.assertRaisesRegex(Failed, said):
                apart.read(self.file("a.other", "nothing"), keep_apart=False)
        self.assertLess(time.monotonic() - began, 60)


if __name__ == "__main__":
    unittest.main()
