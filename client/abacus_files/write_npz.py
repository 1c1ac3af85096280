"""An archive of numpy arrays: `points` and `simplices` as scipy.spatial.Delaunay has them, `ids`, `values`, `codes`, `labels`, `facets` and their
`markers`, and the names in `attributes` and `label_names`.

The members stand one after the other in the archive, but come from the same rows. So one pass over the rows writes the first of them, and keeps
the others in files beside the archive until it is their turn: no row is asked for twice, and none takes memory.
"""
import contextlib
import os
import shutil
import tempfile
import zipfile

import numpy

from .held import loss

suffixes = (".npz",)
holds = ("labels",)


@contextlib.contextmanager
def member(archive, name, dtype, shape):
    """A new array of the archive, to which its bytes are written."""
    with archive.open(name + ".npy", "w", force_zip64=True) as out:
        numpy.lib.format.write_array_header_1_0(out, {"descr": numpy.dtype(dtype).str, "fortran_order": False, "shape": shape})
        yield out


def members(archive, folder, arrays, chunks):
    """Arrays of (name, type, shape), which chunks have in this order."""
    with contextlib.ExitStack() as stack:
        waiting = [stack.enter_context(tempfile.TemporaryFile(dir=folder)) for _ in arrays[1:]]
        with member(archive, *arrays[0]) as out:
            for chunk in chunks:
                for file, part, (_, dtype, _) in zip([out, *waiting], chunk, arrays):
                    file.write(numpy.ascontiguousarray(part, dtype).tobytes())
        for file, array in zip(waiting, arrays[1:]):
            file.seek(0)
            with member(archive, *array) as out:
                shutil.copyfileobj(file, out, 1 << 20)


def write_names(archive, member_name, names):
    array = numpy.array(names, dtype=str)
    with member(archive, member_name, array.dtype, array.shape) as out:
        out.write(array.tobytes())


def refusal(mesh, z):
    """Why the format cannot have the mesh, or None."""
    if z is not None:
        return "arrays have all attributes, as values: --z is for other formats"
    return None


def write(mesh, file, z):
    n, m, count, labels = mesh.vertices, mesh.simplices, len(mesh.attributes), len(mesh.labels)
    folder = os.path.dirname(os.path.abspath(file.name))
    with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
        vertices = [("points", "<f8", (n, mesh.dimension)), ("ids", "<i8", (n,)), ("values", "<f8", (n, count))]
        members(archive, folder, vertices if count else vertices[:2], ((points, ids, values) for ids, points, values in mesh.points()))
        cells = [("simplices", "<i8", (m, mesh.corners)), ("codes", "<i8", (m,)), ("labels", "<f8", (m, labels))]
        members(archive, folder, cells if labels else cells[:2], ((corners, codes, values) for codes, corners, values in mesh.cells()))
        if mesh.facets:
            members(archive, folder, [("facets", "<i8", (mesh.facets, mesh.dimension)), ("markers", "<i4", (mesh.facets,))], mesh.marked_facets())
        write_names(archive, "attributes", mesh.attributes)
        if labels:
            write_names(archive, "label_names", mesh.labels)


def lost(mesh, z):
    return loss(mesh)
