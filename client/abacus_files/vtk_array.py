"""The bytes of an array in a VTK XML file: in text, base64 or raw, compressed or not, within its element or appended."""
import base64
import re
import zlib

import numpy

from .english import counted
from .psql import Failed
from .words import Words
from .xml_lines import LINE

TYPES = {"Int8": "i1", "UInt8": "u1", "Int16": "i2", "UInt16": "u2", "Int32": "i4", "UInt32": "u4", "Int64": "i8", "UInt64": "u8",
         "Float32": "f4", "Float64": "f8"}


class Raw:
    """Bytes in turn."""

    def __init__(self, data, at):
        self.data, self.at = data, at

    def take(self, count):
        if count < 0 or count > len(self.data) - self.at:
            raise Failed("ends within an array")
        self.at += count
        return self.data[self.at - count: self.at]


class Base64:
    """The same from base64, in which the header of an array may be padded by itself."""

    def __init__(self, text, at):
        self.text, self.at, self.rest = text, at, b""

    def take(self, count):
        if count < 0:
            raise Failed("ends within an array")
        while len(self.rest) < count:
            size = max(4, -(-(count - len(self.rest)) // 3) * 4)
            piece = self.text[self.at: self.at + size]
            if len(piece) < 4:
                raise Failed("ends within an array")
            self.at += len(piece)
            self.rest += b"".join(base64.b64decode(part) for part in re.findall(b"[^=]+=*", piece))
        found, self.rest = self.rest[:count], self.rest[count:]
        return found


def no_compressor(name):
    def refuse(data, size):
        raise Failed(f"its data is compressed by {name}, which cannot be read here")
    return refuse


def lzma_bytes(data, size):
    import lzma
    return lzma.LZMADecompressor().decompress(data, size)


def lz4_bytes(data, size):
    try:
        import lz4.block
    except ImportError as error:
        raise Failed("its data is compressed by LZ4: install python3-lz4, or save it without compression") from error
    return lz4.block.decompress(data, uncompressed_size=size)


def zlib_bytes(data, size):
    return zlib.decompressobj().decompress(data, size)


COMPRESSORS = {"vtkZLibDataCompressor": zlib_bytes, "vtkLZMADataCompressor": lzma_bytes, "vtkLZ4DataCompressor": lz4_bytes}


class Arrays:
    """How the file's arrays are kept, and its appended data."""

    def __init__(self, root, appended):
        self.order = {"LittleEndian": "<", "BigEndian": ">"}.get(root.get("byte_order", "LittleEndian"))
        header = root.get("header_type", "UInt32")
        if self.order is None or header not in ("UInt32", "UInt64"):
            raise Failed("has an unknown byte order, or headers of an unknown type")
        self.header = numpy.dtype(self.order + TYPES[header])
        compressor = root.get("compressor")
        self.decompress = compressor and COMPRESSORS.get(compressor, no_compressor(compressor))
        self.appended = appended

    def numbers(self, source, count):
        return [int(n) for n in numpy.frombuffer(source.take(count * self.header.itemsize), self.header)]

    def bytes(self, source):
        if not self.decompress:
            return source.take(*self.numbers(source, 1))
        blocks, = self.numbers(source, 1)
        if blocks == 0:
            return b""
        size, last = self.numbers(source, 2)
        packed = self.numbers(source, blocks)
        sizes = [size] * (blocks - 1) + [last or size]
        found = []
        for length, wanted in zip(packed, sizes):
            block = self.decompress(source.take(length), wanted)
            if len(block) != wanted:
                raise Failed("a compressed block does not have the size that it says")
            found.append(block)
        return b"".join(found)

    def source(self, element):
        way = element.get("format", "ascii")
        if way == "binary":
            return Base64("".join((element.text or "").split()).encode(), 0)
        if way != "appended" or self.appended is None:
            raise Failed(f"has an array of the format {way}, or no appended data")
        encoding, data = self.appended
        at = int(element.get("offset", ""))
        if not 0 <= at <= len(data):
            raise Failed("an array begins after the end of the file")
        return Raw(data, at) if encoding == "raw" else Base64(data, at)

    def read(self, element, rows, columns):
        """An array of so many rows; None: as many as there are."""
        name = element.get("Name", "")
        where = f"line {element.get(LINE)}: the array {name}"
        kind = TYPES.get(element.get("type"))
        if kind is None:
            raise Failed(f"{where} has the unknown type {element.get('type')}")
        try:
            if element.get("format", "ascii") == "ascii":
                words = Words(element.text or "", comments=False, line=int(element.get(LINE)))
                count = len(words.words)
                values = (words.floats if kind[0] == "f" else words.integers)(count, name)
            else:
                values = numpy.frombuffer(self.bytes(self.source(element)), self.order + kind)
        except (ValueError, OverflowError, zlib.error, EOFError, Failed) as error:
            raise Failed(f"{where} cannot be read: {error}") from error
        if rows is not None and len(values) != rows * columns:
            raise Failed(f"{where} has {counted(len(values), 'number')}, but should have {rows} times {columns}")
        return values.astype(kind).reshape(-1, columns)
