"""A mesh cut into parts for the ranks of a parallel program: the cut beside METIS, the shares of all ranks at once beside one reading of the table, and
steps of a solution stored and read."""
import shutil
import subprocess
import tempfile
import threading

import numpy

import server

RANKS = 4
CORNERS = "SELECT v0, v1, v2, v3 FROM abacus_simplices('mesh')"


class Shares:
    """Of the points of an earthquake model; `frequencies` (Hz) tell how many."""

    def __init__(self, frequencies):
        self.frequencies = frequencies

    def measure(self, suite):
        self.suite = suite
        self.runs = {"full": 3, "quick": 2, "smoke": 1}[suite.mode]
        server.create_extension("abacus_lab")
        server.drop("mesh", "mesh_vertices", "points")
        server.query(f"CREATE UNLOGGED TABLE points AS SELECT id, x, y, z, vs FROM abacus_quake({self.frequencies[suite.mode]})")
        self.simplices = int(server.query("SELECT abacus_triangulate('mesh', 'TABLE points', '{vs}', dimension => 3)"))
        self.points = int(server.query("SELECT count(*) FROM points"))
        server.query("VACUUM (FREEZE, ANALYZE) mesh")
        self.partition()
        self.metis()
        self.shares()
        self.steps()
        server.drop("mesh", "mesh_vertices", "points")

    def record(self, question, engine, samples, **more):
        self.suite.measurements.append({"what": "share", "engine": engine, "points": self.points, "question": question,
                                        "samples": samples, **more})
        sample = min(samples, key=lambda sample: sample["wall"])
        facets = f", {sample['facets']} facets between parts" if "facets" in sample else ""
        self.suite.say(f"  {question:40} {engine:8} {sample['wall']:8.3f} s{facets}")

    def partition(self):
        """Each in a session of its own, which has no cut yet."""
        samples = []
        for _ in range(self.runs):
            with server.Session() as session:
                samples.append(session.timed(f"SELECT sum(cut_facets) / 2 FROM abacus_partition('mesh', {RANKS})"))
        for sample in samples:
            sample["facets"] = int(float(sample.pop("printed")))
        self.record("cut in four", "abacus", samples)

    def metis(self):
        """The graph of neighbours, in a file, cut by gpmetis."""
        if shutil.which("gpmetis") is None:
            self.suite.say("  gpmetis is not installed")
            return
        with tempfile.TemporaryDirectory() as folder:
            with open(f"{folder}/corners", "wb") as file:
                subprocess.run(["psql", "-X", "-q", "-c", f"COPY ({CORNERS}) TO STDOUT (DELIMITER ' ')"], stdout=file, check=True)
            corners = numpy.sort(numpy.loadtxt(f"{folder}/corners", dtype=numpy.int64), axis=1)
            count = len(corners)
            facets = numpy.concatenate([numpy.delete(corners, corner, axis=1) for corner in range(4)])
            order = numpy.lexsort(facets.T)
            same = (facets[order[1:]] == facets[order[:-1]]).all(axis=1)
            first, second = order[:-1][same] % count, order[1:][same] % count
            neighbours = numpy.concatenate([numpy.column_stack([first, second]), numpy.column_stack([second, first])])
            neighbours = neighbours[numpy.argsort(neighbours[:, 0], kind="stable")]
            lists = numpy.split(neighbours[:, 1] + 1, numpy.cumsum(numpy.bincount(neighbours[:, 0], minlength=count))[:-1])
            with open(f"{folder}/graph", "w", encoding="ascii") as file:
                file.write(f"{count} {len(first)}\n")
                file.writelines(" ".join(map(str, of.tolist())) + "\n" for of in lists)
            samples = []
            for _ in range(self.runs):
                done = subprocess.run(["gpmetis", f"{folder}/graph", str(RANKS)], stdout=subprocess.PIPE, text=True, check=True).stdout
                seconds = next(line for line in done.splitlines() if "Partitioning:" in line).split()[1]
                part = numpy.loadtxt(f"{folder}/graph.part.{RANKS}", dtype=int)
                samples.append({"wall": float(seconds), "facets": int((part[first] != part[second]).sum())})
            self.record("cut in four, without reading the graph", "metis", samples)

    def shares(self):
        """All ranks at once, each in a session of its own; beside them a reading of all rows of the mesh."""
        samples = []
        for _ in range(self.runs):
            with server.Session() as session:
                samples.append(session.timed("COPY mesh TO '/dev/null' (FORMAT binary)"))
        self.record("the table of the mesh read, by COPY", "copy", samples)
        self.record("the shares of all ranks at once", "abacus", [self.at_once(
            lambda rank: f"SELECT (SELECT count(*) FROM abacus_share_vertices('mesh', {RANKS}, {rank})) + (SELECT count(*) FROM abacus_share_simplices('mesh', {RANKS}, {rank}))")
            for _ in range(self.runs)])

    def at_once(self, statement):
        """Wall time until the last of the sessions has ended; CPU time of all."""
        samples = [None] * RANKS

        def work(rank):
            with server.Session() as session:
                gate.wait()
                samples[rank] = session.timed(statement(rank))

        gate = threading.Barrier(RANKS)
        threads = [threading.Thread(target=work, args=(rank,)) for rank in range(RANKS)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        return {"wall": max(sample["wall"] for sample in samples), "cpu": sum(sample["cpu"] for sample in samples)}

    def steps(self):
        """One part that is the whole mesh, with four values at each vertex; then the step drawn, and read at places."""
        samples = []
        with server.Session() as session:
            session.run("CREATE TEMP TABLE solution AS SELECT id, x AS a, y AS b, z AS c, x + y AS d FROM abacus_share_vertices('mesh', 1, 0, 0) ORDER BY local")
            for step in range(self.runs):
                samples.append(session.timed(f"SELECT abacus_store('mesh', {step}, 1, 0, 'TABLE solution')"))
            self.record("a step of four values stored, in one part", "abacus", samples, values=4 * self.points)
            middle = server.query("SELECT format('%s,%s,%s', (min(x) + max(x)) / 2, (min(y) + max(y)) / 2, min(z) / 3) FROM points")
            for what, step in ("a section drawn of the attribute", "attribute => 'vs'"), ("a section drawn of a step", "attribute => '1', step => 0"):
                self.record(what, "abacus", [session.timed(f"SELECT length(abacus_draw_section('mesh', '{{{middle}}}', '{{0,0,1}}', {step}))") for _ in range(self.runs)])
            places = "SELECT i, x, y, z FROM (SELECT row_number() OVER () AS i, x, y, z FROM points LIMIT 100000) AS p"
            for what, step in ("values of the attribute at places", "'vs'"), ("values of a step at places", "'1', step => 0"):
                self.record(what, "abacus", [session.timed(f"SELECT count(*) FROM abacus_interpolate('mesh', '{places}', {step})") for _ in range(self.runs)],
                            values=min(100000, self.points))
