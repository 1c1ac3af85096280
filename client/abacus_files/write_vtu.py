"""VTU: an unstructured grid for ParaView and VTK, with the data appended raw.

All lengths are known before the first byte, so every array has its place in the file, and one pass over the rows fills several.
"""
from xml.sax.saxutils import quoteattr

import numpy

from .arrays import unlike
from .held import loss

suffixes = (".vtu",)
holds = ("labels",)
# {(dimension, corners): VTK's type}: line, triangle, quad, tetra, hexahedron
TYPES = {(1, 2): 3, (2, 3): 5, (2, 4): 9, (3, 4): 10, (3, 8): 12}


class Appended:
    """The arrays of the file: where each begins, and how far it has been filled."""

    def __init__(self):
        self.size = 0
        self.at = {}
        self.lines = {}

    def add(self, group, name, kind, dtype, components, count):
        several = f' NumberOfComponents="{components}"' if components > 1 else ""
        self.lines.setdefault(group, []).append(
            f'<DataArray type="{kind}" Name={quoteattr(name)}{several} format="appended" offset="{self.size}"/>')
        bytes_ = numpy.dtype(dtype).itemsize * components * count
        self.at[group, name] = [self.size, bytes_, numpy.dtype(dtype)]
        self.size += 8 + bytes_

    def text(self, group):
        return f"<{group}>{''.join(self.lines.get(group, []))}</{group}>\n"

    def open(self, file):
        self.file = file
        self.start = file.tell()
        for at, size, _ in self.at.values():
            file.seek(self.start + at)
            file.write(numpy.uint64(size).tobytes())
        for place in self.at.values():
            place[0] += self.start + 8

    def put(self, group, name, values):
        at, _, dtype = self.at[group, name]
        data = numpy.ascontiguousarray(values, dtype).tobytes()
        self.file.seek(at)
        self.file.write(data)
        self.at[group, name][0] += len(data)


class Cells:
    """The cells of the file: simplices, and behind them the facets that have markers."""

    def __init__(self, mesh, data):
        self.mesh, self.data, self.ends = mesh, data, 0
        self.code, self.marker = unlike(["code", "marker"], mesh.labels)
        count = mesh.simplices + mesh.facets
        for name in mesh.labels:
            data.add("CellData", name, "Float64", "<f8", 1, count)
        data.add("CellData", self.code, "Int64", "<i8", 1, count)
        if mesh.facets:
            data.add("CellData", self.marker, "Int32", "<i4", 1, count)
        data.add("Cells", "connectivity", "Int64", "<i8", 1, mesh.simplices * mesh.corners + mesh.facets * mesh.dimension)
        data.add("Cells", "offsets", "Int64", "<i8", 1, count)
        data.add("Cells", "types", "UInt8", "u1", 1, count)

    def put(self, corners, dimension, codes, labels, markers):
        count, width = corners.shape
        put = self.data.put
        for k, name in enumerate(self.mesh.labels):
            put("CellData", name, labels[:, k])
        put("CellData", self.code, codes)
        if self.mesh.facets:
            put("CellData", self.marker, markers)
        put("Cells", "connectivity", corners)
        put("Cells", "offsets", numpy.arange(1, count + 1) * width + self.ends)
        put("Cells", "types", numpy.full(count, TYPES[dimension, width]))
        self.ends += count * width

    def write(self):
        mesh = self.mesh
        for codes, corners, labels in mesh.cells():
            self.put(corners, mesh.dimension, codes, labels, numpy.zeros(len(codes)))
        for corners, markers in mesh.marked_facets():
            count = len(markers)
            self.put(corners, mesh.dimension - 1, numpy.full(count, -1), numpy.full((count, len(mesh.labels)), numpy.nan), markers)


def write(mesh, file, z):
    n, m = mesh.vertices, mesh.simplices + mesh.facets
    names = unlike(mesh.attributes, ("id",))
    data = Appended()
    for name in names:
        data.add("PointData", name, "Float64", "<f8", 1, n)
    data.add("PointData", "id", "Int64", "<i8", 1, n)
    data.add("Points", "points", "Float64", "<f8", 3, n)
    cells = Cells(mesh, data)
    file.write(f'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'
               f'<UnstructuredGrid><Piece NumberOfPoints="{n}" NumberOfCells="{m}">\n'
               f'{"".join(map(data.text, ("PointData", "CellData", "Points", "Cells")))}'
               f'</Piece></UnstructuredGrid>\n<AppendedData encoding="raw">\n_'.encode())
    data.open(file)
    for ids, coordinates, values in mesh.points():
        data.put("Points", "points", mesh.solid(coordinates, values, z))
        data.put("PointData", "id", ids)
        for k, name in enumerate(names):
            data.put("PointData", name, values[:, k])
    cells.write()
    file.seek(data.start + data.size)
    file.write(b"\n</AppendedData>\n</VTKFile>\n")


def lost(mesh, z):
    return loss(mesh)
