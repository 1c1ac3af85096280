"""The part that runs CuPy's triangulation and interpolation on a GPU, and the core by several numbers of threads on the
processors beside it. It needs no server: `bench.sh pack` makes a folder with all that it brings."""
import json
import os
import subprocess
import sys

import machine
import paths
from points import PointSet
from psql_session import Failure

PEER = paths.ROOT / "bench/suite/cupy_peer.py"
CORE = paths.PROGRAMS / "core_in_memory"
NOT_HERE = 77  # with which the peer ends
MOST_THREADS = 16
SAME = 1e-3  # means of values at the same places differ by less, if a few points are lost


def find_gpu():
    """What the peer says of it; LeftOut if there is none, or no CuPy."""
    done = subprocess.run([sys.executable, PEER], capture_output=True, text=True)
    if done.returncode == NOT_HERE:
        raise machine.LeftOut(f"the part needs an NVIDIA GPU and CuPy: {done.stderr.strip()}")
    done.check_returncode()
    return json.loads(done.stdout)


class Gpu:
    """sets: names and sizes by mode; places: numbers of places by mode."""

    def __init__(self, sets, places, runs):
        self.sets, self.places, self.runs = sets, places, runs

    def measure(self, suite):
        found = find_gpu()
        suite.about["gpu"] = found["gpu"]
        suite.about["packages"] = suite.about["packages"] | found["packages"]
        suite.say(f"  {found['gpu']}, CuPy {found['packages']['cupy']}")
        counts = [count for count in (1, 2, 4, 8, MOST_THREADS) if count <= os.cpu_count()]
        for name, size in self.sets[suite.mode]:
            points = PointSet(2, name, size)
            with points.in_file() as file:
                self.compare(suite, file, {"what": "gpu", "dimension": 2, "set": name, "points": size,
                                           "places": min(size, self.places[suite.mode])}, counts)

    def compare(self, suite, file, labels, counts):
        """The numbers of threads take turns."""
        places, runs = str(labels["places"]), self.runs[suite.mode]
        cupy = {**labels, "engine": "cupy", "samples": self.lines([sys.executable, PEER, file, places, str(runs)])}
        ours = [{**labels, "engine": "abacus", "threads": count, "samples": []} for count in counts]
        for _ in range(runs):
            for measurement in ours:
                measurement["samples"] += self.lines([CORE, file, str(measurement["threads"]), places])
        for measurement in cupy, *ours:
            sample = measurement["samples"][-1]
            suite.say(f"  {labels['points']:,} points  {measurement['engine']:6} {measurement.get('threads', ''):2}"
                      f" {sample['wall']:9.4f} s   {sample['missing']:,} missing   interpolation {sample['interpolate']:9.4f} s")
        check(cupy, ours)
        suite.measurements += [cupy, *ours]

    @staticmethod
    def lines(command):
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
        return [json.loads(line) for line in done.stdout.splitlines()]


def check(cupy, ours):
    """The core has all points, and the same mesh and values with any number of threads; CuPy's mean value is about the same."""
    samples = [sample for measurement in ours for sample in measurement["samples"]]
    if any(sample["missing"] for sample in samples):
        raise Failure("points are missing in the mesh of the core")
    if len({(sample["simplices"], sample["answers"]) for sample in samples}) > 1:
        raise Failure("meshes or answers of the core differ by the number of threads")
    if abs(samples[0]["mean"] - cupy["samples"][0]["mean"]) > SAME:
        raise Failure(f"mean values differ: {samples[0]['mean']} and {cupy['samples'][0]['mean']}")
