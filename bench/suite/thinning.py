"""A raster of heights thinned to an error, and compared with the whole one: abacus_thin beside the build of its mesh, and beside delatin, in memory."""
import json
import pathlib
import shutil
import subprocess
import tempfile

import numpy

import server

DELATIN = "delatin@0.2.0"
MAX_ERROR = 0.5


def relief(side):
    """Heights that a Float32Array holds exactly: hills, ridges and a noise of some centimetres."""
    x, y = numpy.meshgrid(numpy.arange(side), numpy.arange(side))
    noise = (x * 7919 + y * 104729) % 1000 / 10000 - 0.05
    hills = 30 * numpy.sin(x / 90) * numpy.cos(y / 120) + 4 * numpy.sin(x / 23 + y / 31)
    return (hills + 8 * numpy.abs(numpy.sin((x + 2 * y) / 400)) + noise).astype(numpy.float32)


def abacus(question):
    with server.Session(abacus__threads=0, abacus__cache_size=f"{server.cache_size('largest')}MB") as session:
        sample = session.timed(question)
    del sample["printed"]
    return sample


def delatin(folder, heights):
    """None if it cannot be installed."""
    if shutil.which("npm") is None or subprocess.run(["npm", "install", "--silent", "--no-save", "--prefix", folder, DELATIN], check=False).returncode != 0:
        return None
    heights.tofile(folder / "heights")
    script = pathlib.Path(__file__).with_name("delatin.mjs")
    done = subprocess.run(["node", "--max-old-space-size=16384", script, folder / "heights", *map(str, heights.shape), str(MAX_ERROR)],
                          cwd=folder, stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout)


class Thin:
    """sides: pixels on a side of the raster."""

    def __init__(self, sides):
        self.sides = sides

    def measure(self, suite):
        side = self.sides[suite.mode]
        heights = relief(side)
        server.drop("thin_raster", "thin_raster_vertices", "thin_new", "thin_points")
        server.query("CREATE UNLOGGED TABLE thin_points (id bigint, x float8, y float8, h float8)")
        ids = numpy.arange(side * side)
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            numpy.savetxt(folder / "points", numpy.column_stack([ids, ids % side, ids // side, heights.ravel()]), fmt=("%d", "%d", "%d", "%.9g"))
            with open(folder / "points", encoding="ascii") as file:
                subprocess.run(["psql", "-X", "-q", "-c", "COPY thin_points FROM STDIN (DELIMITER ' ')"], stdin=file, check=True)
            self.report(suite, "abacus", "mesh", abacus("SELECT abacus_triangulate('thin_raster', 'TABLE thin_points')"))
            sample = abacus(f"SELECT abacus_thin('thin_raster', 'thin_new', {MAX_ERROR})")
            sample["vertices"] = int(server.query("SELECT count(*) FROM abacus_vertices('thin_new')"))
            self.report(suite, "abacus", "thinned", sample)
            self.report(suite, "abacus", "compared", abacus("SELECT abacus_compare('thin_raster', 'thin_new')"))
            sample = delatin(folder, heights)
            if sample is None:
                suite.say(f"  {DELATIN} is not installed")
            else:
                self.report(suite, "delatin", "thinned", sample)
        server.drop("thin_raster", "thin_raster_vertices", "thin_new", "thin_points")

    def report(self, suite, engine, what, sample):
        side = self.sides[suite.mode]
        suite.measurements.append({"what": "ask", "engine": engine, "points": side * side, "question": f"raster of {side}² {what}", "samples": [sample]})
        vertices = f", {sample['vertices']} vertices" if "vertices" in sample else ""
        suite.say(f"  raster of {side}² {what:8} {engine:8} {sample['wall']:.2f} s{vertices}")
