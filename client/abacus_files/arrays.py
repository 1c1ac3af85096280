"""A mesh as chunks of arrays: what all writers are given."""
import numpy

from .english import counted
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


def find(session, name):
    """Fails if there is no such mesh; an error of the server's would show the query."""
    if not session.all("SELECT 1::int8 FROM pg_extension WHERE extname = 'abacus'", ["int8"]):
        raise Failed("the database does not have the extension abacus")
    if not session.all(f"SELECT 1::int8 WHERE to_regclass({literal(name)}) IS NOT NULL", ["int8"]):
        raise Failed(f"there is no mesh {name}")


def figures(session, sql, names):
    """Figures of abacus_stats; -1 where it has none of that name."""
    return session.all("SELECT " + ", ".join(f"coalesce(max(value) FILTER (WHERE name = '{name}'), -1)::int8" for name in names)
                       + f" FROM abacus_stats({sql})", ["int8"] * len(names))[0]


def values_of(array, count):
    """SQL for so many elements of an array of numbers; a missing one is NaN."""
    return [f"coalesce({array}[{n + 1}], 'NaN')" for n in range(count)]


class Mesh:
    """A mesh of the session's snapshot. Counts and names are there at once; the arrays come in chunks, in any number of passes.

    `attributes` of points, `labels` of simplices, `facets`: how many have markers."""

    but = ""  # what a file holds of regions, if it does not hold regions

    def __init__(self, session, name, progress=None):
        self.session, self.progress, self.name = session, progress, name
        self.sql = f"{literal(name)}::regclass"
        self.dimension, self.vertices, self.simplices, self.waiting, self.repeated = figures(
            session, self.sql, ("dimension", "vertices", "simplices", "waiting", "duplicates"))
        self.corners = self.dimension + 1
        self.attributes = session.texts(f"SELECT name FROM abacus_attributes({self.sql}) ORDER BY position")
        self.labels = session.texts(f"SELECT unnest(abacus_labels({self.sql}))")
        (self.facets,), = session.all(f"SELECT count(*) FROM abacus_facets({self.sql})", ["int8"])
        (self.srid,), = session.all(f"SELECT abacus_srid({self.sql})::int8", ["int8"])
        self.axes = "xyz"[: self.dimension]
        self.within = None  # an argument of SQL, of a part of a mesh
        self.cells_sql = f"abacus_cells({self.sql})"

    def numbered_vertices(self, alias="numbered"):
        return f"abacus_numbered_vertices({self.sql}) AS {alias}"

    def numbered_cells(self, columns):
        return f"SELECT {', '.join(['code', *(f'n{n}' for n in range(self.corners)), *columns])} FROM abacus_numbered_simplices({self.sql})"

    def lines(self):
        return f"abacus_lines({self.sql})"

    def region_names(self):
        return self.session.texts(f"SELECT region FROM abacus_regions({self.sql}) ORDER BY number") if self.dimension == 2 else []

    def id_range(self):
        """The least and the greatest id."""
        return self.session.all(f"SELECT coalesce(min(id), 0), coalesce(max(id), 0) FROM {self.numbered_vertices()}", ["int8"] * 2)[0]

    def ids_differ(self):
        (differ,), = self.session.all(f"SELECT (count(DISTINCT id) = count(*))::int::int8 FROM {self.numbered_vertices()}", ["int8"])
        return bool(differ)

    def unheld(self, holds=()):
        """What no file holds, as texts, but for what this one `holds`."""
        lines, regions = 0, []
        if self.dimension == 2:
            within = f", {self.within}" if self.within else ""
            (lines,), = self.session.all(f"SELECT count(*) FROM abacus_edges({self.sql}, fixed => true{within})", ["int8"])
            regions = self.region_names()
        return [text for what, count, text in (
            ("repeated", self.repeated, counted(self.repeated, 'point at the place of a vertex', 'points at places of vertices')), ("waiting", self.waiting, f"{counted(self.waiting, 'point')} waiting to be inserted"),
            ("lines", lines, f"lines, which fix {counted(lines, 'edge')}"),
            ("regions", len(regions), f"regions ({', '.join(regions)}){self.but}"), ("srid", self.srid, f"the SRID {self.srid}")) if count > 0 and what not in holds]

    def not_delaunay(self):
        """What a file of points and lines loses of a mesh that was made elsewhere, as texts."""
        changeable, = figures(self.session, self.sql, ("changeable",))
        return [] if changeable else [f"its triangles ({self.simplices}): its points and lines make others"]

    def of_label(self, n, greatest):
        """Whether the numbers of a label are whole and not beyond this one; and how many simplices have none."""
        whole, missing = self.session.all(f"SELECT (count(*) FILTER (WHERE labels[{n + 1}] <> trunc(labels[{n + 1}]) OR abs(labels[{n + 1}]) > {greatest}) = 0)"
                                          f"::int::int8, count(*) FILTER (WHERE labels[{n + 1}] IS NULL) FROM {self.cells_sql}", ["int8"] * 2)[0]
        return bool(whole), missing

    def will_read(self, points, cells=1):
        """Says how often a writer reads all points and all cells, where that is not once."""
        if self.progress:
            self.progress.total = points * self.vertices + cells * self.simplices

    def chunks(self, query, types):
        for chunk in self.session.chunks(query, types):
            if self.progress:
                self.progress.add(len(chunk), chunk.nbytes)
            yield chunk

    def points(self, source=None, extra=(), order=""):
        """Chunks of (ids, coordinates n x dimension, values n x attributes); a missing value is NaN. `source`, `order`: the vertices joined
        with something, of which `extra` are columns more."""
        values = values_of("attributes", len(self.attributes)) + list(extra)
        count = len(values)
        query = f"SELECT {', '.join(['id', *self.axes, *values])} FROM {source or self.numbered_vertices()} {order}"
        for chunk in self.chunks(query, ["int8"] + ["float8"] * (self.dimension + count)):
            table = table_of(chunk, 1, self.dimension + count, "<f8")
            yield chunk["f0"].astype("<i8"), table[:, : self.dimension], table[:, self.dimension:]

    def cells(self):
        """Chunks of (codes, numbers of the corners n x (dimension + 1), from 0, labels n x labels); a missing label is NaN."""
        labels = values_of("labels", len(self.labels))
        for chunk in self.chunks(self.numbered_cells(labels), ["int8"] * (self.corners + 1) + ["float8"] * len(labels)):
            yield (chunk["f0"].astype("<i8"), table_of(chunk, 1, self.corners, "<i8"), table_of(chunk, 1 + self.corners, len(labels), "<f8"))

    def marked_facets(self):
        """Chunks of (numbers of the corners n x dimension, markers)."""
        if not self.facets:
            return
        corners = range(self.dimension)  # places tell vertices of one id apart, ids those at one place
        numbers = " ".join(f"JOIN numbered AS c{n} ON c{n}.id = v{n} AND "
                           + " AND ".join(f"c{n}.{axis} = corners[{n + 1}][{k + 1}]" for k, axis in enumerate(self.axes)) for n in corners)
        query = (f"WITH numbered AS MATERIALIZED (SELECT number, id, {', '.join(self.axes)} FROM {self.numbered_vertices()}) "
                 f"SELECT marker::int8, {', '.join(f'c{n}.number' for n in corners)} FROM abacus_facets({self.sql}) {numbers}")
        for chunk in self.session.chunks(query, ["int8"] * (1 + self.dimension)):
            yield table_of(chunk, 1, self.dimension, "<i8"), chunk["f0"].astype("<i4")

    def solid(self, coordinates, values, z):
        """Coordinates with three columns: of a mesh in the plane z is the attribute with that number, or 0."""
        if self.dimension == 3:
            return coordinates
        height = numpy.zeros(len(coordinates)) if z is None else values[:, z]
        if not numpy.isfinite(height).all():
            raise Failed(no_coordinate(self.attributes[z]))
        return numpy.column_stack([coordinates, height])


def table_of(chunk, first, count, dtype):
    """So many fields of a chunk as columns."""
    if count == 0:
        return numpy.empty((len(chunk), 0), dtype)
    return numpy.stack([chunk[f"f{n}"].astype(dtype) for n in range(first, first + count)], axis=1)
