"""Rows in PostgreSQL's binary form of COPY: an id, x, y and attributes. Many are made at once, and no number becomes a text and a number again."""
import numpy

SIGNATURE = b"PGCOPY\n\xff\r\n\0" + bytes(8)
END = b"\xff\xff"  # in place of a row's number of columns
KINDS = {"int2": ">i2", "int4": ">i4", "int8": ">i8", "float8": ">f8"}


class Rows:
    """`types`: of the columns behind id, x and y. At most `size` rows are made at once."""

    def __init__(self, types, size):
        kinds = [KINDS[name] for name in ("int8", "float8", "float8", *types)]
        fields = [("count", ">i2")]
        for n, kind in enumerate(kinds):
            fields += [(f"l{n}", ">i4"), (f"f{n}", kind)]
        self.rows = numpy.empty(size, numpy.dtype(fields))
        self.rows["count"] = len(kinds)
        for n, kind in enumerate(kinds):
            self.rows[f"l{n}"] = numpy.dtype(kind).itemsize
        self.next = 1

    def make(self, *columns):
        """The bytes of rows; ids go on counting."""
        count = len(columns[0])
        rows = self.rows[:count]
        rows["f0"] = numpy.arange(self.next, self.next + count)
        for n, values in enumerate(columns, 1):
            rows[f"f{n}"] = values
        self.next += count
        return rows.tobytes()
