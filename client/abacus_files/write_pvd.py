"""PVD: a time series for ParaView, a list of VTU files that lie beside it, one a step."""
import os
import pathlib

from . import write_vtu
from .held import loss
from .series import Series, Step

suffixes = (".pvd",)
holds = ("labels",)


def write(mesh, file, z, query):
    """Writes NAME_0000.vtu and so on beside NAME.pvd, and the list into `file`."""
    series = Series(mesh.session, query)
    stem = pathlib.Path(file.name.removesuffix(".part")).with_suffix("")
    digits = max(4, len(str(len(series.steps))))
    done, lines = [], []
    mesh.will_read(len(series.steps), len(series.steps))
    try:
        for n, step in enumerate(series.steps):
            path = f"{stem}_{n:0{digits}}.vtu"
            done.append(path + ".part")
            with open(path + ".part", "wb") as grid:
                write_vtu.write(Step(mesh, series, step), grid, z)
            lines.append(f'<DataSet timestep="{step!r}" file="{os.path.basename(path)}"/>\n')
        while done:
            os.replace(done[-1], done[-1].removesuffix(".part"))
            done.pop()
    finally:
        for path in done:
            if os.path.exists(path):
                os.remove(path)
    file.write(f'<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">\n<Collection>\n'
               f'{"".join(lines)}</Collection>\n</VTKFile>\n'.encode())


def lost(mesh, z):
    return loss(mesh)
