"""The part that carries a mesh to others: windows of its foreign table, tiles of web maps, facets with markers, files."""
import json
import math
import pathlib
import resource
import subprocess
import tempfile
import time

import paths
import server

# A terrain in degrees: 1.5 by 1 of them
TERRAIN = """SELECT setseed(0.25); CREATE TABLE points AS SELECT id, x, y, 900 + 300 * sin(9 * x) * cos(7 * y) AS height
    FROM (SELECT id, 7 + 1.5 * random() AS x, 46 + random() AS y FROM generate_series(1, {size}) AS id) AS place"""
MIDDLE = 7.751, 46.507  # in one tile of each zoom

TILES = {
    "picture tile": "abacus_tile_picture('mesh', {z}, {x}, {y}, attribute => 'height', range => '{{600,1200}}')",
    "picture tile, shaded, with contours": "abacus_tile_picture('mesh', {z}, {x}, {y}, attribute => 'height', range => '{{600,1200}}',"
                                           " exaggeration => 2, contours => 20)",
    "vector tile with contours": "abacus_tile_vector('mesh', {z}, {x}, {y}, contours => 20)",
    "tile of heights": "abacus_tile_terrain('mesh', {z}, {x}, {y})",
}
LEVELS = "{5,10,20,40,80,160}"  # metres; a pixel at zoom 14 has 6.6


