"""TetGen's and Triangle's .node and .ele, two files of one name."""
import pathlib

import numpy

from .grid import Grid
from .psql import Failed
from .words import Words, floats, integers, places, read_text

suffixes = (".node", ".ele")
KINDS = {(2, 3): "triangle", (2, 6): "triangle6", (3, 4): "tetra", (3, 10): "tetra10"}


def head(words, line, least):
    """The numbers of the first line; those that are left out are 0."""
    found = [int(word) for word in line]
    if len(found) < least or min(found) < 0:
        raise Failed(f"the first line has fewer than {least} numbers, or a negative one")
    words.take(len(found), "numbers of the first line")
    return found + [0] * (4 - len(found))


def open_part(path, suffix):
    """Its words, and those of the first line, which says how many rows there are."""
    text = read_text(path.with_suffix(suffix))
    lines = (line.split("#", 1)[0].split() for line in text.split("\n"))
    return Words(text), next((line for line in lines if line), [])


def read_nodes(path, suffix):
    words, line = open_part(path, suffix)
    count, dimension, attributes, markers = head(words, line, 2)[:4]
    if dimension not in (2, 3):
        raise Failed(f"its points have {dimension} coordinates, not 2 or 3")
    width = 1 + dimension + attributes + markers
    table = words.table(count, width, "points")
    values = floats(table).reshape(count, width)
    names = [f"tetgen:attr{k + 1}" for k in range(attributes)] + [f"tetgen:ref{k + 1 if k else ''}" for k in range(markers)]
    return integers(table[::width]), values[:, 1: 1 + dimension], {name: values[:, 1 + dimension + k] for k, name in enumerate(names)}


def read(path):
    path = pathlib.Path(path)
    upper = path.suffix.isupper()
    ids, points, data = read_nodes(path, ".NODE" if upper else ".node")
    words, line = open_part(path, ".ELE" if upper else ".ele")
    count, corners, attributes = head(words, line, 2)[:3]
    kind = KINDS.get((points.shape[1], corners))
    if kind is None:
        raise Failed(f"has cells of {corners} corners in {points.shape[1]} dimensions; only triangles and tetrahedra make a mesh")
    table = numpy.array(words.table(count, 1 + corners + attributes, "cells"), dtype=object).reshape(count, 1 + corners + attributes)
    cells = places(integers(table[:, 1: 1 + corners].reshape(-1)).reshape(count, corners), ids)
    return Grid(points, {kind: cells}, ids=ids, data=data, notes=["the regions of cells are left out"] if attributes else [])
