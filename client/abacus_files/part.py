"""A mesh whose triangles have the number of their region as a label; and a region alone: its triangles, and their vertices, numbered anew."""
import numpy

from .arrays import Mesh, unlike
from .english import counted
from .psql import Failed, literal

LABEL = "region"


class Asked(Mesh):
    """A mesh in the plane whose triangles come from `cells_sql`. Its vertices are found by their places."""

    def points(self, source=None, extra=(), order="ORDER BY number"):
        return super().points(source, extra, order)

    def numbered_cells(self, columns):
        joins = " ".join(f"JOIN places AS c{n} ON c{n}.x = corners[{n + 1}][1] AND c{n}.y = corners[{n + 1}][2]" for n in range(3))
        return (f"WITH places AS MATERIALIZED (SELECT number, x, y FROM {self.numbered_vertices()}) "
                f"SELECT {', '.join(['code', *(f'c{n}.number' for n in range(3)), *columns])} FROM {self.cells_sql} {joins}")


class Labelled(Asked):
    """A triangle without a region has no number."""

    def __init__(self, session, name):
        super().__init__(session, name)
        self.labels += unlike([LABEL], self.labels)
        self.but = f", but for their numbers, which are the label {self.labels[-1]}"
        regions = f"abacus_regions({self.sql}) AS r, LATERAL abacus_cells({self.sql}, within => r.region) AS c"
        self.cells_sql = (f"(SELECT code, v0, v1, v2, v3, corners, \"values\", coalesce(labels, '{{}}') || number::float8 AS labels FROM abacus_cells({self.sql}) "
                          f"LEFT JOIN (SELECT number, code, v0, v1, v2, corners FROM {regions}) AS of_regions USING (code, v0, v1, v2, corners)) AS labelled")

    def region_names(self):
        return self.session.texts(f"SELECT region || ': ' || number FROM abacus_regions({self.sql}) ORDER BY number")


class Part(Asked):
    def __init__(self, session, name, region):
        super().__init__(session, name)
        if self.dimension != 2:
            raise Failed("--within is for meshes in the plane")
        self.region = region
        self.within = f"within => {literal(region)}"
        self.cells_sql = f"abacus_cells({self.sql}, {self.within})"
        self.simplices, = self.count(self.cells_sql)
        self.vertices, = self.count(self.numbered_vertices())
        self.facets = self.facets and sum(len(markers) for _, markers in self.marked_facets())

    def is_region(self):
        """Otherwise it is a polygon, which may cut triangles."""
        return bool(self.session.all(f"SELECT count(*) FROM abacus_regions({self.sql}) WHERE region = {literal(self.region)}", ["int8"])[0][0])

    def count(self, rows):
        return self.session.all(f"SELECT count(*) FROM {rows}", ["int8"])[0]

    def numbered_vertices(self, alias="numbered"):
        corners = f"SELECT corners[i][1], corners[i][2] FROM {self.cells_sql}, generate_series(1, 3) AS i"
        return (f"(SELECT row_number() OVER (ORDER BY number) - 1 AS number, id, x, y, attributes FROM abacus_numbered_vertices({self.sql}) "
                f"WHERE (x, y) IN ({corners}) ORDER BY 1) AS {alias}")

    def keys(self, edges):
        """A number for each edge, whichever end comes first."""
        return edges.min(axis=1) * self.vertices + edges.max(axis=1)

    def marked_facets(self):
        """Those between two vertices of the region that are edges of its triangles, which are held in memory."""
        if not self.facets:
            return
        sides = [numpy.unique(numpy.concatenate([self.keys(corners[:, [n, (n + 1) % 3]]) for n in range(3)])) for _, corners, _ in self.cells()]
        inside = numpy.unique(numpy.concatenate(sides or [numpy.empty(0, numpy.int64)]))
        for corners, markers in super().marked_facets():
            kept = numpy.isin(self.keys(corners), inside)
            yield corners[kept], markers[kept]

    def whole_lines(self):
        """The lines that lie in the region with all of their edges."""
        edges = "SELECT unnest(lines) AS line, count(*) AS edges FROM abacus_edges({}) GROUP BY line"
        return (f"SELECT line FROM ({edges.format(f'{self.sql}, fixed => true')}) AS of_all JOIN ({edges.format(f'{self.sql}, fixed => true, {self.within}')}) AS inside "
                "USING (line, edges)")

    def lines(self):
        return f"(SELECT * FROM abacus_lines({self.sql}) WHERE line IN ({self.whole_lines()}))"

    def region_names(self):
        return [self.region]

    def unheld(self, holds=()):
        """Of a format with lines, those that go on beyond the region."""
        cut = self.session.all(f"SELECT count(DISTINCT line) FROM (SELECT unnest(lines) AS line FROM abacus_edges({self.sql}, fixed => true, {self.within})) AS inside "
                               f"WHERE line NOT IN ({self.whole_lines()})", ["int8"])[0][0] if "lines" in holds else 0
        return super().unheld((*holds, "regions")) + ([f"{counted(cut, 'line')} extending beyond the region"] if cut else [])
