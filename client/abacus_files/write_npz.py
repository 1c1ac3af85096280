"""An archive of numpy arrays: `points` and `simplices` as scipy.spatial.Delaunay has them, `ids`, `values`, `codes`, `attributes`.

The members are written one after the other, so each takes a pass of its own over its rows and none of them memory.
"""
import zipfile

import numpy

suffixes = (".npz",)


def member(archive, name, dtype, shape, chunks):
    header = {"descr": numpy.dtype(dtype).str, "fortran_order": False, "shape": shape}
    with archive.open(name + ".npy", "w", force_zip64=True) as out:
        numpy.lib.format.write_array_header_1_0(out, header)
        for chunk in chunks:
            out.write(numpy.ascontiguousarray(chunk, dtype).tobytes())


def write(mesh, file, z):
    n, m = mesh.vertices, mesh.simplices
    with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
        member(archive, "points", "<f8", (n, mesh.dimension), (c for _, c, _ in mesh.points()))
        member(archive, "ids", "<i8", (n,), (i for i, _, _ in mesh.points()))
        if mesh.attributes:
            member(archive, "values", "<f8", (n, len(mesh.attributes)), (v for _, _, v in mesh.points()))
        member(archive, "simplices", "<i8", (m, mesh.dimension + 1), (c for _, c in mesh.cells()))
        member(archive, "codes", "<i8", (m,), (c for c, _ in mesh.cells()))
        names = numpy.array(mesh.attributes, dtype=str)
        member(archive, "attributes", names.dtype, names.shape, [names])
