"""The archives of numpy arrays that abacus-export writes, and others with `points` and `simplices`."""
import zipfile

import numpy

from .grid import Grid
from .psql import Failed

suffixes = (".npz",)
KINDS = {(2, 3): "triangle", (3, 4): "tetra", (2, 4): "quad", (3, 8): "hexahedron"}
FACETS = {2: "line", 3: "triangle"}


class Members:
    def __init__(self, archive):
        self.archive = archive

    def table(self, name, *wanted):
        """An array of numbers of this shape; None: however many there are."""
        try:
            values = self.archive[name]
        except (ValueError, EOFError, OSError, NotImplementedError, zipfile.BadZipFile) as error:
            raise Failed(f"the array {name} cannot be read: {error}") from error
        if values.dtype.kind not in "iuf" or len(values.shape) != len(wanted) or any(want is not None and has != want for has, want in zip(values.shape, wanted)):
            raise Failed(f"the array {name} has the type {values.dtype} and the shape {values.shape}, where numbers in the shape "
                         f"{tuple('any' if want is None else want for want in wanted)} belong")
        return values

    def names(self, name, count, prefix):
        if name not in self.archive:
            return [f"{prefix}{n + 1}" for n in range(count)]
        found = self.archive[name]
        if found.dtype.kind != "U" or found.shape != (count,):
            raise Failed(f"the array {name} does not have {count} names")
        return found.tolist()


def read(path):
    try:
        with numpy.load(path, allow_pickle=False) as archive:
            return grid_of(archive)
    except (zipfile.BadZipFile, ValueError, NotImplementedError, OSError, EOFError, KeyError) as error:
        raise Failed(f"is not an archive of numpy arrays, or is cut off: {error}") from error


def grid_of(archive):
    if not isinstance(archive, numpy.lib.npyio.NpzFile) or not {"points", "simplices"} <= set(archive.files):
        raise Failed("has no arrays points and simplices")
    members = Members(archive)
    points = members.table("points", None, None)
    simplices = members.table("simplices", None, None)
    kind = KINDS.get((points.shape[1], simplices.shape[1]))
    if kind is None:
        raise Failed(f"has simplices of {simplices.shape[1]} corners in {points.shape[1]} dimensions; only triangles and tetrahedra make a mesh")
    known = {"points", "simplices", "codes"}
    grid = Grid(points, {kind: simplices})
    if "codes" in archive.files:
        grid.codes[kind] = members.table("codes", len(simplices)).astype(numpy.int64)
    if "ids" in archive.files:
        grid.ids = members.table("ids", len(points)).astype(numpy.int64)
    for array, names, rows, prefix in ("values", "attributes", len(points), "value"), ("labels", "label_names", len(simplices), "label"):
        if array in archive.files:
            values = members.table(array, rows, None)
            for n, name in enumerate(members.names(names, values.shape[1], prefix)):
                (grid.data if array == "values" else grid.labels)[name if array == "values" else (kind, name)] = values[:, n]
    if {"facets", "markers"} <= set(archive.files):
        facet = FACETS[points.shape[1]]
        grid.cells[facet] = members.table("facets", None, points.shape[1])
        grid.markers[facet] = members.table("markers", len(grid.cells[facet])).astype(numpy.int64)
    left = sorted(set(archive.files) - known - {"ids", "values", "attributes", "labels", "label_names", "facets", "markers"})
    grid.notes += [f"left out: {', '.join(left)}"] if left else []
    return grid
