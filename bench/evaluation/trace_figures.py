"""Figures 5.15 and 5.16: which pages are asked for, and when."""
import plots
from beside import count, percent
from core_programs import places
from document import table


class TraceFigures:
    def __init__(self, report):
        self.report = report
        self.generators = {"figure-5-15": self.vertices, "figure-5-16": self.simplices,
                           "requests": self.requests}

    def trace(self, table_name, kind, by):
        """Dots (seconds, block or place) of the requests of a kind."""
        found = self.report.results.all(what="trace", table=table_name, kind=kind)
        if not found:
            return []
        height = found[0]["blocks"] if by == "by_block" else 1
        return [(x * found[0]["seconds"], y * height) for x, y in places(found[0][by])]

    def vertices(self):
        reads = self.trace("vertices", "read", "by_block")
        if not reads:
            return ""
        plots.dots(self.report.pictures / "trace-vertices.svg", "Vertex table: reads", "seconds",
                   "block", {"read": reads})
        return self.report.picture("trace-vertices", "Blocks of the vertex table that are read, over time")

    def simplices(self):
        text = ""
        for by, name, label in (("by_block", "trace-simplices", "block"),
                                ("by_place", "trace-simplices-curve", "place on the curve")):
            reads = self.trace("simplices", "read", by)
            writes = self.trace("simplices", "write", by)
            if not writes:
                return ""
            plots.dots(self.report.pictures / f"{name}.svg", "Simplex table: reads up, writes down",
                       "seconds", label, {"read": reads, "write": [(x, -y) for x, y in writes]})
            text += self.report.picture(name, f"The simplex table over time, by {label}") + "\n"
        return text

    def requests(self):
        rows = []
        for m in self.report.results.all(what="trace"):
            rows.append((f"{m['table']}, {m['kind']}", f"{m['requests']:,}",
                         percent(m["within"]["1"], 1) or "–", percent(m["within"]["100"], 1) or "–",
                         f"{m['blocks']:,}"))
        points = {m["points"] for m in self.report.results.all(what="trace")}
        text = table(("requests", "number", "at most 1 block from the one before", "at most 100",
                      "blocks of the table"), rows) if rows else ""
        return text + "".join(f"\n{count(size)} points.\n" for size in points)
