"""A region with a tenth of the area of a large mesh: how it is made, contours and volume within it or within a polygon beside those of all, and what
PostGIS takes to cut the triangles by a polygon."""
import math

import server
from ask import LEVELS

# As rough everywhere, so that a tenth of the area has a tenth of the contours
HEIGHT = "100 * sin(62.831853 * x) * cos(62.831853 * y) + 20 * x"

# A square, and its outline of so many points a side. No coordinate is rounded, so the region and the polygon have the same border
LOW, SIDE, ON_SIDE = 0.34375, 0.31640625, 64
SQUARE = [(LOW, LOW), (LOW + SIDE, LOW), (LOW + SIDE, LOW + SIDE), (LOW, LOW + SIDE), (LOW, LOW)]
RING = [(x0 + (x1 - x0) * n / ON_SIDE, y0 + (y1 - y0) * n / ON_SIDE) for (x0, y0), (x1, y1) in zip(SQUARE, SQUARE[1:]) for n in range(ON_SIDE)] + SQUARE[:1]

WITHIN = {"all": "NULL", "region": "'square'", "polygon": f"'POLYGON(({', '.join(f'{x} {y}' for x, y in SQUARE)}))'"}
QUESTIONS = {
    "contours": f"SELECT sum(cardinality(path)) / 2 FROM abacus_contours('mesh', fixed_levels => ARRAY{LEVELS}, within => {{within}})",
    "volume": "SELECT area FROM abacus_volume('mesh', 0, within => {within})",
}

# With 64 corners, and a tenth of the area
ROUND = "POLYGON((" + ", ".join(f"{0.5 + 0.178 * math.cos(n * math.pi / 32)} {0.5 + 0.178 * math.sin(n * math.pi / 32)}" for n in [*range(64), 0]) + "))"


def line(number, corners):
    """A query for a line through new points."""
    rows = ", ".join(f"({position}, {x!r}, {y!r})" for position, (x, y) in enumerate(corners))
    return f"SELECT {number}, position, NULL::bigint, x, y, {HEIGHT} AS height FROM (VALUES {rows}) AS corner (position, x, y)"


OUTLINE = f"SELECT abacus_constrain('mesh', $$ {line(1, RING)} $$)"
INSIDE = f"SELECT abacus_constrain('mesh', $$ {line(2, [(0.5, 0.5001), (0.5001, 0.5001)])} $$)"
BY_OUTLINE = "SELECT abacus_region('mesh', $$VALUES ('square', 1)$$)"
BY_SEED = "SELECT abacus_region('mesh', $$VALUES ('square', 0.5, 0.5)$$)"

# Of the mesh with the outline: what is done first, and what is timed
STEPS = {
    "region of an outline": ("", BY_OUTLINE),
    "region of a seed": ("", BY_SEED),
    "a line in the region of an outline": (BY_OUTLINE, INSIDE),
    "a line in the region of a seed": (BY_SEED, INSIDE),
    "`abacus_regions`": (BY_OUTLINE, "SELECT area FROM abacus_regions('mesh')"),
}


class Regions:
    """sizes: by mode, of the mesh, and of the one whose triangles PostGIS cuts."""

    def __init__(self, sizes):
        self.sizes = sizes

    def measure(self, suite):
        self.suite = suite
        self.runs = {"full": 3, "quick": 3, "smoke": 1}[suite.mode]
        size, few = self.sizes[suite.mode]
        server.restart(shared_buffers="2GB" if size >= 1000000 else "128MB")
        try:
            self.make_mesh(size)
            self.make_region()
            self.ask()
            self.make_mesh(few)
            self.beside_postgis()
        finally:
            server.restart()
        server.drop("mesh", "mesh_vertices", "mesh_lines", "mesh_regions", "points")

    def make_mesh(self, size):
        server.drop("mesh", "mesh_vertices", "mesh_lines", "mesh_regions", "points")
        server.query(f"SELECT setseed(0.25); CREATE TABLE points AS SELECT id, x, y, {HEIGHT} AS height FROM"
                     f" (SELECT id, random() AS x, random() AS y FROM generate_series(1, {size}) AS id) AS place")
        server.query("SELECT abacus_triangulate('mesh', 'TABLE points')")
        server.query("VACUUM (FREEZE, ANALYZE) mesh")
        self.points = size

    def record(self, what, samples, **labels):
        self.suite.measurements.append({"what": what, "points": self.points, **labels, "samples": samples})
        least = min(sample["wall"] for sample in samples)
        self.suite.say(f"  {' '.join(labels.values()):42} {least:9.4f} s")

    def make_region(self):
        self.step("outline of new points", "", OUTLINE)
        server.query(OUTLINE)
        for step, (before, statement) in STEPS.items():
            self.step(step, before, statement)
        server.query(BY_OUTLINE)
        server.query("VACUUM (FREEZE, ANALYZE) mesh")

    def step(self, step, before, statement):
        """Rolled back, so that each run finds the same mesh."""
        samples = []
        for _ in range(self.runs):
            with server.Session() as session:
                session.run(f"BEGIN; {before}")
                samples.append(session.timed(statement))
                session.run("ROLLBACK")
            del samples[-1]["printed"]
        self.record("region step", samples, step=step)

    def in_turns(self, statements):
        """Samples of each, in one session; the first turn is not counted."""
        samples = {key: [] for key in statements}
        with server.Session(max_parallel_workers_per_gather=0) as session:
            for turn in range(self.runs + 1):
                for key, statement in statements.items():
                    sample = session.timed(statement)
                    sample["answers"] = float(sample.pop("printed"))
                    if turn > 0:
                        samples[key].append(sample)
        return samples

    def ask(self):
        for question, statement in QUESTIONS.items():
            samples = self.in_turns({within: statement.format(within=written) for within, written in WITHIN.items()})
            for within, taken in samples.items():
                self.record("within", taken, engine="abacus", question=question, within=within)
            region, polygon = (samples[within][0]["answers"] for within in ("region", "polygon"))
            if not math.isclose(region, polygon, rel_tol=1e-3 if question == "contours" else 1e-9):
                raise server.Failure(f"{question}: {region} within the region, {polygon} within the same polygon")

    def beside_postgis(self):
        """The area of the triangles within a polygon, cut by Abacus, and by PostGIS: only those that are not inside as a whole."""
        if not (server.has_extension("postgis") and server.has_extension("abacus_postgis")):
            self.suite.say("  PostGIS is not installed: its triangles are not cut")
            return
        for extension in "postgis", "abacus_postgis":
            server.create_extension(extension)
        server.drop("triangles")
        server.query("CREATE TABLE triangles AS SELECT geom FROM abacus_cells_geom('mesh'); CREATE INDEX ON triangles USING gist (geom)")
        server.query("VACUUM (FREEZE, ANALYZE) triangles")
        area = f"ST_Area(CASE WHEN ST_Within(geom, '{ROUND}'::geometry) THEN geom ELSE ST_Intersection(geom, '{ROUND}'::geometry) END)"
        samples = self.in_turns({"abacus": f"SELECT area FROM abacus_volume('mesh', 0, within => '{ROUND}')",
                                 "postgis": f"SELECT sum({area}) FROM triangles WHERE ST_Intersects(geom, '{ROUND}'::geometry)"})
        if not math.isclose(*(taken[0]["answers"] for taken in samples.values()), rel_tol=1e-9):
            raise server.Failure("the areas within a polygon differ")
        for engine, taken in samples.items():
            self.record("within", taken, engine=engine, question="area", within="polygon")
        server.drop("triangles")
