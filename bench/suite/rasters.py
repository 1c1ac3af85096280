"""A raster of a mesh beside that of gdal_grid, from the same points: for a part that asks a mesh."""
import pathlib
import resource
import subprocess
import tempfile
import time

import server

LAYER = """<OGRVRTDataSource><OGRVRTLayer name="points"><SrcDataSource>{file}</SrcDataSource>
<GeometryType>wkbPoint</GeometryType><GeometryField encoding="PointFromColumns" x="x" y="y" z="h"/>
</OGRVRTLayer></OGRVRTDataSource>"""


def abacus(pixels):
    # In the select list rows are handed on one by one.
    with server.Session(abacus__cache_size=f"{server.cache_size('largest')}MB") as session:
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


def raster(suite, size, pixels, runs):
    """Samples of both, of random points in the unit square, in a square raster."""
    server.drop("relief", "relief_vertices", "relief_points")
    server.query(f"SELECT setseed(0.5); CREATE TABLE relief_points AS SELECT id, x, y, sin(20 * x) * cos(20 * y) AS h"
                 f" FROM (SELECT id, random() AS x, random() AS y FROM generate_series(1, {size}) AS id) AS points")
    server.query("SELECT abacus_triangulate('relief', 'TABLE relief_points')")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "points.csv").write_text(server.query("COPY (SELECT x, y, h FROM relief_points) TO STDOUT (FORMAT csv, HEADER)") + "\n")
        (folder / "points.vrt").write_text(LAYER.format(file=folder / "points.csv"))
        for engine, sample in ("abacus", lambda: abacus(pixels)), ("gdal", lambda: gdal(folder, pixels)):
            measurement = {"what": "raster", "engine": engine, "points": size, "pixels": pixels, "samples": [sample() for _ in range(runs)]}
            suite.measurements.append(measurement)
            suite.say(f"  raster {pixels}² {engine:6} {min(s['cpu'] for s in measurement['samples']):.2f} s of a processor")
    server.drop("relief", "relief_vertices", "relief_points")
