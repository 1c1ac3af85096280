"""The keywords of Medit's files and the numbers behind them, in text or binary."""
import struct

import numpy

from .psql import Failed
from .words import Words, numbers

MAGIC = (b"\1\0\0\0", b"\0\0\0\1")  # with which binary files begin, in either byte order
CODES = {3: "Dimension", 4: "Vertices", 5: "Edges", 6: "Triangles", 7: "Quadrilaterals", 8: "Tetrahedra", 9: "Prisms", 10: "Hexahedra", 13: "Corners",
         14: "Ridges", 15: "RequiredVertices", 16: "RequiredEdges", 17: "RequiredTriangles", 24: "TrianglesP2", 25: "EdgesP2", 30: "TetrahedraP2",
         49: "Pyramids", 50: "BoundingBox", 54: "End", 60: "Normals"}


def is_keyword(word):
    return word[0].isalpha() and word.lower() not in ("nan", "inf", "infinity")


class TextWords:
    def __init__(self, text):
        self.words = Words(text)
        self.fail = self.words.fail

    def keywords(self):
        """Those of the file in turn. The numbers of one that is not wanted are skipped."""
        begun = False
        while self.words.at < len(self.words.words):
            word, = self.words.take(1, "keywords")
            if not begun and word != "MeshVersionFormatted":
                self.words.fail("does not begin with MeshVersionFormatted")
            begun = True
            if is_keyword(word):
                yield word
            if word == "End":
                break

    line_of_point = None

    def points_begun(self, width):
        """The table that was just read is that of the points."""
        begin = self.row
        self.line_of_point = lambda n: self.words.line(begin + n * width)

    def whole(self, what):
        return self.words.whole(what)

    def table(self, what, reals, integers):
        """The count, and so many rows of numbers: an array of the reals and one of the integers."""
        count, width = self.words.whole(f"numbers of {what}"), reals + integers
        self.row = self.words.at
        taken = self.words.take(count * width, what)
        self.words.at = self.row
        values = numpy.array(taken, dtype=object).reshape(count, width)
        found = self.numbers(values[:, :reals], float, width, 0), self.numbers(values[:, reals:], int, width, reals)
        self.words.at += count * width
        if self.words.at < len(self.words.words) and not is_keyword(self.words.words[self.words.at]):
            self.words.fail(f"more numbers than {count} {what} have", 0)
        return found

    def numbers(self, part, kind, width, first):
        columns = part.shape[1]
        if columns == 0:
            return numpy.empty(part.shape)
        found = numbers(part.reshape(-1).tolist(), kind, lambda n: self.words.line(self.row + n // columns * width + first + n % columns))
        return found.reshape(part.shape)

    def corners(self, numbers, points, what, width):
        """Numbers of points, which count from 1, as places."""
        wrong = numpy.flatnonzero(((numbers < 1) | (numbers > points)).any(axis=1))
        if len(wrong):
            raise Failed(f"line {self.words.line(self.row + int(wrong[0]) * width)}: {what}: the points {numbers[wrong[0]].tolist()}, but there are "
                         f"{points} points before them, counted from 1")
        return numbers - 1


class BinaryWords:
    """Each keyword says where the next one begins. Version 1 has floats of 32 bits, 3 places of 64, 4 numbers of 64."""

    def __init__(self, data):
        self.data, self.order = data, "<" if data[0] == 1 else ">"
        self.at = 4
        self.version = self.one("i4")
        if self.version not in (1, 2, 3, 4):
            raise Failed(f"has version {self.version} of Medit's format; 1 to 4 are read")
        self.integer = "i8" if self.version == 4 else "i4"
        self.place = "i8" if self.version >= 3 else "i4"

    line_of_point = None

    def points_begun(self, width):
        pass

    def fail(self, said, back=0):
        raise Failed(f"byte {self.at}: {said}")

    def one(self, type):
        size = int(type[1])
        if self.at + size > len(self.data):
            self.fail("the file ends within a number")
        self.at += size
        return struct.unpack(self.order + ("i" if size == 4 else "q"), self.data[self.at - size: self.at])[0]

    def keywords(self):
        while self.at < len(self.data):
            code = self.one("i4")
            following = self.one(self.place)
            yield CODES.get(code, f"keyword {code}")
            if code == 54 or following == 0:
                break
            if following < self.at or following > len(self.data):
                self.fail(f"the next keyword should be at byte {following}, but the file has {len(self.data)}")
            self.at = following

    def whole(self, what):
        return self.one("i4")

    def table(self, what, reals, integers):
        count = self.one(self.integer)
        row = numpy.dtype([("reals", self.order + ("f4" if self.version == 1 else "f8"), (reals,)), ("integers", self.order + self.integer, (integers,))])
        if not 0 <= count * row.itemsize <= len(self.data) - self.at:
            self.fail(f"the file ends before all of its {count} {what} are there")
        found = numpy.frombuffer(self.data, row, count, self.at)
        self.at += count * row.itemsize
        return found["reals"].astype("f8"), found["integers"].astype("i8")

    def corners(self, numbers, points, what, width):
        wrong = (numbers < 1) | (numbers > points)
        if wrong.any():
            self.fail(f"one of the {what} names point {numbers[wrong][0]}, but there are {points}, counted from 1")
        return numbers - 1
