#!/bin/bash
# gmsh.model.mesh.triangulate and tetrahedralize leave out simplices at the convex hull of the points.
#
# Version     Gmsh 4.8.4 (Debian 12: python3-gmsh 4.8.4+ds2-3, libgmsh4.8 4.8.4+ds2-3)
# Behaviour   Both functions take points and return Delaunay simplices. What they return is Delaunay, and every
#             point is a vertex. But simplices at the hull are missing, without an error: in the plane
#             about 1 % of the triangles of 1,000 random points, in space 4 %. The number of points does not
#             matter: four points are enough, of which the fourth lies a little inside of an edge.
# Output      four points: 2 triangles of 3, area 38.5 of 40
#             1,000 random points: area 0.9650 of 0.9792; volume 0.8966 of 0.9325
# Expected    The triangulation of the convex hull.
# Way out     Add four points far outside (in space eight), and drop the simplices that use them.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack python3-gmsh=4.8.4+ds2-3 libgmsh4.8=4.8.4+ds2-3 python3-scipy=1.10.1-2 python3-numpy=1:1.24.2-1+deb12u1

cat >"$tmp/hull.py" <<'PYTHON'
import itertools
import sys

import gmsh
import numpy
from scipy.spatial import ConvexHull, Delaunay


def expect(what, expected, found):
    if found != expected:
        sys.exit(f"CHANGED: {what}\n  it was: {expected}\n  it is:  {found}")
    print(f"{what}: {found}")


def simplices(points):
    """What Gmsh returns for these points, as rows of their numbers from 0."""
    call = gmsh.model.mesh.triangulate if points.shape[1] == 2 else gmsh.model.mesh.tetrahedralize
    return numpy.array(call(points.ravel()), dtype=int).reshape(-1, points.shape[1] + 1) - 1


def measure(points, found):
    """Area or volume."""
    sides = points[found[:, 1:]] - points[found[:, :1]]
    return abs(numpy.linalg.det(sides)).sum() / (2 if points.shape[1] == 2 else 6)


def as_set(found):
    return {frozenset(s) for s in found.tolist()}


gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
expect("version", "4.8.4", gmsh.option.getString("General.Version").split("-")[0])

points = numpy.array([(0, 0), (10, 0), (5, 8), (5, 0.3)])
found = simplices(points)
expect("four points, triangles of Gmsh", [[0, 2, 3], [1, 2, 3]], sorted(sorted(t) for t in found.tolist()))
expect("area", ("38.5", "40.0"), (f"{measure(points, found):.1f}", f"{ConvexHull(points).volume:.1f}"))

for dimension, areas in (2, ("0.9650", "0.9792")), (3, ("0.8966", "0.9325")):
    points = numpy.random.default_rng(3).uniform(0, 1, (1000, dimension))
    found, whole = simplices(points), Delaunay(points).simplices
    expect(f"{dimension}D, measure", areas, (f"{measure(points, found):.4f}", f"{ConvexHull(points).volume:.4f}"))
    expect("points that no simplex has", 0, len(points) - len(numpy.unique(found)))
    expect("simplices that are not Delaunay", 0, len(as_set(found) - as_set(whole)))
    missing = as_set(whole) - as_set(found)
    print(f"missing: {len(missing)} of {len(whole)}")
    far = numpy.array(list(itertools.product((-1000, 1000), repeat=dimension)))
    wider = simplices(numpy.vstack([points, far]))
    wider = wider[(wider < len(points)).all(axis=1)]
    expect("simplices that are missing with points far outside", 0, len(as_set(whole) - as_set(wider)))
PYTHON
PYTHONPATH=$tmp/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$libraries /usr/bin/python3 "$tmp/hull.py"
