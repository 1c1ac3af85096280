#!/bin/bash
# One missing value among the points, and SciPy's cubic interpolators have no value anywhere.
#
# Version     SciPy 1.10.1 (Debian 12: python3-scipy 1.10.1-2)
# Behaviour   A value is NaN at 1 of 400 points. CloughTocher2DInterpolator, so griddata with method="cubic", is NaN
#             at every place, also at the other 399 points: it estimates the gradients of all points
#             together. map_coordinates of a grid with one NaN is NaN everywhere too with its default order 3.
#             There is no warning. LinearNDInterpolator is NaN in the triangles around the point only.
# Output      without a value at 1,000 places: CloughTocher2DInterpolator 1000, griddata 1000,
#             map_coordinates 1000, LinearNDInterpolator 16
# Expected    NaN in the neighbourhood of the point only, or an error.
# Way out     Leave out the points without a value. Of a grid, fill the gap first, and mask it afterwards.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack python3-scipy=1.10.1-2 python3-numpy=1:1.24.2-1+deb12u1

cat >"$tmp/one.py" <<'PYTHON'
import sys
import warnings

import numpy
import scipy
from scipy.interpolate import CloughTocher2DInterpolator, LinearNDInterpolator, griddata
from scipy.ndimage import map_coordinates

warnings.simplefilter("error")


def expect(what, expected, found):
    if found != expected:
        sys.exit(f"CHANGED: {what}\n  it was: {expected}\n  it is:  {found}")
    print(f"{what}: {found}")


expect("version", "1.10.1", scipy.__version__)
column, row = (a.ravel() for a in numpy.meshgrid(numpy.arange(20.0), numpy.arange(20.0), indexing="ij"))
points = numpy.c_[column, row] + numpy.random.default_rng(1).uniform(-0.2, 0.2, (400, 2))
values = points @ [2, 1]
values[210] = numpy.nan
grid = (2 * column + row).reshape(20, 20)
grid[10, 10] = numpy.nan
places = numpy.random.default_rng(2).uniform(2, 17, (1000, 2))

found = {
    "CloughTocher2DInterpolator": CloughTocher2DInterpolator(points, values)(places),
    "griddata, cubic": griddata(points, values, places, method="cubic"),
    "map_coordinates": map_coordinates(grid, places.T),
    "LinearNDInterpolator": LinearNDInterpolator(points, values)(places),
    "map_coordinates, order 1": map_coordinates(grid, places.T, order=1),
}
missing = {name: int(numpy.isnan(at).sum()) for name, at in found.items()}
for name in "CloughTocher2DInterpolator", "griddata, cubic", "map_coordinates":
    expect(f"without a value, {name}", 1000, missing[name])
for name in "LinearNDInterpolator", "map_coordinates, order 1":
    expect(f"without a value, {name}: {missing[name]}, fewer than 40", True, 0 < missing[name] < 40)
expect("at the points", 400, int(numpy.isnan(CloughTocher2DInterpolator(points, values)(points)).sum()))
rest = numpy.delete(numpy.arange(400), 210)
expect("without that point", 0, int(numpy.isnan(CloughTocher2DInterpolator(points[rest], values[rest])(places)).sum()))
PYTHON
PYTHONPATH=$tmp/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$libraries /usr/bin/python3 "$tmp/one.py"
