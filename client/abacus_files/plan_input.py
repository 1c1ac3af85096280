"""What a file of points, lines and regions gives abacus_triangulate, abacus_constrain, abacus_mark and abacus_region."""
import numpy

from .arrays import unlike
from .input import Input
from .psql import Failed


class PlanInput(Input):
    """`ids`, `points`, `names` and `values` of attributes, `plan`, `srid`; `notes`: what is left out. `faces`: the Input of the file's triangles, or None."""

    def __init__(self, grid, retriangulate=False):
        self.notes, self.groups = list(grid.notes), grid.groups
        self.dimension, self.plan, self.srid = 2, grid.plan, grid.srid
        self.plan.check(grid.points)
        self.points = grid.points[:, :2]
        if len(self.points) < 3:
            raise Failed("has fewer than three points")
        self.ids = self.ids_of(grid)
        self.names, self.values = self.attributes_of(grid)
        if (self.plan.part >= 0).any():
            self.names = unlike(self.names, ("part",))  # that of lines
        if self.plan.regions and not len(self.plan.line):
            self.notes.append("regions and holes are left out: the file has no segments at which they could end")
            self.plan.regions = []
        self.faces = Input(grid) if len(grid.cells.get("triangle", ())) and not retriangulate else None

    def marks(self):
        """Markers of segments: (the line on which an edge has it, the marker); and rows (line, position, place) of lines that are needed for a
        while, for markers of lines with several segments."""
        plan = self.plan
        begins = plan.segments()
        lines, counts = numpy.unique(plan.line[begins], return_counts=True)
        single = dict(zip(lines.tolist(), (counts == 1).tolist()))
        marks, rows, free = [], [], int(plan.line.max(initial=0)) + 1
        for at in begins[plan.marker[begins] != 0].tolist():
            line = int(plan.line[at])
            if not single[line]:
                line = free + len(marks)
                rows += [(line, 1, int(plan.place[at])), (line, 2, int(plan.place[at + 1]))]
            marks.append((line, int(plan.marker[at])))
        return marks, rows
