"""VTU, the unstructured grids of VTK and ParaView, of one piece or several.

Read by Expat and numpy: meshio mixes up raw appended arrays.
"""
import xml.etree.ElementTree
import xml.parsers.expat

import numpy

from .grid import Grid
from .psql import Failed
from .vtk_array import Arrays

suffixes = (".vtu",)
# {number of VTK: (name of meshio, corners)}
KINDS = {1: ("vertex", 1), 3: ("line", 2), 5: ("triangle", 3), 8: ("pixel", 4), 9: ("quad", 4), 10: ("tetra", 4), 11: ("voxel", 8), 12: ("hexahedron", 8),
         13: ("wedge", 6), 14: ("pyramid", 5), 21: ("line3", 3), 22: ("triangle6", 6), 23: ("quad8", 8), 24: ("tetra10", 10), 25: ("hexahedron20", 20)}
GHOST = 1  # a bit of vtkGhostType: the cell is another piece's


class _Found(Exception):
    """The appended data begins."""


def parse(data):
    """The elements before the appended data, and this: (encoding, bytes)."""
    builder, parser, at, open_ = xml.etree.ElementTree.TreeBuilder(), xml.parsers.expat.ParserCreate(), {}, []

    def start(name, attributes):
        if name == "AppendedData":
            at["start"], at["encoding"] = parser.CurrentByteIndex, attributes.get("encoding", "")
            raise _Found
        open_.append(name)
        builder.start(name, attributes)

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda name: builder.end(open_.pop())
    parser.CharacterDataHandler = builder.data
    parser.buffer_text = True
    try:
        parser.Parse(data, True)
    except _Found:
        while open_:
            builder.end(open_.pop())
    except xml.parsers.expat.ExpatError as error:
        raise Failed(f"is not XML, or is cut off: {error}") from error
    return builder.close(), appended(data, **at) if at else None


def appended(data, start, encoding):
    begin = data.find(b"_", data.find(b">", start)) + 1
    if encoding not in ("raw", "base64") or begin == 0:
        raise Failed("has appended data that is neither raw nor base64")
    if encoding == "raw":
        return encoding, memoryview(data)[begin:]
    return encoding, b"".join(data[begin:].split(b"<", 1)[0].split())


def count_of(piece, name):
    count = int(piece.get(name, "-1"))
    if count < 0:
        raise Failed(f"a piece does not say its {name}")
    return count


class Piece:
    def __init__(self, element, arrays):
        points, cells = count_of(element, "NumberOfPoints"), count_of(element, "NumberOfCells")
        places = element.find("Points/DataArray")
        if points and places is None:
            raise Failed("a piece has no points")
        self.points = arrays.read(places, points, 3) if points else numpy.empty((0, 3))
        self.data, self.vectors = {}, []
        for array in element.iterfind("PointData/*"):
            if array.tag == "DataArray" and array.get("NumberOfComponents", "1") in ("1", "") and array.get("type") != "String":
                self.data[array.get("Name", "")] = arrays.read(array, points, 1).reshape(-1)
            else:
                self.vectors.append(array.get("Name", ""))
        self.cell_data = [array.get("Name", "") for array in element.iterfind("CellData/*") if not self.is_code(array)]
        parts = {array.get("Name"): array for array in element.iterfind("Cells/DataArray")}
        if cells and not {"connectivity", "offsets", "types"} <= set(parts):
            raise Failed("a piece has no connectivity, offsets or types of its cells")
        self.cells, self.ghosts = {}, 0
        if cells:
            self.read_cells({name: arrays.read(parts[name], rows, 1).reshape(-1).astype(numpy.int64)
                             for name, rows in (("connectivity", None), ("offsets", cells), ("types", cells))}, self.hidden(element, arrays, cells))

    def is_code(self, array):
        """As abacus-export writes it beside the ids of points: a place on the curve, which the mesh gets anew."""
        return array.get("Name") == "code" and array.get("type") == "Int64" and "id" in self.data

    def hidden(self, element, arrays, cells):
        """Which cells are there only for their neighbours."""
        array = next((array for array in element.iterfind("CellData/DataArray") if array.get("Name") == "vtkGhostType"), None)
        return numpy.zeros(cells, bool) if array is None else (arrays.read(array, cells, 1).reshape(-1) & GHOST).astype(bool)

    def read_cells(self, parts, hidden):
        ends = parts["offsets"]
        begins = numpy.concatenate([[0], ends[:-1]])
        if (begins > ends).any() or ends[-1] != len(parts["connectivity"]):
            raise Failed(f"the offsets of cells end at {ends[-1]}, but there are {len(parts['connectivity'])} corners")
        self.ghosts = int(hidden.sum())
        for type_ in numpy.unique(parts["types"]).tolist():
            kind, corners = KINDS.get(type_, (f"cells of VTK's type {type_}", None))
            of = (parts["types"] == type_) & ~hidden
            if corners is None or kind not in ("triangle", "tetra"):
                self.cells[kind] = numpy.zeros((int(of.sum()), corners or 1), numpy.int64)  # refused or left out by their kind
                continue
            if (ends[of] - begins[of] != corners).any():
                raise Failed(f"a {kind} does not have {corners} corners")
            self.cells[kind] = parts["connectivity"][begins[of][:, None] + numpy.arange(corners)]
            if ((self.cells[kind] < 0) | (self.cells[kind] >= len(self.points))).any():
                raise Failed(f"a {kind} names a point that its piece does not have")


