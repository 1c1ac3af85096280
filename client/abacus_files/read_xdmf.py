"""XDMF: grids in XML, with arrays in text, binary files or HDF5. Of a series in time the first step is read; grids of a spatial collection are joined."""
import pathlib
import re

import numpy

from .psql import Failed
from .vtu_pieces import joined
from .xdmf_data import Data
from .xdmf_kinds import BY_NUMBER, COUNTED, named
from .xml_lines import LINE, parse

suffixes = (".xdmf", ".xmf", ".xdmf3")


def fail(element, said):
    raise Failed(f"line {element.get(LINE)}: {said}")


def mixed(element, words):
    """{kind: (places of the cells in the file's order, corners)}"""
    found, at, number = {}, 0, 0
    while at < len(words):
        kind, corners = BY_NUMBER.get(int(words[at]), (None, None))
        head = 2 if kind in COUNTED else 1
        if kind is None or at + head + corners > len(words) or head == 2 and words[at + 1] != corners:
            fail(element, f"the mixed topology cannot be read at its number {at}: {words[at: at + 3].tolist()}")
        width = head + corners
        rows = words[at: at + (len(words) - at) // width * width].reshape(-1, width)
        other = numpy.flatnonzero((rows[:, :head] != rows[0, :head]).any(axis=1))
        rows = rows[: other[0]] if len(other) else rows
        found.setdefault(kind, []).append((numpy.arange(number, number + len(rows)), rows[:, head:]))
        at, number = at + rows.size, number + len(rows)
    return {kind: tuple(map(numpy.concatenate, zip(*parts))) for kind, parts in found.items()}, number


class Piece:
    """A grid, as vtu_pieces takes it."""

    ghosts = 0

    def __init__(self, element, data):
        self.element, self.data_of = element, data
        self.points = self.read_points(self.child("Geometry"))
        topology = self.child("Topology")
        places, count = self.read_cells(topology)
        self.cells = {kind: corners for kind, (_, corners) in places.items()}
        for kind, corners in self.cells.items():
            if ((corners < 0) | (corners >= len(self.points))).any():
                fail(topology, f"a {kind} names a point that the grid does not have")
        self.data, self.cell_data, self.texts, self.ids = {}, {}, [], None
        for attribute in element.iterfind("Attribute"):
            self.read_attribute(attribute, places, count)
        ids = self.data.get("id")
        if ids is not None and ids.shape[1] == 1 and (ids.astype(numpy.int64) == ids).all():
            self.ids = self.data.pop("id")[:, 0].astype(numpy.int64)

    def child(self, name):
        """Its geometry or topology: its own, or that of the grid to which an xi:include points, as FEniCS writes it."""
        found = self.element.find(name)
        include = next((part for part in self.element if part.tag.endswith("include")), None)
        if found is None and include is not None:
            of = re.search(r"@Name=[\"']([^\"']*)[\"']", include.get("xpointer", ""))
            grids = [grid for grid in self.data_of.root.iter("Grid") if grid.find(name) is not None and (of is None or grid.get("Name") == of[1])]
            found = grids[0].find(name) if grids else None
        if found is None:
            fail(self.element, f"the grid has no {name}")
        return found

    def item(self, element):
        items = element.findall("DataItem")
        if len(items) != 1:
            fail(element, f"{len(items)} DataItems, where one belongs")
        return items[0]

    def read_points(self, geometry):
        kind = geometry.get("GeometryType", geometry.get("Type", "XYZ")).upper()
        columns = {"XYZ": 3, "XY": 2}.get(kind)
        if columns is None:
            fail(geometry, f"a geometry {kind}; XYZ and XY are read")
        values = self.data_of.read(self.item(geometry)).astype(float)
        if values.size % columns:
            fail(geometry, f"{values.size} coordinates, which are not {columns} for each point")
        return values.reshape(-1, columns)

    def read_cells(self, topology):
        """{kind: (places in the file's order, corners)}, and how many cells there are."""
        name = topology.get("TopologyType", topology.get("Type", ""))
        offset = int(topology.get("BaseOffset", "0"))
        words = self.data_of.read(self.item(topology))
        if words.dtype.kind not in "iu":
            fail(topology, "corners are not whole numbers")
        words = words.astype(numpy.int64)
        if name.lower() == "mixed":
            found, count = mixed(topology, words.reshape(-1))
        else:
            kind, corners = named(name) or (None, 1)
            if kind is None:
                fail(topology, f"cells {name}, which are not known")
            if words.size % corners:
                fail(topology, f"{words.size} corners, which are not {corners} for each cell")
            count = words.size // corners
            found = {kind: (numpy.arange(count), words.reshape(count, corners))}
        said = re.split(r"\s+", topology.get("NumberOfElements", topology.get("Dimensions", "")).strip())[0]
        if said.isdigit() and int(said) != count:
            fail(topology, f"it says that it has {said} cells, but has {count}")
        return {kind: (places, corners - offset) for kind, (places, corners) in found.items()}, count

    def read_attribute(self, attribute, places, cells):
        name, center = attribute.get("Name", ""), attribute.get("Center", "Node").lower()
        rows = {"node": len(self.points), "cell": cells}.get(center)
        if rows is None:
            self.texts.append(name)
            return
        values = self.data_of.read(self.item(attribute))
        if rows == 0 or values.size % rows:
            fail(attribute, f"{name} has {values.size} numbers for {rows} {'points' if center == 'node' else 'cells'}")
        values = values.reshape(rows, -1)
        if center == "node":
            self.data[name] = values
        else:
            self.cell_data[name] = {kind: values[of] for kind, (of, _) in places.items()}


def pieces_of(grid, data):
    """The pieces of a grid, and what should be said."""
    if grid.get("GridType", grid.get("Type", "Uniform")).lower() not in ("collection", "tree"):
        return [Piece(grid, data)], []
    parts = grid.findall("Grid")
    if not parts:
        fail(grid, "the collection has no grid")
    if grid.get("CollectionType", "").lower() == "temporal":
        found, notes = pieces_of(parts[0], data)
        return found, notes + ([f"a series of {len(parts)} steps, of which the first is taken"] if len(parts) > 1 else [])
    found = [pieces_of(part, data) for part in parts]
    return [piece for pieces, _ in found for piece in pieces], [note for _, notes in found for note in notes]


def beside(path):
    """The files that one names."""
    with open(path, "rb") as file:
        names = re.findall(rb">\s*([^<>\s:]{1,200})(?::[^<>]*)?\s*<", file.read(1 << 20))
    return {pathlib.Path(path).parent / name.decode(errors="replace") for name in names if b"\0" not in name}


def read(path, keep_apart=False):
    with open(path, "rb") as file:
        root, _ = parse(file.read())
    if root.tag != "Xdmf":
        fail(root, f"is not XDMF, but {root.tag}")
    grids = root.findall("Domain/Grid")
    if not grids:
        fail(root, "has no grid")
    with Data(path, root) as data:
        pieces, notes = pieces_of(grids[0], data)
    if len(grids) > 1 and any(grid.find(".//Attribute") is not None for grid in grids[1:]):
        notes.append(f"has {len(grids)} grids, of which the first is taken")
    grid = joined(pieces, keep_apart)
    grid.notes += notes
    return grid
