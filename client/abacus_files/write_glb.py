"""glTF 2.0 as one file: surfaces with normals, attributes of vertices and colours.

glTF has 32-bit floats, so places are relative to an origin, which the file names. Its y is up: a matrix turns x, y and z to x, -z and y.
"""
import json
import struct

import numpy

from .arrays import unlike
from .english import counted
from .held import loss
from .normals import normals
from .psql import Failed

suffixes = (".glb",)
holds = ("srid",)
GREATEST = float(numpy.finfo("<f4").max)
MOST_BYTES = (1 << 32) - 1
JSON, BINARY, ARRAY, ELEMENTS, USHORT, UINT, FLOAT = 0x4E4F534A, 0x004E4942, 34962, 34963, 5123, 5125, 5126

# Those of M. Okabe and K. Ito, which the colour-blind can tell apart, as regions have them; and a palette of attributes, viridis.
COLOURS = ("56b4e9", "e69f00", "009e73", "cc79a7", "f0e442", "d55e00", "0072b2")
PALETTE = ("440154", "472d7b", "3b528b", "2c728e", "21908c", "27ad81", "5dc863", "aadc32", "fde725")
UNKNOWN = "cfccc6"  # where a vertex has no value


def light(colour):
    """The linear light of a colour of the screen."""
    part = numpy.frombuffer(bytes.fromhex(colour), "u1") / 255
    return numpy.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)


def refusal(surfaces, z):
    return None


def origin(surfaces):
    """The middle of all points, rounded to a power of two not greater than the extent: few digits, and a place near by."""
    lower = numpy.min([part.points.min(axis=0) for part in surfaces.parts], axis=0)
    upper = numpy.max([part.points.max(axis=0) for part in surfaces.parts], axis=0)
    half = (upper / 2 - lower / 2).max()
    if half * 2 > GREATEST:
        raise Failed(f"glTF has 32-bit floats, which end at {GREATEST:.3g}: the mesh is wider. Use .vtu or .ply")
    step = 2.0 ** numpy.floor(numpy.log2(half)) if half > 0 else 1.0
    return numpy.rint((lower / 2 + upper / 2) / step) * step


def relative(points, origin):
    return (points - origin).astype("<f4")


def is_held(values):
    """Whether an attribute can be one of glTF, where no value may be missing or infinite."""
    return bool((numpy.abs(values) <= GREATEST).all())  # not if it is NaN


def names_of(attributes):
    """glTF wants a _ before them and recommends capitals."""
    return unlike(("_" + "".join(c if c.isalnum() and c.isascii() else "_" for c in name.upper()) for name in attributes), ())


def lost(surfaces, z):
    mesh, middle = surfaces.mesh, origin(surfaces)
    gone, rounded, off = [], [], 0.0
    for part in surfaces.parts:
        off = max(off, numpy.abs(middle + relative(part.points, middle) - part.points).max())
    for n, name in enumerate(surfaces.attributes):
        values = [part.values[:, n] for part in surfaces.parts]
        if not all(map(is_held, values)):
            gone.append(name)
        elif any((v.astype("<f4") != v).any() for v in values):
            rounded.append(name)
    digits = [f"all digits of {what}" for what in ([f"coordinates, which are rounded by up to {off:.2g}"] if off > 0 else []) + (
        [f"attributes ({', '.join(rounded)})"] if rounded else [])]
    left_out = f"attributes with a value that is missing or beyond floats ({', '.join(gone)})" if gone else True
    return loss(mesh, ids=False, attributes=left_out, labels=labels_lost(surfaces), markers=mesh.facets == 0) + digits


def labels_lost(surfaces):
    shown = {part.of.get("label") for part in surfaces.parts}
    others = [name for name in surfaces.mesh.labels if name not in shown]
    return f"labels of cells ({', '.join(others)})" if others else True


class Parts:
    """The arrays of a file, and what its JSON says of them."""

    def __init__(self):
        self.arrays, self.views, self.accessors, self.size = [], [], [], 0

    def add(self, array, kind, component, target, **more):
        """Returns its number."""
        self.arrays.append(array)
        self.views.append({"buffer": 0, "byteOffset": self.size, "byteLength": array.nbytes, "target": target})
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": component, "count": len(array), "type": kind, **more})
        self.size += array.nbytes
        return len(self.accessors) - 1


