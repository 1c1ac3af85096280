#!/bin/bash
# SciPy's interpolators have no value at some of the very points they are given.
#
# Version     SciPy 1.10.1 (Debian 12: python3-scipy 1.10.1-2)
# Behaviour   A grid of 20 x 20 points is turned, and lies where coordinates of UTM do. Every point is a
#             vertex of the triangulation, no two are the same, all have a value. LinearNDInterpolator,
#             CloughTocher2DInterpolator and griddata are NaN at some points of the border: find_simplex
#             finds them in no triangle. Near the origin, too, though for fewer points.
# Output      without a value: LinearNDInterpolator 16 of 400, near the origin 3 (amd64)
# Expected    The given value at each given point.
# Way out     Let NaN be the value of the nearest point (NearestNDInterpolator). Another origin helps,
#             but does not cure it.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack python3-scipy=1.10.1-2 python3-numpy=1:1.24.2-1+deb12u1

cat >"$tmp/given.py" <<'PYTHON'
import sys

import numpy
import scipy
from scipy.interpolate import CloughTocher2DInterpolator, LinearNDInterpolator, NearestNDInterpolator, griddata
from scipy.spatial import Delaunay

ok = scipy.__version__ == "1.10.1"
print("version:", scipy.__version__)
column, row = (a.ravel() for a in numpy.meshgrid(numpy.arange(20.0), numpy.arange(20.0)))
values = column + 2 * row
for origin in (500000, 5700000), (0, 0):
    # Turned by the angle of the triangle 3, 4, 5.
    points = numpy.c_[0.6 * column - 0.8 * row, 0.8 * column + 0.6 * row] + origin
    triangulation = Delaunay(points)
    unused = len(points) - len(numpy.unique(triangulation.simplices))
    repeated = len(points) - len(numpy.unique(points, axis=0))
    print(f"origin {origin}: {unused} points are no vertex, {repeated} are repeated")
    ok &= unused == 0 and repeated == 0
    missing = {"find_simplex": triangulation.find_simplex(points) < 0, "griddata": numpy.isnan(griddata(points, values, points))}
    for interpolator in LinearNDInterpolator, CloughTocher2DInterpolator:
        missing[interpolator.__name__] = numpy.isnan(interpolator(points, values)(points))
    for name, where in missing.items():
        print(f"  without a value: {name} {where.sum()} of {len(points)}")
        ok &= 0 < where.sum() < len(points)
    nearest = NearestNDInterpolator(points, values)(points)
    ok &= (nearest == values).all()
sys.exit(0 if ok else "CHANGED")
PYTHON
PYTHONPATH=$tmp/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$libraries /usr/bin/python3 "$tmp/given.py"
