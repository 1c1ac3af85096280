"""The sections of Gmsh's .msh, in text or binary, in turn."""
import re

import numpy

from .psql import Failed
from .words import Words, numbers


class Section:
    def whole_line(self):
        """A whole number that has a line of its own."""
        text = self.line()
        if not re.fullmatch("-?[0-9]{1,18}", text):
            self.fail(f"{text[:20]!r}, where ${self.name} should have a whole number")
        return int(text)


class TextSection(Section):
    """The numbers between $Name and $EndName. `line`: the number of the first line there."""

    def __init__(self, name, body, line):
        self.name, self.body, self.at_line, self.words = name, body, line, None

    def fail(self, said):
        if self.words is None:
            raise Failed(f"line {max(self.at_line - 1, 1)}: {said}")
        self.words.fail(said)

    def line(self):
        line, _, self.body = self.body.partition(b"\n")
        self.at_line += 1
        return line.decode(errors="replace").strip()

    def begin(self):
        if self.words is None:
            self.words = Words(self.body.decode(errors="replace"), comments=False, line=self.at_line)
        return self.words

    def numbers(self, type, count):
        words = self.begin()
        return (words.floats if type == "f8" else words.integers)(count, f"numbers of ${self.name}")

    def rows(self, count, *types):
        """A table of several types as columns."""
        words, width = self.begin(), len(types)
        begin = words.at
        taken = words.take(count * width, f"numbers of ${self.name}")
        return [numbers(taken[n::width], float if type == "f8" else int, lambda row, n=n: words.line(begin + row * width + n))
                for n, type in enumerate(types)]

    def first(self):
        """The number that begins a section of format 2, in text either way."""
        return int(self.numbers("i8", 1)[0])

    def lines_of(self, rows, width, corners):
        """Of a table that was just read, whose rows end with the corners: the line of the nth corner."""
        begin = self.words.at - rows * width + width - corners
        return lambda n: self.words.line(begin + n // corners * width + n % corners)

    def end(self):
        if self.begin().at != len(self.words.words):
            self.words.fail(f"more numbers in ${self.name} than it says", 0)


class BinarySection(Section):
    """The same from bytes; where it ends is known when it has been read."""

    def __init__(self, name, data, at, order):
        self.name, self.data, self.at, self.order = name, data, at, order

    def fail(self, said):
        raise Failed(f"byte {self.at}: {said}")

    def line(self):
        end = self.data.find(b"\n", self.at)
        if end < 0:
            self.fail(f"the file ends within ${self.name}")
        line, self.at = self.data[self.at: end], end + 1
        return line.decode(errors="replace").strip()

    def rows(self, count, *types):
        dtype = numpy.dtype([(f"f{n}", self.order + type) for n, type in enumerate(types)])
        if not 0 <= count * dtype.itemsize <= len(self.data) - self.at:
            self.fail(f"the file ends before all numbers of ${self.name} are there")
        table = numpy.frombuffer(self.data, dtype, count, self.at)
        self.at += count * dtype.itemsize
        return [table[f"f{n}"].astype("f8" if type == "f8" else "i8") for n, type in enumerate(types)]

    def numbers(self, type, count):
        return self.rows(count, type)[0]

    def first(self):
        return self.whole_line()

    def lines_of(self, rows, width, corners):
        return None


def is_of_fluent(path):
    """ANSYS Fluent has the suffix .msh too."""
    with open(path, "rb") as file:
        return file.read(64).lstrip().startswith(b"(")


class File:
    """Its format, and its sections."""

    def __init__(self, path):
        with open(path, "rb") as file:
            self.data = file.read()
        head = re.match(rb"\s*\$MeshFormat\s+([\d.]+)\s+([01])\s+(\d+)[ \t]*\r?\n", self.data)
        if not head:
            raise Failed("line 1: does not begin with $MeshFormat as Gmsh writes it")
        self.version, self.binary, size = head[1].decode(), head[2] == b"1", int(head[3])
        self.size = f"u{size}" if self.version == "4.1" else "u8"
        if self.version not in ("2", "2.0", "2.1", "2.2", "4", "4.0", "4.1") or size not in (4, 8):
            raise Failed(f"line 2: version {self.version} of Gmsh's format with numbers of {size} bytes; 2, 4.0 and 4.1 are read")
        self.at = head.end()
        self.counted = self.counted_to = 0
        if self.binary:
            one = self.data[self.at: self.at + 4]
            if one not in (b"\1\0\0\0", b"\0\0\0\1"):
                raise Failed(f"byte {self.at}: the file does not say its byte order")
            self.order = "<" if one[0] == 1 else ">"
        self.skip(b"MeshFormat")

    def line_at(self, at):
        """The line of a byte of a text; bytes come in turn."""
        self.counted += self.data.count(b"\n", self.counted_to, at)
        self.counted_to = at
        return self.counted + 1

    def where(self, at):
        return f"byte {at}" if self.binary else f"line {self.line_at(at)}"

    def skip(self, name):
        """Goes behind a section."""
        end = self.data.find(b"$End" + name, self.at)
        if end < 0:
            raise Failed(f"{self.where(len(self.data))}: the file ends within ${name.decode(errors='replace')}")
        self.at = end + 4 + len(name)

    def sections(self, wanted):
        """Those that are wanted, in turn, as (name, section); of others (name, None). What is read of one must be its whole."""
        start = re.compile(rb"\s*\$(\w+)[ \t]*\r?\n")
        while self.data[self.at: self.at + 64].strip():
            found = start.match(self.data, self.at)
            if not found:
                raise Failed(f"{self.where(self.at)}: no section, where one should begin")
            name, self.at = found[1], found.end()
            begin, text = self.at, name.decode()
            if text not in wanted:
                self.skip(name)
                yield text, None
            elif self.binary:
                section = BinarySection(text, self.data, self.at, self.order)
                yield text, section
                self.at = section.at
                self.skip(name)
            else:
                line = self.line_at(begin)
                self.skip(name)
                section = TextSection(text, self.data[begin: self.at - 4 - len(name)], line)
                yield text, section
                section.end()
