"""OFF of Geomview: triangles as text."""
import re

import numpy

from .english import counted
from .grid import Grid
from .psql import Failed
from .words import Rows, numbers, read_text

suffixes = (".off",)
KINDS = {1: "vertex", 2: "line", 3: "triangle", 4: "quad"}


def kind_of(count):
    return KINDS.get(count, f"polygon of {count}")


def counts(rows):
    """How many vertices and faces there are; they may stand beside the first word."""
    first = rows.row("its first line") if rows.more() else [""]
    if not re.fullmatch("(ST)?C?N?OFF", first[0]):
        raise Failed("line 1: does not begin with OFF, COFF, NOFF or the like")
    words = first[1:] or (rows.row("its counts") if rows.more() else [])
    at = rows.at - 1
    if len(words) < 2:
        rows.fail(at, "does not say how many vertices and faces it has")
    vertices, faces = numbers(words[:2], int, lambda n: rows.rows[at][0]).tolist()
    if min(vertices, faces) < 0 or len(rows.rows) - rows.at < vertices + faces:
        rows.fail(-1, f"says that it has {counted(vertices, 'vertex', 'vertices')} and {counted(faces, 'face')}, but ends after {counted(len(rows.rows) - rows.at, 'line')} of them")
    return vertices, faces


def read(path):
    rows = Rows(read_text(path))
    vertices, faces = counts(rows)
    begin = rows.at
    taken = rows.rows[begin: begin + vertices + faces]
    short = next((n for n, (_, words) in enumerate(taken[:vertices]) if len(words) < 3), None)
    if short is not None:
        rows.fail(begin + short, f"a vertex has fewer than three coordinates: {' '.join(taken[short][1])}")
    points = numbers([word for _, words in taken[:vertices] for word in words[:3]], float, lambda n: taken[n // 3][0]).reshape(-1, 3)
    left = {}
    if any(len(words) > 3 for _, words in taken[:vertices]):
        left["colours, normals and the like of vertices"] = None
    corners, lines = {}, {"points": [line for line, _ in taken[:vertices]]}
    for line, words in taken[vertices:]:
        count, = numbers(words[:1], int, lambda n, line=line: line).tolist()
        if not 1 <= count < len(words):
            raise Failed(f"line {line}: a face has fewer corners than it says: {' '.join(words)}")
        lines.setdefault(kind_of(count), []).append(line)
        corners.setdefault(count, []).extend(numbers(words[1: count + 1], int, lambda n, line=line: line).tolist())
        if len(words) > count + 1:
            left["colours of faces"] = None
    return Grid(points, {kind_of(count): numpy.array(places, dtype=numpy.int64).reshape(-1, count) for count, places in corners.items()},
                notes=[f"left out: {', '.join(left)}"] if left else [], lines={what: of.__getitem__ for what, of in lines.items()})
