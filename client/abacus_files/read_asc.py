"""ASCII grids of ESRI: cells as text, row by row from the north. The coordinate system may be in a .prj beside it."""
import pathlib


from . import cells
from .epsg import of_wkt, unknown
from .psql import Failed
from .words import numbers

suffixes = (".asc",)
types, usual, options = cells.types, cells.usual, ("window",)
CORNERS, CENTRES = ("xllcorner", "yllcorner"), ("xllcenter", "yllcenter")
SIZES = ("cellsize", "dx", "dy")
NODATA = "nodata_value"
KNOWN = ("ncols", "nrows", *CORNERS, *CENTRES, *SIZES, NODATA)
USUAL_NODATA = -9999.0  # of a file that does not say so
LONGEST = 1 << 26  # bytes of a line


def prepare(path):
    pass


class Reader:
    """`total`: cells; `srid`; `notes`."""

    def __init__(self, path, names, wanted):
        cells.check(names)
        self.file = open(path, "rb")
        self.line, self.notes, self.said = 0, [], {}
        self.rest = self.header()
        self.columns, self.rows = self.whole("ncols"), self.whole("nrows")
        self.total = self.columns * self.rows
        self.no_data = self.said.get(NODATA, USUAL_NODATA)
        left, bottom, width, height = self.place()
        self.cells = cells.Cells(left, bottom, width, height, wanted["window"])  # the file has its rows from the north, but their numbers count from the south
        self.srid = self.find_srid(pathlib.Path(path).with_suffix(".prj"))

    def fail(self, said):
        raise Failed(f"line {self.line}: {said}")

    def words(self):
        """Those of the next line that has some; none at the end."""
        while True:
            line = self.file.readline(LONGEST)
            self.line += 1
            if len(line) == LONGEST:
                self.fail(f"is longer than {LONGEST} bytes")
            found = line.decode(errors="replace").split()
            if found or not line:
                return found

    def header(self):
        """Takes it; returns the words of the first line behind it."""
        while True:
            words = self.words()
            if not words or words[0].lower() not in KNOWN:
                return words
            key = words[0].lower()
            if len(words) != 2 or key in self.said:
                self.fail(f"{words[0]} should have one number, and come once")
            self.said[key] = float(numbers(words[1:], float, lambda _: self.line)[0])

    def whole(self, key):
        value = self.said.get(key)
        if value is None or not 1 <= value < 1 << 40 or value != int(value):
            self.fail(f"the header does not say {key}, or not as a whole number from 1 on")
        return int(value)

    def place(self):
        sizes = [self.said.get(key, self.said.get("cellsize", 0)) for key in ("dx", "dy")]
        if not all(0 < size < cells.BEYOND for size in sizes):
            self.fail("the header does not say the size of a cell (cellsize), or it is not above 0")
        found = []
        for corner, centre, size in zip(CORNERS, CENTRES, sizes):
            if (corner in self.said) == (centre in self.said):
                self.fail(f"the header should have {corner} or {centre}")
            at = self.said[corner] if corner in self.said else self.said[centre] - size / 2
            if not abs(at) < cells.BEYOND:
                self.fail(f"{corner} is not finite")
            found.append(at)
        return (*found, *sizes)

    def find_srid(self, beside):
        if not beside.is_file():
            self.notes.append("does not say its coordinate system: the mesh has no SRID unless abacus_set_srid gives it one")
            return 0
        srid, name = of_wkt(beside.read_text(errors="replace"))
        if srid == 0:
            self.notes.append(unknown(name))
        return srid

    def values(self):
        """Heights of some cells, in the order of the file, not beyond a row."""
        left, words = self.total, self.rest
        while left:
            if not words:
                self.fail(f"the file ends after {self.total - left} of {self.total} cells")
            if len(words) > left:
                self.fail(f"the file has more than {self.total} cells, which is {self.rows} rows of {self.columns}")
            found = numbers(words, float, lambda _: self.line)
            while len(found):
                count = min(len(found), self.columns - (self.total - left) % self.columns)
                yield found[:count]
                found, left = found[count:], left - count
            words = self.words()
        if words:
            self.fail(f"the file has more than {self.total} cells, which is {self.rows} rows of {self.columns}")

    def blocks(self, size):
        yield from cells.joined(self.parts(size), size)
        if NODATA not in self.said and self.cells.missing:
            self.notes.append(f"does not say NODATA_value: {USUAL_NODATA:g} is none")
        self.notes += self.cells.notes()

    def parts(self, size):
        at = 0
        for values in self.values():
            row, column = divmod(at, self.columns)
            for begin in range(0, len(values), size):
                part = values[begin: begin + size]
                yield len(part), self.cells.row(part, part != self.no_data, self.rows - 1 - row, column + begin)
            at += len(values)
