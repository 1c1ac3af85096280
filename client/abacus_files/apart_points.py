"""Points of a file, read in a process of its own, and streamed: a line of JSON about the file, one about each block of rows and the rows, a last one."""
import json

from . import apart, point_formats
from .copy_rows import Rows
from .psql import Failed

ROWS = 1 << 15  # are made at once


def send(path, names, wanted, first, out):
    """In the process apart."""
    module = point_formats.reader(path)
    reader = module.Reader(path, names, wanted)
    line(out, total=reader.total, srid=reader.srid)
    rows = Rows([module.types[name] for name in names], ROWS)
    rows.next = first
    for read, x, y, values in reader.blocks(ROWS):
        data = rows.make(x, y, *values)
        line(out, read=read, rows=len(x), bytes=len(data))
        out.write(data)
    line(out, notes=reader.notes)


def line(out, **said):
    out.write(json.dumps(said).encode() + b"\n")


class Points:
    """`total`: points that are read, `srid`; in turn (points read, rows, their bytes); then `notes`."""

    def __init__(self, path, names, wanted, first):
        self.path, self.options = path, (names, wanted, first)

    def __enter__(self):
        self.process = apart.process(self.path, "apart_points.send", *self.options)
        self.reader = self.process.__enter__()
        try:
            head = self.line()
        except BaseException as error:
            self.process.__exit__(type(error), error, error.__traceback__)
            raise
        self.total, self.srid, self.notes = head["total"], head["srid"], None
        return self

    def __exit__(self, *error):
        return self.process.__exit__(*error)

    def line(self):
        said = self.reader.stdout.readline()
        if not said.endswith(b"\n"):
            self.reader.wait()
            raise Failed(apart.died(self.reader.returncode, apart.size_of(self.path)))
        said = json.loads(said)
        if "failed" in said:
            raise Failed(said["failed"])
        return said

    def __iter__(self):
        while "notes" not in (said := self.line()):
            data = self.reader.stdout.read(said["bytes"])
            if len(data) == said["bytes"]:  # otherwise the process died, as the next line says
                yield said["read"], said["rows"], data
        self.notes = said["notes"]
