#!/bin/bash
# Triangles that VTK 9 writes in a legacy file are others in vtk.js and three.js.
#
# Version     @kitware/vtk.js 37.4.3, three 0.187.0 (npm); VTK 9.1.0 (Debian 12: python3-vtk9 9.1.0+really9.1.0+dfsg2-5+deb12u1)
# Behaviour   Since VTK 9 legacy files have the version 5.1, where a section POLYGONS keeps the offsets of cells and their vertices apart. Both
#             readers skip the version and read the section as that of version 3 or 4: all places, but nonsense for
#             triangles, with no error. ASCII is the writer's default. (three warns that its loader will be removed.)
# Output      of (0 1 3) (4 3 1) (1 2 4) (5 4 2), in three.js: (4 2 0) (4 0 0) (4 0 0); in vtk.js: polygons of no vertex and of 3, one of which would be vertex 9 of 6
# Expected    the four triangles, or an error
# Way out     SetFileVersion(42), which writes version 4.2; or XML formats.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

command -v npm >/dev/null || exit 77
unpack python3-vtk9=9.1.0+really9.1.0+dfsg2-5+deb12u1 libvtk9.1=9.1.0+really9.1.0+dfsg2-5+deb12u1 \
    python3-numpy=1:1.24.2-1+deb12u1
npm install --silent --no-audit --no-fund --prefix "$tmp" @kitware/vtk.js@37.4.3 three@0.187.0 >&2 || exit 77

cat >"$tmp/write.py" <<'PYTHON'
import sys

import vtk

plane = vtk.vtkPlaneSource()
plane.SetResolution(2, 1)
triangles = vtk.vtkTriangleFilter()
triangles.SetInputConnection(plane.GetOutputPort())
writer = vtk.vtkPolyDataWriter()
writer.SetInputConnection(triangles.GetOutputPort())
writer.SetFileName(sys.argv[1])
if len(sys.argv) > 2:
    writer.SetFileVersion(int(sys.argv[2]))
writer.Write()
PYTHON
write() {
    PYTHONPATH=$tmp/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$libraries /usr/bin/python3 "$tmp/write.py" "$tmp/mesh.vtk" "$@"
}

cat >"$tmp/read.mjs" <<'JAVASCRIPT'
import { readFileSync } from "node:fs";
import reader from "@kitware/vtk.js/IO/Legacy/PolyDataReader.js";
import { VTKLoader } from "three/addons/loaders/VTKLoader.js";

const bytes = readFileSync(process.argv[2]), legacy = reader.newInstance();
legacy.parseAsText(bytes.toString());
const mesh = legacy.getOutputData();
console.log("vtk.js:", mesh.getPoints().getNumberOfPoints(), "points,", mesh.getPolys().getData().join(" "));
const { attributes, index } = new VTKLoader().parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
console.log("three:", attributes.position.count, "points,", index.array.join(" "));
JAVASCRIPT

write
expect "version of the file" "# vtk DataFile Version 5.1" "$(head -n 1 "$tmp/mesh.vtk")"
expect "its cells" "POLYGONS 5 12 OFFSETS vtktypeint64 0 3 6 9 12 CONNECTIVITY vtktypeint64 0 1 3 4 3 1 1 2 4 5 4 2" \
    "$(sed -n '/^POLYGONS/,/^POINT_DATA/{/^POINT_DATA/!p}' "$tmp/mesh.vtk" | xargs)"
expect "as they are read" "vtk.js: 6 points, 0 0 0 3 6 9 12 0 0 0 1 3
three: 6 points, 4 2 0 4 0 0 4 0 0" "$(node "$tmp/read.mjs" "$tmp/mesh.vtk" 2>"$tmp/warnings")"
write 42
expect "from version 4.2" "vtk.js: 6 points, 3 0 1 3 3 4 3 1 3 1 2 4 3 5 4 2
three: 6 points, 0 1 3 4 3 1 1 2 4 5 4 2" "$(node "$tmp/read.mjs" "$tmp/mesh.vtk" 2>"$tmp/warnings")"
