"""Isosurfaces and sections, compared with VTK's contour filter and cutter on the same tetrahedra."""
import unittest

import numpy
import vtkmodules.all as vtk
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

from abacus import numbers, rows, simplices, triangulate, vector


def grid(points, tetrahedra, **arrays):
    """An unstructured grid of VTK's; the first array is the one that is contoured."""
    grid = vtk.vtkUnstructuredGrid()
    places = vtk.vtkPoints()
    places.SetDataTypeToDouble()
    places.SetData(numpy_to_vtk(points, deep=True))
    grid.SetPoints(places)
    cells = vtk.vtkCellArray()
    cells.SetCells(len(tetrahedra), numpy_to_vtkIdTypeArray(numpy.column_stack([numpy.full(len(tetrahedra), 4), tetrahedra]).ravel().astype(numpy.int64), deep=True))
    grid.SetCells(vtk.VTK_TETRA, cells)
    for name, values in arrays.items():
        array = numpy_to_vtk(values, deep=True)
        array.SetName(name)
        grid.GetPointData().AddArray(array)
    grid.GetPointData().SetActiveScalars(next(iter(arrays)))
    return grid


def polygons_of(filter):
    """The points of the output, its polygons, and its point data by name."""
    filter.SetOutputPointsPrecision(vtk.vtkAlgorithm.DOUBLE_PRECISION)
    filter.Update()
    output = filter.GetOutput()
    data = output.GetPointData()
    values = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    flat = vtk_to_numpy(output.GetPolys().GetData())
    polygons, at = [], 0
    while at < len(flat):
        polygons.append(flat[at + 1:at + 1 + flat[at]])
        at += 1 + flat[at]
    return vtk_to_numpy(output.GetPoints().GetData()), polygons, values


def canonical(places, digits=9):
    """Polygons as a sorted list: each from its least corner on, so that what is turned differs."""
    result = []
    for polygon in places:
        rounded = [tuple(numpy.round(p, digits) + 0.0) for p in polygon]
        least = min(range(len(rounded)), key=rounded.__getitem__)
        result.append(tuple(rounded[least:] + rounded[:least]))
    return sorted(result)


def areas(triangles):
    return numpy.linalg.norm(numpy.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1) / 2


