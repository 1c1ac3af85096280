"""The lines and regions that a file gives, for abacus_constrain, abacus_mark and abacus_region."""
import numpy

from .psql import Failed

HOLE = "hole"  # the region of places that are cut out of a file's domain
ROWS = ("line", "position", "place", "part", "soft", "marker")


class Plan:
    """`regions`: [name, line, x, y] of each outline (x and y are None) or seed (line is None). Arrays have a row for each corner of a line: the
    `line`'s number, the `position` of the corner, its `place` among the points, its `part` (-1: none), whether it is `soft`, and the `marker` of
    the segment that begins there (0: none)."""

    def __init__(self, regions=()):
        self.regions = list(regions)
        self.line, self.position, self.place, self.part, self.soft, self.marker = (numpy.empty(0, numpy.int64) for _ in ROWS)

    def arrays(self):
        return {name: getattr(self, name) for name in ROWS}

    def take(self, rows):
        """Rows as tuples, in the order of ROWS."""
        table = numpy.array(rows, dtype=numpy.int64).reshape(-1, len(ROWS))
        for name, column in zip(ROWS, table.T):
            setattr(self, name, column)

    def segments(self):
        """The rows at which a segment begins; the next one is where it ends."""
        return numpy.flatnonzero((self.line[1:] == self.line[:-1]) & (self.part[1:] == self.part[:-1]))

    def check(self, points):
        """A reader is not believed here, either."""
        if len(self.place) and (self.place.min() < 0 or self.place.max() >= len(points)):
            raise Failed("a line names a point that is not there")
        if (numpy.abs(self.marker) >= 1 << 31).any():
            raise Failed("the marker of a segment does not fit 32 bits")
