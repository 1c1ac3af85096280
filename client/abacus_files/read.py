"""Files as meshes: which reader a file's name asks for, and what becomes of points, cells and data."""
import os
import sys

import numpy

from . import apart, read_2dm, read_msh, read_obj, read_off, read_other, read_ply, read_tetgen, read_vtu
from .arrays import unlike
from .grid import SIMPLICES, SMALL
from .psql import Failed

NAME_BYTES = 63
READERS = {suffix: module for module in (read_2dm, read_msh, read_obj, read_off, read_ply, read_tetgen, read_vtu) for suffix in module.suffixes}


def read_here(path, keep_apart):
    """The grid of a file, read in this process. `keep_apart`: vertices at one place."""
    module = READERS.get(os.path.splitext(path)[1].lower(), read_other)
    return module.read(path, keep_apart) if module is read_vtu else module.read(path)


class Input:
    """What abacus_load is given."""

    def __init__(self, grid):
        kind = grid.kind()
        self.notes = list(grid.notes)
        self.dimension = SIMPLICES[kind]
        self.simplices = grid.cells[kind]
        self.points = grid.points[:, : self.dimension]
        if grid.points.shape[1] < self.dimension:
            raise Failed(f"points have {grid.points.shape[1]} coordinates, but {self.dimension} are needed")
        self.ids = self.ids_of(grid)
        self.names, self.values = self.attributes_of(grid)
        self.materials = grid.tags.get(kind)
        if self.materials is not None and not self.materials.any():
            self.materials = None
        self.facets, self.markers = self.facets_of(grid, SMALL[self.dimension - 1])
        self.say_what_is_left(grid, kind)

    def ids_of(self, grid):
        if grid.ids is not None:
            return grid.ids
        plain = numpy.arange(len(grid.points))
        if "id" not in grid.data:
            return plain
        with numpy.errstate(invalid="ignore"):
            ids = grid.data["id"].astype(numpy.int64)
        if (ids != grid.data["id"]).any() or len(numpy.unique(ids)) != len(ids):
            self.notes.append("the ids are not whole numbers, or not all different: points are numbered from 0")
            return plain
        return ids

    def attributes_of(self, grid):
        """A mesh in the plane keeps z as an attribute unless it is 0 everywhere."""
        found = []
        if self.dimension == 2 and grid.points.shape[1] == 3 and numpy.any(grid.points[:, 2] != 0):
            found.append(("z", grid.points[:, 2]))
        found += [(name, values.astype(float)) for name, values in grid.data.items() if name != "id" or grid.ids is not None]
        return unlike([self.short(name) for name, _ in found], ()), [values for _, values in found]

    def short(self, name):
        """A name that an attribute may have: 1 to 63 bytes."""
        if len(name.encode()) <= NAME_BYTES:
            return name or "_"
        cut = name.encode()[: NAME_BYTES - 3].decode(errors="ignore")  # leaves room for a _ or three
        self.notes.append(f"the name {name} is too long, and cut to {cut}")
        return cut

    def facets_of(self, grid, kind):
        """Marked facets of the simplices, each once, by places of their corners."""
        empty = numpy.empty((0, self.dimension), numpy.int64), numpy.empty(0, numpy.int64)
        if kind not in grid.tags:
            return empty
        marked = grid.tags[kind] != 0
        facets, markers = numpy.sort(grid.cells[kind][marked], axis=1), grid.tags[kind][marked]
        if not len(facets):
            return empty
        corners = numpy.sort(self.simplices, axis=1)
        sides = numpy.concatenate([numpy.delete(corners, n, axis=1) for n in range(self.dimension + 1)])
        sides, place = numpy.unique(numpy.concatenate([sides, facets]), axis=0, return_inverse=True)
        place = place.reshape(-1)
        is_side = numpy.zeros(len(sides), bool)
        is_side[place[: -len(facets)]] = True
        number = place[-len(facets):]
        _, first = numpy.unique(number, return_index=True)
        kept = first[is_side[number[first]]]
        left = len(facets) - len(kept)
        if left:
            self.notes.append(f"{left} marked facets are left out: no simplex has them, or they are marked twice")
        return facets[kept], markers[kept]

    def say_what_is_left(self, grid, kind):
        left = {name: len(corners) for name, corners in grid.cells.items() if name != kind and len(corners)}
        if kind == "tetra" or "line" in left:
            left[SMALL[self.dimension - 1]] = left.get(SMALL[self.dimension - 1], 0) - len(self.facets)
        texts = [f"{count} of the kind {name}" for name, count in left.items() if count > 0]
        if texts:
            self.notes.append(f"cells that are not {'tetrahedra' if kind == 'tetra' else 'triangles'} are left out: {', '.join(texts)}")
        unused = len(grid.points) - len(numpy.unique(self.simplices))
        if unused:
            self.notes.append(f"{unused} points that belong to no {'tetrahedron' if kind == 'tetra' else 'triangle'} are left out")


def read_file(path, keep_apart):
    """What a file has. It is read in a process of its own; errors name the file."""
    try:
        found = Input(apart.read(path, keep_apart=keep_apart))
    except Failed as error:
        raise Failed(f"{path}: {error}") from error
    for note in found.notes:
        print(f"abacus-import: {path}: {note}", file=sys.stderr)
    return found
