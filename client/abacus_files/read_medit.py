"""Medit's .mesh in text and .meshb in binary: references of simplices are materials, those of facets markers."""
import numpy

from .grid import Grid
from .medit_words import MAGIC, BinaryWords, TextWords
from .psql import Failed

suffixes = (".mesh", ".meshb")
# {keyword: (name of meshio, corners)}
KINDS = {"Edges": ("line", 2), "Triangles": ("triangle", 3), "Quadrilaterals": ("quad", 4), "Tetrahedra": ("tetra", 4), "Prisms": ("wedge", 6),
         "Pyramids": ("pyramid", 5), "Hexahedra": ("hexahedron", 8), "EdgesP2": ("line3", 3), "TrianglesP2": ("triangle6", 6),
         "TetrahedraP2": ("tetra10", 10)}
SILENT = ("MeshVersionFormatted", "End", "BoundingBox")


def read(path):
    with open(path, "rb") as file:
        data = file.read()
    words = BinaryWords(data) if data[:4] in MAGIC else TextWords(data.decode(errors="replace"))
    dimension, points, references, cells, labels, markers, left = None, None, None, {}, {}, {}, []
    ended = False
    for keyword in words.keywords():
        if keyword == "Dimension":
            dimension = words.whole("Dimension")
            if dimension not in (2, 3):
                words.fail(f"the dimension is {dimension}, not 2 or 3")
        elif keyword == "Vertices":
            if dimension is None or points is not None:
                words.fail("Vertices without a Dimension before them, or for the second time")
            points, references = words.table("Vertices", dimension, 1)
            words.points_begun(dimension + 1)
        elif keyword in KINDS:
            kind, corners = KINDS[keyword]
            if kind in cells:
                words.fail(f"{keyword} for the second time")
            found, marks = words.table(keyword, 0, corners + 1)
            cells[kind] = words.corners(marks[:, :corners], 0 if points is None else len(points), keyword, corners + 1)
            if marks[:, corners].any() and kind.startswith(("tetra", "triangle")):
                labels[kind, "material"] = marks[:, corners].astype(float)
            if marks[:, corners].any() and kind.startswith(("triangle", "line")):
                markers[kind] = marks[:, corners]
        elif keyword not in SILENT:
            left.append(keyword)
        ended = ended or keyword == "End"
    if points is None:
        raise Failed("has no Vertices")
    notes = [f"left out: {', '.join(dict.fromkeys(left))}"] if left else []
    if not ended:
        notes.append("has no End, so it may be cut off")
    data = {"medit:ref": references[:, 0]} if references.any() else {}
    lines = {"points": words.line_of_point} if words.line_of_point else {}
    return Grid(points, cells, ids=numpy.arange(1, len(points) + 1), data=data, labels=labels, markers=markers, notes=notes, lines=lines)
