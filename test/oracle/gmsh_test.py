"""Files that Gmsh writes, as abacus-import takes them and as Gmsh's own reader does: value by value, without a database."""
import pathlib
import sys
import tempfile
import unittest

import gmsh
import numpy

import abacus

sys.path.insert(0, str(abacus.REPOSITORY / "client"))
from abacus_files import input, read  # noqa: E402

TETRA, TRIANGLE, LINE = 4, 2, 1
CORNERS = {TETRA: 4, TRIANGLE: 3, LINE: 2, 11: 4, 9: 3, 8: 2}
PLAIN = {11: TETRA, 9: TRIANGLE, 8: LINE}


def of_gmsh(dimension):
    """{corners of an element, by tags: the physical groups of its entity} as Gmsh has them."""
    found = {}
    for of, entity in gmsh.model.getEntities(dimension):
        groups = sorted(map(abs, gmsh.model.getPhysicalGroupsForEntity(of, entity).tolist()))
        for kind, nodes in zip(*gmsh.model.mesh.getElements(of, entity)[::2]):
            count = gmsh.model.mesh.getElementProperties(kind)[3]
            for row in numpy.asarray(nodes, dtype=int).reshape(-1, count)[:, : CORNERS[kind]].tolist():
                found[tuple(sorted(row))] = groups
    return found


def corners_at(places):
    return tuple(sorted(map(tuple, numpy.round(places, 9).tolist())))


