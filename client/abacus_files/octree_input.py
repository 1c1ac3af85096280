"""A file of an octree or a quadtree that abacus-export has written, as abacus_octree_from_rows takes it."""
import numpy

from .arrays import unlike
from .psql import Failed

# {kind: (dimension, levels of the curve's grid)}
KINDS = {"quad": (2, 31), "hexahedron": (3, 21)}
LEVEL = "level"


def kind_of(grid):
    """The kind of the leaves; None if the grid is something else."""
    kinds = [kind for kind, corners in grid.cells.items() if len(corners)]
    return kinds[0] if len(kinds) == 1 and kinds[0] in KINDS and kinds[0] in grid.codes and (kinds[0], LEVEL) in grid.labels else None


def curve(places, levels, depth):
    """The codes of the leaves of these levels, whose lower corners are at so many of their own sizes."""
    codes = numpy.zeros(len(places), numpy.int64)
    for axis, steps in enumerate(places.T):
        for bit in range(depth):
            codes |= ((steps >> bit) & 1) << (bit * places.shape[1] + axis)
    return codes << (places.shape[1] * (depth - levels))


class OctreeInput:
    """`dimension`, `lower` and `upper` of the domain, `codes`, `levels`, `names` and `values` of attributes."""

    def __init__(self, grid, kind):
        self.dimension, depth = KINDS[kind]
        self.notes = list(grid.notes)
        corners = grid.points[grid.cells[kind]][:, :, : self.dimension]
        self.lower, self.upper = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
        levels = grid.labels[kind, LEVEL]
        self.levels, self.codes = levels.astype(numpy.int64), grid.codes[kind]
        if (self.levels != levels).any() or (self.levels < 0).any() or (self.levels > depth).any():
            raise Failed(f"a level is not a whole number from 0 to {depth}")
        shares = (corners.min(axis=1) - self.lower) / (self.upper - self.lower)
        places = numpy.rint(shares * (1 << self.levels)[:, None]).astype(numpy.int64)
        wrong = curve(places, self.levels, depth) != self.codes
        if wrong.any():
            n = int(numpy.flatnonzero(wrong)[0])
            raise Failed(f"cell {n}, counted from 0, has the code {self.codes[n]} and the level {self.levels[n]}, but is not there in the octree")
        of = {name: values for (part, name), values in grid.labels.items() if part == kind and name != LEVEL}
        self.names, self.values = unlike(of, ()), list(of.values())
