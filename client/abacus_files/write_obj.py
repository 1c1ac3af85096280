"""Wavefront OBJ: triangles, or the quadrangles of a quadtree, as text."""
from .held import loss
from .psql import Failed

suffixes = (".obj",)


def write(mesh, file, z):
    if mesh.dimension != 2:
        raise Failed("OBJ has faces only, no tetrahedra: use .vtu or .npz")
    for _, coordinates, values in mesh.points():
        file.write("".join(f"v {x!r} {y!r} {h!r}\n" for x, y, h in mesh.solid(coordinates, values, z).tolist()).encode())
    for _, corners, _ in mesh.cells():
        file.write("".join(f"f {' '.join(map(str, row))}\n" for row in (corners + 1).tolist()).encode())


def lost(mesh, z):
    others = [name for n, name in enumerate(mesh.attributes) if n != z]
    return loss(mesh, ids=False, attributes=f"attributes of points ({', '.join(others)})" if others else True, labels=False, markers=False)
