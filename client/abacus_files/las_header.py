"""The header of a LAS file of versions 1.0 to 1.4, and where its variable length records are."""
import os
import struct

from .psql import Failed

SIZES = {0: 227, 1: 227, 2: 227, 3: 235, 4: 375}  # of the header of version 1.n
LENGTHS = (20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67)  # of a record of each point format, without extra bytes
COMPRESSED, OLD = 0x80, 0x40  # bits of the point format
WKT = 0x10  # bit of the global encoding: the coordinate system is in WKT
RECORD, LONG_RECORD = struct.Struct("<2x16sHH32x"), struct.Struct("<2x16sHQ32x")


def text(data):
    return data.split(b"\0", 1)[0].decode(errors="replace")


class Header:
    """`format` and `length` of a record, `count` of points, `begin`: the byte of the first one, `scale`, `offset` and `bounds` (least, greatest) of each axis, `compressed`, `wkt`,
    `records`: {(user, number): (byte, length)}, `size` of the file."""

    def __init__(self, file):
        self.file = file
        self.size = os.fstat(file.fileno()).st_size
        head = file.read(max(SIZES.values()))
        if head[:4] != b"LASF":
            raise Failed("byte 0: does not begin with LASF")
        if len(head) < min(SIZES.values()):
            raise Failed(f"byte {len(head)}: the file ends within its header")
        major, self.minor = head[24:26]
        if major != 1 or self.minor not in SIZES:
            raise Failed(f"byte 24: has the version {major}.{self.minor}; known are 1.0 to 1.4")
        size, self.begin, records, format, self.length, count = struct.unpack_from("<HIIBHI", head, 94)
        if len(head) < SIZES[self.minor] or size < SIZES[self.minor] or size > self.size:
            raise Failed(f"byte 94: has a header of {size} bytes in a file of {self.size}, where version 1.{self.minor} needs {SIZES[self.minor]}")
        self.wkt = bool(head[6] & WKT)
        self.take_format(format)
        self.scale, self.offset = struct.unpack_from("<3d", head, 131), struct.unpack_from("<3d", head, 155)
        bounds = struct.unpack_from("<6d", head, 179)
        self.bounds = list(zip(bounds[1::2], bounds[::2]))
        self.take_count(head, count)
        if not size <= self.begin <= self.size:
            raise Failed(f"byte 96: its points begin at byte {self.begin}, but the header ends at {size} and the file at {self.size}")
        self.records = {}
        self.walk(size, records, RECORD, self.begin)
        if self.minor == 4:
            at, records = struct.unpack_from("<QI", head, 235)
            self.walk(at, records, LONG_RECORD, self.size)

    def take_format(self, format):
        self.compressed, self.format = bool(format & COMPRESSED), format & ~(COMPRESSED | OLD)
        if format & OLD:
            raise Failed("byte 104: is compressed in a way that only the first versions of LASzip had")
        if self.format >= len(LENGTHS):
            raise Failed(f"byte 104: has points of format {self.format}; known are 0 to {len(LENGTHS) - 1}")
        if self.length < LENGTHS[self.format]:
            raise Failed(f"byte 105: has records of {self.length} bytes, where format {self.format} needs {LENGTHS[self.format]}")

    def take_count(self, head, count):
        self.count = count
        if self.minor == 4 and (count == 0 or self.format >= 6):
            self.count, = struct.unpack_from("<Q", head, 247)
        if not self.compressed and self.begin + self.count * self.length > self.size:
            there = max(self.size - self.begin, 0) // self.length
            raise Failed(f"byte {self.size}: the file ends after {there} of {self.count} points")

    def walk(self, at, count, form, end):
        """Finds variable length records."""
        for n in range(count):
            self.file.seek(at)
            head = self.file.read(form.size)
            length = form.unpack(head)[2] if len(head) == form.size else 0
            if at + form.size + length > end:
                raise Failed(f"byte {at}: variable length record {n + 1} of {count} ends beyond byte {end}; the file is cut off or damaged")
            user, number, _ = form.unpack(head)
            self.records.setdefault((text(user), number), (at + form.size, length))
            at += form.size + length

    def record(self, user, number):
        """The bytes of a variable length record, or None."""
        if (user, number) not in self.records:
            return None
        at, length = self.records[user, number]
        self.file.seek(at)
        return self.file.read(length)
