"""The part that asks a mesh more than where places are: values, contours, windows; beside others in memory."""
import json
import shutil
import subprocess

import paths
import server
from location import create_places
from points import PointSet

HEIGHT = "100 * sin(8 * x) * cos(6 * y) + 20 * x"
LEVELS = [-95 + 10 * n for n in range(20)]

# Statements that answer all places of a table: rates of the interpolations beside that of abacus_locate
RATES = {
    "locate, a call each": ("ordered", "SELECT count(abacus_locate('mesh', x, y)) FROM ordered"),
    "linear, a call each": ("ordered", "SELECT count(abacus_interpolate('mesh', x, y)) FROM ordered"),
    "natural, a call each": ("ordered", "SELECT count(abacus_interpolate('mesh', x, y, method => 'natural')) FROM ordered"),
    "locate, one call": ("places", "SELECT count(code) FROM abacus_locate('mesh', 'SELECT id, x, y FROM places')"),
    "linear, one call": ("places", "SELECT count(\"values\"[1]) FROM abacus_interpolate('mesh', 'SELECT id, x, y FROM places')"),
    "natural, one call": ("places", "SELECT count(\"values\"[1]) FROM abacus_interpolate('mesh', 'SELECT id, x, y FROM places',"
                                    " method => 'natural')"),
}


class Ask:
    """sizes: of the mesh that is compared with others, of the places, of the mesh of the windows, and of the places that
    SciPy gets, which takes long for each."""

    def __init__(self, sizes):
        self.sizes = sizes

    def measure(self, suite):
        self.suite = suite
        size, self.places, large, self.few = self.sizes[suite.mode]
        self.runs = {"full": 5, "quick": 3, "smoke": 1}[suite.mode]
        server.restart(shared_buffers="2GB" if large >= 1000000 else "128MB")
        try:
            self.make_mesh(size)
            create_places(PointSet(2, "uniform", size), self.places)
            self.labels = {"points": size}
            self.contours()
            self.rates()
            self.beside_others()
            self.make_mesh(large)
            self.labels = {"points": large}
            self.window()
        finally:
            server.restart()
        server.drop("mesh", "mesh_vertices", "points", "places", "ordered")

    def make_mesh(self, size):
        server.drop("mesh", "mesh_vertices", "points")
        server.query(f"SELECT setseed(0.25); CREATE TABLE points AS SELECT id, x, y, {HEIGHT} AS height FROM"
                     f" (SELECT id, random() AS x, random() AS y FROM generate_series(1, {size}) AS id) AS place")
        server.query("SELECT abacus_triangulate('mesh', 'TABLE points')")
        server.query("VACUUM (FREEZE, ANALYZE) mesh")

    def session(self):
        return server.Session(abacus__cache_size=f"{server.cache_size('largest')}MB",
                              max_parallel_workers_per_gather=0)

    def record(self, question, engine, samples, **figures):
        self.suite.measurements.append({"what": "ask", "question": question, "engine": engine, **self.labels,
                                        **figures, "samples": samples})
        least = min(sample["wall"] for sample in samples)
        self.suite.say(f"  {question:24} {engine:8} {least:9.4f} s")

    def timed(self, question, statement, **figures):
        """With the settings that a session has."""
        with server.Session(max_parallel_workers_per_gather=0) as session:
            session.run(statement)
            samples = [session.timed(statement) for _ in range(self.runs)]
        for sample in samples:
            sample["answers"] = sample.pop("printed")
        self.record(question, "abacus", samples, **figures)

    def contours(self):
        levels = ",".join(map(str, LEVELS))
        for question, polygonize in ("contours", "false"), ("bands", "true"):
            self.timed(question, "SELECT sum(cardinality(path)) / 2 FROM abacus_contours('mesh',"
                                 f" fixed_levels => '{{{levels}}}', polygonize => {polygonize})")

    def rates(self):
        """In turns, in one session."""
        samples = {question: [] for question in RATES}
        with self.session() as session:
            for turn in range(self.runs + 1):
                for question, (_, statement) in RATES.items():
                    sample = session.timed(statement)
                    del sample["printed"]
                    if turn > 0:  # the first one fills the cache
                        samples[question].append(sample)
        for question, taken in samples.items():
            self.record(question, "abacus", taken, places=self.places)

    def beside_others(self):
        """What SciPy and matplotlib take, in a process of their own; ours of the same kind before. All places, and as few
        as SciPy gets: what a place takes is compared."""
        for count in self.places, self.few:
            self.timed("interpolate", "SELECT count(\"values\"[1]) FROM abacus_interpolate('mesh',"
                       f" 'SELECT id, x, y FROM places LIMIT {count}')", places=count)
        folder = paths.DATA / "peers"
        folder.mkdir(parents=True, exist_ok=True)
        try:
            for name, query in ("points", "SELECT x, y, height FROM points ORDER BY id"), \
                               ("triangles", "SELECT v0 - 1, v1 - 1, v2 - 1 FROM abacus_simplices('mesh')"), \
                               ("places", f"SELECT x, y FROM places LIMIT {self.few}"):
                with open(folder / f"{name}.csv", "w") as file:
                    subprocess.run(["psql", "-X", "-q", "-c", f"COPY ({query}) TO STDOUT (FORMAT csv)"], stdout=file, check=True)
            printed = subprocess.run(["/usr/bin/python3", paths.ROOT / "bench/suite/peers.py", folder, str(self.runs),
                                      *map(str, LEVELS)], stdout=subprocess.PIPE, text=True, check=True).stdout
        finally:
            shutil.rmtree(folder)
        for line in printed.splitlines():
            measured = json.loads(line)
            question = measured["question"]
            self.record(question, "matplotlib" if question == "contours" else "scipy", measured["samples"],
                        **({"places": self.few} if question == "interpolate" else {}))

    def window(self):
        """Triangles of a hundredth of the mesh, and of all of it, once: time, and pages read."""
        statements = {"whole": "SELECT count(*) FROM abacus_cells('mesh')",
                      "window": "SELECT count(*) FROM abacus_cells('mesh', lower => '{0.45,0.45}', upper => '{0.55,0.55}')"}
        for question, statement in statements.items():
            with server.Session(max_parallel_workers_per_gather=0) as session:
                if question == "window":
                    session.run(statement)
                samples = []
                for _ in range(self.runs if question == "window" else 1):
                    sample = session.timed(statement)
                    del sample["printed"]
                    plan = json.loads(session.run(f"EXPLAIN (ANALYZE, BUFFERS, FORMAT JSON) {statement}"))[0]["Plan"]
                    sample["pages"] = plan["Shared Hit Blocks"] + plan["Shared Read Blocks"]
                    samples.append(sample)
            self.record(question, "abacus", samples)
