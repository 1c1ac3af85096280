"""XDMF: an unstructured grid for ParaView, described in XML, with its arrays in an HDF5 file beside it. A series has its mesh there once."""
import os
import pathlib
from xml.sax.saxutils import escape, quoteattr

import numpy

from .arrays import unlike
from .held import loss
from .psql import Failed
from .series import Series, Step
from .xdmf_kinds import COUNTED, KINDS

suffixes = (".xdmf", ".xmf")
holds = ("labels",)
# {(dimension, corners): the kind}
OF = {(1, 2): "line", (2, 3): "triangle", (2, 4): "quad", (3, 4): "tetra", (3, 8): "hexahedron"}


def heavy():
    try:
        import h5py
    except ImportError as error:
        raise Failed("XDMF is written by h5py, which is not installed (python3-h5py in Debian, h5py in PyPI)") from error
    return h5py


class Arrays:
    """The datasets of the HDF5 file, which are filled chunk by chunk, and XML that names them."""

    def __init__(self, store, name):
        self.store, self.name = store, name
        self.filled = {}

    def add(self, path, shape, dtype):
        self.store.create_dataset(path, shape=shape, dtype=dtype)
        self.filled[path] = 0

    def put(self, path, values):
        begin = self.filled[path]
        self.store[path][begin: begin + len(values)] = values
        self.filled[path] += len(values)

    def item(self, path):
        data = self.store[path]
        kind = "Float" if data.dtype.kind == "f" else "Int"
        return (f'<DataItem DataType="{kind}" Precision="{data.dtype.itemsize}" Dimensions="{" ".join(map(str, data.shape))}" Format="HDF">'
                f"{escape(self.name)}:{path}</DataItem>")

    def attribute(self, name, center, path):
        return f'<Attribute Name={quoteattr(name)} AttributeType="Scalar" Center="{center}">{self.item(path)}</Attribute>\n'


def write_points(mesh, arrays, z, names, folder):
    """Values of points, and if `folder` is that of the mesh, their places and ids, too."""
    whole = folder == "/mesh"
    for n in range(len(names)):
        arrays.add(f"{folder}/point{n}", (mesh.vertices,), "<f8")
    if whole:
        arrays.add("/mesh/points", (mesh.vertices, 3), "<f8")
        arrays.add("/mesh/id", (mesh.vertices,), "<i8")
    first = len(mesh.attributes) - len(names)
    for ids, coordinates, values in mesh.points():
        for n in range(len(names)):
            arrays.put(f"{folder}/point{n}", values[:, first + n])
        if whole:
            arrays.put("/mesh/points", mesh.solid(coordinates, values, z))
            arrays.put("/mesh/id", ids)


class Cells:
    """Simplices, and behind them the marked facets, if there are any: then the topology is mixed."""

    def __init__(self, mesh, arrays):
        self.mesh, self.arrays = mesh, arrays
        self.count = mesh.simplices + mesh.facets
        self.code, self.marker = unlike(["code", "marker"], mesh.labels)
        for n in range(len(mesh.labels)):
            arrays.add(f"/mesh/cell{n}", (self.count,), "<f8")
        arrays.add("/mesh/code", (self.count,), "<i8")
        width = mesh.corners
        if mesh.facets:
            arrays.add("/mesh/marker", (self.count,), "<i4")
            facet = mesh.dimension + (2 if OF[mesh.dimension - 1, mesh.dimension] in COUNTED else 1)
            arrays.add("/mesh/cells", (mesh.simplices * (width + 1) + mesh.facets * facet,), "<i8")
        else:
            arrays.add("/mesh/cells", (mesh.simplices, width), "<i8")

    def put(self, dimension, corners, codes, labels, markers):
        kind = OF[dimension, corners.shape[1]]
        if self.mesh.facets:
            head = [KINDS[kind][1]] + ([corners.shape[1]] if kind in COUNTED else [])
            corners = numpy.column_stack([*(numpy.full(len(corners), number) for number in head), corners]).reshape(-1)
            self.arrays.put("/mesh/marker", markers)
        self.arrays.put("/mesh/cells", corners)
        self.arrays.put("/mesh/code", codes)
        for n in range(len(self.mesh.labels)):
            self.arrays.put(f"/mesh/cell{n}", labels[:, n])

    def write(self):
        mesh = self.mesh
        for codes, corners, labels in mesh.cells():
            self.put(mesh.dimension, corners, codes, labels, numpy.zeros(len(codes)))
        for corners, markers in mesh.marked_facets():
            count = len(markers)
            self.put(mesh.dimension - 1, corners, numpy.full(count, -1), numpy.full((count, len(mesh.labels)), numpy.nan), markers)

    def topology(self):
        kind = "Mixed" if self.mesh.facets else KINDS[OF[self.mesh.dimension, self.mesh.corners]][0]
        return f'<Topology TopologyType="{kind}" NumberOfElements="{self.count}">{self.arrays.item("/mesh/cells")}</Topology>\n'

    def attributes(self):
        found = "".join(self.arrays.attribute(name, "Cell", f"/mesh/cell{n}") for n, name in enumerate(self.mesh.labels))
        found += self.arrays.attribute(self.code, "Cell", "/mesh/code")
        return found + (self.arrays.attribute(self.marker, "Cell", "/mesh/marker") if self.mesh.facets else "")


def write_arrays(mesh, arrays, z, query):
    """Fills the HDF5 file; returns the grids in XML: (time or None, its content)."""
    series = Series(mesh.session, query) if query is not None else None
    mesh.will_read(1 + len(series.steps if series else []))
    names = unlike(mesh.attributes + (series.names if series else []), ("id",))
    own = names[: len(mesh.attributes)]
    write_points(mesh, arrays, z, own, "/mesh")
    cells = Cells(mesh, arrays)
    cells.write()
    whole = (f'<Geometry GeometryType="XYZ">{arrays.item("/mesh/points")}</Geometry>\n{cells.topology()}'
             + "".join(arrays.attribute(name, "Node", f"/mesh/point{n}") for n, name in enumerate(own))
             + arrays.attribute("id", "Node", "/mesh/id") + cells.attributes())
    if series is None:
        return [(None, whole)]
    grids = []
    for n, step in enumerate(series.steps):
        write_points(Step(mesh, series, step), arrays, None, series.names, f"/step{n}")
        grids.append((step, whole + "".join(arrays.attribute(name, "Node", f"/step{n}/point{k}") for k, name in enumerate(names[len(own):]))))
    return grids


def text(grids):
    found = ""
    for n, (time, content) in enumerate(grids):
        when = f'<Time Value="{time!r}"/>\n' if time is not None else ""
        found += f'<Grid Name="mesh{n if time is not None else ""}" GridType="Uniform">\n{when}{content}</Grid>\n'
    if grids[0][0] is not None:
        found = f'<Grid Name="series" GridType="Collection" CollectionType="Temporal">\n{found}</Grid>\n'
    return f'<?xml version="1.0"?>\n<Xdmf Version="3.0">\n<Domain>\n{found}</Domain>\n</Xdmf>\n'


def write(mesh, file, z, query=None):
    """Writes NAME.h5 beside NAME.xdmf, and what it is into `file`."""
    h5py = heavy()
    beside = pathlib.Path(file.name.removesuffix(".part")).with_suffix(".h5")
    part = f"{beside}.part"
    try:
        with h5py.File(part, "w") as store:
            grids = write_arrays(mesh, Arrays(store, beside.name), z, query)
        file.write(text(grids).encode())
        os.replace(part, beside)
    finally:
        if os.path.exists(part):
            os.remove(part)


def lost(mesh, z):
    return loss(mesh)