def merged(points, data, cells, piece):
    """Points of several pieces at one place become that of the first; what one piece has twice is left to abacus_load. `piece`: whose they are."""
    _, first, place = numpy.unique(points + 0.0, axis=0, return_index=True, return_inverse=True)  # -0 is 0
    first = first[place.reshape(-1)]
    shared = piece[first] != piece
    if not shared.any():
        return points, data, cells, []
    notes = [f"{shared.sum()} points that several pieces have were taken once"]
    differ = [name for name, values in data.items() if not numpy.array_equal(values[shared].astype(float), values[first[shared]].astype(float), equal_nan=True)]
    if differ:
        notes.append(f"these points differ from piece to piece in {', '.join(differ)}; those of the first piece were taken")
    target = numpy.where(shared, first, numpy.arange(len(points)))
    kept = numpy.flatnonzero(~shared)
    return points[kept], {name: values[kept] for name, values in data.items()}, {
        kind: numpy.searchsorted(kept, target[corners]) for kind, corners in cells.items()}, notes


def joined(pieces, keep_apart):
    """One grid of them. A point that several pieces have is one, unless vertices at one place are to be kept apart."""
    names = [name for name in pieces[0].data if all(name in piece.data for piece in pieces)]
    points = numpy.concatenate([piece.points for piece in pieces])
    data = {name: numpy.concatenate([piece.data[name] for piece in pieces]) for name in names}
    begins = numpy.cumsum([0] + [len(piece.points) for piece in pieces])
    cells = {kind: numpy.concatenate([piece.cells[kind] + begin for piece, begin in zip(pieces, begins) if kind in piece.cells])
             for kind in dict.fromkeys(kind for piece in pieces for kind in piece.cells)}
    notes = []
    if len(pieces) > 1 and not keep_apart:
        points, data, cells, notes = merged(points, data, cells, numpy.repeat(numpy.arange(len(pieces)), numpy.diff(begins)))
    ghosts = sum(piece.ghosts for piece in pieces)
    if ghosts:
        notes.append(f"{ghosts} ghost cells, which other pieces have, are left out")
    left = dict.fromkeys(name for piece in pieces for name in (*piece.vectors, *piece.data) if name not in names)
    if left:
        notes.append(f"vectors, texts and data that not all pieces have are left out: {', '.join(left)}")
    left = dict.fromkeys(name for piece in pieces for name in piece.cell_data if name != "vtkGhostType")
    if left:
        notes.append(f"data of cells is left out: {', '.join(left)}")
    return Grid(points, cells, data=data, notes=notes)


def read(path, keep_apart=False):
    with open(path, "rb") as file:
        root, appended_data = parse(file.read())
    if root.tag != "VTKFile" or root.get("type") != "UnstructuredGrid":
        raise Failed(f"is not an unstructured grid of VTK, but {root.get('type') or root.tag}")
    arrays = Arrays(root, appended_data)
    pieces = [Piece(element, arrays) for element in root.iterfind("UnstructuredGrid/Piece")]
    if not pieces:
        raise Failed("has no piece")
    return joined(pieces, keep_apart)
