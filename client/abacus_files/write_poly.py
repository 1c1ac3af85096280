"""Triangle's .poly: points, the segments of lines with their markers, holes and regions. Comments have the rest (poly_words.py)."""
import json
import re

from . import poly_words
from .english import counted
from .held import doubles_hold_ids, loss
from .mesh_lines import Corners, Markers, regions
from .plan import HOLE
from .seeds import seeds

suffixes = (".poly",)
NUMBER = r"-?\d+(\.\d+)?"
holds = ("lines", "regions", "srid")


def numbered_by_ids(mesh):
    """Whether the ids are what Triangle asks for: one after the other, from 0 or 1."""
    least, greatest = mesh.id_range()
    return least in (0, 1) and greatest - least + 1 == mesh.vertices and mesh.ids_differ()


def ids_held(mesh):
    return "id" not in mesh.attributes and doubles_hold_ids(mesh)


def write_points(mesh, file, by_ids):
    """The points, in the order of their numbers; their ids are an attribute if they are not the numbers."""
    with_ids = not by_ids and ids_held(mesh)
    names = ["id"] * with_ids + mesh.attributes
    if names:
        file.write(f"{poly_words.PREFIX}attributes {json.dumps(names)}\n".encode())
    if mesh.srid > 0:
        file.write(f"{poly_words.PREFIX}srid {mesh.srid}\n".encode())
    file.write(f"{mesh.vertices} 2 {len(names)} 0\n".encode())
    number = 0
    for ids, coordinates, values in mesh.points(order="ORDER BY id" if by_ids else ""):
        rows = []
        for id_, place, of in zip(ids.tolist(), coordinates.tolist(), values.tolist()):
            number += 1
            rows.append(" ".join([str(id_ if by_ids else number), *map(repr, place), *([str(id_)] if with_ids else []), *map(repr, of)]) + "\n")
        file.write("".join(rows).encode())


def write_segments(mesh, file, by_ids):
    corners = Corners(mesh)
    markers = Markers(mesh, corners).of
    segments = corners.segments()
    heads = set(corners.begins().tolist())
    number = corners.id if by_ids else corners.number + 1
    file.write(f"{len(segments)} 1\n".encode())
    for n, at in enumerate(segments.tolist(), 1):
        if at in heads:
            part = None if corners.part[at] < 0 else corners.part[at]
            file.write(poly_words.line(corners.line[at], corners.soft[at], part).encode())
        file.write(f"{n} {number[at]} {number[at + 1]} {markers.get(at, 0)}\n".encode())


def write_regions(mesh, file):
    """Holes, which are the region of that name, and regions. Their attributes are their names if all of these are numbers."""
    found = [(name, number, lines, places or seeds(mesh, name)) for name, number, lines, places in regions(mesh)]
    numeric = all(re.fullmatch(NUMBER, name) for name, *_ in found if name != HOLE)
    for is_hole in True, False:
        of = [entry for entry in found if (entry[0] == HOLE) == is_hole]
        file.write(f"{sum(len(places) for *_, places in of)}\n".encode())
        n = 0
        for name, number, lines, places in of:
            file.write(poly_words.region(name, lines).encode())
            for x, y in places:
                n += 1
                file.write(f"{n} {x!r} {y!r}{'' if is_hole else f' {name if numeric else number} -1'}\n".encode())


def refusal(mesh, z):
    """Why the format cannot have the mesh, or None."""
    if mesh.dimension != 2 or mesh.corners != 3:
        return ".poly has points and segments in the plane: use .vtu or .npz"
    if z is not None:
        return ".poly has all attributes of points, and no third coordinate: leave out --z"
    if mesh.within:
        return ".poly has no triangles, so none of a region: leave out --within"
    return None


def write(mesh, file, z):
    by_ids = numbered_by_ids(mesh)
    write_points(mesh, file, by_ids)
    write_segments(mesh, file, by_ids)
    write_regions(mesh, file)


def lost(mesh, z):
    free = Markers(mesh, Corners(mesh)).lost
    return loss(mesh, ids=numbered_by_ids(mesh) or (ids_held(mesh) and (mesh.ids_differ() or "ids of points (some are equal)")), labels=False) + (
        [f"markers of {counted(free, 'edge')} (only whole segments of lines have markers)"] if free else []) + mesh.not_delaunay()
