"""Levels of detail beside the build of their mesh, and tiles of terrain of triangles from them: processor time and pages of a tile at several zooms."""
import json
import random

import server

SIDE = 131072  # metres, of the mesh, which is a square on the map of Web Mercator
ROOT = 40075016.68557849  # metres, the side of the map
OF_ROOT = 154134.68  # metres, what Cesium takes as the error of a tile of zoom 0
# Mountains of 500 m over 20 km, hills of 20 m over 5 km, and a noise of a decimetre
HEIGHT = "500 * sin(x / 3183) * cos(y / 2617) + 20 * sin((x + 0.7 * y) / 800) + 0.1 * sin(x * 7.1) * cos(y * 5.3)"
ERRORS = [0.58, 2.3, 9.4, 37, 150, 400]  # for zooms from 16 on upwards
ZOOMS = (8, 10, 12, 14, 16)
TILES = 20


def error_of(zoom):
    """Half a pixel of Cesium's, as the viewer has it."""
    return OF_ROOT / 2 ** zoom / 4


def tiles(zoom):
    """Places of tiles within the mesh, the same in each run."""
    chosen = random.Random(zoom)
    side = ROOT / 2 ** zoom
    first = 2 ** (zoom - 1)
    count = max(int(SIDE / side), 1)
    return [(first + chosen.randrange(count), first + chosen.randrange(count)) for _ in range(TILES)]


class Detail:
    """sizes: points of each mesh."""

    def __init__(self, sizes):
        self.sizes = sizes

    def measure(self, suite):
        self.suite = suite
        for size in self.sizes[suite.mode]:
            server.restart(shared_buffers="2GB" if size >= 1000000 else "128MB")
            try:
                self.measure_size(size)
            finally:
                server.drop("mesh", "mesh_vertices", "points")
                server.restart()

    def measure_size(self, size):
        server.drop("mesh", "mesh_vertices", "points")
        server.query(f"CREATE UNLOGGED TABLE points AS SELECT i AS id, x, y, {HEIGHT} AS height FROM (SELECT i, {SIDE} * ((i * 0.7548776662466927) % 1) AS x, "
                     f"{SIDE} * ((i * 0.5698402909980532) % 1) AS y FROM generate_series(1, {size}) AS i) AS places")
        with server.Session(abacus__threads=0, abacus__cache_size=f"{server.cache_size('largest')}MB") as session:
            for what, statement in ("mesh", "SELECT abacus_triangulate('mesh', 'TABLE points')"), ("levels", f"SELECT count(*) FROM abacus_levels('mesh', ARRAY{ERRORS})"):
                sample = session.timed(statement)
                del sample["printed"]
                self.record(size, "levels", [sample], made=what)
        server.query("SELECT abacus_set_srid('mesh', 3857)")
        vertices = {level: int(server.query(f"SELECT value FROM abacus_stats('mesh_level_{level}') WHERE name = 'vertices'")) for level in range(1, len(ERRORS) + 1)}
        self.suite.say(f"    vertices of the levels: {', '.join(map(str, vertices.values()))}")
        server.query("VACUUM (ANALYZE) mesh")
        with server.Session() as session:
            for zoom in ZOOMS:
                self.measure_tiles(session, size, zoom)

    def measure_tiles(self, session, size, zoom):
        samples = []
        for x, y in tiles(zoom):
            call = f"abacus_tile_mesh('mesh', {zoom}, {x}, {y}, max_error => {error_of(zoom)})"
            session.run(f"SELECT length({call})")  # warm
            sample = session.timed(f"SELECT length({call})")
            sample["bytes"] = int(sample.pop("printed"))
            plan, = json.loads(session.run(f"EXPLAIN (ANALYZE, BUFFERS, COSTS false, TIMING false, FORMAT json) SELECT {call}"))
            sample["pages"] = plan["Plan"]["Shared Hit Blocks"] + plan["Plan"]["Shared Read Blocks"]
            samples.append(sample)
        self.record(size, "tile mesh", samples, zoom=zoom)

    def record(self, size, what, samples, **more):
        self.suite.measurements.append({"what": what, "engine": "abacus", "points": size, **more, "samples": samples})
        middle = sorted(samples, key=lambda sample: sample["cpu"])[len(samples) // 2]
        figures = f"{middle['cpu']:.4f} s of a processor, {middle['wall']:.4f} s" + (f", {middle['pages']} pages" if "pages" in middle else "")
        self.suite.say(f"  {size:>9} points {what} {' '.join(map(str, more.values()))}: {figures}")
