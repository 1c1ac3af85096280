#!/bin/bash
# matplotlib's interpolators fail at a triangulation that has a very flat triangle at its border, and
# its own mask of flat triangles leaves the flattest.
#
# Version     matplotlib 3.6.3 (Debian 12: python3-matplotlib 3.6.3-1+b1)
# Behaviour   The triangulations are valid: the triangles are counter-clockwise in exact arithmetic, and
#             fill the convex hull. Programs that compute exactly make such triangles, where points lie on
#             a line but for the rounding of their coordinates. Qhull, which matplotlib calls itself,
#             leaves them out.
#             Square: LinearTriInterpolator gives 0 where a vertex has 2, without an error.
#             Road: both interpolators refuse. get_flat_tri_mask(0.01) does not cure it: the circle ratio
#             of a triangle that it should mask is NaN, so it and the one behind it are not masked.
#             If the triangles come in another order, the same road may be accepted.
# Output      [ 0.  0. 20.  0.] instead of [ 0.  2. 20.  0.1]
#             RuntimeError: In initialize: Triangulation is invalid
# Expected    The value of each vertex at that vertex; a mask that has the flattest triangles.
# Way out     Mask all triangles of next to no area, by an area that you compute.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack python3-matplotlib=3.6.3-1+b1 python-matplotlib-data=3.6.3-1 python3-numpy=1:1.24.2-1+deb12u1
packages=$tmp/usr/lib/python3/dist-packages
# The package looks for its data where it would be installed.
sed -i "s:'/usr/share/matplotlib:'$tmp/usr/share/matplotlib:" "$packages/matplotlib/__init__.py"

cat >"$tmp/flat.py" <<'PYTHON'
import sys
from fractions import Fraction

import matplotlib
import numpy
from matplotlib.tri import CubicTriInterpolator, LinearTriInterpolator, TriAnalyzer, Triangulation


def area(points, triangle):
    (ax, ay), (bx, by), (cx, cy) = (map(Fraction, points[k]) for k in triangle)
    return ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2


def checked(points, triangles):
    """The triangulation, if it is valid: all in exact arithmetic."""
    edges = [(t[k], t[k - 2]) for t in triangles for k in range(3)]
    assert len(set(edges)) == len(edges)
    assert {k for t in triangles for k in t} == set(range(len(points)))
    assert all(area(points, t) > 0 for t in triangles)
    border = [e for e in edges if e[::-1] not in edges]
    assert all(area(points, (a, b, k)) >= 0 for a, b in border for k in range(len(points)))
    return Triangulation(*numpy.array(points).T, triangles)


def at_vertices(interpolator, triangulation, values):
    try:
        found = interpolator(triangulation, values)(triangulation.x, triangulation.y)
        return numpy.ma.filled(found.round(6), numpy.nan).tolist()
    except RuntimeError as error:
        return str(error)


def expect(what, expected, found):
    if str(found) != str(expected):
        sys.exit(f"CHANGED: {what}\n  it was: {expected}\n  it is:  {found}")
    print(f"{what}: {found}")


expect("version", "3.6.3", matplotlib.__version__)
invalid = "In initialize: Triangulation is invalid"

# Three corners of a square of side 2, turned by the angle of the triangle 3, 4, 5, and a point of its border.
points = [(0, 0), (1.2, 1.6), (-1.6, 1.2), (0.06, 0.08000000000000002)]
square = checked(points, [(0, 1, 3), (0, 3, 2), (1, 2, 3)])
values = numpy.array([0, 2, 20, 0.1])
expect("square, linear", [0.0, 0.0, 20.0, 0.0], at_vertices(LinearTriInterpolator, square, values))
square.set_mask([True, False, False])
expect("square, linear, flat one masked", values.tolist(), at_vertices(LinearTriInterpolator, square, values))

# A straight road, and a place beside it.
points = [(0, 0), (1, 0.1), (2, 0.2), (4, 0.4), (5, 0.5), (1, 3)]
triangles = [(0, 4, 1), (0, 1, 5), (1, 4, 2), (1, 2, 5), (2, 4, 3), (2, 3, 5), (3, 4, 5)]
flat = [area(points, t) < 1e-9 for t in triangles]
road = checked(points, triangles)
values = numpy.array([0.0, 1, 2, 4, 5, 1])
for interpolator in LinearTriInterpolator, CubicTriInterpolator:
    expect(f"road, {interpolator.__name__}", invalid, at_vertices(interpolator, road, values))
numpy.seterr(invalid="ignore")
expect("road, circle ratio is NaN", [False, True, False], numpy.isnan(TriAnalyzer(road).circle_ratios())[flat].tolist())
mask = TriAnalyzer(road).get_flat_tri_mask(0.01)
expect("road, flat triangles in the mask", [True, False, False], mask[flat].tolist())
road.set_mask(mask)
expect("road, linear, masked", invalid, at_vertices(LinearTriInterpolator, road, values))
road.set_mask(flat)
expect("road, linear, all flat ones masked", values.tolist(), at_vertices(LinearTriInterpolator, road, values))
PYTHON
PYTHONPATH=$packages LD_LIBRARY_PATH=$libraries MPLCONFIGDIR=$tmp/config /usr/bin/python3 "$tmp/flat.py"
