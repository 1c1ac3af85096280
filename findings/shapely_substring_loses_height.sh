#!/bin/bash
# Shapely's substring() of a line drops the heights.
#
# Version     Shapely 1.8.5 (Debian 12: python3-shapely 1.8.5-2+b1)
# Behaviour   The part of a line with Z that substring() returns is two-dimensional; so are both points that
#             nearest_points() returns, even where one is a vertex. There is no warning. interpolate() and
#             split() of the same line interpolate Z.
# Output      LINESTRING (1 0, 3 0)
# Expected    LINESTRING Z (1 0 3.5, 3 0 6.5)
# Way out     Give the ends their Z by line.interpolate(distance), or split the line.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack python3-shapely=1.8.5-2+b1 python3-numpy=1:1.24.2-1+deb12u1

cat >"$tmp/substring.py" <<'PYTHON'
import sys
import warnings

import shapely
from shapely.geometry import LineString, Point
from shapely.ops import nearest_points, split, substring

warnings.filterwarnings("error", module="shapely")


def expect(what, expected, found):
    if found != expected:
        sys.exit(f"CHANGED: {what}\n  it was: {expected}\n  it is:  {found}")
    print(f"{what}: {found}")


expect("version", "1.8.5", shapely.__version__)
line = LineString([(0, 0, 2), (4, 0, 8)])
expect("substring", "LINESTRING (1 0, 3 0)", substring(line, 1, 3).wkt)
expect("substring from the first to the last vertex", "LINESTRING (0 0, 4 0)", substring(line, 0, 4).wkt)
expect("nearest_points", ["POINT (0 0)", "POINT (-1 0)"], [p.wkt for p in nearest_points(line, Point(-1, 0, 50))])
expect("interpolate", ["POINT Z (1 0 3.5)", "POINT Z (3 0 6.5)"], [line.interpolate(d).wkt for d in (1, 3)])
parts = split(line, LineString([(1, -1), (1, 1)])).geoms
expect("split", ["LINESTRING Z (0 0 2, 1 0 3.5)", "LINESTRING Z (1 0 3.5, 4 0 8)"], [p.wkt for p in parts])
PYTHON
PYTHONPATH=$tmp/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$libraries /usr/bin/python3 "$tmp/substring.py"
