"""Every other format, by meshio: VTK's old format, Abaqus, Nastran, SU2 and more.

Where a format says how many points and cells a file has, this is compared with what meshio has made of it.
"""
import os
import re

import numpy

from . import cell_arrays
from .grid import OF_HIGHER_ORDER, Grid
from .psql import Failed

# {suffix: (what says the number of points, what says the number of cells of a kind or of all)}, in text and in VTK's binary files
COUNTS = {".vtk": (rb"^POINTS\s+(\d+)", {None: rb"^CELL_TYPES\s+(\d+)"}),
          ".vol": (rb"^points\s+(\d+)", {"tetra": rb"^volumeelements\s+(\d+)"}),
          ".msh": (rb"^\(10 \(0 1 ([0-9a-fA-F]+)", {}),  # of ANSYS Fluent
          ".su2": (rb"^[ \t]*NPOIN\s*=\s*(\d+)", {}),
          ".ugrid": (rb"\A\s*(\d+)", {"triangle": rb"\A\s*\d+\s+(\d+)", "tetra": rb"\A\s*\d+\s+\d+\s+\d+\s+(\d+)"})}


def count_in(data, pattern, base):
    """The sum of what a file says; None where it says nothing."""
    found = [int(number, base) for number in re.findall(pattern, data, re.MULTILINE)]
    return sum(found) if found else None


def compare(path, points, cells):
    suffix = os.path.splitext(path)[1].lower()
    pattern, kinds = COUNTS.get(suffix, (None, {}))
    if pattern is None:
        return
    with open(path, "rb") as file:
        data = file.read()
    checks = [("points", pattern, len(points))]
    for kind, each in kinds.items():
        checks.append((f"cells ({kind})" if kind else "cells", each, sum(len(found) for name, found in cells.items() if kind in (None, name))))
    for what, each, found in checks:
        said = count_in(data, each, 16 if suffix == ".msh" else 10)
        if said is not None and said != found:
            raise Failed(f"says that it has {said} {what}, but meshio reads {found}; it may be cut off, or meshio misreads it")


def read(path):
    try:
        import meshio
    except ImportError as error:
        raise Failed("this format is read by meshio, which is not installed (python3-meshio in Debian, meshio in PyPI)") from error
    try:
        mesh = meshio.read(path)
    except SystemExit as error:  # meshio's way where it cannot go on
        raise Failed("is not a file that meshio can read") from error
    blocks = {}
    for block in mesh.cells:
        blocks.setdefault(block.type, []).append(block.data)
    cells = {kind: numpy.concatenate(parts) if kind == "vertex" or OF_HIGHER_ORDER.fullmatch(kind) else numpy.zeros((sum(map(len, parts)), 1), int)
             for kind, parts in blocks.items()}
    compare(path, mesh.points, cells)
    grid = Grid(mesh.points, cells, data=mesh.point_data)
    kinds = [block.type for block in mesh.cells]
    cell_arrays.take(grid, {name: by_kind(kinds, parts) for name, parts in mesh.cell_data.items()})
    return grid


def by_kind(kinds, parts):
    """An array of cells, which meshio has block by block, as {kind: values}."""
    found = {}
    for kind, part in zip(kinds, parts):
        found.setdefault(kind, []).append(numpy.asarray(part))
    return {kind: numpy.concatenate(of) for kind, of in found.items()}
