"""VTU, the unstructured grids of VTK and ParaView, of one piece or several.

Read by Expat and numpy: meshio mixes up raw appended arrays.
"""
import numpy

from .cell_arrays import of_kind
from .psql import Failed
from .vtk_array import Arrays
from .vtu_pieces import joined
from .xml_lines import LINE, parse

suffixes = (".vtu",)
# {number of VTK: (name of meshio, corners)}; those of any order have so many corners at least
KINDS = {1: ("vertex", 1), 3: ("line", 2), 5: ("triangle", 3), 8: ("pixel", 4), 9: ("quad", 4), 10: ("tetra", 4), 11: ("voxel", 8), 12: ("hexahedron", 8),
         13: ("wedge", 6), 14: ("pyramid", 5), 21: ("line3", 3), 22: ("triangle6", 6), 23: ("quad8", 8), 24: ("tetra10", 10), 25: ("hexahedron20", 20),
         34: ("triangle7", 7)}
OF_ANY_ORDER = {35: "line", 68: "line", 69: "triangle", 71: "tetra", 75: "line", 76: "triangle", 78: "tetra"}
TAKEN = ("line", "triangle", "tetra", "quad", "hexahedron")
GHOST = 1  # a bit of vtkGhostType: the cell is another piece's


def appended(data, start, encoding):
    begin = data.find(b"_", data.find(b">", start)) + 1
    if encoding not in ("raw", "base64") or begin == 0:
        raise Failed("has appended data that is neither raw nor base64")
    if encoding == "raw":
        return encoding, memoryview(data)[begin:]
    return encoding, b"".join(data[begin:].split(b"<", 1)[0].split())


def is_text(array):
    return array.tag != "DataArray" or array.get("type") == "String"


class Piece:
    """`points`, `ids` or None, `data` of points, `cells` and `cell_data` by kind, `texts`: names of arrays of no numbers, `ghosts`: how many."""

    def __init__(self, element, arrays):
        self.element, self.arrays = element, arrays
        points, cells = self.count("NumberOfPoints"), self.count("NumberOfCells")
        places = element.find("Points/DataArray")
        if points and places is None:
            self.fail("the piece has no points")
        self.points = arrays.read(places, points, 3) if points else numpy.empty((0, 3))
        self.data = self.read_data("PointData", points)
        self.ids = self.take_ids()
        self.texts = [array.get("Name", "") for group in ("PointData", "CellData") for array in element.iterfind(f"{group}/*") if is_text(array)]
        self.cells, self.cell_data, self.ghosts = {}, {}, 0
        if cells:
            parts = {array.get("Name"): array for array in element.iterfind("Cells/DataArray")}
            if not {"connectivity", "offsets", "types"} <= set(parts):
                self.fail("the piece has no connectivity, offsets or types of its cells")
            self.read_cells({name: arrays.read(parts[name], rows, 1).reshape(-1).astype(numpy.int64)
                             for name, rows in (("connectivity", None), ("offsets", cells), ("types", cells))}, self.read_data("CellData", cells))

    def fail(self, said):
        raise Failed(f"line {self.element.get(LINE)}: {said}")

    def count(self, name):
        text = self.element.get(name, "")
        if not text.isdigit():
            self.fail(f"a piece does not say its {name}")
        return int(text)

    def read_data(self, group, rows):
        """{name: rows x components}"""
        found = {}
        for array in self.element.iterfind(f"{group}/*"):
            if is_text(array):
                continue
            several = array.get("NumberOfComponents") or "1"
            if not several.isdigit() or int(several) == 0:
                raise Failed(f"line {array.get(LINE)}: the array {array.get('Name', '')} has {several} components")
            found[array.get("Name", "")] = self.arrays.read(array, rows, int(several)) if rows else numpy.empty((0, int(several)))
        return found

    def take_ids(self):
        """The array `id`, or else the one that the file calls global ids, if its numbers are whole."""
        data = self.element.find("PointData")
        name = "id" if "id" in self.data else data.get("GlobalIds") if data is not None else None
        if name not in self.data or self.data[name].shape[1] != 1:
            return None
        values = self.data[name][:, 0]
        with numpy.errstate(invalid="ignore"):
            ids = values.astype(numpy.int64)
        if (ids != values).any():
            return None
        del self.data[name]
        return ids

    def read_cells(self, parts, data):
        ends = parts["offsets"]
        begins = numpy.concatenate([[0], ends[:-1]])
        if (begins > ends).any() or ends[-1] != len(parts["connectivity"]):
            self.fail(f"the offsets of cells end at {ends[-1]}, but there are {len(parts['connectivity'])} corners")
        hidden = (data.pop("vtkGhostType", numpy.zeros((len(ends), 1), int))[:, 0].astype(numpy.int64) & GHOST).astype(bool)
        self.ghosts = int(hidden.sum())
        self.cell_data = {name: {} for name in data}
        for type_ in numpy.unique(parts["types"]).tolist():
            of = (parts["types"] == type_) & ~hidden
            for kind, which in self.kinds(type_, of, ends - begins):
                if of_kind(kind) not in TAKEN:  # refused or left out by their kind
                    self.cells[kind] = numpy.zeros((int(which.sum()), 1), numpy.int64)
                    continue
                corners = parts["connectivity"][begins[which][:, None] + numpy.arange((ends - begins)[which].max(initial=0))]
                if ((corners < 0) | (corners >= len(self.points))).any():
                    self.fail(f"a {kind} names a point that its piece does not have")
                self.take_cells(kind, corners, {name: values[which] for name, values in data.items()})

    def kinds(self, type_, of, counts):
        """The kinds of the cells of a type, each with which they are."""
        if type_ in OF_ANY_ORDER:
            plain = OF_ANY_ORDER[type_]
            return [(plain if count == {"line": 2, "triangle": 3, "tetra": 4}[plain] else f"{plain}{count}", of & (counts == count))
                    for count in numpy.unique(counts[of]).tolist()]
        kind, corners = KINDS.get(type_, (f"cells of VTK's type {type_}", None))
        if corners is not None and (counts[of] != corners).any():
            self.fail(f"a {kind} does not have {corners} corners")
        return [(kind, of)]

    def take_cells(self, kind, corners, data):
        """Adds cells of a kind; VTK may have several types of it."""
        old = self.cells.get(kind)
        self.cells[kind] = corners if old is None else numpy.concatenate([old, corners])
        for name, values in data.items():
            self.cell_data[name][kind] = values if old is None else numpy.concatenate([self.cell_data[name][kind], values])


def read(path, keep_apart=False):
    with open(path, "rb") as file:
        data = file.read()
    root, begun = parse(data, "AppendedData")
    appended_data = appended(data, begun[0], begun[1].get("encoding", "")) if begun else None
    if root.tag != "VTKFile" or root.get("type") != "UnstructuredGrid":
        raise Failed(f"line {root.get(LINE)}: is not an unstructured grid of VTK, but {root.get('type') or root.tag}")
    arrays = Arrays(root, appended_data)
    pieces = [Piece(element, arrays) for element in root.iterfind("UnstructuredGrid/Piece")]
    if not pieces:
        raise Failed(f"line {root.get(LINE)}: has no piece")
    return joined(pieces, keep_apart)
