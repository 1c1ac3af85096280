"""Wavefront OBJ: triangles, or the quadrangles of a quadtree, as text."""
from .held import loss

suffixes = (".obj",)


def refusal(mesh, z):
    """Why the format cannot have the mesh, or None."""
    if mesh.dimension != 2:
        return "OBJ has faces only, no tetrahedra: use .vtu or .npz"
    return None


def write(mesh, file, z):
    for _, coordinates, values in mesh.points():
        file.write("".join(f"v {x!r} {y!r} {h!r}\n" for x, y, h in mesh.solid(coordinates, values, z).tolist()).encode())
    for _, corners, _ in mesh.cells():
        file.write("".join(f"f {' '.join(map(str, row))}\n" for row in (corners + 1).tolist()).encode())


def lost(mesh, z):
    others = [name for n, name in enumerate(mesh.attributes) if n != z]
    return loss(mesh, ids=False, attributes=f"attributes of points ({', '.join(others)})" if others else True, labels=False, markers=False)
