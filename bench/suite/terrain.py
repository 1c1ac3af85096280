"""A terrain with breaklines and regions: from three tables to a table of contours, beside the points alone; then points and lines that come into
regions."""
import math

import server
from ask import HEIGHT, LEVELS
from edits import SINGLE, latencies

BLOCK = 5  # cells along a side of a region
SHORE = [(n, 0) for n in range(BLOCK)] + [(BLOCK, n) for n in range(BLOCK)] + [(n, BLOCK) for n in range(BLOCK, 0, -1)] \
    + [(0, n) for n in range(BLOCK, 0, -1)]
CORNERS = 6  # of a breakline

# A grid of cells. A region is a block of them, one or more cells away from the next; the corners of its outline are up to 0.08 of a cell beside those
# of the cells. A cell has one breakline at most, and above that there is room for another line. All corners are points of the terrain.
MAKE = """
CREATE TABLE places AS SELECT 'parcel ' || n AS region, n AS line, 1 + (n - 1) % {across} * {stride} AS x, 1 + (n - 1) / {across} * {stride} AS y
    FROM generate_series(1, {regions}) AS n;
CREATE TABLE corners AS
    SELECT line, n AS position, (line - 1) * {around} + n AS id, (x + dx + 0.16 * (random() - 0.5)) / {cells} AS x,
        (y + dy + 0.16 * (random() - 0.5)) / {cells} AS y FROM places, (VALUES {shore}) AS corner (n, dx, dy)
    UNION ALL
    SELECT {regions} + n, k, {regions} * {around} + (n - 1) * {corners} + k, ((n - 1) % {cells} + 0.1 + 0.8 * (k - 1) / {corners}) / {cells},
        ((n - 1) / {cells} + 0.2 + 0.5 * random()) / {cells} FROM generate_series(1, {lines}) AS n, generate_series(1, {corners}) AS k;
CREATE TABLE points AS SELECT id, x, y, {height} AS height FROM
    (SELECT id, x, y FROM corners UNION ALL
     SELECT id, random(), random() FROM generate_series((SELECT max(id) FROM corners) + 1, {points}) AS id) AS place;
CREATE TABLE lines AS SELECT line, position, id AS point FROM corners UNION ALL
    SELECT line, {around} + 1, id FROM corners WHERE line <= {regions} AND position = 1;
CREATE TABLE regions AS SELECT region, line FROM places;
CREATE TABLE beside AS SELECT n AS number, (x + 0.1 + {inner} * random()) / {cells} AS x, (y + 0.1 + {inner} * random()) / {cells} AS y
    FROM generate_series(1, {single}) AS n JOIN places ON line = 1 + n % {regions};
CREATE TABLE added AS SELECT 1000000 + n AS line, k AS position, NULL::bigint AS point, (x + n / {regions} % {block} + 0.3 * k) / {cells} AS x,
        (y + n / {regions} / {block} % {block} + 0.8 + 0.1 * random()) / {cells} AS y, 0.0::float8 AS height
    FROM generate_series(1, {added}) AS n JOIN places ON line = 1 + n % {regions}, generate_series(1, 2) AS k;
CREATE UNIQUE INDEX ON beside (number);
CREATE INDEX ON added (line);
"""
TABLES = "points", "lines", "regions", "places", "corners", "beside", "added", "contours"
MESH = "mesh", "mesh_vertices", "mesh_lines", "mesh_regions"
ADDED = {"full": 50, "quick": 20, "smoke": 5}

TRIANGULATE = "SELECT abacus_triangulate('mesh', 'TABLE points')"
REGION = "SELECT abacus_region('mesh', 'TABLE regions')"
EACH = f"SELECT count(*) FROM regions, abacus_contours('mesh', fixed_levels => ARRAY{LEVELS}, within => region)"

# What is asked by a statement of its own is no step on the way to the table of contours.
WAYS = {
    "points alone": {"triangulate": TRIANGULATE, "contours": None},
    "points, then lines": {"triangulate": TRIANGULATE, "constrain": "SELECT abacus_constrain('mesh', 'TABLE lines')", "region": REGION,
                           "contours": None, "each": EACH},
    "points and lines in one call": {"triangulate": TRIANGULATE.removesuffix(")") + ", lines => 'TABLE lines')", "region": REGION,
                                     "contours": None, "each": EACH},
}


