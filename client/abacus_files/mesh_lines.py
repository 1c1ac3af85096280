"""The lines, markers and regions of a mesh, as writers take them. They are held in memory."""
from fractions import Fraction

import numpy

from .arrays import table_of, values_of
from .psql import Failed, literal


class Corners:
    """Corners of lines in the order of line and position: `line`, `number` of the vertex (from 0), `id`, `places`, `part` (-1: none), `soft`.
    `values`: of the attribute `z`, which is its place among the attributes."""

    def __init__(self, mesh, z=None):
        query = (f"SELECT line, coalesce(v.number, -1), coalesce(v.id, -1), coalesce(part, -1), (kind = 'soft')::int::int8, l.x, l.y, "
                 f"{'0::float8' if z is None else values_of('v.attributes', z + 1)[z]} FROM {mesh.lines()} AS l LEFT JOIN {mesh.numbered_vertices('v')} ON v.x = l.x AND v.y = l.y ORDER BY line, position")
        parts = [(table_of(chunk, 0, 5, "<i8"), table_of(chunk, 5, 3, "<f8")) for chunk in mesh.session.chunks(query, ["int8"] * 5 + ["float8"] * 3)]
        whole = numpy.concatenate([numpy.empty((0, 5), "<i8"), *(part for part, _ in parts)])
        reals = numpy.concatenate([numpy.empty((0, 3)), *(part for _, part in parts)])
        self.places, self.values = reals[:, :2], reals[:, 2]
        self.line, self.number, self.id, self.part, self.soft = whole.T
        if (self.number < 0).any():
            raise Failed("the lines of the mesh wait for points: call abacus_build() first")

    def segments(self):
        """The corners at which a segment begins; it ends at the next one."""
        return numpy.flatnonzero((self.line[1:] == self.line[:-1]) & (self.part[1:] == self.part[:-1]))

    def begins(self):
        """The corners at which a line or a part of it begins."""
        return numpy.setdiff1d(numpy.arange(len(self.line)), self.segments() + 1)


def along(place, begin, end):
    """How far along a segment a place lies, exactly: from 0 to 1; None if it is beside it."""
    (x, y), (ax, ay), (bx, by) = (tuple(map(Fraction, of)) for of in (place, begin, end))
    if (bx - ax) * (y - ay) != (by - ay) * (x - ax):
        return None
    share = ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / ((bx - ax) ** 2 + (by - ay) ** 2)
    return share if 0 <= share <= 1 else None


class Markers:
    """The markers of segments: `of` each segment's first corner, and `lost`: how many marked edges are not those of a whole segment."""

    def __init__(self, mesh, corners):
        self.of, self.lost = {}, 0
        if mesh.facets:
            self.find(mesh, corners)

    def find(self, mesh, corners):
        query = (f"SELECT f.marker::int8, coalesce(l, -1), corners[1][1], corners[1][2], corners[2][1], corners[2][2] FROM abacus_facets({mesh.sql}) AS f "
                 f"LEFT JOIN (SELECT v0, v1, unnest(lines) AS l FROM abacus_edges({mesh.sql}, fixed => true)) AS e "
                 f"ON least(f.v0, f.v1) = least(e.v0, e.v1) AND greatest(f.v0, f.v1) = greatest(e.v0, e.v1)")
        where, parts, edges = Where(corners), {}, {}  # {segment: {(begin, end, marker)}}, {edge: segments}
        for marker, line, *ends in mesh.session.all(query, ["int8"] * 2 + ["float8"] * 4):
            of = edges.setdefault(tuple(ends), set())
            for at, begin, end in where.find(line, tuple(ends[:2]), tuple(ends[2:])):
                parts.setdefault(at, set()).add((begin, end, marker))
                of.add(at)
        for at, found in parts.items():
            found = sorted(found)
            covers = found[0][0] == 0 and found[-1][1] == 1 and all(before[1] == after[0] for before, after in zip(found, found[1:]))
            if covers and len({marker for *_, marker in found}) == 1:
                self.of[at] = found[0][2]
        self.lost = sum(not (of & self.of.keys()) for of in edges.values())


class Where:
    """On which segments of a line an edge lies. Most edges are segments; others are compared with all segments of the line."""

    def __init__(self, corners):
        self.begins = corners.segments()
        self.line, self.begin, self.end = corners.line[self.begins], corners.places[self.begins], corners.places[self.begins + 1]
        self.whole = {}
        for at, line, a, b in zip(self.begins.tolist(), self.line.tolist(), map(tuple, self.begin.tolist()), map(tuple, self.end.tolist())):
            self.whole.setdefault((line, min(a, b), max(a, b)), []).append(at)

    def find(self, line, a, b):
        """(segment, how far along the edge begins, how far it ends)"""
        known = self.whole.get((line, min(a, b), max(a, b)))
        return [(at, 0, 1) for at in known] if known else self.compare(line, a, b)

    def compare(self, line, a, b):
        low, high = numpy.minimum(self.begin, self.end), numpy.maximum(self.begin, self.end)
        near = (self.line == line) & (low <= numpy.minimum(a, b)).all(axis=1) & (high >= numpy.maximum(a, b)).all(axis=1)
        for n in numpy.flatnonzero(near).tolist():
            ends = [along(place, self.begin[n].tolist(), self.end[n].tolist()) for place in (a, b)]
            if None not in ends:
                yield int(self.begins[n]), min(ends), max(ends)


def regions(mesh):
    """[(name, number, lines, seeds)] of the regions; a region has lines, which are its outlines, or seeds."""
    names = mesh.region_names()
    if not names:
        return []
    table, = mesh.session.texts(f"SELECT format('%I.%I', nspname, relname || '_regions') FROM pg_class c JOIN pg_namespace n ON n.oid = relnamespace "
                                f"WHERE c.oid = {mesh.sql}")
    found = []
    for name in names:
        rows = mesh.session.all(f"SELECT number::int8, (line IS NULL)::int::int8, coalesce(line, 0), coalesce(x, 0), coalesce(y, 0) FROM {table} "
                                f"WHERE region = {literal(name)} ORDER BY part", ["int8"] * 3 + ["float8"] * 2)
        found.append((name, rows[0][0], [line for _, seed, line, _, _ in rows if not seed], [(x, y) for _, seed, _, x, y in rows if seed]))
    return found
