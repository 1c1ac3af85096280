"""A place inside each piece of a region: of what fixed edges leave connected."""
from fractions import Fraction

import numpy

from .arrays import table_of
from .psql import Failed, literal


def inside(corners):
    """The centre of a triangle as it is rounded, if that is inside; else None."""
    place = (corners[0] + (corners[1] - corners[0] + corners[2] - corners[0]) / 3).tolist()
    (x, y), exact = map(Fraction, place), [tuple(map(Fraction, corner)) for corner in corners.tolist()]
    sides = [(bx - ax) * (y - ay) - (by - ay) * (x - ax) for (ax, ay), (bx, by) in zip(exact, exact[1:] + exact[:1])]
    return tuple(place) if min(sides) > 0 or max(sides) < 0 else None


def pieces(triangles, fixed):
    """The number of its piece for each triangle; `fixed`: pairs of vertices between which no piece goes on."""
    sides, of = {}, list(range(len(triangles)))

    def root(n):
        while of[n] != n:
            of[n] = of[of[n]]
            n = of[n]
        return n

    for n, (a, b, c) in enumerate(triangles):
        for side in (min(a, b), max(a, b)), (min(b, c), max(b, c)), (min(a, c), max(a, c)):
            if side not in fixed:
                of[root(sides.setdefault(side, n))] = root(n)
    return [root(n) for n in range(len(triangles))]


def seeds(mesh, region):
    """A place for each piece: the centre of its greatest triangle, or of the next one where rounding moves the centre out."""
    within = f"within => {literal(region)}"
    columns = [f"corners[{i}][{k}]" for i in (1, 2, 3) for k in (1, 2)]
    parts = [(table_of(chunk, 0, 3, "<i8"), table_of(chunk, 3, 6, "<f8")) for chunk in mesh.session.chunks(
        f"SELECT v0, v1, v2, {', '.join(columns)} FROM abacus_cells({mesh.sql}, {within})", ["int8"] * 3 + ["float8"] * 6)]
    triangles = numpy.concatenate([part for part, _ in parts]).tolist()
    corners = numpy.concatenate([part for _, part in parts]).reshape(-1, 3, 2)
    fixed = {(min(edge), max(edge)) for edge in mesh.session.all(f"SELECT v0, v1 FROM abacus_edges({mesh.sql}, fixed => true, {within})", ["int8"] * 2)}
    area = numpy.abs(numpy.linalg.det(corners[:, 1:] - corners[:, :1]))
    number, found = pieces(triangles, fixed), {}
    for n in numpy.argsort(-area, kind="stable").tolist():
        if number[n] not in found:
            place = inside(corners[n])
            if place is not None:
                found[number[n]] = place
    if len(found) < len(set(number)):
        raise Failed(f"region {region} has a piece without a place inside that doubles can hold")
    return list(found.values())
