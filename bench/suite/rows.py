"""Point location as one does it without Abacus: a table of one row a triangle, with its box under
GiST; what the index finds is tested by the signs of three areas.

In double precision these are quick to get and may be wrong near an edge. As `numeric` they are
exact, if coordinates can be had exactly: here all are multiples of 2^-53, so times 2^53 they are
integers. (The plain cast from double precision rounds to 15 digits.)
"""
import server
from location import create_places
from points import PointSet

SCALE = 2**53

# The triangle's box contains the place, and the place is not to the right of any edge.
ROWS = """
    SELECT count(t.v0), sum(t.v0 + t.v1 + t.v2) FROM {{places}} AS p
    LEFT JOIN LATERAL (
        SELECT v0, v1, v2 FROM {table}
        WHERE box && box(point(p.x, p.y), point(p.x, p.y))
          AND (x1 - x0) * (p.{y} - y0) - (y1 - y0) * (p.{x} - x0) >= 0
          AND (x2 - x1) * (p.{y} - y1) - (y2 - y1) * (p.{x} - x1) >= 0
          AND (x0 - x2) * (p.{y} - y2) - (y0 - y2) * (p.{x} - x2) >= 0
        LIMIT 1) AS t ON true"""
POSTGIS = """
    SELECT count(t.v0), sum(t.v0 + t.v1 + t.v2) FROM {places} AS p
    LEFT JOIN LATERAL (
        SELECT v0, v1, v2 FROM polygons WHERE ST_Intersects(polygon, ST_MakePoint(p.x, p.y))
        LIMIT 1) AS t ON true"""
# In the select list, and in a join like the others: there PostgreSQL makes a table for each row, which takes longer than the
# answer.
ABACUS = """
    SELECT count(t), sum((t).v0 + (t).v1 + (t).v2)
    FROM (SELECT abacus_locate('mesh', p.x, p.y) AS t FROM {places} AS p OFFSET 0) AS located"""
ABACUS_JOINED = """
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
    "exact_rows": """
        CREATE TABLE exact_triangles AS SELECT v0, v1, v2, """
    + ", ".join(f"({c}{i} * {SCALE})::bigint::numeric AS {c}{i}" for i in range(3) for c in "xy")
    + """, box FROM triangles;
        CREATE INDEX ON exact_triangles USING gist (box)""",
    "postgis": """
        CREATE TABLE polygons AS
        SELECT v0, v1, v2, ST_MakePolygon(ST_MakeLine(ARRAY[ST_MakePoint(x0, y0), ST_MakePoint(x1, y1),
               ST_MakePoint(x2, y2), ST_MakePoint(x0, y0)])) AS polygon
        FROM triangles;
        CREATE INDEX ON polygons USING gist (polygon)""",
}
STATEMENTS = {"abacus": ABACUS, "abacus_joined": ABACUS_JOINED,
              "rows": ROWS.format(table="triangles", x="x", y="y"),
              "exact_rows": ROWS.format(table="exact_triangles", x="exact_x", y="exact_y"),
              "postgis": POSTGIS}
TABLE_OF = {"abacus": "mesh", "abacus_joined": "mesh", "rows": "triangles", "exact_rows": "exact_triangles",
            "postgis": "polygons"}


class Rows:
    """(points, places, …) by mode: so many places at random, and the same along the curve, warm: a
    statement is timed right after it has run, as places a second are (location.py)."""

    def __init__(self, sizes, runs, habits=("rows", "exact_rows", "postgis"), disk=0):
        self.sizes, self.runs, self.habits, self.disk = sizes, runs, habits, disk

    def measure(self, suite):
        if suite.mode not in self.sizes:
            return
        server.require_disk(self.disk)
        wanted, *counts = self.sizes[suite.mode]
        points = PointSet(2, "uniform", wanted)
        server.restart(shared_buffers="2GB")
        try:
            size = points.create_table()
            server.query(points.triangulate())
            engines = ["abacus", "abacus_joined", *make_tables(self.habits)]
            for places in counts:
                create_places(points, places)
                add_exact_places()
                self.compare(suite, engines,
                             {"dimension": 2, "set": points.name, "points": size, "places": places})
        finally:
            server.restart()
        server.drop("mesh_vertices", "points", *dict.fromkeys(TABLE_OF.values()), "places", "ordered")

    def compare(self, suite, engines, labels):
        for order in "ordered", "places":
            measurements = [{"what": "rows", "engine": engine, "order": order, **labels,
                             "bytes": table_bytes(engine), "samples": []} for engine in engines]
            with server.Session(abacus__cache_size="2GB", max_parallel_workers_per_gather=0,
                                jit="off") as session:
                for _ in range(self.runs[suite.mode]):
                    answers = set()
                    for measurement in measurements:
                        statement = STATEMENTS[measurement["engine"]].format(places=order)
                        session.run(statement)  # otherwise its memory is as the other engines left it
                        sample = session.timed(statement)
                        answers.add(sample.pop("printed"))
                        measurement["samples"].append(sample)
                    if len(answers) > 1:
                        raise server.Failure(f"answers differ: {answers}")
            suite.measurements += measurements
            for measurement in measurements:
                cpu = measurement["samples"][-1]["cpu"]
                suite.say(f"  {order:8} {measurement['engine']:13} {labels['places'] / cpu:12,.0f}"
                          " places a CPU second")


def make_tables(habits):
    """One for each habit; those that there are."""
    if server.has_extension("postgis"):
        server.create_extension("postgis")
    else:
        habits = [habit for habit in habits if habit != "postgis"]
    server.drop(*(TABLE_OF[habit] for habit in habits))
    for habit in habits:
        server.query(TABLES[habit])
        server.query(f"VACUUM (FREEZE, ANALYZE) {TABLE_OF[habit]}")
    return habits


def add_exact_places():
    """As integers, beside those in double precision."""
    for table in "places", "ordered":
        server.query(f"ALTER TABLE {table} " + ", ".join(
            f"ADD exact_{c} numeric GENERATED ALWAYS AS (({c} * {SCALE})::bigint::numeric) STORED"
            for c in "xy"))
        server.query(f"VACUUM (FREEZE, ANALYZE) {table}")


def table_bytes(engine):
    """With the index."""
    return int(server.query(f"SELECT pg_total_relation_size('{TABLE_OF[engine]}')"))
