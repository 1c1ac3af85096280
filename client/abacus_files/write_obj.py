"""Wavefront OBJ: triangles as text."""
from .psql import Failed

suffixes = (".obj",)


def write(mesh, file, z):
    if mesh.dimension != 2:
        raise Failed("OBJ has faces only, no tetrahedra: use .vtu or .npz")
    for _, coordinates, values in mesh.points():
        file.write("".join(f"v {x!r} {y!r} {h!r}\n" for x, y, h in mesh.solid(coordinates, values, z).tolist()).encode())
    for _, corners in mesh.cells():
        file.write("".join(f"f {a} {b} {c}\n" for a, b, c in (corners + 1).tolist()).encode())
