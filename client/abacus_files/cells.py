"""Centres of the cells of a raster, as points with heights."""
import numpy

from .decimals import Axis
from .english import counted
from .psql import Failed

types, usual = {"z": "float8"}, ("z",)
BEYOND = 3.4e38  # as large as this is a missing value in 32 bits, whatever the file says


def check(names):
    if list(names) != list(usual):
        raise Failed("cells of a raster have no attribute but z")


class Cells:
    """`x`, `y`: the corner of the first cell, `width` and `height`: the steps to the next column and row, which may be negative. `missing` counts cells without
    data, `wrong` those without a finite number."""

    def __init__(self, x, y, width, height, window):
        self.window = window
        self.x, self.y = Axis(width / 2, x), Axis(height / 2, y)
        self.missing = self.wrong = 0

    def row(self, values, valid, row, column=0):
        """(x, y, [z]) of cells of one row, from a column on."""
        x, y = self.x.values(2 * numpy.arange(column, column + len(values)) + 1), self.y.values(2 * row + 1)
        inside = numpy.ones(len(values), bool)
        if self.window is not None:
            x1, y1, x2, y2 = self.window
            inside = (x >= x1) & (x <= x2) & (y1 <= y <= y2)
        finite = numpy.isfinite(values) & (numpy.abs(values) < BEYOND)
        self.missing += int((inside & ~valid).sum())
        self.wrong += int((inside & valid & ~finite).sum())
        kept = inside & valid & finite
        return x[kept], numpy.full(int(kept.sum()), y), [values[kept]]

    def notes(self):
        return [f"left out: {counted(count, 'cell')} without {what}" for count, what in ((self.missing, "data"), (self.wrong, "a finite height")) if count]


def joined(rows, size):
    """(cells read, x, y, [z]) of several rows at once, from (cells read, (x, y, [z])) of each."""
    read, held, count = 0, [], 0
    for cells, row in rows:
        if count + len(row[0]) > size:
            yield together(read, held)
            read, held, count = 0, [], 0
        held.append(row)
        read, count = read + cells, count + len(row[0])
    if held:
        yield together(read, held)


def together(read, rows):
    x, y, z = zip(*((x, y, z) for x, y, (z,) in rows))
    return read, numpy.concatenate(x), numpy.concatenate(y), [numpy.concatenate(z)]