class Gmsh(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = pathlib.Path(cls.folder.name)
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)

    @classmethod
    def tearDownClass(cls):
        gmsh.finalize()
        cls.folder.cleanup()

    def setUp(self):
        gmsh.clear()

    def two_squares(self):
        """Two squares side by side: one group on the left, several on the right; an edge that goes the other way round; an edge in no group."""
        geo = gmsh.model.geo
        points = [geo.addPoint(x, y, 0, 0.4) for x, y in ((0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1))]
        lines = [geo.addLine(points[n], points[(n + 1) % 6]) for n in range(6)] + [geo.addLine(points[1], points[4])]
        left = geo.addPlaneSurface([geo.addCurveLoop([lines[0], lines[6], lines[4], lines[5]])])
        right = geo.addPlaneSurface([geo.addCurveLoop([lines[1], lines[2], lines[3], -lines[6]])])
        geo.synchronize()
        gmsh.model.addPhysicalGroup(2, [left], 5)
        gmsh.model.addPhysicalGroup(2, [right], 6)
        gmsh.model.addPhysicalGroup(1, [lines[0], -lines[2]], 77)
        gmsh.model.addPhysicalGroup(1, [lines[6]], 78)
        gmsh.model.setPhysicalName(2, 5, "clay \"wet\"")
        gmsh.model.setPhysicalName(1, 77, "inflow")
        gmsh.model.mesh.generate(2)
        return left, right

    def box(self, order=1):
        """A cube, of which two sides are marked; the volume is in two groups."""
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.CharacteristicLengthMin", 0.5)
        gmsh.option.setNumber("Mesh.CharacteristicLengthMax", 0.5)
        gmsh.model.addPhysicalGroup(3, [1], 3)
        gmsh.model.addPhysicalGroup(3, [1], 4)
        gmsh.model.addPhysicalGroup(2, [1, 2], 11)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(order)

    def compare(self, path, dimension):
        """A file as it is taken against the model that Gmsh has read from it."""
        gmsh.clear()
        gmsh.open(str(path))
        grid = read.read_here(str(path), False)
        grid.check()
        found = input.Input(grid)
        tags, places, _ = gmsh.model.mesh.getNodes()
        order = numpy.argsort(tags)
        wanted = dict(zip(tags[order].tolist(), places.reshape(-1, 3)[order].tolist()))
        self.assertEqual({id_: place for id_, place in zip(found.ids.tolist(), grid.points.tolist())}, wanted)
        cells, facets = of_gmsh(dimension), of_gmsh(dimension - 1)
        have = {tuple(sorted(found.ids[row].tolist())): sorted(int(values[n]) for values in found.labels if values[n])
                for n, row in enumerate(found.simplices)}
        self.assertEqual(have, cells)
        marked = {tuple(sorted(found.ids[row].tolist())): marker for row, marker in zip(found.facets, found.markers.tolist())}
        self.assertEqual(marked, {corners: groups[0] for corners, groups in facets.items() if groups})
        return found

    def test_plane(self):
        for version, binary in ((2.2, 0), (2.2, 1), (4.0, 0), (4.1, 0), (4.1, 1)):  # Gmsh writes 4.0 in text only
            with self.subTest(version=version, binary=binary):
                gmsh.clear()
                self.two_squares()
                gmsh.option.setNumber("Mesh.MshFileVersion", version)
                gmsh.option.setNumber("Mesh.Binary", binary)
                gmsh.option.setNumber("Mesh.SaveAll", int(version > 2.2))  # with it, 2.2 has no groups
                gmsh.write(str(self.at / "p.msh"))
                found = self.compare(self.at / "p.msh", 2)
                self.assertEqual(sorted(map(tuple, found.groups)), [(1, 77, "inflow"), (2, 5, "clay \"wet\"")])
                self.assertEqual(sorted(set(found.markers.tolist())), [77, 78])

    def test_space(self):
        for version, order in (2.2, 1), (2.2, 2), (4.1, 1), (4.1, 2):
            with self.subTest(version=version, order=order):
                gmsh.clear()
                self.box(order)
                gmsh.option.setNumber("Mesh.MshFileVersion", version)
                gmsh.option.setNumber("Mesh.SaveAll", 0)
                gmsh.option.setNumber("Mesh.Binary", 0)
                gmsh.write(str(self.at / "s.msh"))
                found = self.compare(self.at / "s.msh", 3)
                self.assertEqual([set(values.tolist()) for values in found.labels], [{3}, {4}])
                self.assertEqual(any("higher order: " in note for note in found.notes), order == 2)

    def test_partitioned(self):
        for version, binary in ((2.2, 0), (2.2, 1), (4.0, 0), (4.1, 0), (4.1, 1)):  # Gmsh writes 4.0 in text only
            with self.subTest(version=version, binary=binary):
                gmsh.clear()
                left, right = self.two_squares()
                wanted = self.placed(2)
                gmsh.option.setNumber("Mesh.MshFileVersion", version)
                gmsh.option.setNumber("Mesh.Binary", binary)
                gmsh.option.setNumber("Mesh.SaveAll", int(version > 2.2))  # with it, 2.2 has no groups
                gmsh.option.setNumber("Mesh.PartitionCreateGhostCells", 1)
                gmsh.model.mesh.partition(3)
                gmsh.write(str(self.at / "parts.msh"))
                grid = read.read_here(str(self.at / "parts.msh"), False)
                grid.check()
                found = input.Input(grid)
                have = {corners_at(grid.points[row]): [int(found.labels[0][n])] for n, row in enumerate(found.simplices)}  # 2.2 has other tags
                self.assertEqual(have, wanted)
                self.assertEqual(set(found.markers.tolist()), {77, 78})

    def test_data(self):
        """Views of nodes and of elements: scalars and vectors."""
        self.two_squares()
        gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
        gmsh.option.setNumber("Mesh.Binary", 0)
        tags, places, _ = gmsh.model.mesh.getNodes()
        places = places.reshape(-1, 3)
        elements = numpy.concatenate(gmsh.model.mesh.getElements(2)[1])
        gmsh.option.setNumber("PostProcessing.SaveMesh", 0)
        at = self.at / "d.msh"
        gmsh.write(str(at))
        for name, kind, of, values in (("h", "NodeData", tags, places[:, :1] + 0.1), ("wind", "NodeData", tags, places * 2),
                                       ("porosity", "ElementData", elements, elements[:, None] / 7.0)):
            view = gmsh.view.add(name)
            gmsh.view.addModelData(view, 0, gmsh.model.getCurrent(), kind, of, values.tolist())
            gmsh.view.write(view, str(at), True)
        grid = read.read_here(str(at), False)
        grid.check()
        found = input.Input(grid)
        self.assertEqual(found.names, ["h", "wind_x", "wind_y", "wind_z"])
        order = numpy.searchsorted(numpy.sort(tags), found.ids)
        sorted_places = places[numpy.argsort(tags)][order]
        for have, wanted in zip(found.values, (sorted_places[:, 0] + 0.1, *(sorted_places * 2).T)):
            numpy.testing.assert_allclose(have, wanted, rtol=1e-15)
        self.assertEqual(found.label_names, ["material", "porosity"])
        numpy.testing.assert_allclose(sorted(found.labels[1]), sorted(elements / 7.0), rtol=1e-15)

    def test_medit(self):
        """Gmsh's entities are Medit's references."""
        for make, dimension in (self.two_squares, 2), (self.box, 3):
            gmsh.clear()
            make()
            gmsh.option.setNumber("Mesh.SaveAll", 1)
            gmsh.write(str(self.at / "m.mesh"))
            wanted = [set(self.placed(of)) for of in (dimension, dimension - 1)]
            grid = read.read_here(str(self.at / "m.mesh"), False)
            grid.check()
            found = input.Input(grid)
            self.assertEqual({corners_at(grid.points[row]) for row in found.simplices}, wanted[0])
            self.assertEqual({corners_at(grid.points[row]) for row in found.facets}, wanted[1])
            self.assertEqual(found.ids.tolist(), list(range(1, len(grid.points) + 1)))
            self.assertEqual(found.label_names, ["material"])

    def placed(self, dimension):
        """What of_gmsh() returns, by places in place of tags."""
        tags, places, _ = gmsh.model.mesh.getNodes()
        at = dict(zip(tags.tolist(), places.reshape(-1, 3).tolist()))
        return {corners_at([at[tag] for tag in corners]): groups for corners, groups in of_gmsh(dimension).items()}


if __name__ == "__main__":
    unittest.main()
