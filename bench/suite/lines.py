"""Shores, borders and rivers with all their segments as fixed edges: builds with lines and without, beside CGAL in memory, and points that
come beside lines."""
import json
import struct
import subprocess

import engines
import paths
import server
from edits import SINGLE, latencies
from points import PointSet

CACHE = "8"  # MB
SEGMENTS = paths.DATA / "segments.raw"

# Rows of lines without repeated corners. Of two segments that cross, as rivers and borders do, one is left out: there its line goes on as
# another part.
CLEAN = """
CREATE UNLOGGED TABLE corners AS SELECT line, position, point, x, y FROM
    (SELECT line, position, point, x, y, lag(x) OVER w AS x0, lag(y) OVER w AS y0 FROM raw_lines JOIN points ON id = point
     WINDOW w AS (PARTITION BY line ORDER BY position)) AS c WHERE (x, y) IS DISTINCT FROM (x0, y0);
CREATE UNLOGGED TABLE crossed AS SELECT DISTINCT line_b AS line, position_b AS position
    FROM abacus_crossings('mesh', 'SELECT line, position, x, y FROM corners');
CREATE TABLE lines AS SELECT line, position, point, part FROM
    (SELECT *, count(*) OVER (PARTITION BY line, part) AS n FROM
     (SELECT line, position, point, count(before.line) OVER (PARTITION BY line ORDER BY position ROWS BETWEEN UNBOUNDED PRECEDING AND 1 PRECEDING)
        AS part FROM corners LEFT JOIN crossed AS before USING (line, position)) AS p) AS c WHERE n > 1;
VACUUM (FREEZE, ANALYZE) lines;
DROP TABLE corners, crossed, raw_lines"""


class Shores(PointSet):
    """The points of the first files, up to `size`; all if that is None. Their order is that of the bins, so lines are cut only once."""

    def __init__(self, resolution, size):
        super().__init__(2, "shorelines", size)
        self.resolution = resolution

    def command(self, form):
        return [paths.ROOT / "scripts/gshhg_points.py", self.resolution, form]

    def create_tables(self):
        """The tables `points` and `lines`; how many points and segments they have, and how many segments are left out."""
        server.drop("points", "lines", "raw_lines", "corners", "crossed", "mesh", "mesh_vertices", "mesh_lines")
        self.copy("points", "id bigint, x float8, y float8", "copy", "id")
        self.copy("raw_lines", "line bigint, position bigint, point bigint", "lines", "point")
        server.query("VACUUM (FREEZE, ANALYZE) points")
        server.query("VACUUM (FREEZE, ANALYZE) raw_lines")
        server.query(self.triangulate())
        crossed = self.clean()
        server.drop("mesh", "mesh_vertices")
        count, segments = map(int, server.query("SELECT (SELECT count(*) FROM points), count(*) - count(DISTINCT (line, part)) FROM lines").split("|"))
        return count, segments, crossed

    def clean(self):
        with server.Session() as session:
            for statement in CLEAN.split(";"):
                session.run(statement)
                if "crossed AS SELECT" in statement:
                    crossed = int(session.run("SELECT count(*) FROM crossed"))
        return crossed

    def copy(self, table, columns, form, number):
        most = "" if self.size is None else f" WHERE {number} <= {self.size}"
        server.query(f"CREATE TABLE {table} ({columns})")
        with subprocess.Popen(self.command(form), stdout=subprocess.PIPE) as source:
            subprocess.run(["psql", "-X", "-q", "-v", "ON_ERROR_STOP=1", "-c", f"COPY {table} FROM STDIN (FORMAT binary){most}"],
                           stdin=source.stdout, check=True)
        if source.returncode != 0:
            raise server.Failure(f"no {table} of the shorelines")

    def write_files(self):
        """The same points and segments for CGAL."""
        paths.DATA.mkdir(parents=True, exist_ok=True)
        write(self.file, "<qdd", "SELECT id, x, y FROM points ORDER BY id")
        write(SEGMENTS, "<qq", "SELECT point, next FROM (SELECT point, lead(point) OVER (PARTITION BY line, part ORDER BY position) AS next FROM lines) AS s"
              " WHERE next IS NOT NULL")

    def remove_files(self):
        for file in self.file, SEGMENTS:
            file.unlink(missing_ok=True)