class Surface(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        random = numpy.random.default_rng(3)
        cls.points = random.uniform(-1, 1, (8000, 3))
        cls.radius = numpy.linalg.norm(cls.points, axis=1)
        cls.height = cls.points @ [1, 2, 4]
        triangulate("oracle_solid", cls.points, radius=cls.radius, height=cls.height)
        cls.grid = grid(cls.points, simplices("oracle_solid", 4), radius=cls.radius, height=cls.height)

    def surface(self, value, rest=""):
        found = rows(f"SELECT v0, v1, v2, corners, \"values\" FROM abacus_isosurface('oracle_solid', {value}, 'radius', 'height'{rest})")
        numbers = numpy.array([[int(n) for n in row[:3]] for row in found])
        corners = numpy.array([vector(row[3], 3) for row in found])
        values = numpy.array([vector(row[4]) for row in found])
        return numbers, corners, values

    def test_an_isosurface_is_vtks(self):
        contour = vtk.vtkContourFilter()
        contour.SetInputData(self.grid)
        contour.ComputeNormalsOff()
        contour.GenerateTrianglesOn()
        for value in (0.35, 0.7, 1.1):
            contour.SetValue(0, value)
            places, polygons, data = polygons_of(contour)
            numbers, corners, values = self.surface(value)
            self.assertEqual(len(polygons), len(numbers))
            # The same corners, each with its values.
            distinct, first = numpy.unique(numbers, return_index=True)
            ours = numpy.column_stack([corners.reshape(-1, 3)[first], values.ravel()[first]])
            theirs = numpy.column_stack([places, data["height"]])
            self.assertEqual(len(ours), len(theirs))
            ours, theirs = (a[numpy.lexsort(numpy.round(a[:, :3], 7).T)] for a in (ours, theirs))
            self.assertLess(numpy.abs(ours - theirs).max(), 1e-7)
            # The same area in the same direction; a quadrilateral may be divided the other way.
            triangles = numpy.array([places[p] for p in polygons])
            self.assertAlmostEqual(areas(corners).sum(), areas(triangles).sum(), delta=2e-2 * areas(triangles).sum())
            alike = len(set(canonical(corners, 7)) & set(canonical(triangles, 7)))
            self.assertGreater(alike, 0.3 * len(triangles))

    def test_a_sphere_is_closed_and_converges(self):
        numbers, corners, _ = self.surface(0.7)
        self.assertEqual(sorted(set(numbers.ravel())), list(range(numbers.max() + 1)))
        sides = {(a, b) for t in numbers for a, b in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))}
        self.assertEqual(len(sides), 3 * len(numbers))
        self.assertEqual(sides, {(b, a) for a, b in sides})
        self.assertEqual(numbers.max() + 1 - len(sides) // 2 + len(numbers), 2)
        places = {}
        for number, place in zip(numbers.ravel(), corners.reshape(-1, 3)):
            self.assertEqual(places.setdefault(number, tuple(place)), tuple(place))
        self.assertAlmostEqual(areas(corners).sum(), 4 * numpy.pi * 0.49, delta=0.06 * 4 * numpy.pi * 0.49)

    def test_a_section_is_vtks_cut(self):
        plane, cutter = vtk.vtkPlane(), vtk.vtkCutter()
        cutter.SetInputData(self.grid)
        cutter.SetCutFunction(plane)
        cutter.GenerateTrianglesOff()
        for through, normal in (((0, 0, 0.1), (0, 0, 1)), ((0.2, 0.1, 0), (1, -2, 0.5)), ((5, 0, 0), (0, -3, 0))):
            plane.SetOrigin(*through)
            plane.SetNormal(*normal)
            places, polygons, data = polygons_of(cutter)
            found = rows(f"SELECT polygon, \"values\" FROM abacus_section('oracle_solid', '{{{','.join(map(str, through))}}}', '{{{','.join(map(str, normal))}}}', 'height')")
            ours = [vector(row[0], 3) for row in found]
            self.assertEqual(len(ours), len(polygons))
            # VTK's polygons may turn either way, and begin anywhere.
            unordered = lambda all: sorted(tuple(sorted(tuple(numpy.round(p, 8) + 0.0) for p in polygon)) for polygon in all)
            theirs = unordered([places[p] for p in polygons])
            for a, b in zip(unordered(ours), theirs):
                self.assertLess(numpy.abs(numpy.array(a) - numpy.array(b)).max(), 1e-7)
            for polygon, row in zip(ours, found):
                self.assertLess(numpy.abs(vector(row[1]) - polygon @ [1, 2, 4]).max(), 1e-12)
                turn = numpy.cross(polygon[1] - polygon[0], polygon[2] - polygon[0])
                self.assertGreaterEqual(turn @ normal, -1e-12)

    def test_through_vertices_a_section_is_all_of_the_square(self):
        lattice = numpy.stack(numpy.meshgrid(*[numpy.arange(6.0)] * 3), axis=-1).reshape(-1, 3)
        triangulate("oracle_lattice", lattice)
        for z in (0, 2, 5):
            for up in (1, -1):
                area = numbers(f"""SELECT count(*), sum(abs((polygon[4]-polygon[1])*(polygon[8]-polygon[2]) - (polygon[7]-polygon[1])*(polygon[5]-polygon[2])) / 2)
                                   FROM abacus_section('oracle_lattice', '{{0,0,{z}}}', '{{0,0,{up}}}')""")[0]
                self.assertEqual(tuple(area), (50, 25))


if __name__ == "__main__":
    unittest.main()
