"""The numbers of a DataItem of XDMF: in text, in a binary file or in HDF5."""
import math
import os

import numpy

from .psql import Failed
from .words import Words
from .xml_lines import LINE

TYPES = {"float": "f", "int": "i", "uint": "u", "char": "i", "uchar": "u", "short": "i", "ushort": "u"}
SIZES = {"char": 1, "uchar": 1, "short": 2, "ushort": 2}


class Data:
    """The file's DataItems. HDF5 files are opened once, and closed at the end."""

    def __init__(self, path, root):
        self.folder, self.root, self.open = os.path.dirname(os.path.abspath(path)), root, {}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for file in self.open.values():
            file.close()

    def read(self, item):
        where = f"line {item.get(LINE)}"
        way = item.get("Format", "XML").upper()
        if item.get("ItemType", "Uniform") != "Uniform" or item.get("Reference") is not None:
            raise Failed(f"{where}: a DataItem that is made of others is not read")
        try:
            shape = [int(word) for word in item.get("Dimensions", "").split()]
            name = item.get("DataType", item.get("NumberType", "Float")).lower()
            type_ = numpy.dtype(f"{TYPES[name]}{SIZES.get(name) or int(item.get('Precision', '4'))}")
        except (ValueError, KeyError, TypeError) as error:
            raise Failed(f"{where}: the DataItem has Dimensions, a DataType or a Precision that is not known") from error
        if not shape or min(shape) < 0:
            raise Failed(f"{where}: the DataItem does not say its Dimensions")
        values = {"XML": self.in_text, "HDF": self.in_hdf, "BINARY": self.in_binary}.get(way, self.unknown)(item, where, type_)
        if values.size != math.prod(shape):
            raise Failed(f"{where}: the DataItem has {values.size} numbers, but should have {' times '.join(map(str, shape))}")
        return values.reshape(shape)

    def unknown(self, item, where, type_):
        raise Failed(f"{where}: the Format {item.get('Format')} is not known; XML, HDF and Binary are read")

    def in_text(self, item, where, type_):
        words = Words(item.text or "", comments=False, line=int(item.get(LINE)))
        return (words.floats if type_.kind == "f" else words.integers)(len(words.words), "numbers")

    def in_binary(self, item, where, type_):
        order = {"big": ">", "little": "<"}.get(item.get("Endian", "Native").lower(), "=")
        path = os.path.join(self.folder, (item.text or "").strip())
        try:
            # a number has a byte at least
            count = min(math.prod(int(word) for word in item.get("Dimensions").split()), os.path.getsize(path))
            return numpy.fromfile(path, type_.newbyteorder(order), count, offset=int(item.get("Seek", "0")))
        except (OSError, ValueError, OverflowError) as error:
            raise Failed(f"{where}: {path} cannot be read: {error}") from error

    def in_hdf(self, item, where, type_):
        try:
            import h5py
        except ImportError as error:
            raise Failed("HDF5 is read by h5py, which is not installed (python3-h5py in Debian, h5py in PyPI)") from error
        name, _, inside = (item.text or "").strip().rpartition(":")
        try:
            if name not in self.open:
                self.open[name] = h5py.File(os.path.join(self.folder, name), "r")
            found = self.open[name][inside]
            return found[()]
        except (OSError, KeyError, ValueError, TypeError) as error:
            raise Failed(f"{where}: {name}:{inside} cannot be read: {error}") from error
