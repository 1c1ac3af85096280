#!/bin/bash
# VTK cannot read the NaN that it writes into its legacy files in ASCII; the other arrays are lost, too.
#
# Version     VTK 9.1.0 (Debian 12: python3-vtk9 9.1.0+really9.1.0+dfsg2-5+deb12u1)
# Behaviour   The writer writes a NaN as "nan". The reader stops there and takes the rest for the names of other arrays: the values from the
#             NaN on are never set, and all arrays after it are lost. It complains on the error stream; nothing is raised, and GetErrorCode()
#             is 0. ASCII is the writer's default, and a NaN is what many filters give where there is no value.
# Output      arrays "depth", with a number in place of the NaN, and "nan", of "depth" and "salt"
# Expected    both, as from binary files and from XML in ASCII
# Way out     SetFileTypeToBinary(), or the XML formats.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack python3-vtk9=9.1.0+really9.1.0+dfsg2-5+deb12u1 libvtk9.1=9.1.0+really9.1.0+dfsg2-5+deb12u1 \
    python3-numpy=1:1.24.2-1+deb12u1

cat >"$tmp/nan.py" <<'PYTHON'
import math
import os
import sys

import vtk


def expect(what, expected, found):
    if str(found) != expected:
        sys.exit(f"CHANGED: {what}\n  it was: {expected}\n  it is:  {found}")
    print(f"{what}: {found}")


def array(name, values):
    made = vtk.vtkDoubleArray()
    made.SetName(name)
    for value in values:
        made.InsertNextValue(value)
    return made


def again(writer, reader, change=lambda writer: None):
    writer.SetFileName("mesh")
    writer.SetInputData(mesh)
    change(writer)
    writer.Write()
    reader.SetFileName("mesh")
    if hasattr(reader, "ReadAllScalarsOn"):
        reader.ReadAllScalarsOn()
    reader.Update()
    read = reader.GetOutput()
    data = read.GetPointData()
    arrays = [data.GetArray(i) for i in range(data.GetNumberOfArrays())]
    return (reader.GetErrorCode(), read.GetNumberOfPoints(), read.GetNumberOfCells(),
            {a.GetName(): [a.GetValue(i) for i in range(a.GetNumberOfTuples())] for a in arrays})


os.chdir(sys.argv[1])
vtk.vtkObject.GlobalWarningDisplayOff()
expect("version", "9.1.0", vtk.vtkVersion.GetVTKVersion())
points = vtk.vtkPoints()
for x, y in ((0, 0), (1, 0), (0, 1)):
    points.InsertNextPoint(x, y, 0)
triangle = vtk.vtkTriangle()
for i in range(3):
    triangle.GetPointIds().SetId(i, i)
mesh = vtk.vtkUnstructuredGrid()
mesh.SetPoints(points)
mesh.InsertNextCell(triangle.GetCellType(), triangle.GetPointIds())
mesh.GetPointData().AddArray(array("depth", (1, math.nan, 3)))
mesh.GetPointData().AddArray(array("salt", (10, 20, 30)))

both = "(0, 3, 1, {'depth': [1.0, nan, 3.0], 'salt': [10.0, 20.0, 30.0]})"
error, _, cells, arrays = again(vtk.vtkUnstructuredGridWriter(), vtk.vtkUnstructuredGridReader())
expect("legacy, ASCII", "0 1 ['depth', 'nan'] 1.0", f"{error} {cells} {list(arrays)} {arrays['depth'][0]}")
expect("legacy, binary", both, again(vtk.vtkUnstructuredGridWriter(), vtk.vtkUnstructuredGridReader(), lambda w: w.SetFileTypeToBinary()))
expect("XML, ASCII", both, again(vtk.vtkXMLUnstructuredGridWriter(), vtk.vtkXMLUnstructuredGridReader(), lambda w: w.SetDataModeToAscii()))
PYTHON
PYTHONPATH=$tmp/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$libraries /usr/bin/python3 "$tmp/nan.py" "$tmp"
