"""LAS and LAZ: points with their classes, in blocks."""
import numpy

from . import laz, laz_chunks
from .copc import Octree
from .copc import USER as COPC, INFO
from .decimals import Axis
from .english import counted
from .epsg import of_keys, of_wkt, unknown
from .las_header import Header
from .las_records import TYPES, USUAL, Records
from .psql import Failed

suffixes = (".las", ".laz")
types, usual, options = TYPES, USUAL, ("classes", "window", "spacing")
USER = "LASF_Projection"
KEYS, WKT = 34735, 2112


def prepare(path):
    """What is done before the process that reads the file is limited."""
    with open(path, "rb") as file:
        if Header(file).compressed:
            laz.install()


class Reader:
    """`total`: how many points are read; `srid`; `notes`."""

    def __init__(self, path, names, wanted):
        self.path, self.names, self.wanted = path, names, wanted
        self.file = open(path, "rb")
        self.header = Header(self.file)
        self.records = Records(self.header)
        self.check()
        self.axes = [Axis(scale, offset) for scale, offset in zip(self.header.scale, self.header.offset)]
        self.notes = [] if self.header.count else ["has no points"]
        if not all(axis.exact for axis in self.axes[:2]):
            self.notes.append(f"its scale ({', '.join(map(repr, self.header.scale[:2]))}) is not a short decimal, so coordinates are rounded, and a place "
                              "that another file has, too, may differ in the last digit")
        self.srid = self.find_srid()
        self.chunks = self.find_chunks() if self.header.count else []
        self.total = sum(count for _, _, count in self.chunks)
        self.bounds = self.find_bounds()
        self.withheld = self.outside = 0

    def check(self):
        for axis, scale, offset in zip("xyz", self.header.scale, self.header.offset):
            if not (numpy.isfinite(scale) and numpy.isfinite(offset) and scale != 0):
                raise Failed(f"byte 131: the scale ({scale}) or the offset ({offset}) of {axis} is not a number")
        missing = [name for name in self.names if name not in self.records.names]
        if missing:
            raise Failed(f"points of format {self.header.format} have no {missing[0]}; they have {', '.join(self.records.names)}")

    def find_bounds(self):
        """[(field, least, greatest)]: the whole numbers that the header says are in a field, to a step; those of an axis of which it says nothing are left out."""
        found = []
        for field, scale, offset, bounds in zip("XYZ", self.header.scale, self.header.offset, self.header.bounds):
            ends = sorted((end - offset) / scale for end in bounds)
            if bounds[0] <= bounds[1] and any(bounds) and numpy.isfinite(ends).all():
                found.append((field, ends[0] - 1, ends[1] + 1))
        return found

    def find_srid(self):
        header = self.header
        wkt, keys = header.record(USER, WKT), header.record(USER, KEYS)
        name = ""
        if wkt is not None and (header.wkt or keys is None):
            srid, name = of_wkt(wkt.split(b"\0", 1)[0].decode(errors="replace"))
        elif keys is not None:
            srid = of_keys(keys)
        else:
            self.notes.append("does not say its coordinate system: the mesh has no SRID unless abacus_set_srid gives it one")
            return 0
        if srid == 0:
            self.notes.append(unknown(name))
        return srid

    def find_chunks(self):
        header, (window, spacing) = self.header, (self.wanted["window"], self.wanted["spacing"])
        if not header.compressed:
            if spacing is not None:
                raise Failed("is not a COPC file: --spacing needs the octree that such a file has")
            return [[header.begin, header.count * header.length, header.count]]
        laz_chunks.way_of(header)
        if spacing is not None or window is not None and (COPC, INFO) in header.records:
            return Octree(header).chunks(window, spacing)
        return laz_chunks.chunks(header)

    def data(self, size):
        """The bytes of records, so many at once."""
        header = self.header
        if header.compressed:
            yield from laz.blocks(self.path, header, self.chunks, size)
            return
        self.file.seek(header.begin)
        for begin in range(0, header.count, size):
            yield self.file.read(min(size, header.count - begin) * header.length)

    def blocks(self, size):
        """(how many points were read, x, y, and values of the attributes) of those that are wanted."""
        for data in self.data(size):
            found = numpy.frombuffer(data, self.records.dtype)
            read, kept = len(found), ~self.records.withheld(found)
            outside = numpy.zeros(read, bool)
            for field, least, greatest in self.bounds:
                outside |= (found[field] < least) | (found[field] > greatest)
            self.outside += int(outside.sum())
            self.withheld += read - int(kept.sum())
            if self.wanted["classes"]:
                kept &= numpy.isin(self.records.classes(found), self.wanted["classes"])
            found = found if kept.all() else found[kept]
            x, y = (axis.values(found[name]) for axis, name in zip(self.axes, "XY"))
            if self.wanted["window"] is not None:
                x1, y1, x2, y2 = self.wanted["window"]
                kept = (x >= x1) & (x <= x2) & (y >= y1) & (y <= y2)
                found, x, y = found[kept], x[kept], y[kept]
            yield read, x, y, [self.axes[2].values(found["Z"]) if name == "z" else self.records.values(name, found) for name in self.names]
        if self.outside:
            self.notes.append(f"has {counted(self.outside, 'point')} outside of the bounds in its header; the file may be damaged")
        if self.withheld:
            self.notes.append(f"left out: {counted(self.withheld, 'point')} marked as withheld")
