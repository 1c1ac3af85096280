#!/usr/bin/python3
"""What others take in memory for what a mesh is asked: matplotlib's contours, SciPy's interpolation.

A program of its own, for the packages of the system's Python. It reads `points.csv` (x, y, height),
`triangles.csv` (indices of points) and `places.csv` (x, y) in a folder, and prints a line of JSON for
each measurement: what was asked, and its samples.
"""
import json
import pathlib
import sys
import time

import matplotlib

matplotlib.use("Agg")

import numpy
from matplotlib import _tri
from matplotlib.tri import Triangulation
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import Delaunay


def sampled(question, runs, work, prepare=lambda: None):
    """Prints what `work` took; it gets what `prepare` has made, which is not counted."""
    samples = []
    for _ in range(runs):
        ready = prepare()
        wall, cpu = time.perf_counter(), time.process_time()
        answers = work(ready)
        samples.append({"wall": time.perf_counter() - wall, "cpu": time.process_time() - cpu, "answers": answers})
        del ready
    print(json.dumps({"question": question, "samples": samples}), flush=True)


def main(folder, runs, levels):
    points, triangles, places = (numpy.loadtxt(pathlib.Path(folder, f"{name}.csv"), delimiter=",", ndmin=2)
                                 for name in ("points", "triangles", "places"))
    mesh = Triangulation(points[:, 0], points[:, 1], triangles.astype(numpy.int32))
    heights = numpy.ascontiguousarray(points[:, 2])
    mesh.neighbors  # computed before: Abacus has them stored

    def contours(generator):
        return sum(len(line) for level in levels for line in generator.create_contour(level)[0])

    sampled("contours", runs, contours, lambda: _tri.TriContourGenerator(mesh.get_cpp_triangulation(), heights))
    linear = LinearNDInterpolator(points[:, :2], heights)
    linear(places[:10])
    sampled("interpolate", runs, lambda _: int(numpy.isfinite(linear(places)).sum()))
    sampled("build", runs, lambda _: len(LinearNDInterpolator(Delaunay(points[:, :2]), heights).points))


main(sys.argv[1], int(sys.argv[2]), [float(level) for level in sys.argv[3:]])
