"""What a reader makes of a file: points, cells by kind, and numbers that belong to them."""
import numpy

from .psql import Failed

# What Gmsh, VTK and meshio call the cells that others have; a mesh takes triangles and tetrahedra.
SIMPLICES = {"triangle": 2, "tetra": 3}
SMALL = ("vertex", "line", "triangle")  # may lie beside larger ones


class Grid:
    """`points`: n x 2 or n x 3. `ids`: of the points, or None. `data`: {name: n numbers}. `cells`: {kind: m x corners}, where a corner is a
    point's place, from 0. `tags`: {kind: m whole numbers}, where 0 is none: materials of simplices, markers of facets. `notes`: what a user
    should know."""

    def __init__(self, points, cells, ids=None, data=None, tags=None, notes=()):
        self.points = points
        self.cells = cells
        self.ids = ids
        self.data = data or {}
        self.tags = tags or {}
        self.notes = list(notes)

    def check(self):
        """A reader is not believed: whatever it has misread should not become a mesh."""
        points = numpy.asarray(self.points, dtype=float)
        if points.ndim != 2 or points.shape[1] not in (2, 3) or len(points) == 0:
            raise Failed("has no points")
        self.points = points
        for kind, corners in self.cells.items():
            corners = numpy.asarray(corners)
            if corners.size == 0:
                corners = corners.reshape(0, corners.shape[-1] if corners.ndim == 2 else 0).astype(numpy.int64)
            if corners.ndim != 2 or corners.dtype.kind not in "iu":
                raise Failed(f"corners of its cells ({kind}) are not whole numbers")
            wrong = (corners < 0) | (corners >= len(points))
            if wrong.any():
                raise Failed(f"a cell ({kind}) has the corner {corners[wrong][0]}, but there are {len(points)} points, counted from 0")
            self.cells[kind] = corners.astype(numpy.int64)
        for kind, tags in self.tags.items():
            if len(tags) != len(self.cells[kind]):
                raise Failed(f"has {len(self.cells[kind])} cells ({kind}), but marks {len(tags)}")
        if self.ids is not None and len(self.ids) != len(points):
            raise Failed(f"has {len(points)} points, but {len(self.ids)} ids")
        self.check_data()

    def check_data(self):
        """What is no single number a point is left out."""
        kept, left = {}, []
        for name, values in self.data.items():
            values = numpy.asarray(values)
            if len(values) != len(self.points):
                raise Failed(f"has {len(self.points)} points, but {len(values)} values of {name}")
            if values.dtype.kind in "iufb" and values.size == len(values):
                kept[name] = values.reshape(-1)
            else:
                left.append(name)
        self.data = kept
        if left:
            self.notes.append(f"vectors and texts of points are left out: {', '.join(left)}")

    def kind(self):
        """The kind of its simplices: tetrahedra where there are any, else triangles."""
        kinds = {kind for kind, corners in self.cells.items() if len(corners)}
        found = "tetra" if "tetra" in kinds else "triangle"
        others = sorted(kinds - {"tetra", *SMALL})
        if others:
            raise Failed(f"has cells of other kinds ({', '.join(others)}); only triangles and tetrahedra make a mesh")
        if found not in kinds:
            raise Failed("has neither triangles nor tetrahedra")
        return found
