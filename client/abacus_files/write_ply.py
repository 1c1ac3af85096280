"""PLY, binary little-endian: triangles, as QGIS (MDAL), MeshLab and CloudCompare read them."""
import numpy

from .arrays import unlike
from .psql import Failed

suffixes = (".ply",)


def write(mesh, file, z):
    if mesh.dimension != 2:
        raise Failed("PLY has faces only, no tetrahedra: use .vtu or .npz")
    number = "int" if mesh.vertices < 1 << 31 else "uint"
    if mesh.vertices >= 1 << 32:
        raise Failed("PLY numbers at most 4,294,967,295 vertices: use .vtu or .npz")
    axes = ("x", "y", "z")
    names = unlike(("".join(c if c.isalnum() and c.isascii() else "_" for c in name) for name in mesh.attributes), (*axes, "id"))
    properties = "".join(f"property double {name}\n" for name in (*axes, *names))
    file.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {mesh.vertices}\n{properties}"
                f"element face {mesh.simplices}\nproperty list uchar {number} vertex_indices\nend_header\n").encode())
    for _, coordinates, values in mesh.points():
        file.write(numpy.column_stack([mesh.solid(coordinates, values, z), values]).astype("<f8").tobytes())
    face = numpy.dtype([("count", "u1"), ("corners", "<i4" if number == "int" else "<u4", (3,))])
    for _, corners in mesh.cells():
        faces = numpy.empty(len(corners), face)
        faces["count"] = 3
        faces["corners"] = corners
        file.write(faces.tobytes())
