"""Point location as one does it without Abacus: a table of one row a triangle, with its box under
GiST; what the index finds is tested by the signs of three areas.

The signs are those of double precision, which is quick and may be wrong near an edge. Numeric would
be no better: the cast from double precision rounds to 15 digits. So the rows are favoured.
"""
import server
from location import create_places
from points import PointSet

# box(p, p) lies in the box of the triangle's corners, and p is not to the right of an edge.
ROWS = """
    SELECT count(t.v0), sum(t.v0 + t.v1 + t.v2) FROM {places} AS p
    LEFT JOIN LATERAL (
        SELECT v0, v1, v2 FROM triangles
        WHERE box && box(point(p.x, p.y), point(p.x, p.y))
          AND (x1 - x0) * (p.y - y0) - (y1 - y0) * (p.x - x0) >= 0
          AND (x2 - x1) * (p.y - y1) - (y2 - y1) * (p.x - x1) >= 0
          AND (x0 - x2) * (p.y - y2) - (y0 - y2) * (p.x - x2) >= 0
        LIMIT 1) AS t ON true"""
POSTGIS = """
    SELECT count(t.v0), sum(t.v0 + t.v1 + t.v2) FROM {places} AS p
    LEFT JOIN LATERAL (
        SELECT v0, v1, v2 FROM polygons WHERE ST_Intersects(polygon, ST_MakePoint(p.x, p.y))
        LIMIT 1) AS t ON true"""
ABACUS = """
    SELECT count(t.v0), sum(t.v0 + t.v1 + t.v2) FROM {places} AS p
    LEFT JOIN LATERAL abacus_locate('mesh', p.x, p.y) AS t ON true"""

TABLES = {
    "rows": """
        CREATE TABLE triangles AS
        SELECT v0, v1, v2, a.x AS x0, a.y AS y0, b.x AS x1, b.y AS y1, c.x AS x2, c.y AS y2,
               box(point(least(a.x, b.x, c.x), least(a.y, b.y, c.y)),
                   point(greatest(a.x, b.x, c.x), greatest(a.y, b.y, c.y))) AS box
        FROM abacus_simplices('mesh') AS t JOIN points AS a ON a.id = v0 JOIN points AS b ON b.id = v1
             JOIN points AS c ON c.id = v2
        ORDER BY code;
        CREATE INDEX ON triangles USING gist (box)""",
    "postgis": """
        CREATE TABLE polygons AS
        SELECT v0, v1, v2, ST_MakePolygon(ST_MakeLine(ARRAY[ST_MakePoint(x0, y0), ST_MakePoint(x1, y1),
               ST_MakePoint(x2, y2), ST_MakePoint(x0, y0)])) AS polygon
        FROM triangles;
        CREATE INDEX ON polygons USING gist (polygon)""",
}
STATEMENTS = {"abacus": ABACUS, "rows": ROWS, "postgis": POSTGIS}


class Rows:
    """(points, places) by mode: places at random, and the same along the curve, warm."""

    def __init__(self, sizes, runs):
        self.sizes, self.runs = sizes, runs

    def measure(self, suite):
        size, places = self.sizes[suite.mode]
        server.restart(shared_buffers="2GB")
        try:
            self.compare(suite, PointSet(2, "uniform", size), places)
        finally:
            server.restart()
        server.drop("mesh", "mesh_vertices", "points", "triangles", "polygons", "places", "ordered")

    def compare(self, suite, points, places):
        labels = {"dimension": 2, "set": points.name, "points": points.create_table(), "places": places}
        server.query(points.triangulate())
        engines = make_tables()
        create_places(points, places)
        for order in "ordered", "places":
            measurements = [{"what": "rows", "engine": engine, "order": order, **labels,
                             "bytes": table_bytes(engine), "samples": []} for engine in engines]
            with server.Session(abacus__cache_size="2GB", max_parallel_workers_per_gather=0,
                                jit="off") as session:
                for run in range(1 + self.runs[suite.mode]):  # the first one warms
                    answers = set()
                    for measurement in measurements:
                        sample = session.timed(STATEMENTS[measurement["engine"]].format(places=order))
                        answers.add(sample.pop("printed"))
                        if run > 0:
                            measurement["samples"].append(sample)
                    if len(answers) > 1:
                        raise server.Failure(f"answers differ: {answers}")
            suite.measurements += measurements
            for measurement in measurements:
                cpu = measurement["samples"][-1]["cpu"]
                suite.say(f"  {order:8} {measurement['engine']:8} {places / cpu:12,.0f} places a CPU second")


def make_tables():
    """One for each habit; what to compare."""
    engines = ["abacus", "rows"]
    server.drop("triangles", "polygons")
    server.query(TABLES["rows"])
    if server.has_extension("postgis"):
        server.query("SET client_min_messages = warning; CREATE EXTENSION IF NOT EXISTS postgis")
        server.query(TABLES["postgis"])
        engines.append("postgis")
    for table in ["triangles", "polygons"][:len(engines) - 1]:
        server.query(f"VACUUM (FREEZE, ANALYZE) {table}")
    return engines


def table_bytes(engine):
    """With the index."""
    table = {"abacus": "mesh", "rows": "triangles", "postgis": "polygons"}[engine]
    return int(server.query(f"SELECT pg_total_relation_size('{table}')"))
