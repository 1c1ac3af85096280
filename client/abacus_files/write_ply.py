"""PLY, binary little-endian: triangles, as QGIS (MDAL), MeshLab and CloudCompare read them, and the marked edges."""
import numpy

from .arrays import unlike
from .held import doubles_hold_ids, loss

suffixes = (".ply",)
holds = ("labels",)
AXES = ("x", "y", "z")
LIST = "vertex_indices"


def plain(names, taken):
    """Names that a header may have."""
    return unlike(("".join(c if c.isalnum() and c.isascii() else "_" for c in name) or "_" for name in names), taken)


def type_of_ids(mesh):
    """PLY has whole numbers of 32 bits; doubles hold greater ones. None: nothing holds them."""
    least, greatest = mesh.id_range()
    return "int" if -(1 << 31) <= least and greatest < 1 << 31 else "double" if doubles_hold_ids(mesh) else None


def refusal(mesh, z):
    """Why the format cannot have the mesh, or None."""
    if mesh.dimension != 2:
        return "PLY has faces only, no tetrahedra: use .vtu or .npz"
    if mesh.vertices >= 1 << 32:
        return "PLY numbers at most 4,294,967,295 vertices: use .vtu or .npz"
    return None


def write(mesh, file, z):
    number, index = ("int", "<i4") if mesh.vertices < 1 << 31 else ("uint", "<u4")
    id_type = type_of_ids(mesh)
    vertex = [*((name, "double", "<f8") for name in (*AXES, *plain(mesh.attributes, (*AXES, "id")))),
              *([("id", id_type, "<i4" if id_type == "int" else "<f8")] if id_type else [])]
    labels = plain(mesh.labels, (LIST,))
    file.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {mesh.vertices}\n"
                + "".join(f"property {type_} {name}\n" for name, type_, _ in vertex)
                + f"element face {mesh.simplices}\nproperty list uchar {number} {LIST}\n" + "".join(f"property double {name}\n" for name in labels)
                + (f"element edge {mesh.facets}\nproperty {number} vertex1\nproperty {number} vertex2\nproperty int marker\n" if mesh.facets else "")
                + "end_header\n").encode())
    row = numpy.dtype([("values", "<f8", (3 + len(mesh.attributes),)), *([("id", vertex[-1][2])] if id_type else [])])
    for ids, coordinates, values in mesh.points():
        rows = numpy.empty(len(ids), row)
        rows["values"] = numpy.column_stack([mesh.solid(coordinates, values, z), values])
        if id_type:
            rows["id"] = ids
        file.write(rows.tobytes())
    face = numpy.dtype([("count", "u1"), ("corners", index, (mesh.corners,)), ("labels", "<f8", (len(labels),))])
    for _, corners, values in mesh.cells():
        faces = numpy.empty(len(corners), face)
        faces["count"], faces["corners"], faces["labels"] = mesh.corners, corners, values
        file.write(faces.tobytes())
    edge = numpy.dtype([("corners", index, (2,)), ("marker", "<i4")])
    for corners, markers in mesh.marked_facets():
        edges = numpy.empty(len(markers), edge)
        edges["corners"], edges["marker"] = corners, markers
        file.write(edges.tobytes())


def lost(mesh, z):
    renamed = [f"{name}: {new}" for names, taken in ((mesh.attributes, (*AXES, "id")), (mesh.labels, (LIST,)))
               for name, new in zip(names, plain(names, taken)) if name != new]
    return loss(mesh, ids=type_of_ids(mesh) is not None) + ([f"names, which are changed ({', '.join(renamed)})"] if renamed else [])
