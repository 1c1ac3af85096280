"""Parts that change a mesh: many points in a statement, one in a transaction, and cancelled builds."""
import os
import pathlib
import statistics
import subprocess
import tempfile
import threading
import time

import server
from points import PointSet

TILES_OF_AN_AXIS = {2: 20, 3: 6}
SINGLE = {"full": 5000, "quick": 1000, "smoke": 20}


class Edits:
    """Half of a point set as a mesh, the other half to be inserted."""

    def __init__(self, dimension, sizes):
        self.dimension, self.sizes = dimension, sizes

    def begin(self, suite):
        self.suite, self.size = suite, self.sizes[suite.mode]
        self.points = PointSet(self.dimension, "uniform", 2 * self.size)
        self.labels = {"dimension": self.dimension, "set": "uniform", "points": self.size}
        self.points.create_table()
        self.select = f"SELECT id, {self.points.columns} FROM points WHERE"
        self.make = self.points.triangulate(f" WHERE id <= {self.size}")

    def measure(self, suite):
        self.begin(suite)
        runs = {"full": 3, "quick": 1, "smoke": 1}[suite.mode]
        self.insert_many(runs)
        self.delete_many(runs)
        self.grow(runs)
        self.queue()
        self.space(self.size // 20)
        self.space(min(1000, self.size // 20))
        server.restart(fsync="off")
        try:
            self.one_by_one()
        finally:
            server.restart()
        faults = server.query("SELECT count(*) FROM abacus_check('mesh')")
        if faults != "0":
            raise server.Failure(f"{faults} faults after changes")
        server.drop("mesh", "mesh_vertices", "points", "queue")

    def fresh_mesh(self):
        server.drop("mesh", "mesh_vertices")
        server.query(self.make)
        server.settle()

    def record(self, change, samples, **figures):
        self.suite.measurements.append({"what": "edit", "change": change, **self.labels, **figures,
                                        "samples": samples})

    def changed(self, change, condition, count, **settings):
        """A sample of one statement that changes many points of a fresh mesh."""
        self.fresh_mesh()
        with server.Session(**settings) as session:
            sample = session.timed(f"SELECT abacus_{change}('mesh', '{self.select} {condition}')")
        if int(sample.pop("printed")) != count:
            raise server.Failure(f"abacus_{change} did not change {count} points")
        self.suite.say(f"  {change} {count:,} points: {sample['wall']:.3f} s")
        return sample

    def insert_many(self, runs):
        """As many points as there are, in turns with a first build of the points that are inserted."""
        built, inserted = [], []
        for _ in range(runs):
            built.append(self.built_of_others())
            inserted.append(self.changed("insert", f"id > {self.size}", self.size))
        self.record("build many", built, changed=self.size)
        self.record("insert many", inserted, changed=self.size)

    def built_of_others(self):
        """A sample of a first build of the points that are inserted."""
        server.drop("mesh", "mesh_vertices")
        server.settle()
        with server.Session() as session:
            sample = session.timed(self.points.triangulate(f" WHERE id > {self.size}"))
        del sample["printed"]
        self.suite.say(f"  build of {self.size:,} points: {sample['wall']:.3f} s")
        return sample

    def delete_many(self, runs):
        count = self.size // 2
        samples = [self.changed("delete", f"id <= {self.size} AND id % 2 = 0", count) for _ in range(runs)]
        self.record("delete many", samples, changed=count)

    def grow(self, runs):
        """A mesh that begins with the points of one tile, a corner, and gets the others tile by tile."""
        axis = TILES_OF_AN_AXIS[self.dimension]
        tiles = axis ** self.dimension
        tile = " + ".join(f"floor({axis} * {x})::int * {axis ** i}"
                          for i, x in enumerate(self.points.columns.split(",")))
        server.drop("tiles")
        server.query(f"CREATE TABLE tiles AS SELECT *, {tile} AS tile FROM points WHERE id <= {self.size};"
                     " CREATE INDEX ON tiles (tile); ANALYZE tiles")
        of_tile = f"SELECT id, {self.points.columns} FROM tiles WHERE tile ="
        samples = []
        for _ in range(runs):
            server.drop("mesh", "mesh_vertices")
            server.query(f"SELECT abacus_triangulate('mesh', '{of_tile} 0', dimension => {self.dimension})")
            server.settle()
            with server.Session() as session:
                sample = session.timed(f"DO $$ BEGIN FOR tile IN 1 .. {tiles - 1} LOOP"
                                       f" PERFORM abacus_insert('mesh', '{of_tile} ' || tile); COMMIT;"
                                       " END LOOP; END $$")
            del sample["printed"]
            samples.append(sample)
            self.suite.say(f"  {tiles} tiles: {sample['wall']:.3f} s")
        count = int(server.query("SELECT value FROM abacus_stats('mesh') WHERE name = 'points'"))
        if count != self.size:
            raise server.Failure(f"{count} of {self.size} points are in the tiles")
        server.drop("tiles")
        self.record("grow many", samples, changed=self.size, tiles=tiles)

    def space(self, at_once):
        """Half of the points replaced, at random places, so many in a statement: the table's size."""
        size = "SELECT pg_total_relation_size('mesh') + pg_total_relation_size('mesh_vertices')"
        self.fresh_mesh()
        fresh, wal = int(server.query(size)), server.wal_position()
        half = self.size // 2
        with server.Session() as session:
            for first in range(0, half, at_once):
                chosen = f"number > {first} AND number <= {min(first + at_once, half)}"
                for change, which in (("delete", "NOT comes"), ("insert", "comes")):
                    session.run(f"SELECT abacus_{change}('mesh', 'SELECT id, {self.points.columns}"
                                f" FROM queue WHERE {which} AND {chosen}')")
        sample = {"fresh": fresh, "wal": server.wal_position() - wal, "after": int(server.query(size))}
        # a measurement that moves pages begins with one that does not
        for which, moves in (("vacuumed", "off"), ("moved", "on")):
            with server.Session() as session:
                session.run("LOAD 'abacus'")
                session.run(f"SET abacus.vacuum_moves_rows = {moves}")
                session.run("VACUUM mesh, mesh_vertices")
            sample[which] = int(server.query(size))
        self.suite.say(f"  {at_once:,} in a statement: {sample['vacuumed'] / fresh:.2f} times the size,"
                       f" {sample['moved'] / fresh:.2f} after VACUUM that moves pages")
        self.record("space", [sample], changed=2 * half, at_once=at_once)

    def queue(self):
        """A table of the points in random order: those of the mesh, and others that come."""
        server.drop("queue")
        server.query(f"CREATE TABLE queue AS SELECT id, {self.points.columns}, id > {self.size} AS comes,"
                     f" row_number() OVER (PARTITION BY id > {self.size} ORDER BY hashint8(id)) AS number"
                     " FROM points; CREATE UNIQUE INDEX ON queue (comes, number); ANALYZE queue")

    def one_by_one(self):
        """Latencies of single points, each in a transaction of its own, by pgbench."""
        place = ", ".join(f"(:n % {prime}) / {prime}.0" for prime in (99991, 77773, 55541)[:self.dimension])
        self.latency("insert", "\\set n random(1, 2000000000)\n"
                     f"SELECT abacus_insert('mesh', 'SELECT 3000000000 + :n, {place}');")
        server.query("DROP SEQUENCE IF EXISTS next_victim;"
                     f" CREATE SEQUENCE next_victim START {self.size // 2 + 1}")
        self.latency("delete", f"SELECT abacus_delete('mesh', format('SELECT id, {self.points.columns}"
                     " FROM queue WHERE NOT comes AND number = %s', nextval('next_victim')));")

    def latency(self, change, statement):
        ordered = latencies(statement, SINGLE[self.suite.mode])
        self.suite.say(f"  {change} one point: {1000 * statistics.median(ordered):.2f} ms")
        self.record(f"{change} one", [{"wall": round(statistics.median(ordered), 6)}], transactions=len(ordered),
                    percentile99=ordered[len(ordered) * 99 // 100])


def latencies(statement, count):
    """Seconds of so many transactions of pgbench, in ascending order."""
    with tempfile.TemporaryDirectory() as folder:
        script = pathlib.Path(folder) / "script"
        script.write_text(statement + "\n")
        subprocess.run(["pgbench", "-n", "-t", str(count), "-f", script, "-l", f"--log-prefix={folder}/log"],
                       check=True, capture_output=True)
        seconds = [int(line.split()[2]) * 1e-6 for log in pathlib.Path(folder).glob("log.*")
                   for line in log.read_text().splitlines()]
    if len(seconds) != count:
        raise server.Failure(f"pgbench ended {len(seconds)} of {count} transactions")
    return sorted(seconds)


class SharedDeletes(Edits):
    """Half of the points of a mesh leave: by one thread, by two, and by all processors."""

    def measure(self, suite):
        self.begin(suite)
        count = self.size // 2
        for threads in sorted({1, 2, os.cpu_count()}):
            samples = [self.changed("delete", f"id <= {self.size} AND id % 2 = 0", count, abacus__threads=threads)
                       for _ in range({"full": 3, "quick": 1, "smoke": 1}[suite.mode])]
            self.record("delete shared many", samples, changed=count, threads=threads)
        server.drop("mesh", "mesh_vertices", "points")


def cancelled_builds(dimension, sizes):
    """A part: how long a cancel takes at several moments of a build, which then leaves nothing."""
    def measure(suite):
        points = PointSet(dimension, "uniform", sizes[suite.mode])
        count = points.create_table()
        with server.Session() as session:
            whole = session.timed(points.triangulate())["wall"]
        samples = []
        for share in (0.03, 0.1, 0.25, 0.4, 0.6, 0.8, 0.95):
            server.drop("mesh", "mesh_vertices")
            waited = cancel_after(points, share * whole)
            if waited is not None:
                samples.append({"wall": round(waited, 6), "share": share})
        if samples:
            suite.say(f"  longest wait for a cancel: {max(s['wall'] for s in samples):.3f} s")
            suite.measurements.append({"what": "cancel", "dimension": dimension, "set": "uniform",
                                       "points": count, "samples": samples})
        server.drop("mesh", "mesh_vertices", "points")
    return measure


def cancel_after(points, seconds):
    """Seconds from pg_cancel_backend to the end of the statement; None if that had ended before."""
    outcome = []
    with server.Session() as session, server.Session() as other:
        def build():
            try:
                session.run(points.triangulate())
            except server.Failure as failure:
                outcome.append((time.monotonic(), str(failure)))
        victim = threading.Thread(target=build)
        victim.start()
        time.sleep(seconds)
        start = time.monotonic()
        other.run(f"SELECT pg_cancel_backend({session.backend})")
        victim.join()
    if not outcome:
        return None
    ended, message = outcome[0]
    if "canceling statement" not in message or server.query("SELECT to_regclass('mesh') IS NULL") != "t":
        raise server.Failure(f"a cancelled build: {message}")
    return ended - start
