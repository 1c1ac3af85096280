"""What abacus_load is given of a grid: what becomes of its points, cells and data."""
import numpy

from .arrays import unlike
from .english import counted
from .grid import SIMPLICES, SMALL
from .psql import Failed

NAME_BYTES = 63


class Input:
    """`dimension`, `ids`, `points`, `simplices` as places, `names` and `values` of attributes, `label_names` and `labels`, `facets` as places and
    their `markers`, `groups`; `notes`: what is left out."""

    def __init__(self, grid):
        kind = grid.kind()
        self.notes, self.groups = list(grid.notes), grid.groups
        self.dimension = SIMPLICES[kind]
        self.simplices = grid.cells[kind]
        self.points = grid.points[:, : self.dimension]
        if grid.points.shape[1] < self.dimension:
            raise Failed(f"points have {grid.points.shape[1]} coordinates, but {self.dimension} are needed")
        self.ids = self.ids_of(grid)
        self.names, self.values = self.attributes_of(grid)
        labels = {name: values for (of, name), values in grid.labels.items() if of == kind}
        self.label_names = unlike(map(self.short, labels), self.names)
        self.labels = list(labels.values())
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
        """A name that an attribute or a label may have: 1 to 63 bytes."""
        if len(name.encode()) <= NAME_BYTES:
            return name or "_"
        cut = name.encode()[: NAME_BYTES - 3].decode(errors="ignore")  # leaves room for a _ or three
        self.notes.append(f"the name {name} is too long, and cut to {cut}")
        return cut

    def facets_of(self, grid, kind):
        """Marked facets of the simplices, each once, by places of their corners."""
        empty = numpy.empty((0, self.dimension), numpy.int64), numpy.empty(0, numpy.int64)
        if kind not in grid.markers:
            return empty
        marked = grid.markers[kind] != 0
        facets, markers = numpy.sort(grid.cells[kind][marked], axis=1), grid.markers[kind][marked]
        if not len(facets):
            return empty
        corners = numpy.sort(self.simplices, axis=1)
        sides = numpy.concatenate([numpy.delete(corners, n, axis=1) for n in range(self.dimension + 1)])
        sides, place = numpy.unique(numpy.concatenate([sides, facets]), axis=0, return_inverse=True)
        place = place.reshape(-1)
        is_side = numpy.zeros(len(sides), bool)
        is_side[place[: -len(facets)]] = True
        number = place[-len(facets):]
        _, first, of = numpy.unique(number, return_index=True, return_inverse=True)
        kept = first[is_side[number[first]]]
        self.say_facets(int((~is_side[number]).sum()), int((markers != markers[first[of.reshape(-1)]]).sum()))
        return facets[kept], markers[kept]

    def say_facets(self, loose, other):
        if loose:
            self.notes.append(f"left out: {counted(loose, 'marked facet')} of no simplex")
        if other:
            self.notes.append(f"left out: another marker of {counted(other, 'facet')} (the first one is taken)")

    def say_what_is_left(self, grid, kind):
        left = {name: len(corners) for name, corners in grid.cells.items() if name != kind and len(corners)}
        facet = SMALL[self.dimension - 1]
        left[facet] = left.get(facet, 0) - int((grid.markers[facet] != 0).sum() if facet in grid.markers else 0)
        texts = [f"{count} of the kind {name}" for name, count in left.items() if count > 0]
        if texts:
            self.notes.append(f"cells that are neither {'tetrahedra' if kind == 'tetra' else 'triangles'} nor marked facets are left out: {', '.join(texts)}")
        unused = len(grid.points) - len(numpy.unique(self.simplices))
        if unused:
            self.notes.append(f"left out: {counted(unused, 'point')} of no {'tetrahedron' if kind == 'tetra' else 'triangle'}")
