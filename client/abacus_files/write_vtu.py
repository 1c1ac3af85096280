"""VTU: an unstructured grid for ParaView and VTK, with the data appended raw.

All lengths are known before the first byte, so every array has its place in the file, and one pass over the rows fills several.
"""
from xml.sax.saxutils import quoteattr

import numpy

from .arrays import unlike

suffixes = (".vtu",)
CELL_TYPE = {2: 5, 3: 10}  # VTK_TRIANGLE, VTK_TETRA


class Appended:
    """The arrays of the file: where each begins, and how far it has been filled."""

    def __init__(self):
        self.size = 0
        self.at = {}
        self.lines = {}

    def add(self, name, kind, dtype, components, count):
        several = f' NumberOfComponents="{components}"' if components > 1 else ""
        self.lines[name] = f'<DataArray type="{kind}" Name={quoteattr(name)}{several} format="appended" offset="{self.size}"/>'
        bytes_ = numpy.dtype(dtype).itemsize * components * count
        self.at[name] = [self.size, bytes_, numpy.dtype(dtype)]
        self.size += 8 + bytes_

    def open(self, file):
        self.file = file
        self.start = file.tell()
        for at, size, _ in self.at.values():
            file.seek(self.start + at)
            file.write(numpy.uint64(size).tobytes())
        for place in self.at.values():
            place[0] += self.start + 8

    def put(self, name, values):
        at, _, dtype = self.at[name]
        data = numpy.ascontiguousarray(values, dtype).tobytes()
        self.file.seek(at)
        self.file.write(data)
        self.at[name][0] += len(data)


def write(mesh, file, z):
    n, m, corners = mesh.vertices, mesh.simplices, mesh.dimension + 1
    names = unlike(mesh.attributes, ("id", "code", "points", "connectivity", "offsets", "types"))
    data = Appended()
    for name in names:
        data.add(name, "Float64", "<f8", 1, n)
    data.add("id", "Int64", "<i8", 1, n)
    data.add("code", "Int64", "<i8", 1, m)
    data.add("points", "Float64", "<f8", 3, n)
    data.add("connectivity", "Int64", "<i8", 1, m * corners)
    data.add("offsets", "Int64", "<i8", 1, m)
    data.add("types", "UInt8", "u1", 1, m)
    lines = data.lines
    point_data = "".join(lines[name] for name in (*names, "id"))
    file.write(f'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'
               f'<UnstructuredGrid><Piece NumberOfPoints="{n}" NumberOfCells="{m}">\n'
               f'<PointData>{point_data}</PointData>\n<CellData>{lines["code"]}</CellData>\n<Points>{lines["points"]}</Points>\n'
               f'<Cells>{lines["connectivity"]}{lines["offsets"]}{lines["types"]}</Cells>\n'
               f'</Piece></UnstructuredGrid>\n<AppendedData encoding="raw">\n_'.encode())
    data.open(file)
    for ids, coordinates, values in mesh.points():
        data.put("points", mesh.solid(coordinates, values, z))
        data.put("id", ids)
        for k, name in enumerate(names):
            data.put(name, values[:, k])
    done = 0
    for codes, numbers in mesh.cells():
        data.put("connectivity", numbers)
        data.put("code", codes)
        data.put("offsets", (numpy.arange(len(codes)) + done + 1) * corners)
        data.put("types", numpy.full(len(codes), CELL_TYPE[mesh.dimension]))
        done += len(codes)
    file.seek(data.start + data.size)
    file.write(b"\n</AppendedData>\n</VTKFile>\n")