def colours(values, low, high):
    stops = numpy.array([light(colour) for colour in PALETTE])
    place = numpy.clip((values / 2 - low / 2) / (high / 2 - low / 2) if low < high else numpy.full(len(values), 0.5), 0, 1) * (len(stops) - 1)
    known = numpy.isfinite(place)
    before = numpy.minimum(numpy.where(known, place, 0).astype(int), len(stops) - 2)
    share = (place - before)[:, None]
    mixed = numpy.where(known[:, None], stops[before] * (1 - share) + stops[before + 1] * share, light(UNKNOWN))
    return numpy.column_stack([numpy.rint(mixed * 65535), numpy.full(len(values), 65535)]).astype("<u2")


def range_of(surfaces, colour):
    """The place of the attribute that gives colours, its least value and its greatest one."""
    if colour not in surfaces.attributes:
        raise Failed(f"the mesh has no attribute {colour}; it has: {', '.join(surfaces.attributes) or 'none'}")
    n = surfaces.attributes.index(colour)
    values = numpy.concatenate([part.values[:, n] for part in surfaces.parts])
    values = values[numpy.isfinite(values)]
    if not len(values):
        raise Failed(f"no vertex of the surface has a value of {colour}, so it cannot give colours")
    return n, float(values.min()), float(values.max())


def described(surfaces, colour):
    """The JSON, and the arrays."""
    middle, parts, meshes = origin(surfaces), Parts(), []
    names = names_of(surfaces.attributes)
    shaded = range_of(surfaces, colour) if colour is not None else None
    for number, part in enumerate(surfaces.parts):
        points = relative(part.points, middle)
        attributes = {"POSITION": parts.add(points, "VEC3", FLOAT, ARRAY, min=points.min(axis=0).tolist(), max=points.max(axis=0).tolist()),
                      "NORMAL": parts.add(normals(part.points - middle, part.triangles).astype("<f4"), "VEC3", FLOAT, ARRAY)}
        if shaded:
            attributes["COLOR_0"] = parts.add(colours(part.values[:, shaded[0]], *shaded[1:]), "VEC4", USHORT, ARRAY, normalized=True)
        held = {names[n]: name for n, name in enumerate(surfaces.attributes) if all(is_held(each.values[:, n]) for each in surfaces.parts)}
        for n, name in enumerate(names):
            if name in held:
                attributes[name] = parts.add(part.values[:, n].astype("<f4"), "SCALAR", FLOAT, ARRAY)
        indices = parts.add(part.triangles.ravel().astype("<u4"), "SCALAR", UINT, ELEMENTS)
        of_colour = {"colour": {"attribute": colour, "from": shaded[1], "to": shaded[2]}} if shaded else {}
        meshes.append({"name": part.name, "primitives": [{"attributes": attributes, "indices": indices, "material": number}],
                       "extras": {**part.of, "attributes": held, **of_colour}})
    one = len(meshes) == 1
    materials = [{"name": mesh["name"], "doubleSided": True, "pbrMetallicRoughness": {
        "baseColorFactor": [*(light(COLOURS[n % len(COLOURS)]).tolist() if not shaded else [1, 1, 1]), 1], "metallicFactor": 0, "roughnessFactor": 1}}
        for n, mesh in enumerate(meshes)]
    upright = {"name": surfaces.mesh.name, "matrix": [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1]}
    nodes = [{**upright, "mesh": 0}] if one else [{**upright, "children": list(range(1, len(meshes) + 1))},
                                                 *({"name": mesh["name"], "mesh": n} for n, mesh in enumerate(meshes))]
    extras = {"origin": middle.tolist(), **({"srid": surfaces.mesh.srid} if surfaces.mesh.srid > 0 else {})}
    return {"asset": {"version": "2.0", "generator": "Abacus", "extras": extras}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes, "meshes": meshes,
            "materials": materials, "accessors": parts.accessors, "bufferViews": parts.views, "buffers": [{"byteLength": parts.size}]}, parts


def write(surfaces, file, z, colour=None):
    description, parts = described(surfaces, colour)
    text = json.dumps(description, allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    size = 12 + 8 + len(text) + 8 + parts.size
    if size > MOST_BYTES:
        raise Failed(f"glTF's files end at 4 GB, and this one would have {counted(size, 'byte')}: use .vtu, or a part of the mesh")
    file.write(struct.pack("<4sIIII", b"glTF", 2, size, len(text), JSON) + text + struct.pack("<II", parts.size, BINARY))
    for array in parts.arrays:
        file.write(numpy.ascontiguousarray(array).tobytes())
