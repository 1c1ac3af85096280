"""2DM of SMS, the mesh format of hydraulic models, which QGIS reads as a mesh layer."""
from .psql import Failed

suffixes = (".2dm",)


def write(mesh, file, z):
    if mesh.dimension != 2:
        raise Failed("2DM has triangles only, no tetrahedra: use .vtu or .npz")
    file.write(b"MESH2D\n")
    number = 0
    for _, corners in mesh.cells():
        lines = []
        for a, b, c in (corners + 1).tolist():
            number += 1
            lines.append(f"E3T {number} {a} {b} {c} 1\n")
        file.write("".join(lines).encode())
    number = 0
    for _, coordinates, values in mesh.points():
        lines = []
        for x, y, h in mesh.solid(coordinates, values, z).tolist():
            number += 1
            lines.append(f"ND {number} {x!r} {y!r} {h!r}\n")
        file.write("".join(lines).encode())
