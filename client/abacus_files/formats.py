"""Which writer a file's name asks for."""
import pathlib

from . import write_2dm, write_geojson, write_glb, write_landxml, write_npz, write_obj, write_ply, write_poly, write_pvd, write_vtu, write_xdmf
from .psql import Failed

WRITERS = {suffix: module for module in (write_2dm, write_geojson, write_glb, write_landxml, write_npz, write_obj, write_ply, write_poly, write_pvd, write_vtu, write_xdmf)
           for suffix in module.suffixes}
OF_SERIES = (*write_pvd.suffixes, *write_xdmf.suffixes)  # write a series of steps, .pvd nothing else
OF_SURFACES = write_glb.suffixes  # write surfaces of a mesh, which are chosen


def writer(path):
    """The module: write(mesh, file, z), lost(mesh, z), what the format cannot hold, and perhaps `holds`, what only few formats do (Mesh.unheld), and
    refusal(mesh, z), why it cannot have the mesh."""
    suffix = pathlib.Path(path).suffix.lower()
    if suffix not in WRITERS:
        raise Failed(f"{path}: the suffix is not that of a known format; known are {', '.join(sorted(WRITERS))}")
    return WRITERS[suffix]
