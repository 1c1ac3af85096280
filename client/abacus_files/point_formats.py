"""Which reader of points a file's name asks for. A module has `types` of attributes, those that are `usual`, prepare(path) and a Reader."""
import os

from . import read_asc, read_las, read_tiff

READERS = {suffix: module for module in (read_asc, read_las, read_tiff) for suffix in module.suffixes}


def reader(path):
    """None if the file is a mesh, or something else."""
    return READERS.get(os.path.splitext(path)[1].lower())
