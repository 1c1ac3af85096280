"""One psql that answers a list of queries in one snapshot, as a stream.

Rows come in PostgreSQL's binary COPY format. Where no value is NULL or of variable length all rows have one length, so numpy reads
thousands at once. psql keeps no row.
"""
import subprocess
import sys
import tempfile

import numpy

from . import psql
from .psql import Failed

SIGNATURE = b"PGCOPY\n\xff\r\n\0"
END = b"\xff\xff"  # in place of a row's number of columns
TYPES = {"float8": (">f8", 8), "int8": (">i8", 8), "int4": (">i4", 4)}
CHUNK = 1 << 20  # bytes read at once


def check_form(rows, types, sent):
    """Rows of another form would be waited for without end: one with NULL is shorter. `sent`: how many bytes of the last row are there."""
    sizes = {"count": len(types), **{f"l{n}": TYPES[name][1] for n, name in enumerate(types)}}
    for name, wanted in sizes.items():
        field, at = rows.dtype.fields[name]
        if at + field.itemsize <= sent and (rows[name] != wanted).any():
            raise Failed("psql sent rows in an unexpected form")


class Session:
    """Runs queries in turn; each is a pair of SQL and the types of its columns. `snapshot`: as pg_export_snapshot() returned it to a session
    that is still in its transaction."""

    def __init__(self, database, snapshot=None):
        self.database = database
        self.snapshot = snapshot
        self.rest = b""

    def __enter__(self):
        self.messages = tempfile.TemporaryFile()  # a pipe that is full of warnings would stop psql
        self.psql = psql.start(self.database, options="-c client_min_messages=warning", stderr=self.messages)
        # in one piece, since psql's own queries would come in between
        taken = "" if self.snapshot is None else f"; SET TRANSACTION SNAPSHOT {psql.literal(self.snapshot)}"
        self.send("BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY" + taken)
        return self

    def __exit__(self, kind, value, trace):
        if kind is None:
            self.finish()
        psql.end(self.psql)
        if kind is None:
            sys.stderr.write(self.said())
        self.messages.close()

    def finish(self):
        """Lets psql come to its end by itself: it may not have heard yet that the last statement is done, and would say that it cancels it."""
        self.psql.stdin.close()
        try:
            self.psql.wait(10)
        except subprocess.TimeoutExpired:
            pass

    def send(self, sql):
        try:
            self.psql.stdin.write(psql.statement(sql).encode(errors="surrogateescape"))
            self.psql.stdin.flush()
        except BrokenPipeError:
            self.fail()

    def said(self):
        self.messages.seek(0)
        return self.messages.read().decode(errors="replace")

    def fail(self):
        self.psql.wait()
        raise Failed(self.said().strip() or "psql ended early")

    def read(self):
        more = self.psql.stdout.read1(CHUNK)
        if not more:
            self.fail()
        self.rest += more

    def chunks(self, query, types):
        """The rows of a query as structured arrays with fields f0, f1, ... in the machine's byte order; none is NULL."""
        fields = [("count", ">i2")]
        for n, name in enumerate(types):
            fields += [(f"l{n}", ">i4"), (f"f{n}", TYPES[name][0])]
        row = numpy.dtype(fields)
        self.send(f"COPY ({query}\n) TO STDOUT (FORMAT binary)")
        head = len(SIGNATURE) + 8
        while len(self.rest) < head:
            self.read()
        if not self.rest.startswith(SIGNATURE):
            raise Failed("psql sent no rows")
        self.rest = self.rest[head:]
        while not self.rest.startswith(END):
            whole = numpy.frombuffer(self.rest, row, len(self.rest) // row.itemsize)
            ends = numpy.flatnonzero(whole["count"] == -1)
            whole = whole[: ends[0]] if len(ends) else whole
            if len(whole) == 0:
                check_form(numpy.frombuffer(self.rest.ljust(row.itemsize, b"\xff")[: row.itemsize], row), types, len(self.rest))
                self.read()
                continue
            check_form(whole, types, row.itemsize)
            self.rest = self.rest[len(whole) * row.itemsize:]
            yield whole
        self.rest = self.rest[len(END):]

    def all(self, query, types):
        """All rows of a small query, as tuples."""
        return [tuple(row[f"f{n}"].item() for n in range(len(types))) for chunk in self.chunks(query, types) for row in chunk]

    def texts(self, query):
        """All rows of a small query of one text column."""
        self.send(f"COPY (SELECT encode(convert_to(line, 'UTF8'), 'hex') FROM ({query}\n) AS lines (line)) TO STDOUT")
        self.send("COPY (SELECT '.') TO STDOUT")
        while not (self.rest.startswith(b".\n") or b"\n.\n" in self.rest):
            self.read()
        lines, self.rest = (b"\n" + self.rest).split(b"\n.\n", 1)
        return [bytes.fromhex(line.decode()).decode() for line in lines.split(b"\n") if line]
