"""Parts of `threads`: a mesh checked, and many places asked; points sorted, and a mesh loaded. By one thread, by
two, and by all processors."""
import os

import server
from points import PointSet

STATEMENTS = {
    "check": "SELECT count(*) FROM abacus_check('mesh')",
    "locate": "SELECT count(code) FROM abacus_locate('mesh', 'TABLE places')",
    "natural": "SELECT count(weight) FROM abacus_weights('mesh', 'TABLE places', method => 'natural')",
    "nearest": "SELECT count(distance) FROM abacus_nearest('mesh', 'TABLE places', 4)",
}


class SharedReading:
    """sizes: by mode, of the mesh and of the places."""

    def __init__(self, dimension, sizes, runs):
        self.dimension, self.sizes, self.runs = dimension, sizes, runs

    def measure(self, suite):
        size, places = self.sizes[suite.mode]
        axes = ", ".join("xyz"[:self.dimension])
        server.drop("places")
        points = PointSet(self.dimension, "uniform", size)
        points.create_table()
        server.query(points.triangulate())
        coordinates = ", ".join("random()" for _ in range(self.dimension))
        server.query(f"SELECT setseed(0.5); CREATE TABLE places (id, {axes}) AS"
                     f" SELECT id, {coordinates} FROM generate_series(1, {places}) AS id")
        server.query("VACUUM (FREEZE, ANALYZE) mesh, places")
        for name, statement in STATEMENTS.items():
            self.measure_statement(suite, name, statement, size, places)
        server.drop("mesh", "mesh_vertices", "points", "places")

    def measure_statement(self, suite, name, statement, size, places=0, before=lambda: None):
        """In turns, so that what else the machine does concerns all alike."""
        counts = sorted({1, 2, os.cpu_count()})
        measurements = [{"what": "shared reading", "question": name, "threads": str(count), "dimension": self.dimension,
                         "points": size, "places": places, "samples": []} for count in counts]
        answers = set()
        for _ in range(self.runs[suite.mode]):
            for count, measurement in zip(counts, measurements):
                before()
                with server.Session(abacus__threads=count) as session:
                    sample = session.timed(statement)
                answers.add(sample.pop("printed"))
                measurement["samples"].append(sample)
                suite.say(f"  {name:8} {count} threads  {sample['wall']:9.3f} s   CPU {sample['cpu']:9.3f} s")
        if len(answers) > 1:
            raise server.Failure(f"{name}: answers differ by the number of threads: {answers}")
        suite.measurements += measurements


class SharedLoading(SharedReading):
    """sizes: by mode, of the points. Sorting is staging: query, sort, and vertex pages."""

    def measure(self, suite):
        size = self.sizes[suite.mode]
        axes, corners = ", ".join("xyz"[:self.dimension]), ", ".join(f"v{i}" for i in range(self.dimension + 1))
        points = PointSet(self.dimension, "uniform", size)
        points.create_table()
        server.query(points.triangulate())
        server.query(f"CREATE TABLE corners AS SELECT id, {axes} FROM abacus_vertices('mesh');"
                     f" CREATE TABLE simplices AS SELECT {corners} FROM abacus_simplices('mesh') ORDER BY random()")
        server.query("VACUUM (FREEZE, ANALYZE) points, corners, simplices")

        def without_mesh():
            server.drop("mesh", "mesh_vertices")

        def with_empty_mesh():
            without_mesh()
            server.query(f"SELECT abacus_create('mesh', {self.dimension})")

        self.measure_statement(suite, "sort", f"SELECT abacus_stage('mesh', 'SELECT id, {axes} FROM points')", size,
                               before=with_empty_mesh)
        self.measure_statement(suite, "load", "SELECT abacus_load('mesh', 'TABLE corners', 'TABLE simplices')", size,
                               before=without_mesh)
        server.drop("mesh", "mesh_vertices", "points", "corners", "simplices")
