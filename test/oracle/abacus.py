"""The extension as the tests of this folder ask it: through psql, in the database that the environment names. Numbers come back as numpy arrays."""
import csv
import io
import pathlib
import subprocess
import tempfile
import unittest

import numpy

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]


class InFolder(unittest.TestCase):
    """Tests with files in a folder of their own."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = pathlib.Path(cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def file(self, name, text):
        path = self.at / name
        path.write_text(text)
        return path


class Refused(Exception):
    """A statement failed; the text is what psql says."""


def psql(sql, sent=""):
    """What a script prints. Notices are not errors."""
    done = subprocess.run(["psql", "-X", "-q", "-v", "ON_ERROR_STOP=1", "-c", "SET extra_float_digits = 3", "-c", sql],
                          input=sent, text=True, capture_output=True)
    if done.returncode != 0:
        raise Refused(done.stderr)
    return done.stdout


def script(sql):
    """What a script prints, statement by statement, errors and notices as well; it goes on after an error."""
    return subprocess.run(["psql", "-X", "-q"], input=sql, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False).stdout


def rows(query):
    """The rows of a query, each a list of texts; NULL is the word."""
    return list(csv.reader(io.StringIO(psql(f"COPY ({query}) TO STDOUT (FORMAT csv, NULL 'NULL')"))))


def numbers(query):
    """The rows of a query of numbers; NULL is NaN."""
    return numpy.array([[numpy.nan if value == "NULL" else float(value) for value in row] for row in rows(query)])


def vector(text, width=1):
    """The numbers of an array as PostgreSQL prints it, so many in a row if that is more than one."""
    flat = numpy.array([numpy.nan if part == "NULL" else float(part) for part in text.replace("{", "").replace("}", "").split(",") if part])
    return flat if width == 1 else flat.reshape(-1, width)


def store(table, columns, values):
    """A new table of float8 with these columns, and an id in front that counts from 1."""
    lines = "".join(",".join([str(n), *("" if numpy.isnan(v) else repr(float(v)) for v in row)]) + "\n" for n, row in enumerate(values, 1))
    definition = ", ".join(f"{name} float8" for name in columns)
    psql(f"DROP TABLE IF EXISTS {table}; CREATE TABLE {table} (id bigint PRIMARY KEY, {definition})")
    psql(f"COPY {table} FROM STDIN (FORMAT csv)", lines)


def triangulate(mesh, coordinates, **attributes):
    """A new mesh of points (an array of n x 2 or n x 3) with attributes, arrays of n each. The points stay in the table of the same name
    and `_points`; their ids count from 1."""
    dimension = coordinates.shape[1]
    columns = [*"xyz"[:dimension], *attributes]
    store(f"{mesh}_points", columns, numpy.column_stack([coordinates, *attributes.values()]))
    names = "{" + ",".join(attributes) + "}"
    psql(f"DROP TABLE IF EXISTS {mesh}, {mesh}_vertices CASCADE")
    psql(f"SELECT abacus_triangulate('{mesh}', 'SELECT id, {', '.join(columns)} FROM {mesh}_points', '{names}', dimension => {dimension})")


def simplices(mesh, corners=3):
    """Its simplices as rows of indices into the points that triangulate() was given."""
    query = ", ".join(f"v{i} - 1" for i in range(corners))
    return numbers(f"SELECT {query} FROM abacus_simplices('{mesh}')").astype(int)
