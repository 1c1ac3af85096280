"""Which writer a file's name asks for."""
import pathlib

from . import write_2dm, write_geojson, write_npz, write_obj, write_ply, write_pvd, write_vtu
from .psql import Failed

WRITERS = {suffix: module for module in (write_2dm, write_geojson, write_npz, write_obj, write_ply, write_pvd, write_vtu) for suffix in module.suffixes}


def writer(path):
    suffix = pathlib.Path(path).suffix.lower()
    if suffix not in WRITERS:
        raise Failed(f"{path}: the suffix is not that of a known format; known are {', '.join(sorted(WRITERS))}")
    return WRITERS[suffix].write
