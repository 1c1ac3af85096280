"""A raster of a mesh beside that of gdal_grid, from the same points."""
import pathlib
import resource
import shutil
import subprocess
import tempfile
import time

import server

LAYER = """<OGRVRTDataSource><OGRVRTLayer name="points"><SrcDataSource>{file}</SrcDataSource>
<GeometryType>wkbPoint</GeometryType><GeometryField encoding="PointFromColumns" x="x" y="y" z="h"/>
</OGRVRTLayer></OGRVRTDataSource>"""


def abacus(pixels):
    # In a select list, rows are passed on one by one. Both compute with all processors.
    with server.Session(abacus__threads=0, abacus__cache_size=f"{server.cache_size('largest')}MB") as session:
        sample = session.timed(f"SELECT count(*) FROM (SELECT abacus_raster('relief', '{{0, 0}}', '{{1, 1}}', {pixels}, {pixels}) OFFSET 0) AS row")
    del sample["printed"]
    return sample


def gdal(folder, pixels):
    """The processor's time is that of all its threads. It triangulates first."""
    def used():
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime
    before, began = used(), time.perf_counter()
    subprocess.run(["gdal_grid", "-q", "-a", "linear", "-txe", "0", "1", "-tye", "1", "0", "-outsize", str(pixels), str(pixels),
                    "-ot", "Float64", "-l", "points", folder / "points.vrt", folder / "raster.tif"], check=True)
    return {"wall": round(time.perf_counter() - began, 6), "cpu": round(used() - before, 6)}


class Raster:
    """sizes: points and pixels on a side, of random points in the unit square."""

    def __init__(self, sizes):
        self.sizes = sizes

    def measure(self, suite):
        size, pixels = self.sizes[suite.mode]
        server.drop("relief", "relief_vertices", "relief_points")
        server.query(f"SELECT setseed(0.5); CREATE TABLE relief_points AS SELECT id, x, y, sin(20 * x) * cos(20 * y) AS h"
                     f" FROM (SELECT id, random() AS x, random() AS y FROM generate_series(1, {size}) AS id) AS points")
        server.query("SELECT abacus_triangulate('relief', 'TABLE relief_points')")
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "points.csv").write_text(server.query("COPY (SELECT x, y, h FROM relief_points) TO STDOUT (FORMAT csv, HEADER)") + "\n")
            (folder / "points.vrt").write_text(LAYER.format(file=folder / "points.csv"))
            for engine, sample in ("abacus", lambda: abacus(pixels)), ("gdal", lambda: gdal(folder, pixels)):
                if engine == "gdal" and shutil.which("gdal_grid") is None:
                    suite.say("  gdal_grid is not installed")
                    continue
                measurement = {"what": "ask", "engine": engine, "points": size, "question": f"raster of {pixels}²", "samples": [sample()]}
                suite.measurements.append(measurement)
                suite.say(f"  raster of {pixels}² {engine:6} {measurement['samples'][0]['wall']:.2f} s")
        server.drop("relief", "relief_vertices", "relief_points")
