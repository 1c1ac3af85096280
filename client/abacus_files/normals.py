"""Normals of a surface at its vertices."""
import numpy

PARTS = 1 << 40  # of a radian: sums of whole numbers do not depend on the order of triangles


def lengths(vectors):
    return numpy.sqrt((vectors * vectors).sum(axis=1))[:, None]


def directions(vectors):
    """Of length 1; 0 if there is none."""
    long = numpy.abs(vectors).max(axis=1, initial=0)[:, None]
    scaled = numpy.divide(vectors, long, out=numpy.zeros_like(vectors), where=long > 0)
    length = lengths(scaled)
    return numpy.divide(scaled, length, out=scaled, where=length > 0)


def normals(points, triangles):
    """The normal of each triangle counts by its angle at the vertex. Upwards where that gives none."""
    corners = points[triangles]
    sides = [directions(corners[:, (n + 1) % 3] - corners[:, n]) for n in range(3)]
    faces = directions(numpy.cross(sides[0], sides[1]))
    order = numpy.argsort(triangles.ravel(), kind="stable")
    weighted = numpy.empty((len(triangles), 3, 3), numpy.int64)
    for n in range(3):
        cosine = -(sides[n] * sides[n - 1]).sum(axis=1)
        weighted[:, n] = numpy.rint(faces * numpy.arccos(numpy.clip(cosine, -1, 1))[:, None] * PARTS)
    used, begins = numpy.unique(triangles.ravel()[order], return_index=True)
    sums = numpy.zeros((len(points), 3))
    sums[used] = numpy.add.reduceat(weighted.reshape(-1, 3)[order], begins, axis=0)
    found = directions(sums)
    found[(found == 0).all(axis=1)] = 0, 0, 1
    return found
