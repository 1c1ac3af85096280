#!/bin/bash
# meshio writes a file .msh in the format of ANSYS Fluent, not of Gmsh, and drops the data of the mesh.
#
# Version     meshio 5.0.0 (Debian 12: python3-meshio 7.0.0-3, which calls itself 5.0.0)
# Behaviour   mesh.write("a.msh") takes the first format that has this suffix, which is ansys. That has
#             neither values of points nor of cells; they are gone without a warning. meshio reads the
#             file again, since it then tries both formats, so a round trip hides which one was written.
# Output      (1 "meshio 5.0.0")
# Expected    $MeshFormat, the first line of a file of Gmsh, which names its own files so; or a warning
#             that data are lost.
# Way out     mesh.write("a.msh", file_format="gmsh") or "gmsh22".
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack python3-meshio=7.0.0-3 python3-numpy=1:1.24.2-1+deb12u1

cat >"$tmp/suffix.py" <<'PYTHON'
import os
import sys
import warnings

import meshio
import numpy

warnings.simplefilter("error")
os.chdir(sys.argv[1])


def written(**options):
    """The first line of the file, and the names of the values that are read from it again."""
    mesh = meshio.Mesh(
        numpy.array([[0.0, 0, 1], [1, 0, 2], [0, 1, 3]]), [("triangle", numpy.array([[0, 1, 2]]))],
        point_data={"height": numpy.array([1.0, 2, 3])}, cell_data={"mark": [numpy.array([7])]})
    mesh.write("a.msh", **options)
    with open("a.msh", "rb") as file:
        line = file.readline().decode().strip()
    mesh = meshio.read("a.msh")
    return line, len(mesh.points), sorted([*mesh.point_data, *(n for n in mesh.cell_data if ":" not in n)])


def expect(what, expected, found):
    if found != expected:
        sys.exit(f"CHANGED: {what}\n  it was: {expected}\n  it is:  {found}")
    print(f"{what}: {found}")


expect("by the suffix", ('(1 "meshio 5.0.0")', 3, []), written())
expect("by name", ("$MeshFormat", 3, ["height", "mark"]), written(file_format="gmsh22"))
PYTHON
PYTHONPATH=$tmp/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$libraries /usr/bin/python3 "$tmp/suffix.py" "$tmp" 2>"$tmp/warnings"
expect "messages" "" "$(grep -v 'Appending zeros' "$tmp/warnings" | grep -v '^ *$' || true)"
