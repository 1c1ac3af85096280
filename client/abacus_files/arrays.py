"""A mesh as chunks of arrays: what all writers are given."""
import numpy

from .psql import Failed, literal


def unlike(names, taken):
    """Names that differ from one another and from those that a file has already: one that is taken gets a _ or more."""
    taken, found = set(taken), []
    for name in names:
        while name in taken:
            name += "_"
        taken.add(name)
        found.append(name)
    return found


def no_coordinate(attribute):
    return f"{attribute} is missing or infinite at some vertices, so it cannot be the third coordinate"


class Mesh:
    """A mesh of the session's snapshot. Counts and names are there at once; the arrays come in chunks, in any number of passes."""

    def __init__(self, session, name):
        self.session = session
        self.sql = f"{literal(name)}::regclass"
        self.dimension, self.vertices, self.simplices = session.all(
            "SELECT " + ", ".join(f"coalesce(max(value) FILTER (WHERE name = '{figure}'), -1)::int8" for figure in ("dimension", "vertices", "simplices"))
            + f" FROM abacus_stats({self.sql})", ["int8"] * 3)[0]
        if self.simplices < 0:
            raise Failed(f"{name} is an octree or a quadtree: it has no triangles or tetrahedra to write to a file")
        self.attributes = session.texts(f"SELECT name FROM abacus_attributes({self.sql}) ORDER BY position")
        self.axes = "xyz"[: self.dimension]

    def numbered_vertices(self):
        return f"abacus_numbered_vertices({self.sql})"

    def points(self, source=None, extra=(), order=""):
        """Chunks of (ids, coordinates n x dimension, values n x attributes); a missing value is NaN. `source`, `order`: the vertices joined
        with something, of which `extra` are columns more."""
        values = [f"coalesce(attributes[{n + 1}], 'NaN')" for n in range(len(self.attributes))] + list(extra)
        count = len(values)
        query = f"SELECT {', '.join(['id', *self.axes, *values])} FROM {source or self.numbered_vertices()} {order}"
        for chunk in self.session.chunks(query, ["int8"] + ["float8"] * (self.dimension + count)):
            columns = [chunk[f"f{n + 1}"].astype("<f8") for n in range(self.dimension + count)]
            table = numpy.stack(columns, axis=1)
            yield chunk["f0"].astype("<i8"), table[:, : self.dimension], table[:, self.dimension:]

    def cells(self):
        """Chunks of (codes, numbers of the corners n x (dimension + 1), from 0)."""
        corners = self.dimension + 1
        query = f"SELECT code, {', '.join(f'n{n}' for n in range(corners))} FROM abacus_numbered_simplices({self.sql})"
        for chunk in self.session.chunks(query, ["int8"] * (corners + 1)):
            yield chunk["f0"].astype("<i8"), numpy.stack([chunk[f"f{n + 1}"].astype("<i8") for n in range(corners)], axis=1)

    def solid(self, coordinates, values, z):
        """Coordinates with three columns: of a mesh in the plane z is the attribute with that number, or 0."""
        if self.dimension == 3:
            return coordinates
        height = numpy.zeros(len(coordinates)) if z is None else values[:, z]
        if not numpy.isfinite(height).all():
            raise Failed(no_coordinate(self.attributes[z]))
        return numpy.column_stack([coordinates, height])
