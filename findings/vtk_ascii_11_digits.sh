#!/bin/bash
# VTK's legacy files in ASCII have 11 digits of a double, in a field that says double.
#
# Version     VTK 9.1.0 (Debian 12: python3-vtk9 9.1.0+really9.1.0+dfsg2-5+deb12u1)
# Behaviour   vtkPolyDataWriter writes "POINTS 1 double", and then 11 significant digits. ASCII is its default. At
#             coordinates of UTM a point moves by up to 0.05 mm, so the same point in a binary file is another
#             place. The writer has no setting for the digits.
# Output      5700000.1235 instead of 5700000.123456789
# Expected    17 digits, which a double needs; the XML writer in ASCII keeps all doubles.
# Way out     SetFileTypeToBinary(), or the XML formats.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack python3-vtk9=9.1.0+really9.1.0+dfsg2-5+deb12u1 libvtk9.1=9.1.0+really9.1.0+dfsg2-5+deb12u1 \
    python3-numpy=1:1.24.2-1+deb12u1

cat >"$tmp/digits.py" <<'PYTHON'
import os
import sys

import vtk


def expect(what, expected, found):
    if found != expected:
        sys.exit(f"CHANGED: {what}\n  it was: {expected}\n  it is:  {found}")
    print(f"{what}: {found}")


os.chdir(sys.argv[1])
expect("version", "9.1.0", vtk.vtkVersion.GetVTKVersion())
place = (500000.123456789, 5700000.123456789, 100.123456789)
points = vtk.vtkPoints()
points.SetDataTypeToDouble()
points.InsertNextPoint(place)
mesh = vtk.vtkPolyData()
mesh.SetPoints(points)


def again(writer, reader, change=lambda writer: None):
    writer.SetFileName("points")
    writer.SetInputData(mesh)
    change(writer)
    writer.Write()
    reader.SetFileName("points")
    reader.Update()
    return reader.GetOutput().GetPoint(0)


expect("legacy", (500000.12346, 5700000.1235, 100.12345679), again(vtk.vtkPolyDataWriter(), vtk.vtkPolyDataReader()))
with open("points", encoding="ascii") as file:
    expect("in the file", ["POINTS 1 double", "500000.12346 5700000.1235 100.12345679"], [line.strip() for line in file][4:6])
expect("legacy, binary", place, again(vtk.vtkPolyDataWriter(), vtk.vtkPolyDataReader(), lambda w: w.SetFileTypeToBinary()))
expect("XML, ASCII", place, again(vtk.vtkXMLPolyDataWriter(), vtk.vtkXMLPolyDataReader(), lambda w: w.SetDataModeToAscii()))
PYTHON
PYTHONPATH=$tmp/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$libraries /usr/bin/python3 "$tmp/digits.py" "$tmp"