def write(path, form, query):
    """The rows of a query of numbers as binary records."""
    kinds = [int if letter == "q" else float for letter in form[1:]]
    record = struct.Struct(form)
    with open(path, "wb") as file, subprocess.Popen(["psql", "-X", "-q", "-c", f"COPY ({query}) TO STDOUT (FORMAT csv)"], stdout=subprocess.PIPE,
                                                    text=True) as source:
        for line in source.stdout:
            file.write(record.pack(*(kind(value) for kind, value in zip(kinds, line.split(",")))))
    if source.returncode != 0:
        raise server.Failure("the points and lines cannot be written")


class CgalLines(engines.Program):
    """CGAL with the segments as constraints."""

    def __init__(self):
        super().__init__("cgal")
        self.program = paths.PROGRAMS / "bench_cgal_lines"

    def sample(self, points):
        done = subprocess.run([self.program, points.file, SEGMENTS], stdout=subprocess.PIPE, check=True)
        return json.loads(done.stdout)


class AbacusLines(engines.Abacus):
    """Points and lines in one call of abacus_triangulate."""

    def sample(self, points):
        server.drop("mesh", "mesh_vertices", "mesh_lines")
        server.settle()
        with server.Session(abacus__cache_size=f"{CACHE}MB") as session:
            sample = session.timed(points.triangulate().removesuffix(")") + ", lines => 'TABLE lines')")
        sample["simplices"] = int(sample.pop("printed"))
        return sample


class Lines:
    """`sizes`: the resolution of the shorelines and the number of points, None for all of them, by mode."""

    def __init__(self, sizes, runs):
        self.sizes, self.runs = sizes, runs

    def measure(self, suite):
        self.suite = suite
        points = Shores(*self.sizes[suite.mode])
        count, segments, crossed = points.create_tables()
        suite.say(f"  {count:,} points, {segments:,} segments; {crossed:,} that cross others are left out")
        self.labels = {"points": count, "segments": segments, "left_out": crossed}
        points.write_files()
        try:
            self.builds(points)
        finally:
            points.remove_files()
        server.restart(fsync="off")
        try:
            self.insertions(points)
        finally:
            server.restart()
        server.drop("mesh", "mesh_vertices", "mesh_lines", "points", "lines", "beside")

    def builds(self, points):
        contestants = {("cgal", False): engines.Program("cgal"), ("cgal", True): CgalLines(),
                       ("abacus", False): engines.Abacus(CACHE), ("abacus", True): AbacusLines(CACHE)}
        samples = {key: [] for key in contestants}
        for _ in range(self.runs[self.suite.mode]):
            for key, contestant in contestants.items():
                samples[key].append(contestant.sample(points))
                self.suite.say(f"  {key[0]:6} {'with' if key[1] else 'without'} lines {samples[key][-1]['wall']:9.3f} s"
                               f"   {samples[key][-1]['memory'] / 2**20:7.0f} MB")
        if len({sample["simplices"] for of_engine in samples.values() for sample in of_engine}) > 1:
            raise server.Failure("numbers of triangles differ")
        for (engine, has_lines), found in samples.items():
            self.suite.measurements.append({"what": "lines", "engine": engine, "lines": has_lines, **self.labels, "samples": found})

    def insertions(self, points):
        """Points close to corners of lines, each in a transaction of its own: with lines, which are there from the last build, and without."""
        faults = server.query("SELECT count(*) FROM abacus_check('mesh')")
        if faults != "0":
            raise server.Failure(f"{faults} faults with lines")
        server.drop("beside")
        server.query("CREATE TABLE beside AS SELECT row_number() OVER () AS number, x + 1e-6 * (hashint8(id) % 1000) AS x, y + 1e-6 * (hashint8(-id) % 1000) AS y"
                     f" FROM (SELECT * FROM points ORDER BY hashint8(id + 1) LIMIT {SINGLE[self.suite.mode]}) AS p; CREATE UNIQUE INDEX ON beside (number)")
        for has_lines in True, False:
            if not has_lines:
                server.drop("mesh", "mesh_vertices", "mesh_lines")
                server.query(points.triangulate())
            server.query("DROP SEQUENCE IF EXISTS next_beside; CREATE SEQUENCE next_beside")
            seconds = latencies("SELECT abacus_insert('mesh', format('SELECT 9000000000 + number, x, y FROM beside WHERE number = %s',"
                                " nextval('next_beside')));", SINGLE[self.suite.mode])
            middle = seconds[len(seconds) // 2]
            self.suite.say(f"  a point {'beside lines' if has_lines else 'without lines'} {1000 * middle:.2f} ms")
            self.suite.measurements.append({"what": "line insert", "engine": "abacus", "lines": has_lines, **self.labels, "transactions": len(seconds),
                                            "percentile99": seconds[len(seconds) * 99 // 100], "samples": [{"wall": round(middle, 6)}]})
