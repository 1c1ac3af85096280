"""OFF of Geomview: triangles as text."""
import re

from .grid import Grid
from .psql import Failed
from .words import floats, integers, read_text

suffixes = (".off",)


def read(path):
    lines = (line.split("#", 1)[0].split() for line in read_text(path).split("\n"))
    rows = [words for words in lines if words]
    if not rows or not re.fullmatch("(ST)?C?N?OFF", rows[0][0]):
        raise Failed("does not begin with OFF, COFF, NOFF or the like")
    head = rows.pop(0)[1:]  # the counts may stand beside it
    if not head and rows:
        head = rows.pop(0)
    if len(head) < 2:
        raise Failed("does not say how many vertices and faces it has")
    vertices, faces = int(head[0]), int(head[1])
    if min(vertices, faces) < 0 or len(rows) < vertices + faces:
        raise Failed(f"says that it has {vertices} vertices and {faces} faces, but ends after {len(rows)} lines of them")
    short = next((row for row in rows[:vertices] if len(row) < 3), None)
    if short:
        raise Failed(f"a vertex has fewer than three coordinates: {' '.join(short)}")
    points = floats(word for row in rows[:vertices] for word in row[:3]).reshape(-1, 3)
    left = {}
    if any(len(row) > 3 for row in rows[:vertices]):
        left["colours, normals and the like of vertices"] = None
    corners = {}
    for row in rows[vertices: vertices + faces]:
        count = int(row[0])
        if not 1 <= count < len(row):
            raise Failed(f"a face has fewer corners than it says: {' '.join(row)}")
        corners.setdefault(count, []).extend(row[1: count + 1])
        if len(row) > count + 1:
            left["colours of faces"] = None
    kinds = {1: "vertex", 2: "line", 3: "triangle", 4: "quad"}
    return Grid(points, {kinds.get(count, f"polygon of {count}"): integers(words).reshape(-1, count) for count, words in corners.items()},
                notes=[f"left out: {', '.join(left)}"] if left else [])
