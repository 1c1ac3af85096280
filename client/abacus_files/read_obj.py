"""Wavefront OBJ: triangles as text. Places of textures and normals are not read."""
from .grid import Grid
from .psql import Failed
from .words import floats, integers, read_text

suffixes = (".obj",)
UNREAD = {"vn": "normals", "vt": "places in textures"}
SHAPES = {"curv", "curv2", "surf"}


def place(word, count):
    """A corner's place from 0. OBJ counts from 1, and negative numbers back from the last vertex so far."""
    number = int(word.split("/", 1)[0])
    at = number - 1 if number > 0 else count + number
    if number == 0 or at < 0:
        raise Failed(f"a face has the corner {number} where there are {count} vertices")
    return at


def read(path):
    vertices, corners, notes, left = [], {}, [], {}
    for line in read_text(path).replace("\\\n", " ").split("\n"):
        words = line.split("#", 1)[0].split()
        if not words:
            continue
        if words[0] == "v":
            if len(words) < 3:
                raise Failed(f"a vertex has fewer than two coordinates: {line.strip()}")
            vertices.append((words[1:4] + ["0"])[:3])
            if len(words) > 5:
                left["colours of vertices"] = None
        elif words[0] == "f":
            count = len(words) - 1
            corners.setdefault(count, []).extend(place(word, len(vertices)) for word in words[1:])
        elif words[0] in UNREAD:
            left[UNREAD[words[0]]] = None
        elif words[0] in ("l", "p"):
            left["lines and points"] = None
        elif words[0] in SHAPES:
            raise Failed("has curves or curved surfaces; only triangles make a mesh")
    if left:
        notes.append(f"left out: {', '.join(left)}")
    kinds = {3: "triangle", 4: "quad"}
    return Grid(floats(word for vertex in vertices for word in vertex).reshape(-1, 3),
                {kinds.get(count, f"polygon of {count}"): integers(places).reshape(-1, count) for count, places in corners.items()}, notes=notes)
