"""Points, lines and regions that were read from a file, into a mesh."""
import numpy

from .load import reals, table, texts, wholes
from .psql import literal, statement

POINTS = "abacus_import_points"
# The edges on which a marked line lies, each with the markers of these lines
MARKED = """CREATE TEMP TABLE abacus_import_marked ON COMMIT DROP AS
SELECT least(v0, v1) AS a, greatest(v0, v1) AS b, (array_agg(marker ORDER BY m.line))[1] AS marker, count(DISTINCT marker) > 1 AS several
FROM (SELECT v0, v1, unnest(lines) AS line FROM abacus_edges({mesh}, fixed => true)) AS e JOIN abacus_import_marks AS m USING (line) GROUP BY 1, 2"""
SAY_SEVERAL = """DO $$DECLARE edges bigint := (SELECT count(*) FROM abacus_import_marked WHERE several);
BEGIN IF edges > 0 THEN RAISE WARNING 'edges that lie on segments with several markers: %; each gets that of the first', edges; END IF; END$$"""
MARK = """SELECT code, v0, v1, v2, facet, marker FROM abacus_import_marked JOIN
(SELECT code, v0, v1, v2, facet, least(p, q) AS a, greatest(p, q) AS b
 FROM abacus_cells({mesh}), LATERAL (VALUES (0, v1, v2), (1, v0, v2), (2, v0, v1)) AS side (facet, p, q)) AS sides USING (a, b)"""


def or_null(write):
    return lambda values: ["" if value is None else write(value) for value in values]


def quoted(values):
    return ['"' + value.replace('"', '""') + '"' for value in values]


class PlanScript:
    """What psql is sent, in pieces of (rows, text)."""

    def __init__(self, name, found):
        self.name, self.found, self.plan = name, found, found.plan
        self.mesh = f"{literal(name)}::regclass"
        self.attributes = [f"a{n}" for n in range(len(found.names))]
        self.marks, self.probes = found.marks()
        self.rows = len(found.points) + len(self.plan.line)

    def pieces(self):
        yield 0, "BEGIN;\n"
        yield from self.tables()
        for step in self.steps():
            yield 0, statement(step)
        yield 0, statement(f"SELECT value::bigint FROM abacus_stats({self.mesh}) WHERE name = 'simplices'")
        yield 0, "COMMIT;\n"

    def tables(self):
        found, plan = self.found, self.plan
        yield from table("points", ["id bigint", "x float8", "y float8", *(f"{name} float8" for name in self.attributes)],
                         [(wholes, found.ids), *((reals, axis) for axis in found.points.T), *((reals, values) for values in found.values)])
        places = found.points[plan.place]
        yield from table("lines", ["line bigint", "position bigint", "x float8", "y float8", "part integer", "soft integer"],
                         [(wholes, plan.line), (wholes, plan.position), *((reals, axis) for axis in places.T), (wholes, plan.part), (wholes, plan.soft)])
        names, lines, *axes = zip(*plan.regions) if plan.regions else ((),) * 4
        yield from table("regions", ["region text", "line bigint", "x float8", "y float8"],
                         [(quoted, names), (or_null(str), lines), *((or_null(repr), axis) for axis in axes)])
        probes = numpy.array(self.probes, numpy.int64).reshape(-1, 3)
        yield from table("probes", ["line bigint", "position bigint", "x float8", "y float8"],
                         [(wholes, probes[:, 0]), (wholes, probes[:, 1]), *((reals, axis) for axis in found.points[probes[:, 2]].T)])
        marks = numpy.array(self.marks, numpy.int64).reshape(-1, 2)
        yield from table("marks", ["line bigint", "marker integer"], [(wholes, column) for column in marks.T])

    def constrain(self, soft):
        part = ", nullif(part, -1) AS part" if (self.plan.part >= 0).any() else ""
        query = f"SELECT line, position, NULL::bigint AS point, x, y{part} FROM abacus_import_lines WHERE soft = {int(soft)}"
        return f"SELECT abacus_constrain({self.mesh}, {literal(query)}, kind => '{'soft' if soft else 'hard'}')"

    def mark(self):
        if self.probes:
            yield (f"SELECT abacus_constrain({self.mesh}, 'SELECT line, position, NULL::bigint AS point, x, y FROM abacus_import_probes', kind => 'soft')")
        yield MARKED.format(mesh=self.mesh)
        yield SAY_SEVERAL
        yield f"SELECT abacus_mark({self.mesh}, {literal(MARK.format(mesh=self.mesh))})"
        if self.probes:
            yield f"SELECT abacus_unconstrain({self.mesh}, 'SELECT DISTINCT line FROM abacus_import_probes')"

    def steps(self):
        """Statements that make the mesh of the tables."""
        points = f"SELECT {', '.join(['id', 'x', 'y', *self.attributes])} FROM {POINTS}"
        yield f"SELECT abacus_triangulate({literal(self.name)}, {literal(points)}, attributes => {texts(self.found.names)})"
        if self.found.srid:
            yield f"SELECT abacus_set_srid({self.mesh}, {self.found.srid})"
        yield from (self.constrain(soft) for soft in (False, True) if (self.plan.soft == soft).any())
        if self.marks:
            yield from self.mark()
        for column, columns in ("line", "line"), ("x", "x, y"):
            if any((row[1] is not None) == (column == "line") for row in self.plan.regions):
                yield f"SELECT abacus_region({self.mesh}, 'SELECT region, {columns} FROM abacus_import_regions WHERE {column} IS NOT NULL')"
