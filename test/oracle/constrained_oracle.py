"""CGAL's constrained Delaunay triangulation, as oracle_constrained prints it."""
import os
import pathlib
import subprocess

import numpy

import abacus

ORACLE = pathlib.Path(os.environ.get("ABACUS_BUILD", abacus.REPOSITORY / "build")) / "release/test/oracle/oracle_constrained"


def theirs(points, segments, sides=()):
    """CGAL's triangles and constrained edges, in canonical order, by indices of points; and rows of triangles within regions, whose `sides` are
    rows of the region's number and two indices."""
    sides = numpy.array(sides, dtype="<i8").reshape(-1, 3)
    counts = numpy.array([len(points), len(segments), len(sides)], "<i8")
    done = subprocess.run([ORACLE], input=counts.tobytes() + points.astype("<f8").tobytes() + segments.astype("<i8").tobytes() + sides.tobytes(),
                          capture_output=True, check=False)
    if done.returncode != 0:
        raise AssertionError(done.stderr.decode())
    words = numpy.frombuffer(done.stdout, "<i8")
    triangles, edges, inside = numpy.split(words[3:], numpy.cumsum([3 * words[0], 2 * words[1]]))
    return triangles.reshape(-1, 3), edges.reshape(-1, 2), inside.reshape(-1, 4)


def canonical(triangles):
    """The least corner first, in ascending order, orientation kept."""
    first = triangles.argmin(axis=1)[:, None]
    rotated = numpy.take_along_axis(triangles, (first + numpy.arange(3)) % 3, axis=1)
    return rotated[numpy.lexsort(rotated.T[::-1])]
