"""An octree of points in the unit square or cube: made, balanced, extracted and asked, beside p4est in memory."""
import json
import subprocess

import paths
import server
from points import PointSet

MOST = 1  # points in a leaf
P4EST = paths.PROGRAMS / "bench_p4est"  # exists if its library is installed


class Octrees:
    """`sizes`: numbers of points by mode, in each dimension."""

    def __init__(self, sizes):
        self.sizes = sizes

    def measure(self, suite):
        self.suite = suite
        self.runs = {"full": 3, "quick": 1, "smoke": 1}[suite.mode]
        for dimension in 2, 3:
            points = PointSet(dimension, "uniform", self.sizes[suite.mode])
            with points.in_file():
                self.contest(points, points.create_table())
        server.drop("tree", "tree_vertices", "points")

    def contest(self, points, size):
        """In turns; each makes the same leaves."""
        steps = {}
        for _ in range(self.runs):
            leaves = self.abacus(points, size, steps)
            if P4EST.exists() and self.p4est(points, steps) != leaves:
                raise server.Failure("p4est has made another number of leaves")
        for (engine, step), samples in steps.items():
            self.suite.measurements.append({"what": "octree", "dimension": points.dimension, "points": size, "leaves": leaves,
                                            "engine": engine, "step": step, "samples": samples})
            self.suite.say(f"  {points.dimension}D {step:10} {engine:8} {min(sample['wall'] for sample in samples):9.4f} s")

    def abacus(self, points, size, steps):
        """The steps one after the other, in one session; the number of leaves."""
        server.drop("tree", "tree_vertices")
        server.settle()
        ends = ("{0,0}", "{1,1}") if points.dimension == 2 else ("{0,0,0}", "{1,1,1}")
        with server.Session(abacus__cache_size="64MB", max_parallel_workers_per_gather=0) as session:
            session.run(f"SELECT abacus_octree_create('tree', {points.dimension}, '{ends[0]}', '{ends[1]}')")

            def timed(step, statement):
                sample = session.timed(statement)
                sample["answers"] = int(sample.pop("printed"))
                steps.setdefault(("abacus", step), []).append(sample)
                return sample

            timed("construct", f"SELECT abacus_octree_from_points('tree', 'SELECT id, {points.columns} FROM points', {MOST})")
            balance = timed("balance", "SELECT abacus_octree_balance('tree')")
            balance["bytes"] = int(server.query("SELECT pg_table_size('tree') + pg_indexes_size('tree')"))
            # In a select list, rows are passed on one by one.
            for step, function in ("nodes", "nodes"), ("elements", "elements"), ("simplices", "tetrahedra"):
                timed(step, f"SELECT count(*) FROM (SELECT abacus_octree_{function}('tree') OFFSET 0) AS row")
            located = timed("locate", f"SELECT count(code) FROM abacus_octree_locate('tree', 'SELECT id, {points.columns} FROM points')")
            if located["answers"] != size:
                raise server.Failure("a place is in no leaf")
        return balance["answers"]

    def p4est(self, points, steps):
        """In memory; nodes and elements are one step."""
        printed = subprocess.run([P4EST, str(points.dimension), points.file], stdout=subprocess.PIPE, check=True).stdout
        figures = json.loads(printed)
        for step, phase in ("construct", "construct"), ("balance", "balance"), ("nodes", "extract"):
            steps.setdefault(("p4est", step), []).append({"wall": figures[phase]})
        return figures["simplices"]
