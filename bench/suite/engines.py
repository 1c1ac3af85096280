"""What is compared: each engine makes the triangulation of a point set once, as a sample.

Abacus is timed from the table of points to the committed mesh; PostGIS from the same table to the
geometry, which is kept nowhere, and to committed and indexed rows; the others read a file of the
same points and build in core (bench/comparators).
"""
import json
import subprocess

import paths
import server
from points import PointSet


class Program:
    """A program of bench/comparators."""

    def __init__(self, engine):
        self.labels = {"engine": engine}
        self.program = paths.PROGRAMS / f"bench_{engine}"

    def sample(self, points: PointSet):
        done = subprocess.run([self.program, str(points.dimension), points.file],
                              stdout=subprocess.PIPE, check=True)
        return json.loads(done.stdout)

    def details(self):
        return {}


class Parallel(Program):
    """CGAL's parallel triangulation, by so many threads."""

    def __init__(self, threads):
        super().__init__("cgal_parallel")
        self.labels["threads"] = threads

    def sample(self, points: PointSet):
        done = subprocess.run([self.program, str(points.dimension), points.file, self.labels["threads"]],
                              stdout=subprocess.PIPE, check=True)
        return json.loads(done.stdout)


class Abacus:
    """abacus_triangulate by one thread with a cache of a given size, all other settings at their defaults."""

    def __init__(self, cache):
        self.labels = {"engine": "abacus", "cache": cache}
        self.settings = {}

    def sample(self, points: PointSet):
        server.drop("mesh", "mesh_vertices")
        server.settle()
        megabytes = server.cache_size(self.labels["cache"])
        with server.Session(abacus__cache_size=f"{megabytes}MB", **self.settings) as session:
            sample = session.timed(points.triangulate())
        sample["simplices"] = int(sample.pop("printed"))
        return sample

    def details(self):
        """Of the mesh that the last run has left."""
        return server.mesh_sizes()


class Threads(Abacus):
    """The same with the default cache and so many threads."""

    def __init__(self, threads):
        super().__init__("default")
        self.labels["threads"] = threads
        self.settings = {"abacus__threads": threads}


class PostGIS:
    """ST_DelaunayTriangles. Its answer is counted, which takes next to no time."""

    triangles = "ST_DelaunayTriangles(ST_Collect(ST_MakePoint(x, y)))"

    def __init__(self):
        self.labels = {"engine": "postgis"}

    def sample(self, points: PointSet):
        server.create_extension("postgis")
        server.settle()
        with server.Session() as session:
            sample = session.timed(f"SELECT ST_NumGeometries({self.triangles}) FROM points")
        sample["simplices"] = int(sample.pop("printed"))
        return sample

    def details(self):
        return {}


class KeptPostGIS(PostGIS):
    """The same, and its triangles are kept, as a mesh is: a row each, with an index to find them by."""

    def __init__(self):
        self.labels = {"engine": "postgis_kept"}

    def sample(self, points: PointSet):
        server.create_extension("postgis")
        server.drop("triangles")
        server.settle()
        with server.Session() as session:
            sample = session.timed("DO $$ BEGIN CREATE TABLE triangles AS"
                                   f" SELECT (ST_Dump({self.triangles})).geom FROM points;"
                                   " CREATE INDEX ON triangles USING gist (geom); END $$")
        del sample["printed"]
        sample["simplices"] = int(server.query("SELECT count(*) FROM triangles"))
        self.disk = {"simplices": int(server.query("SELECT pg_table_size('triangles')")),
                     "index": int(server.query("SELECT pg_indexes_size('triangles')"))}
        server.drop("triangles")
        return sample

    def details(self):
        return {"disk": self.disk}


def engine(name, say):
    """Of a name: cgal, tetgen, qhull, postgis, postgis:kept, abacus:CACHE, threads:COUNT or cgal_parallel:COUNT;
    None if it is not installed."""
    if name.startswith("cgal_parallel:"):
        parallel = Parallel(name.removeprefix("cgal_parallel:"))
        if parallel.program.exists():
            return parallel
        say("CGAL's parallel triangulation is left out: it was built without TBB (libtbb-dev)")
        return None
    if name.startswith("threads:"):
        return Threads(name.removeprefix("threads:"))
    if name.startswith("abacus:"):
        return Abacus(name.removeprefix("abacus:"))
    if not name.startswith("postgis"):
        return Program(name)
    if server.has_extension("postgis"):
        return KeptPostGIS() if name == "postgis:kept" else PostGIS()
    say("PostGIS is not installed and left out")
    return None
