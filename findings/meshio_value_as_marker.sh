#!/bin/bash
# The first values at points that meshio writes for TetGen become boundary markers, and lose what is behind the point.
#
# Version     meshio 5.0.0 (Debian 12: python3-meshio 7.0.0-3), TetGen 1.5.0 (tetgen 1.5.0-5)
# Behaviour   A .node file has attributes, which are numbers, and one marker, which is an integer and says on what part of the border a
#             point lies. If no values are named tetgen:ref, meshio writes the first ones, such as heights, as the
#             marker, without a warning. TetGen cuts them to integers, and boundary conditions follow them.
# Output      "5 3 0 1", no attribute and a marker, and 10 from TetGen for a height of 10.5
# Expected    "5 3 1 0", an attribute, as for the further values
# Way out     Add integers called tetgen:ref to the values at points.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack python3-meshio=7.0.0-3 python3-numpy=1:1.24.2-1+deb12u1 tetgen=1.5.0-5

cat >"$tmp/write.py" <<'PYTHON'
import os
import sys

import meshio
import numpy

os.chdir(sys.argv[1])
points = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1.0]])
cells = [("tetra", numpy.array([[0, 1, 2, 3], [1, 2, 3, 4]]))]
heights = {"height": numpy.array([10.5, 20.5, 30.5, 40.5, 50.5])}
salt = {"salt": numpy.array([1.25, 2.25, 3.25, 4.25, 5.25])}
markers = {"tetgen:ref": numpy.array([1, 1, 1, 1, 1])}
for name, data in (("one", heights), ("two", heights | salt), ("marked", markers | heights)):
    meshio.write(f"{name}.node", meshio.Mesh(points, cells, point_data=data))
print(meshio.__version__)
PYTHON
export LD_LIBRARY_PATH=$libraries
expect "version" 5.0.0 "$(PYTHONPATH=$tmp/usr/lib/python3/dist-packages /usr/bin/python3 "$tmp/write.py" "$tmp" 2>"$tmp/warnings")"

# line FILE NUMBER: of those that are no comments, with a blank between words, and without needless zeros.
line() {
    grep -v '^#' "$tmp/$1" | sed -n "$2p" | xargs printf '%g '
}

expect "warnings" "" "$(cat "$tmp/warnings")"
expect "heights, head of the file" "5 3 0 1 " "$(line one.node 1)"
expect "heights, first point" "0 0 0 0 10.5 " "$(line one.node 2)"
"$tmp/usr/bin/tetgen" -rQ "$tmp/one" >"$tmp/said"
expect "heights, by TetGen" "0 0 0 0 10 " "$(line one.1.node 2)"
expect "heights and salt" "5 3 1 1 0 0 0 0 1.25 10.5 " "$(line two.node 1)$(line two.node 2)"
expect "markers and heights" "5 3 1 1 0 0 0 0 10.5 1 " "$(line marked.node 1)$(line marked.node 2)"
