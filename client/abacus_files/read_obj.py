"""Wavefront OBJ: triangles as text. Places of textures and normals are not read."""
import numpy

from .grid import Grid
from .psql import Failed
from .words import numbers, read_text

suffixes = (".obj",)
UNREAD = {"vn": "normals", "vt": "places in textures"}
SHAPES = {"curv", "curv2", "surf"}


def kind_of(count):
    return {3: "triangle", 4: "quad"}.get(count, f"polygon of {count}")


def place(n, word, count):
    """A corner's place from 0. OBJ counts from 1, and negative numbers back from the last vertex so far."""
    try:
        corner = int(numbers([word.split("/", 1)[0]], int, lambda _: n)[0])
    except Failed:
        raise Failed(f"line {n}: {word} is not a corner") from None
    at = corner - 1 if corner > 0 else count + corner
    if corner == 0 or at < 0:
        raise Failed(f"line {n}: a face has the corner {corner} where there are {count} vertices")
    return at


def read(path):
    vertices, lines, faces, corners, notes, left = [], [], {}, {}, [], {}
    n, after = 0, 1
    for line in read_text(path).replace("\\\n", "\r").split("\n"):  # no text has a \r of its own
        n, after = after, after + 1 + line.count("\r")
        words = line.split("#", 1)[0].split()
        if not words:
            continue
        if words[0] == "v":
            if len(words) < 3:
                raise Failed(f"line {n}: a vertex has fewer than two coordinates: {line.strip()}")
            vertices.append((words[1:4] + ["0"])[:3])
            lines.append(n)
            if len(words) > 5:
                left["colours of vertices"] = None
        elif words[0] == "f":
            count = len(words) - 1
            if count == 0:
                raise Failed(f"line {n}: a face without corners")
            faces.setdefault(kind_of(count), []).append(n)
            corners.setdefault(count, []).extend(place(n, word, len(vertices)) for word in words[1:])
        elif words[0] in UNREAD:
            left[UNREAD[words[0]]] = None
        elif words[0] in ("l", "p"):
            left["lines and points"] = None
        elif words[0] in SHAPES:
            raise Failed(f"line {n}: has curves or curved surfaces; only triangles make a mesh")
    if left:
        notes.append(f"left out: {', '.join(left)}")
    points = numbers([word for vertex in vertices for word in vertex], float, lambda at: lines[at // 3]).reshape(-1, 3)
    lines_of = {"points": lines.__getitem__, **{kind: of.__getitem__ for kind, of in faces.items()}}
    return Grid(points, {kind_of(count): numpy.array(places, dtype=numpy.int64).reshape(-1, count)
                         for count, places in corners.items()}, notes=notes, lines=lines_of)
