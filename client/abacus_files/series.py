"""A mesh at the steps of a time series: its values come from a query of (id, step, value, ...)."""
import math

from .psql import Failed


class Series:
    """The steps of a query whose columns are a vertex's id, the step as a number, and any values."""

    def __init__(self, session, query):
        query = query.strip().rstrip(";")
        session.send(f"PREPARE abacus_series AS {query}")  # by itself it must be one statement, with no parenthesis too many
        columns = session.texts(f"SELECT key FROM (SELECT * FROM ({query}\n) AS series LIMIT 1) AS one, "
                                "json_object_keys(row_to_json(one)) WITH ORDINALITY AS keys (key, n) ORDER BY n")
        if not columns:
            raise Failed("the series has no rows")
        if len(columns) < 3:
            raise Failed(f"a series has an id, a step and values; this has the columns: {', '.join(columns)}")
        self.names = columns[2:]
        self.values = [f"s{n}" for n in range(len(self.names))]
        self.rows = f"({query}\n) AS series ({', '.join(['id', 'step', *self.values])})"
        self.steps = [step for step, in session.all(f"SELECT DISTINCT step::float8 FROM {self.rows} WHERE step IS NOT NULL ORDER BY 1", ["float8"])]
        if not self.steps:
            raise Failed("the series has no steps: all are NULL")
        if not all(map(math.isfinite, self.steps)):
            raise Failed("a step of the series is NaN or infinite")


class Step:
    """A mesh that has the values of one step beside its attributes; where a vertex has none they are NaN."""

    def __init__(self, mesh, series, step):
        self.mesh, self.series, self.step = mesh, series, step
        self.dimension, self.corners, self.labels, self.facets = mesh.dimension, mesh.corners, mesh.labels, mesh.facets
        self.vertices, self.simplices = mesh.vertices, mesh.simplices
        self.attributes = mesh.attributes + series.names
        self.cells, self.marked_facets, self.solid = mesh.cells, mesh.marked_facets, mesh.solid

    def points(self):
        values = ", ".join(f"{value}::float8" for value in self.series.values)
        source = (f"{self.mesh.numbered_vertices()} LEFT JOIN (SELECT id::bigint AS step_id, {values} FROM {self.series.rows} "
                  f"WHERE step::float8 = '{self.step!r}'::float8) AS step ON step_id = id")
        seen = 0
        for chunk in self.mesh.points(source, [f"coalesce({value}, 'NaN')" for value in self.series.values], "ORDER BY number"):
            seen += len(chunk[0])
            if seen > self.vertices:
                break
            yield chunk
        if seen != self.vertices:
            raise Failed(f"the series has a vertex more than once in step {self.step:g}")
