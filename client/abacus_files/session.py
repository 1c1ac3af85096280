"""One psql that answers a list of queries in one snapshot, as a stream.

Rows come in PostgreSQL's binary COPY format. Where no value is NULL or of variable length all rows have one length, so numpy reads
thousands at once. psql brings the connection options, the password file and the environment that users know; it keeps no row.
"""
import os
import subprocess

import numpy

SIGNATURE = b"PGCOPY\n\xff\r\n\0"
TYPES = {"float8": (">f8", 8), "int8": (">i8", 8), "int4": (">i4", 4)}
CHUNK = 1 << 20  # bytes read at once


class Failed(Exception):
    """What psql said, or a file that is not as it should be."""


class Session:
    """Runs queries in turn; each is a pair of SQL and the types of its columns."""

    def __init__(self, database, variables):
        self.command = ["psql", "-X", "-q", "-A", "-t", "-v", "ON_ERROR_STOP=1"]
        if database:
            self.command += ["-d", database]
        for name, value in variables.items():
            self.command += ["-v", f"{name}={value}"]
        self.rest = b""

    def __enter__(self):
        environment = dict(os.environ, PGOPTIONS=os.environ.get("PGOPTIONS", "") + " -c client_min_messages=warning")
        self.psql = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment)
        self.send("BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY;\n")
        return self

    def __exit__(self, kind, value, trace):
        self.psql.kill()
        self.psql.wait()
        for pipe in (self.psql.stdin, self.psql.stdout, self.psql.stderr):
            try:
                pipe.close()
            except BrokenPipeError:
                pass

    def send(self, text):
        try:
            self.psql.stdin.write(text.encode())
            self.psql.stdin.flush()
        except BrokenPipeError:
            self.fail()

    def fail(self):
        said = self.psql.stderr.read().decode(errors="replace").strip()
        raise Failed(said or "psql ended early")

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
        self.send(f"COPY ({query}) TO STDOUT (FORMAT binary);\n")
        head = len(SIGNATURE) + 8
        while len(self.rest) < head:
            self.read()
        if not self.rest.startswith(SIGNATURE):
            raise Failed("psql sent no rows")
        self.rest = self.rest[head:]
        while True:
            if len(self.rest) >= 2 and self.rest[:2] == b"\xff\xff":
                self.rest = self.rest[2:]
                return
            whole = numpy.frombuffer(self.rest, row, len(self.rest) // row.itemsize)
            rows = numpy.flatnonzero(whole["count"] != len(types))
            whole = whole[: rows[0]] if len(rows) else whole
            if len(whole) == 0:
                if len(self.rest) >= row.itemsize:
                    raise Failed("psql sent rows of another form")
                self.read()
                continue
            for n, name in enumerate(types):
                if (whole[f"l{n}"] != TYPES[name][1]).any():
                    raise Failed("psql sent rows of another form")
            self.rest = self.rest[len(whole) * row.itemsize:]
            yield whole

    def all(self, query, types):
        """All rows of a small query, as tuples."""
        return [tuple(row[f"f{n}"].item() for n in range(len(types))) for chunk in self.chunks(query, types) for row in chunk]

    def texts(self, query):
        """All rows of a small query of one text column."""
        self.send(f"COPY (SELECT encode(convert_to(line, 'UTF8'), 'hex') FROM ({query}) AS lines (line)) TO STDOUT;\nCOPY (SELECT '.') TO STDOUT;\n")
        while not (self.rest.startswith(b".\n") or b"\n.\n" in self.rest):
            self.read()
        lines, self.rest = (b"\n" + self.rest).split(b"\n.\n", 1)
        return [bytes.fromhex(line.decode()).decode() for line in lines.split(b"\n") if line]
