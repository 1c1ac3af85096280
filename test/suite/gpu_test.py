#!/usr/bin/python3
"""The part `gpu` of the benchmarks: it is skipped where there is no NVIDIA GPU or no CuPy, and compares the two sides where
there are: here a stand-in for CuPy, and one for the core."""
import array
import contextlib
import io
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench/suite"))

import driver
import gpu
import machine
import psql_session

NO_CUPY = "raise ImportError('libcuda.so.1: no such file')"
NO_GPU = """
class cuda:
    class runtime:
        is_hip = False
        class CUDARuntimeError(Exception): pass
        def getDeviceCount(): raise cuda.runtime.CUDARuntimeError('no CUDA-capable device is detected')
"""
# numpy in its place; the last point is in no triangle.
CUPY = """
from numpy import *
import numpy
__version__ = '14.2.0'
class cuda:
    class runtime:
        is_hip = False
        class CUDARuntimeError(Exception): pass
        getDeviceCount = staticmethod(lambda: 1)
        getDeviceProperties = staticmethod(lambda number: {'name': b'NVIDIA H200'})
        runtimeGetVersion = staticmethod(lambda: 13000)
    class stream:
        synchronize = staticmethod(lambda: None)
    get_current_stream = staticmethod(lambda: cuda.stream)
"""
DELAUNAY = """
import numpy
class Delaunay:
    def __init__(self, points):
        last = len(points) - 2
        self.points, self.simplices = points, numpy.array([[0, n, n + 1] for n in range(1, last)])
"""
LINEAR = """
import numpy
class LinearNDInterpolator:
    def __init__(self, mesh, values): self.values = values
    def __call__(self, places): return numpy.full(len(places), self.values.mean())
"""
CORE = """#!/bin/sh
cat <<END
{{"wall": 1, "cpu": 1, "interpolate": 1, "interpolate_cpu": 1, "simplices": {simplices}, "missing": {missing}, "answers": 5, "mean": {mean}}}
END
"""
PYTHON = "/usr/bin/python3"  # that of the system's packages
has_numpy = unittest.skipIf(subprocess.run([PYTHON, "-c", "import numpy"], capture_output=True).returncode, "numpy is not installed")
LABELS = {"what": "gpu", "dimension": 2, "set": "uniform", "points": 8, "places": 5}


class Part(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.enterContext(mock.patch.dict(os.environ, PYTHONPATH=folder.name))

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def core(self, missing=0, mean=0.5, simplices="9"):
        path = self.write("core", CORE.format(missing=missing, mean=mean, simplices=simplices))
        path.chmod(0o755)
        self.enterContext(mock.patch.object(gpu, "CORE", path))

    def cupy(self):
        self.enterContext(mock.patch.object(sys, "executable", PYTHON))
        self.write("cupy.py", CUPY)
        for name, text in ("cupyx/scipy/spatial", DELAUNAY), ("cupyx/scipy/interpolate", LINEAR):
            self.write(name + "/__init__.py", text)
        for name in "cupyx", "cupyx/scipy":
            self.write(name + "/__init__.py", "")

    def compare(self):
        """Of eight points on a parabola."""
        file = self.folder / "points.raw"
        words = b"".join(array.array("q", [n]).tobytes() + array.array("d", [n / 8, n * n / 64]).tobytes() for n in range(8))
        file.write_bytes(words)
        suite = mock.Mock(mode="full", measurements=[], about={"packages": {}})
        part = gpu.Gpu({}, {}, {"full": 2})
        part.compare(suite, file, LABELS, [1, 2])
        return suite.measurements

    def test_it_is_left_out_without_cupy(self):
        self.write("cupy.py", NO_CUPY)
        with self.assertRaisesRegex(machine.LeftOut, "needs an NVIDIA GPU and CuPy: CuPy cannot be imported .*libcuda"):
            gpu.find_gpu()

    def test_it_is_left_out_without_a_gpu(self):
        self.write("cupy.py", NO_GPU)
        with self.assertRaisesRegex(machine.LeftOut, "there is no NVIDIA GPU .no CUDA-capable device"):
            gpu.find_gpu()

    def test_what_is_left_out_has_not_failed(self):
        self.write("cupy.py", NO_CUPY)
        part = driver.Part("gpu", "", 1, gpu.Gpu({}, {}, {}).measure, needs_server=False)
        printed = io.StringIO()
        with mock.patch.object(machine, "describe", return_value={"packages": {}}), contextlib.redirect_stdout(printed):
            self.assertTrue(driver.Suite("full", self.folder / "results").run(part))
        self.assertIn("left out: the part needs an NVIDIA GPU", printed.getvalue())
        self.assertFalse((self.folder / "results").exists())
        with mock.patch.object(machine, "describe", return_value={"packages": {}}), self.assertRaises(SystemExit) as ended, \
                contextlib.redirect_stderr(printed):
            driver.Alone("full", self.folder).print(part)
        self.assertEqual(ended.exception.code, 77)

    @has_numpy
    def test_both_sides_are_compared(self):
        self.cupy()
        self.assertEqual(gpu.find_gpu(), {"gpu": "NVIDIA H200", "packages": {"cupy": "14.2.0", "cuda": "13.0"}})
        mean = sum(math.sin(n) * math.cos(6 * n * n / 64) + n / 8 for n in range(8)) / 8
        self.core(mean=mean)
        cupy, one, two = self.compare()
        self.assertEqual([(m["engine"], m.get("threads"), len(m["samples"])) for m in (cupy, one, two)],
                         [("cupy", None, 2), ("abacus", 1, 2), ("abacus", 2, 2)])
        sample = cupy["samples"][0]
        self.assertEqual((sample["missing"], sample["simplices"], sample["answers"]), (1, 5, 5))
        self.assertAlmostEqual(sample["mean"], mean)

    @has_numpy
    def test_what_differs_is_a_failure(self):
        self.cupy()
        self.core(mean=77)
        with self.assertRaisesRegex(psql_session.Failure, "mean values differ"):
            self.compare()
        self.core(missing=1)
        with self.assertRaisesRegex(psql_session.Failure, "points are missing"):
            self.compare()
        self.core(simplices="$2")  # the number of threads
        with self.assertRaisesRegex(psql_session.Failure, "differ by the number of threads"):
            self.compare()


class Alone(unittest.TestCase):
    def test_results_are_what_a_part_leaves(self):
        part = driver.Part("gpu", "what", 1, lambda suite: suite.measurements.append({"what": "gpu", "samples": []}), needs_server=False)
        printed = io.StringIO()
        with mock.patch.object(machine, "describe", return_value={"packages": {}}), contextlib.redirect_stdout(printed), \
                contextlib.redirect_stderr(io.StringIO()):
            driver.Alone("full", ROOT).print(part)
        self.assertEqual(json.loads(printed.getvalue()), {"part": "gpu", "mode": "full", "seconds": 0, "machine": {"packages": {}},
                                                          "measurements": [{"what": "gpu", "samples": []}]})


if __name__ == "__main__":
    unittest.main()