class Terrain:
    """sizes: points, breaklines and regions, by mode."""

    def __init__(self, sizes, runs):
        self.sizes, self.runs = sizes, runs

    def measure(self, suite):
        self.suite = suite
        points, lines, regions = self.sizes[suite.mode]
        self.labels = {"points": points, "lines": lines, "regions": regions}
        self.make_tables(points, lines, regions)
        self.contours = self.contours_statement()
        self.builds()
        server.restart(fsync="off")
        try:
            self.edits()
        finally:
            server.restart()
        server.drop(*MESH, *TABLES)

    def make_tables(self, points, lines, regions):
        server.drop(*MESH, *TABLES)
        cells, across = math.isqrt(lines - 1) + 1, math.isqrt(regions - 1) + 1
        server.query("SELECT setseed(0.25); " + MAKE.format(
            points=points, lines=lines, regions=regions, cells=cells, across=across, stride=cells // across, around=len(SHORE), block=BLOCK,
            corners=CORNERS, inner=BLOCK - 0.2, height=HEIGHT, single=SINGLE[self.suite.mode], added=ADDED[self.suite.mode],
            shore=", ".join(f"({n}, {x}, {y})" for n, (x, y) in enumerate(SHORE, 1))))
        server.query("VACUUM (FREEZE, ANALYZE)")

    def contours_statement(self):
        """Into a table of geometries, if there is PostGIS."""
        self.labels["geometries"] = server.has_extension("postgis") and server.has_extension("abacus_postgis")
        if not self.labels["geometries"]:
            self.suite.say("  PostGIS is not installed: contours are arrays")
            return f"CREATE TABLE contours AS SELECT * FROM abacus_contours('mesh', fixed_levels => ARRAY{LEVELS})"
        for extension in "postgis", "abacus_postgis":
            server.create_extension(extension)
        return f"CREATE TABLE contours AS SELECT * FROM abacus_contours_geom('mesh', fixed_levels => ARRAY{LEVELS})"

    # ---- From tables to contours ----------------------------------------------------

    def builds(self):
        samples = {way: [] for way in WAYS}
        for _ in range(self.runs[self.suite.mode]):
            for way, steps in WAYS.items():
                samples[way].append(self.build(steps))
                self.suite.say(f"  {way:30} {samples[way][-1]['wall']:9.3f} s")
        if len({sample["answers"] for way, taken in samples.items() if way != "points alone" for sample in taken}) > 1:
            raise server.Failure("the contours of one mesh differ")
        for way, taken in samples.items():
            self.suite.measurements.append({"what": "terrain", "way": way, **self.labels, "samples": taken})

    def build(self, steps):
        """All steps in a session, with the time of each, and the sums."""
        server.drop(*MESH, "contours")
        server.settle()
        with server.Session() as session:
            taken = {step: session.timed(statement or self.contours) for step, statement in steps.items()}
        counted = [sample for step, sample in taken.items() if step != "each"]
        return {"wall": sum(sample["wall"] for sample in counted), "cpu": sum(sample["cpu"] for sample in counted),
                "memory": max(sample["memory"] for sample in counted), "answers": int(server.query("SELECT count(*) FROM contours")),
                **{step: sample["wall"] for step, sample in taken.items()}}

    # ---- Points and lines that come -------------------------------------------------

    def edits(self):
        """Each in a transaction of its own: into regions, which are there from the last build, and where there are neither lines nor regions."""
        for has_regions in True, False:
            if not has_regions:
                server.drop(*MESH)
                server.query(TRIANGULATE)
            self.edit("point", has_regions, "SELECT abacus_insert('mesh', format('SELECT 9000000000 + number, x, y, 0.0 FROM beside WHERE number = %s',"
                      " nextval('next')));", SINGLE[self.suite.mode])
            self.edit("line", has_regions, "SELECT abacus_constrain('mesh', format('SELECT * FROM added WHERE line = 1000000 + %s',"
                      " nextval('next')));", ADDED[self.suite.mode])
            faults = server.query("SELECT count(*) FROM abacus_check('mesh')")
            if faults != "0":
                raise server.Failure(f"{faults} faults after changes")

    def edit(self, edit, has_regions, statement, count):
        server.query("DROP SEQUENCE IF EXISTS next; CREATE SEQUENCE next")
        seconds = latencies(statement, count)
        middle = seconds[len(seconds) // 2]
        self.suite.say(f"  a {edit} {'into a region' if has_regions else 'into points alone'} {1000 * middle:.2f} ms")
        self.suite.measurements.append({"what": "region edit", "edit": edit, "inside": has_regions, **self.labels, "transactions": count,
                                        "percentile99": seconds[count * 99 // 100], "samples": [{"wall": round(middle, 6)}]})
