#!/bin/bash
# Beside a missing value, SciPy's linear interpolation has no value at nodes that do have one.
#
# Version     SciPy 1.10.1 (Debian 12: python3-scipy 1.10.1-2)
# Behaviour   In a grid of 20 x 20 one value is NaN. RegularGridInterpolator, asked for the nodes themselves, is NaN
#             at that node and at three others, whose values are given; map_coordinates with order=1 at the same
#             four. The missing neighbour has the weight 0 there, and 0 * NaN is NaN. Only the nodes just
#             before it on the axes lose their value, those after it do not.
# Output      [(9, 9), (9, 10), (10, 9), (10, 10)]
# Expected    [(10, 10)]: elsewhere the value of the node.
# Way out     Interpolate twice: the values with 0 for NaN, and weights that are 0 there and 1 elsewhere. Where the
#             second result is 1, the first is the value.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack python3-scipy=1.10.1-2 python3-numpy=1:1.24.2-1+deb12u1

cat >"$tmp/beside.py" <<'PYTHON'
import sys

import numpy
import scipy
from scipy.interpolate import RegularGridInterpolator
from scipy.ndimage import map_coordinates


def expect(what, expected, found):
    if found != expected:
        sys.exit(f"CHANGED: {what}\n  it was: {expected}\n  it is:  {found}")
    print(f"{what}: {found}")


def nodes(where):
    return [tuple(n) for n in numpy.argwhere(where).tolist()]


expect("version", "1.10.1", scipy.__version__)
axis = numpy.arange(20.0)
column, row = numpy.meshgrid(axis, axis, indexing="ij")
grid = 2 * column + row
grid[10, 10] = numpy.nan
at = numpy.stack([column, row], axis=-1)
four = [(9, 9), (9, 10), (10, 9), (10, 10)]
expect("missing", [(10, 10)], nodes(numpy.isnan(grid)))
expect("RegularGridInterpolator", four, nodes(numpy.isnan(RegularGridInterpolator((axis, axis), grid)(at))))
expect("map_coordinates", four, nodes(numpy.isnan(map_coordinates(grid, [column, row], order=1))))
expect("nearest", [(10, 10)], nodes(numpy.isnan(RegularGridInterpolator((axis, axis), grid, method="nearest")(at))))

there = ~numpy.isnan(grid)
value, weight = (RegularGridInterpolator((axis, axis), v)(at) for v in (numpy.where(there, grid, 0), there.astype(float)))
expect("with weights", [(10, 10)], nodes(weight < 1))
expect("the values with weights are the given ones", True, bool((value[there] == grid[there]).all()))
PYTHON
PYTHONPATH=$tmp/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$libraries /usr/bin/python3 "$tmp/beside.py"
