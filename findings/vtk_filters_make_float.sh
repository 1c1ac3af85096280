#!/bin/bash
# Some of VTK's filters make floats of double coordinates, so the points of a fine mesh fall together.
#
# Version     VTK 9.1.0 (Debian 12: python3-vtk9 9.1.0+really9.1.0+dfsg2-5+deb12u1)
# Behaviour   The points are doubles, 0.1 m apart, where coordinates of UTM lie. vtkTransformFilter, vtkContourFilter,
#             vtkFeatureEdges and vtkDecimatePro return doubles. The following return floats, whose step is
#             0.5 m in the northing there, without a warning: vtkWarpScalar, vtkExtractEdges, vtkShrinkFilter,
#             vtkReflectionFilter, vtkLinearExtrusionFilter, vtkLinearSubdivisionFilter,
#             vtkButterflySubdivisionFilter, vtkQuadricDecimation, vtkBandedPolyDataContourFilter.
# Output      1,600 points at 360 places after vtkExtractEdges,
#             6,241 points at 711 places after vtkLinearSubdivisionFilter
# Expected    Doubles, so as many places as points.
# Way out     Move the mesh to the origin before, and back at the end, in doubles. vtkWarpScalar keeps doubles after
#             SetOutputPointsPrecision(vtk.vtkAlgorithm.DOUBLE_PRECISION).
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack python3-vtk9=9.1.0+really9.1.0+dfsg2-5+deb12u1 libvtk9.1=9.1.0+really9.1.0+dfsg2-5+deb12u1 \
    python3-numpy=1:1.24.2-1+deb12u1

cat >"$tmp/floats.py" <<'PYTHON'
import sys

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy


def expect(what, expected, found):
    if found != expected:
        sys.exit(f"CHANGED: {what}\n  it was: {expected}\n  it is:  {found}")
    print(f"{what}: {found}")


def mesh(east, north, step, n=40):
    """Triangles over a grid of n x n points, whose coordinates are doubles."""
    row, column = (a.ravel() for a in numpy.mgrid[0:n, 0:n])
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(numpy.c_[east + step * column, north + step * row, 100 + 0.1 * row], deep=True))
    cells = vtk.vtkCellArray()
    for a in (k for k in range(n * (n - 1)) if k % n < n - 1):
        for triangle in (a, a + 1, a + n), (a + 1, a + n + 1, a + n):
            cells.InsertNextCell(3, triangle)
    made = vtk.vtkPolyData()
    made.SetPoints(points)
    made.SetPolys(cells)
    height = numpy_to_vtk(100 + 0.1 * row, deep=True)
    height.SetName("height")
    made.GetPointData().SetScalars(height)
    return made


def places(data):
    """How many points there are, at how many places in the plane, and their type."""
    points = vtk_to_numpy(data.GetPoints().GetData())
    return len(points), len(numpy.unique(points[:, :2], axis=0)), str(points.dtype)


def filtered(name, data):
    made = getattr(vtk, name)()
    made.SetInputData(data)
    if name == "vtkContourFilter":
        made.SetValue(0, 101.05)
    if name == "vtkBandedPolyDataContourFilter":
        made.GenerateValues(4, 100, 104)
    if name == "vtkTransformFilter":
        made.SetTransform(vtk.vtkTransform())
    if name in ("vtkDecimatePro", "vtkQuadricDecimation"):
        made.SetTargetReduction(0.5)
    made.Update()
    return made.GetOutput()


expect("version", "9.1.0", vtk.vtkVersion.GetVTKVersion())
terrain = mesh(500000, 5700000, 0.1)
expect("points, places", (1600, 1600, "float64"), places(terrain))
for name in "vtkTransformFilter", "vtkContourFilter", "vtkFeatureEdges", "vtkDecimatePro":
    expect(name, "float64", places(filtered(name, terrain))[2])
for name in (
        "vtkWarpScalar", "vtkExtractEdges", "vtkShrinkFilter", "vtkReflectionFilter", "vtkLinearExtrusionFilter",
        "vtkLinearSubdivisionFilter", "vtkButterflySubdivisionFilter", "vtkQuadricDecimation", "vtkBandedPolyDataContourFilter"):
    expect(name, "float32", places(filtered(name, terrain))[2])
for name, found, near in ("vtkExtractEdges", (1600, 360), (1600, 1600)), ("vtkLinearSubdivisionFilter", (6241, 711), (6241, 6241)):
    expect(f"points, places after {name}", found, places(filtered(name, terrain))[:2])
    expect("near the origin", near, places(filtered(name, mesh(0, 0, 0.1)))[:2])
warp = vtk.vtkWarpScalar()
warp.SetInputData(terrain)
warp.SetOutputPointsPrecision(vtk.vtkAlgorithm.DOUBLE_PRECISION)
warp.Update()
expect("vtkWarpScalar with SetOutputPointsPrecision", (1600, 1600, "float64"), places(warp.GetOutput()))
PYTHON
PYTHONPATH=$tmp/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$libraries /usr/bin/python3 "$tmp/floats.py"
