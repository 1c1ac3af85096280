"""TetGen's and Triangle's .node and .ele, with the .face, .edge or (of Triangle) .poly that lies beside them: files of one name."""
import pathlib

import numpy

from .english import counted
from .grid import Grid
from .psql import Failed
from .words import Places, Rows, read_text

suffixes = (".node", ".ele", ".face", ".edge")
KINDS = {(2, 3): "triangle", (2, 6): "triangle6", (3, 4): "tetra", (3, 10): "tetra10"}
# columns of a line of .face or .edge without its marker: so many corners. More are points within an edge, or the neighbours.
FACETS = {".face": ("triangle", {4: 3, 6: 3, 7: 6, 9: 6}), ".edge": ("line", {3: 2, 4: 2, 5: 2})}


class Part:
    """One of the files. Its errors name it."""

    def __init__(self, path, suffix):
        self.path = path.with_suffix(suffix.upper() if path.suffix.isupper() else suffix)

    def exists(self):
        return self.path.is_file()

    def read(self, take, *arguments):
        try:
            if not self.exists():
                raise Failed("is needed beside it, but is not there")
            return take(Rows(read_text(self.path)), *arguments)
        except Failed as error:
            raise Failed(f"{self.path.name}: {error}") from error


def nodes(rows):
    count, dimension, attributes, markers = (rows.whole(2, "its first line") + [0, 0])[:4]
    if dimension not in (2, 3) or min(attributes, markers) < 0:
        rows.fail(0, f"points of {dimension} coordinates, {attributes} attributes and {markers} markers; 2 or 3 coordinates are read")
    width = 1 + dimension + attributes + (markers > 0)
    table, begin = rows.table(count, width, "points")
    ids = rows.numbers(table[::width], int, begin, 1)
    values = rows.numbers(table, float, begin, width).reshape(count, width)
    names = [f"tetgen:attr{k + 1}" for k in range(attributes)] + ["tetgen:ref"] * (markers > 0)
    return lambda n: rows.rows[begin + n][0], ids, values[:, 1: 1 + dimension], {name: values[:, 1 + dimension + k] for k, name in enumerate(names)}


def corners_of(rows, table, begin, width, corners, places):
    found = numpy.array(table, dtype=object).reshape(-1, width)[:, 1: 1 + corners].reshape(-1).tolist()
    return places.of(rows.numbers(found, int, begin, corners).reshape(-1, corners), lambda n: rows.rows[begin + n // corners][0])


def elements(rows, dimension, places):
    """Kind, corners, and the attributes of cells: the first is the region."""
    count, corners, attributes = (rows.whole(2, "its first line") + [0])[:3]
    kind = KINDS.get((dimension, corners))
    if kind is None or attributes < 0:
        rows.fail(0, f"cells of {corners} corners in {dimension} dimensions; only triangles and tetrahedra make a mesh")
    width = 1 + corners + attributes
    table, begin = rows.table(count, width, "cells")
    cells = corners_of(rows, table, begin, width, corners, places)
    regions = {}
    for k in range(attributes):
        regions[kind, "material" if k == 0 else f"material_{k + 1}"] = rows.numbers(table[1 + corners + k:: width], float, begin, 1)
    return kind, cells, regions


def facets(rows, widths, places):
    """Corners and markers."""
    count, markers = (rows.whole(1, "its first line") + [0])[:2]
    if count == 0:
        return numpy.empty((0, 2), numpy.int64), None
    width = len(rows.row("the facets"))
    rows.at -= 1
    corners = widths.get(width - (markers > 0))
    if corners is None:
        rows.fail(rows.at, f"{counted(width, 'number')}; {' or '.join(map(str, sorted(k + (markers > 0) for k in widths)))} were expected")
    table, begin = rows.table(count, width, "facets")
    found = corners_of(rows, table, begin, width, corners, places)
    return found, rows.numbers(table[1 + corners:: width], int, begin, 1) if markers else None


def segments(rows, widths, places):
    """Those of Triangle's .poly, behind the points, which it may leave to .node."""
    count, dimension, attributes, markers = (rows.whole(2, "its first line") + [0, 0])[:4]
    rows.table(count, 1 + dimension + attributes + (markers > 0), "points")
    return facets(rows, widths, places)


def beside(path):
    """The files that belong to one, this one among them."""
    return [Part(pathlib.Path(path), suffix).path for suffix in (*suffixes, ".poly")]


def facet_parts(path, dimension):
    """The files with facets that are there: (part, how it is read, kind, its widths). .poly is read where Triangle has written no .edge."""
    parts = [(Part(path, suffix), facets, *FACETS[suffix]) for suffix in FACETS if dimension == 3 or suffix == ".edge"]
    found = [entry for entry in parts if entry[0].exists()]
    poly = Part(path, ".poly")
    return found if found or dimension == 3 or not poly.exists() else [(poly, segments, *FACETS[".edge"])]


def read(path):
    path = pathlib.Path(path)
    line_of, ids, points, data = Part(path, ".node").read(nodes)
    places = Places(ids, line_of)
    kind, cells, regions = Part(path, ".ele").read(elements, points.shape[1], places)
    found, markers, notes = {kind: cells}, {}, []
    for part, take, facet, widths in facet_parts(path, points.shape[1]):
        corners, marks = part.read(take, widths, places)
        facet = facet + "6" if corners.shape[1] == 6 else facet
        found[facet] = corners
        if marks is not None:
            markers[facet] = marks
        notes.append(f"{part.path.name} was read, too: {counted(len(corners), 'facet')}" + ("" if marks is not None else " without markers"))
    return Grid(points, found, ids=ids, data=data, labels=regions, markers=markers, notes=notes,
                lines={"points": line_of})
