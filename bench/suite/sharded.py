"""One mesh over several servers beside one on a single server: the processor time of all sessions, that of the slowest server, and what travels. The servers are
databases of one cluster."""
import time

import server

SHARDS = 4
# Questions about a mesh, by its name; places are a table of 1,000
READING = {
    "contours": "SELECT count(*) FROM abacus_contours('{mesh}', 1e4, attribute => 'h')",
    "edges": "SELECT count(*) FROM abacus_edges('{mesh}')",
    "a picture": "SELECT length(abacus_draw('{mesh}', 800, edges => false))",
    "a picture of a hundredth": "SELECT length(abacus_draw('{mesh}', 800, lower => '{{0.45,0.45}}', upper => '{{0.55,0.55}}', edges => false))",
    "places, in one call": "SELECT count(*) FROM abacus_locate('{mesh}', 'TABLE places')",
    "places, each alone": "SELECT count(abacus_locate('{mesh}', x, y)) FROM places",
    "natural neighbours, in one call": "SELECT count(*) FROM abacus_interpolate('{mesh}', 'TABLE places', 'h', method => 'natural')"}


class Sharded:
    """Uniform points; `counts` are pairs of a dimension and a number of points."""

    def __init__(self, counts, runs):
        self.counts, self.runs = counts, runs

    def measure(self, suite):
        self.suite = suite
        server.create_extension("abacus")
        server.create_extension("postgres_fdw")
        self.make_servers()
        for dimension, count in self.counts[suite.mode]:
            self.points(dimension, count)
            server.drop("mesh", "mesh_vertices", "points")
        for shard in range(1, SHARDS + 1):
            server.query(f"DROP DATABASE bench_shard{shard} (FORCE)")
            server.query(f"SET client_min_messages = warning; DROP SERVER bench_shard{shard} CASCADE")

    def make_servers(self):
        for shard in range(1, SHARDS + 1):
            name = f"bench_shard{shard}"
            server.query(f"CREATE DATABASE {name}")
            server.query("CREATE EXTENSION abacus", name)
            server.query(f"CREATE SERVER {name} FOREIGN DATA WRAPPER postgres_fdw OPTIONS (dbname '{name}', port '{server.query('SHOW port')}',"
                         f" host '{server.query('SHOW unix_socket_directories').split(',')[0]}')")
            server.query(f"CREATE USER MAPPING FOR CURRENT_USER SERVER {name} OPTIONS (user '{server.query('SELECT current_user')}')")

    def points(self, dimension, count):
        z = ", random() AS z" if dimension == 3 else ""
        server.drop("mesh", "mesh_vertices", "points")
        server.query(f"SELECT setseed(0.5); CREATE UNLOGGED TABLE points AS SELECT i AS id, random() AS x, random() AS y{z}, i / 7.0::float8 AS h"
                     f" FROM generate_series(1, {count}) AS i")
        runs = self.runs[self.suite.mode]
        alone = []
        for _ in range(runs):
            server.drop("mesh", "mesh_vertices")
            server.settle()
            with server.Session() as session:
                alone.append(session.timed(f"SELECT abacus_triangulate('mesh', 'TABLE points', dimension => {dimension})"))
        self.record(dimension, count, "one server", alone)
        names = ",".join(f"bench_shard{shard}" for shard in range(1, SHARDS + 1))
        server.query(f"SELECT abacus_shard_create('many', '{{{names}}}', {dimension})")
        self.record(dimension, count, "a query of the coordinator", [self.build("'TABLE points'") for _ in range(runs)])
        self.hand_out(dimension)
        queries = "ARRAY[" + ", ".join(["'TABLE points'"] * SHARDS) + "]"
        self.record(dimension, count, "a query for each server", [self.build(queries) for _ in range(runs)])
        if server.query("SELECT simplices FROM many ORDER BY generation DESC LIMIT 1") != alone[-1]["printed"]:
            raise server.Failure("the mesh over several servers has another number of simplices")
        if dimension == 2:
            self.read(count)
        server.query("SELECT abacus_shard_drop('many')")

    def read(self, count):
        """The same questions about both meshes, in turns, each in a new session: nothing of the mesh is in its memory yet."""
        server.query("DROP TABLE IF EXISTS places; SELECT setseed(0.25); CREATE TABLE places AS SELECT i AS id, random() AS x, random() AS y"
                     " FROM generate_series(1, 1000) AS i")
        for question, sql in READING.items():
            samples = {"mesh": [], "many": []}
            for _ in range(self.runs[self.suite.mode]):
                for mesh, taken in samples.items():
                    with server.Session() as session:
                        taken.append(session.timed(sql.format(mesh=mesh)))
            if samples["mesh"][-1]["printed"] != samples["many"][-1]["printed"] and "picture" not in question:
                raise server.Failure(f"{question}: the mesh over several servers has another answer")
            for mesh, taken in samples.items():
                self.suite.measurements.append({"what": "sharded reading", "engine": "abacus", "dimension": 2, "points": count, "question": question,
                                                "shards": 1 if mesh == "mesh" else SHARDS, "samples": taken})
            walls = [min(sample["wall"] for sample in samples[mesh]) for mesh in samples]
            self.suite.say(f"  {count:>10,} points, {question:32} one server {walls[0]:8.3f} s, {SHARDS} shards {walls[1]:8.3f} s")
        server.drop("places")

    def hand_out(self, dimension):
        """Each server gets a table of the points that it owns, in no order."""
        z = ", z" if dimension == 3 else ""
        for row in server.query("SELECT server, shard_mesh FROM abacus_shards('many')").splitlines():
            name, mesh = row.split("|")
            server.query(f"DROP TABLE IF EXISTS points; CREATE UNLOGGED TABLE points AS SELECT id, x, y{z}, attributes[1] AS h FROM abacus_vertices('{mesh}')"
                         f" WHERE (x, y, coalesce(z, 0)) NOT IN (SELECT x, y, z FROM {mesh}_guests) ORDER BY hashint8(id)", name)

    def build(self, source):
        """Processor time is that of the session and of its connections to the servers."""
        server.settle()
        with server.Session() as session:
            wal, cpu = server.wal_position(), session.cpu()
            began = time.perf_counter()
            session.run(f"CALL abacus_shard_build('many', {source})")
            wall = time.perf_counter() - began
            backends = server.query("SELECT pid FROM pg_stat_activity WHERE datname LIKE 'bench\\_shard%' AND backend_type = 'client backend'").split()
            shards = [time.clock_gettime(~int(backend) << 3 | 2) for backend in backends]
            own = session.cpu() - cpu
        rounds, sent = server.query("SELECT rounds, sent FROM many ORDER BY generation DESC LIMIT 1").split("|")
        return {"wall": round(wall, 6), "cpu": round(own + sum(shards), 6), "slowest": round(max(shards), 6), "coordinator": round(own, 6),
                "rounds": int(rounds), "sent": int(sent), "wal": server.wal_position() - wal}

    def record(self, dimension, count, source, samples):
        for sample in samples:
            sample.pop("memory", None)
        self.suite.measurements.append({"what": "sharded", "engine": "abacus", "dimension": dimension, "points": count, "source": source,
                                        "shards": 1 if source == "one server" else SHARDS, "samples": samples})
        sample = min(samples, key=lambda sample: sample["cpu"])
        self.suite.say(f"  {count:>10,} points, {dimension}D, {source:28} CPU {sample['cpu']:8.3f} s" + (
            f", slowest server {sample['slowest']:8.3f} s, {sample['sent']:,} vertices in {sample['rounds']} rounds" if "sent" in sample else ""))
