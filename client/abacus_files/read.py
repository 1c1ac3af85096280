"""Which reader a file's name asks for."""
import os
import sys

from . import apart, octree_input, read_2dm, read_landxml, read_medit, read_msh, read_npz, read_obj, read_off, read_other, read_ply, read_poly, read_tetgen, read_vtu, read_xdmf, xml_stream
from .input import Input
from .plan_input import PlanInput
from .psql import Failed

READERS = {suffix: module for module in (read_2dm, read_landxml, read_medit, read_msh, read_npz, read_obj, read_off, read_ply, read_poly, read_tetgen, read_vtu, read_xdmf)
           for suffix in module.suffixes}
DOLFIN = "dolfin"  # of FEniCS, writes .xml, too, which meshio reads


def reader(path):
    module = READERS.get(os.path.splitext(path)[1].lower(), read_other)
    return read_other if module is read_landxml and xml_stream.root(path) == DOLFIN else module


def read_here(path, keep_apart, surface=None):
    """The grid of a file, read in this process. `keep_apart`: vertices at one place. `surface`: the name of one of LandXML."""
    module = reader(path)
    if module is read_landxml:
        return module.read(path, surface)
    if surface is not None:
        raise Failed("has no surfaces: --surface is for LandXML")
    return module.read(path, keep_apart) if module in (read_vtu, read_xdmf) else module.read(path)


def read_file(path, keep_apart, surface=None, retriangulate=False):
    """What a file has, of a mesh, of points and lines, or of an octree. It is read in a process of its own; errors name the file."""
    try:
        grid = apart.read(path, keep_apart=keep_apart, surface=surface)
        leaves = octree_input.kind_of(grid)
        found = PlanInput(grid, retriangulate) if grid.plan else octree_input.OctreeInput(grid, leaves) if leaves else Input(grid)
    except Failed as error:
        raise Failed(f"{path}: {error}") from error
    for note in found.notes:
        print(f"abacus-import: {path}: {note}", file=sys.stderr)
    return found
