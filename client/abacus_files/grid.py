"""What a reader makes of a file: points, cells by kind, and numbers that belong to them."""
import re

import numpy

from .english import counted
from .psql import Failed

# What Gmsh, VTK and meshio call the cells that others have; a mesh takes triangles and tetrahedra.
SIMPLICES = {"triangle": 2, "tetra": 3}
SMALL = ("vertex", "line", "triangle")  # may lie beside larger ones
CORNERS = {"vertex": 1, "line": 2, "triangle": 3, "tetra": 4}
OF_HIGHER_ORDER = re.compile("(line|triangle|tetra)[0-9]*")  # their corners come first


def joined(parts, counts, none):
    """Numbers of cells of several kinds, one after the other; `none`: where a kind has none."""
    return numpy.concatenate([numpy.full(count, none) if part is None else part for part, count in zip(parts, counts)])


class Grid:
    """`points`: n x 2 or n x 3. `ids`: of the points, or None. `data`: {name: n numbers, or n x k}. `cells`: {kind: m x corners}, where a corner
    is a point's place, from 0. `labels`: {(kind, name): m numbers}, NaN where a cell has none. `markers`: {kind: m whole numbers}, where 0 is none.
    `codes`: {kind: m places of octants on the curve}. `groups`: what a file calls its labels, as (dimension, number, name). `notes`: what a user
    should know. `plan`: the Plan of a file that gives lines instead of triangles, or beside them. `srid`: of its coordinates, 0 if unknown.
    `lines`: of a text, functions that say in which line a point, or a cell of a kind, is: {"points" or kind: function of its place}."""

    def __init__(self, points, cells, ids=None, data=None, labels=None, markers=None, groups=(), notes=(), lines=None):
        self.points = points
        self.cells = cells
        self.ids = ids
        self.data = data or {}
        self.labels = labels or {}
        self.markers = markers or {}
        self.codes = {}
        self.plan, self.srid = None, 0
        self.groups = list(groups)
        self.notes = list(notes)
        self.lines = lines or {}

    def where(self, what, place):
        """The line of something, to begin a message with, if it is known."""
        return f"line {self.lines[what](place)}: " if what in self.lines else ""

    def check(self):
        """A reader is not believed: whatever it has misread should not become a mesh."""
        points = numpy.asarray(self.points, dtype=float)
        if points.ndim != 2 or points.shape[1] not in (2, 3) or len(points) == 0:
            raise Failed("has no points")
        self.points = points
        if not numpy.isfinite(points).all():
            place = int(numpy.flatnonzero(~numpy.isfinite(points).all(axis=1))[0])
            raise Failed(f"{self.where('points', place)}point {place if self.ids is None else self.ids[place]} has a coordinate that is not finite")
        for kind, corners in self.cells.items():
            self.cells[kind] = self.checked(kind, numpy.asarray(corners))
        for kind, values in (*((kind, values) for (kind, _), values in self.labels.items()), *self.markers.items(), *self.codes.items()):
            if len(values) != len(self.cells[kind]):
                raise Failed(f"has {counted(len(self.cells[kind]), 'cell')} ({kind}), but {counted(len(values), 'number')} for them")
        for kind, values in self.markers.items():
            markers = numpy.asarray(values, dtype=float)
            wrong = (markers < -(1 << 31)) | (markers >= 1 << 31)
            if wrong.any():
                raise Failed(f"{self.where(kind, int(numpy.flatnonzero(wrong)[0]))}a marker of a cell ({kind}) does not fit 32 bits")
        if self.ids is not None and len(self.ids) != len(points):
            raise Failed(f"has {counted(len(points), 'point')}, but {counted(len(self.ids), 'id')}")
        self.take_corners()
        self.check_data()

    def checked(self, kind, corners):
        if corners.size == 0:
            return corners.reshape(0, corners.shape[-1] if corners.ndim == 2 else 0).astype(numpy.int64)
        if corners.ndim != 2 or corners.dtype.kind not in "iu":
            raise Failed(f"corners of its cells ({kind}) are not whole numbers")
        wrong = (corners < 0) | (corners >= len(self.points))
        if wrong.any():
            where = self.where(kind, int(numpy.flatnonzero(wrong.any(axis=1))[0]))
            raise Failed(f"{where}a cell ({kind}) has the corner {corners[wrong][0]}, but points are numbered from 0 to {len(self.points) - 1}")
        return corners.astype(numpy.int64)

    def take_corners(self):
        """Cells of second and higher order give their corners."""
        higher = [kind for kind, corners in self.cells.items() if len(corners) and kind not in CORNERS and OF_HIGHER_ORDER.fullmatch(kind)]
        for kind in higher:
            plain = OF_HIGHER_ORDER.fullmatch(kind)[1]
            corners = self.cells.pop(kind)[:, : CORNERS[plain]]
            counts = len(self.cells.get(plain, ())), len(corners)
            self.cells[plain] = numpy.concatenate([self.cells[plain], corners]) if counts[0] else corners
            for name in dict.fromkeys(name for of, name in self.labels if of in (plain, kind)):
                self.labels[plain, name] = joined([self.labels.pop((of, name), None) for of in (plain, kind)], counts, numpy.nan)
            if plain in self.markers or kind in self.markers:
                self.markers[plain] = joined([self.markers.pop(of, None) for of in (plain, kind)], counts, 0)
        if higher:
            self.notes.append(f"only the corners are taken of cells of higher order: {', '.join(higher)}")

    def check_data(self):
        """A vector becomes an attribute for each component; texts are left out."""
        kept, left = {}, []
        for name, values in self.data.items():
            values = numpy.asarray(values)
            if len(values) != len(self.points):
                raise Failed(f"has {counted(len(self.points), 'point')}, but {counted(len(values), 'value')} of {name}")
            columns = values.reshape(len(values), -1).T
            if values.dtype.kind not in "iufb" or len(columns) == 0:
                left.append(name)
            elif len(columns) == 1:
                kept[name] = columns[0]
            else:
                parts = "xyz" if len(columns) <= 3 else range(len(columns))
                kept.update({f"{name}_{part}": column for part, column in zip(parts, columns)})
        self.data = kept
        if left:
            self.notes.append(f"texts of points are left out: {', '.join(left)}")

    def kind(self):
        """The kind of its simplices: tetrahedra where there are any, else triangles."""
        kinds = {kind for kind, corners in self.cells.items() if len(corners)}
        found = "tetra" if "tetra" in kinds else "triangle"
        others = sorted(kinds - {"tetra", *SMALL})
        if others:
            counted = ", ".join(f"{kind}: {len(self.cells[kind])}" for kind in others)
            raise Failed(f"has cells of other kinds ({counted}); only triangles and tetrahedra make a mesh")
        if found not in kinds:
            raise Failed("has neither triangles nor tetrahedra")
        return found
