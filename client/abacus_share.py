"""A rank's share of a mesh as numpy arrays, for parallel programs.

    import abacus_share
    share = abacus_share.read("mesh", parts=comm.size, part=comm.rank)

Rows come as binary COPY, through psql with the connection options of the environment, and numpy reads thousands at once. All ranks see
one state of the mesh if they read one snapshot, whose owner keeps it until all have read:

    with abacus_share.Snapshot(name=comm.bcast(None)) as snapshot:
        share = snapshot.share("mesh", comm.size, comm.rank)
"""
import dataclasses
import subprocess

import numpy

from abacus_files import copy_rows
from abacus_files.psql import Failed, literal
from abacus_files.session import TYPES, Session

__all__ = ["Failed", "Share", "Snapshot", "read", "store"]


@dataclasses.dataclass
class Share:
    """A part, and layers of simplices around it. Vertices are numbered from 0: the part's own first, then by owner."""

    mesh: str
    parts: int
    part: int
    weight: str | None
    id: numpy.ndarray             # of each vertex
    owner: numpy.ndarray          # its part
    points: numpy.ndarray         # its coordinates, a row each
    attributes: numpy.ndarray     # a row each, in the order of `names`; NaN where one is missing
    names: list[str]
    simplices: numpy.ndarray      # numbers of the corners, a row each, positively oriented
    code: numpy.ndarray           # its place on the curve
    simplex_owner: numpy.ndarray  # its part
    labels: numpy.ndarray         # a row each, in the order of `label_names`; NaN where one is missing
    label_names: list[str]
    markers: numpy.ndarray        # of the facet opposite each corner; NaN where there is none

    @property
    def own(self):
        """How many vertices are the part's own: those with numbers below."""
        return int(numpy.searchsorted(self.owner != self.part, True))

    def attribute(self, name):
        return self.attributes[:, self.names.index(name)]

    def label(self, name):
        return self.labels[:, self.label_names.index(name)]


def _columns(session, query, types):
    """The columns of a query."""
    chunks = list(session.chunks(query, types))
    kinds = [TYPES[name][0].replace(">", "=") for name in types]  # in the machine's byte order
    return [numpy.concatenate([numpy.empty(0, kind), *(chunk[f"f{n}"] for chunk in chunks)], dtype=kind) for n, kind in enumerate(kinds)]


def _beside(columns, rows):
    return numpy.column_stack(columns) if columns else numpy.empty((rows, 0))


def _or_nan(array, count):
    return [f"coalesce({array}[{n + 1}], 'NaN')" for n in range(count)]


class Snapshot(Session):
    """A state of the database, read by one session: its own, or that with a name, which is another's that still keeps it."""

    def __init__(self, database=None, name=None):
        super().__init__(database, name)
        self.name = name

    def __enter__(self):
        super().__enter__()
        if self.name is None:
            self.name, = self.texts("SELECT pg_export_snapshot()")
        return self

    def share(self, mesh, parts, part, halo=1, weight=None):
        """The share of one part, with so many layers of simplices around it."""
        name = f"{literal(mesh)}::regclass"
        names = self.texts(f"SELECT name FROM abacus_attributes({name}) ORDER BY position")
        labels = self.texts(f"SELECT unnest(abacus_labels({name}))")
        (dimension,), = self.all(f"SELECT value::int8 FROM abacus_stats({name}) WHERE name = 'dimension'", ["int8"])
        corners = dimension + 1
        arguments = f"{name}, {int(parts)}, {int(part)}, {int(halo)}, {'NULL' if weight is None else literal(weight)}"
        wanted = ["id", "owner", *"xyz"[:dimension], *_or_nan("attributes", len(names))]
        ids, owner, *values = _columns(self, f"SELECT {', '.join(wanted)} FROM abacus_share_vertices({arguments}) ORDER BY local",
                                       ["int8", "int4", *["float8"] * (dimension + len(names))])
        wanted = ["code", "owner", *[f"v{i}" for i in range(corners)], *_or_nan("labels", len(labels)), *_or_nan("markers", corners)]
        code, simplex_owner, *rest = _columns(self, f"SELECT {', '.join(wanted)} FROM abacus_share_simplices({arguments})",
                                              ["int8", "int4", *["int8"] * corners, *["float8"] * (len(labels) + corners)])
        return Share(mesh, parts, part, weight, ids, owner, numpy.column_stack(values[:dimension]), _beside(values[dimension:], len(ids)), names,
                     numpy.column_stack(rest[:corners]), code, simplex_owner, _beside(rest[corners:-corners], len(code)), labels,
                     numpy.column_stack(rest[-corners:]))


def read(mesh, parts, part, halo=1, weight=None, database=None):
    """The share of one part, as the mesh is now."""
    with Snapshot(database) as snapshot:
        return snapshot.share(mesh, parts, part, halo, weight)


def store(share, step, values, database=None):
    """Stores values of the part's own vertices, a row or a number for each in the order of their local numbers; NaN becomes NULL. What the part has
    stored at this step before is replaced."""
    values = numpy.asarray(values, float).reshape(share.own, -1)
    names = [f"value_{n}" for n in range(values.shape[1])]
    row = numpy.dtype([("count", ">i2"), ("l", ">i4"), ("id", ">i8"), *[field for name in names for field in ((f"l_{name}", ">i4"), (name, ">f8"))]])
    rows = numpy.empty(share.own, row)
    rows["count"], rows["l"], rows["id"] = 1 + len(names), 8, share.id[:share.own]
    for n, name in enumerate(names):
        rows[f"l_{name}"], rows[name] = 8, values[:, n]
    columns = ", ".join(["id int8", *[f"{name} float8" for name in names]])
    arguments = f"{literal(share.mesh)}::regclass, {int(step)}, {share.parts}, {share.part}, 'TABLE pg_temp.abacus_values'"
    weight = "" if share.weight is None else f", {literal(share.weight)}"
    command = ["psql", "-X", "-q", "-v", "ON_ERROR_STOP=1", *(["-d", database] if database else []), "--single-transaction",
               "-c", f"CREATE TEMP TABLE abacus_values ({columns}) ON COMMIT DROP", "-c", "COPY pg_temp.abacus_values FROM STDIN (FORMAT binary)",
               "-c", f"SELECT abacus_store({arguments}{weight})"]
    done = subprocess.run(command, input=copy_rows.SIGNATURE + rows.tobytes() + copy_rows.END, capture_output=True, check=False)
    if done.returncode != 0:
        raise Failed(done.stderr.decode(errors="replace").strip())
