#!/usr/bin/python3
"""What CuPy takes on an NVIDIA GPU for what core_in_memory does: the triangulation of points in the plane, and linear
interpolation at places, of the same points, values and places.

    cupy_peer.py                       says which GPU and which versions there are, as JSON
    cupy_peer.py FILE PLACES RUNS      a line of JSON for each run

A program of its own: where there is no such GPU, or no CuPy, it says so and ends with 77. All is in the memory of the
GPU before, and the first run, in which CuPy compiles its kernels, is not counted.
"""
import json
import sys
import time

NOT_HERE = 77


def leave(why):
    print(why, file=sys.stderr)
    sys.exit(NOT_HERE)


def gpu():
    """CuPy, and what it runs on."""
    try:
        import cupy
    except ImportError as error:
        leave(f"CuPy cannot be imported ({error})")
    runtime = cupy.cuda.runtime
    if runtime.is_hip:
        leave("CuPy is for AMD's GPUs here")
    try:
        if runtime.getDeviceCount() == 0:
            leave("there is no NVIDIA GPU")
        name = runtime.getDeviceProperties(0)["name"]
    except runtime.CUDARuntimeError as error:
        leave(f"there is no NVIDIA GPU ({error})")
    version = runtime.runtimeGetVersion()
    return cupy, {"gpu": name.decode() if isinstance(name, bytes) else name,
                  "packages": {"cupy": cupy.__version__, "cuda": f"{version // 1000}.{version % 1000 // 10}"}}


def measure(cupy, file, count, runs):
    import numpy
    from cupyx.scipy.interpolate import LinearNDInterpolator
    from cupyx.scipy.spatial import Delaunay

    records = numpy.fromfile(file, dtype=[("id", "<i8"), ("place", "<f8", (2,))])
    points = cupy.asarray(numpy.ascontiguousarray(records["place"]))
    x, y = points[:, 0], points[:, 1]
    values = cupy.sin(8 * x) * cupy.cos(6 * y) + x
    places = cupy.ascontiguousarray(points[:count, ::-1])

    def timed(work):
        cupy.cuda.get_current_stream().synchronize()
        began = time.perf_counter()
        made = work()
        cupy.cuda.get_current_stream().synchronize()
        return round(time.perf_counter() - began, 6), made

    for run in range(runs + 1):
        wall, mesh = timed(lambda: Delaunay(points))
        is_corner = cupy.zeros(len(points), dtype=bool)
        is_corner[mesh.simplices.ravel()] = True
        linear = LinearNDInterpolator(mesh, values)
        seconds, found = timed(lambda: linear(places))
        has_value = cupy.isfinite(found)
        if run > 0:
            print(json.dumps({"wall": wall, "interpolate": seconds, "simplices": len(mesh.simplices),
                              "missing": len(points) - int(is_corner.sum()), "answers": int(has_value.sum()),
                              "mean": float(found[has_value].mean())}), flush=True)


if __name__ == "__main__":
    module, about = gpu()
    if len(sys.argv) == 1:
        print(json.dumps(about))
    else:
        measure(module, sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