class Carried:
    """sizes: points of the terrain, and of a mesh in space."""

    def __init__(self, sizes, runs):
        self.sizes, self.runs = sizes, runs

    def measure(self, suite):
        self.suite = suite
        terrain, rock = self.sizes[suite.mode]
        server.drop("mesh", "mesh_vertices", "points")
        server.query(TERRAIN.format(size=terrain))
        server.query("SELECT abacus_triangulate('mesh', 'TABLE points'); SELECT abacus_set_srid('mesh', 4326)")
        server.query("VACUUM (FREEZE, ANALYZE) mesh")
        self.points = terrain
        self.windows()
        self.tiles("", "")
        self.levels()
        self.tiles(", of levels", ", pixel_error => 1")
        self.facets()
        self.file("PLY of {count} triangles", "mesh.ply", "--z", "height")
        server.drop("mesh", "mesh_vertices", "points")
        server.query(f"SELECT setseed(0.5); SELECT abacus_triangulate('mesh', 'SELECT id, random(), random(), random(), random() AS speed"
                     f" FROM generate_series(1, {rock}) AS id', dimension => 3)")
        self.points = rock
        self.file("arrays of {count} tetrahedra", "mesh.npz")
        server.drop("mesh", "mesh_vertices")

    def record(self, question, samples, **more):
        self.suite.measurements.append({"what": "ask", "question": question, "engine": "abacus", "points": self.points, "samples": samples, **more})
        middle = sorted(sample["wall"] for sample in samples)[len(samples) // 2]
        self.suite.say(f"  {question:48} {1000 * middle:9.1f} ms")

    def windows(self):
        """Of 2,000 triangles: the first of a session after the server's start, and one of a hundred after that."""
        if not server.has_extension("postgis"):
            self.suite.say("  PostGIS is not installed: no windows of foreign tables")
            return
        server.create_extension("postgis")
        server.query("SELECT abacus_publish('mesh', cells => 'mesh_cells', points => 'mesh_points')")
        side = (min(1, 1000 / self.points) * 1.5) ** 0.5
        for name, condition in ("&&", "geom && {window}"), ("ST_Intersects", "ST_Intersects(geom, {window})"):
            def statement(n):
                x, y = 7 + (1.5 - side) * (n * 0.7549 % 1), 46 + (1 - side) * (n * 0.5698 % 1)
                window = f"ST_MakeEnvelope({x}, {y}, {x + side}, {y + side}, 4326)"
                return f"SELECT count(*), sum(ST_NPoints(geom)) FROM mesh_cells WHERE {condition.format(window=window)}"
            cold = []
            for run in range(self.runs[self.suite.mode]):
                server.restart()
                with server.Session() as session:
                    cold.append(self.window(session, statement(run)))
            with server.Session() as session:
                session.run(statement(0))
                warm = [self.window(session, statement(n)) for n in range(1, 101 if self.suite.mode == "full" else 11)]
            self.record(f"foreign table, window by {name}, cold", cold)
            self.record(f"foreign table, window by {name}", warm)

    def window(self, session, statement):
        sample = session.timed(statement)
        sample["answers"] = int(sample.pop("printed").split("|")[0])
        plan = json.loads(session.run(f"EXPLAIN (ANALYZE, FORMAT JSON) {statement}"))[0]["Plan"]
        sample["pages"] = plan["Plans"][0]["Mesh Pages Read"]
        return sample

    def levels(self):
        """Made once, and made anew."""
        for name, call in ("levels of detail", f"abacus_levels('mesh', '{LEVELS}')"), ("levels of detail, made anew", "abacus_levels_refresh('mesh')"):
            with server.Session() as session:
                sample = session.timed(f"SELECT sum(vertices) FROM {call}")
            sample["answers"] = int(sample.pop("printed"))
            self.record(name, [sample])

    def tiles(self, which, choice):
        """A walk from zoom 0 to 14 over one place; a sample is a tile."""
        for name, call in TILES.items():
            samples = []
            with server.Session() as session:
                for again in range(2):  # the first walk fills the server's cache
                    samples = [self.tile(session, call[:-1] + choice + ")", zoom) for zoom in range(15)]
            self.record(f"{name}{which}, zoom 0 to 14", samples)

    def tile(self, session, call, zoom):
        lon, lat = MIDDLE
        x = math.floor((lon + 180) / 360 * 2 ** zoom)
        y = math.floor((1 - math.log(math.tan(math.radians(45 + lat / 2))) / math.pi) / 2 * 2 ** zoom)
        sample = session.timed(f"SELECT length({call.format(z=zoom, x=x, y=y)})")
        sample["bytes"] = int(sample.pop("printed"))
        return sample

    def facets(self):
        """Those with a marker, of the mesh and of one with the same triangles that is not Delaunay, in turns."""
        meshes = {"mesh": "facets with a marker", "loaded": "facets with a marker, of a mesh that is not Delaunay"}
        server.drop("loaded", "loaded_vertices")
        server.query("SELECT abacus_load('loaded', 'SELECT id, 5 * x, y FROM abacus_vertices(''mesh'')', 'SELECT v0, v1, v2 FROM abacus_simplices(''mesh'')')")
        samples = {mesh: [] for mesh in meshes}
        for mesh in meshes:
            server.query(f"SELECT abacus_mark('{mesh}', 'SELECT code, v0, v1, v2, 0, 1 FROM abacus_simplices(''{mesh}'') WHERE v0 % 10 = 0')")
        with server.Session() as session:
            for _ in range(self.runs[self.suite.mode]):
                for mesh in meshes:
                    sample = session.timed(f"SELECT count(*), sum(v0) FROM abacus_facets('{mesh}')")
                    sample["answers"] = int(sample.pop("printed").split("|")[0])
                    samples[mesh].append(sample)
        for mesh, question in meshes.items():
            self.record(question, samples[mesh])
        server.drop("loaded", "loaded_vertices")

    def file(self, question, name, *options):
        count = int(server.query("SELECT value::bigint FROM abacus_stats('mesh') WHERE name = 'simplices'"))
        samples = []
        for _ in range(self.runs[self.suite.mode]):
            with tempfile.TemporaryDirectory() as folder:
                target = pathlib.Path(folder, name)
                used, began = self.used(), time.perf_counter()
                subprocess.run([paths.ROOT / "client/abacus-export", "mesh", target, *options], check=True, stdout=subprocess.DEVNULL)
                samples.append({"wall": round(time.perf_counter() - began, 6), "cpu": round(self.used() - used, 6), "bytes": target.stat().st_size})
        self.record(question.format(count=f"{count:,}"), samples, written=True)

    @staticmethod
    def used():
        """Processor time of the clients that have ended: the server's is not among it."""
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime
