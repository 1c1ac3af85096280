"""The sections of Gmsh's .msh, in text or binary, in turn."""
import re

import numpy

from .psql import Failed


class TextSection:
    """The numbers between $Name and $EndName."""

    def __init__(self, body):
        self.body, self.words, self.at = body, None, 0

    def line(self):
        line, _, self.body = self.body.partition(b"\n")
        return line.decode(errors="replace").strip()

    def numbers(self, type, count):
        if self.words is None:
            self.words = self.body.split()
        if not 0 <= count <= len(self.words) - self.at:
            raise Failed("ends before all numbers of a section are there")
        self.at += count
        words = self.words[self.at - count: self.at]
        return numpy.array(list(map(float if type == "f8" else int, words)), dtype="f8" if type == "f8" else "i8")

    def rows(self, count, *types):
        """A table of several types as columns."""
        table = self.numbers("f8", count * len(types)).reshape(count, len(types))
        return [table[:, n] if type == "f8" else table[:, n].astype("i8") for n, type in enumerate(types)]

    def first(self):
        """The number that begins a section of format 2, in text either way."""
        return int(self.numbers("i8", 1)[0])


class BinarySection:
    """The same from bytes; where it ends is known when it has been read."""

    def __init__(self, data, at, order):
        self.data, self.at, self.order = data, at, order

    def line(self):
        end = self.data.find(b"\n", self.at)
        if end < 0:
            raise Failed("ends within a section")
        line, self.at = self.data[self.at: end], end + 1
        return line.decode(errors="replace").strip()

    def rows(self, count, *types):
        dtype = numpy.dtype([(f"f{n}", self.order + type) for n, type in enumerate(types)])
        if not 0 <= count * dtype.itemsize <= len(self.data) - self.at:
            raise Failed("ends before all numbers of a section are there")
        table = numpy.frombuffer(self.data, dtype, count, self.at)
        self.at += count * dtype.itemsize
        return [table[f"f{n}"].astype("f8" if type == "f8" else "i8") for n, type in enumerate(types)]

    def numbers(self, type, count):
        return self.rows(count, type)[0]

    def first(self):
        return int(self.line())


def is_of_gmsh(path):
    """Other programs have the suffix .msh too."""
    with open(path, "rb") as file:
        return file.read(64).lstrip().startswith(b"$MeshFormat")


class File:
    """Its format, and its sections."""

    def __init__(self, path):
        with open(path, "rb") as file:
            self.data = file.read()
        head = re.match(rb"\s*\$MeshFormat\s+([\d.]+)\s+([01])\s+(\d+)[ \t]*\r?\n", self.data)
        if not head:
            raise Failed("its first section is not as Gmsh writes it")
        self.version, self.binary, size = head[1].decode(), head[2] == b"1", int(head[3])
        self.size = f"u{size}" if self.version == "4.1" else "u8"
        if self.version not in ("2", "2.0", "2.1", "2.2", "4", "4.0", "4.1") or size not in (4, 8):
            raise Failed(f"has version {self.version} of Gmsh's format; 2, 4.0 and 4.1 are read")
        self.at = head.end()
        if self.binary:
            one = self.data[self.at: self.at + 4]
            if one not in (b"\1\0\0\0", b"\0\0\0\1"):
                raise Failed("does not say its byte order")
            self.order = "<" if one[0] == 1 else ">"
        self.skip(b"MeshFormat")

    def skip(self, name):
        """Goes behind a section."""
        end = self.data.find(b"$End" + name, self.at)
        if end < 0:
            raise Failed(f"ends within ${name.decode(errors='replace')}")
        self.at = end + 4 + len(name)

    def sections(self, wanted):
        """Those that are wanted, in turn: (name, section). What is read of one must be its whole."""
        start = re.compile(rb"\s*\$(\w+)[ \t]*\r?\n")
        while self.data[self.at: self.at + 64].strip():
            found = start.match(self.data, self.at)
            if not found:
                raise Failed(f"has no section where one should begin, at byte {self.at}")
            name, self.at = found[1], found.end()
            if name.decode() in wanted:
                if self.binary:
                    section = BinarySection(self.data, self.at, self.order)
                    yield name.decode(), section
                    self.at = section.at
                else:
                    body = self.at
                    self.skip(name)
                    section = TextSection(self.data[body: self.at - 4 - len(name)])
                    yield name.decode(), section
                    if section.at != len(section.words or ()):
                        raise Failed(f"has more numbers in ${name.decode()} than it says")
                    continue
            self.skip(name)
