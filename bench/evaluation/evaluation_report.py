"""Makes docs/evaluation.md from results: the regions of the document, by name."""
from beside import Beside, clock, count, number, percent, size
from cache_figures import CacheFigures
from dissertation import DELETED_CREATED, FIGURE, FREQUENCIES, POINTS_2D
from document import Document
from growth_figures import GrowthFigures
from results import median
from trace_figures import TraceFigures

RECORD_BYTES = {2: 24, 3: 32}  # for a point in the dissertation's files


class EvaluationReport(Document):
    def __init__(self, results, pictures):
        super().__init__(results, pictures)
        for dimension, figures in ((2, ("5-2", "5-5", "5-7")), (3, ("5-4", "5-6", "5-8"))):
            for name, make in zip(figures, (self.sets, self.staging, self.triangulating)):
                self.generators[f"figure-{name}"] = lambda make=make, d=dimension, name=name: make(
                    d, FIGURE[name.replace("-", ".")])
        for figures in (GrowthFigures(self), CacheFigures(self), TraceFigures(self)):
            self.generators.update(figures.generators)

    def steps(self, dimension, cache=None, memory=None):
        """Entries {key, stage, triangulate}, one for each data set; of the main cache size unless said."""
        cache = cache or self.main_cache(dimension)
        entries = {}
        for step in ("stage", "triangulate"):
            for measurement in self.results.all(what=step, dimension=dimension, cache=cache, memory=memory):
                key = measurement.get("frequency", measurement["points"])
                entries.setdefault(key, {"key": key, "points": measurement["points"]})[step] = measurement
        return list(entries.values())

    def main_cache(self, dimension):
        """That of the largest data set of the main parts; smoke runs have one of their own."""
        found = [m for name, part in self.results.parts.items() if name.startswith(f"{dimension}d-")
                 for m in part["measurements"] if m["what"] == "stage"]
        return max(found, key=lambda m: m["points"])["cache"] if found else None

    def beside(self, dimension, figure, entries, others=()):
        if dimension == 2:
            return Beside(figure, POINTS_2D, entries, count, others)
        return Beside(figure, FREQUENCIES, entries, lambda key: f"{key:g} Hz", others)

    def sets(self, dimension, figure):
        table = self.beside(dimension, figure, self.steps(dimension))
        table.add("points", "vertices", lambda e: count(e["points"]))
        table.add("file", "file", lambda e: size(RECORD_BYTES[dimension] * e["points"]))
        return table.markdown()

    def staging(self, dimension, figure):
        table = self.beside(dimension, figure, self.steps(dimension))
        table.add("points", "vertices", lambda e: count(e["points"]))
        table.add("vertex table", "table", lambda e: size(e["stage"]["disk"]["vertices"]))
        table.add("its B-tree", "index", lambda e: size(e["stage"]["disk"]["vertex_index"]))
        table.add("staging, m:ss", "wall", lambda e: clock(median(e["stage"], "wall")))
        self.add_cpu(table, "stage")
        table.add("MB of points a second", "throughput", lambda e: number(
            RECORD_BYTES[dimension] * e["points"] / 1e6 / median(e["stage"], "wall")))
        table.add("WAL", None, lambda e: size(median(e["stage"], "wal")))
        return table.markdown()

    def triangulating(self, dimension, figure):
        table = self.beside(dimension, figure, self.steps(dimension))
        table.add("points", "vertices", lambda e: count(e["points"]))
        table.add(("triangles" if dimension == 2 else "tetrahedra"), "simplices",
                  lambda e: count(stats(e)["simplices"]))
        table.add("simplex table", "table", lambda e: size(e["triangulate"]["disk"]["simplices"]))
        table.add("its B-tree", "index", lambda e: size(e["triangulate"]["disk"]["simplex_index"]))
        table.add("bytes a simplex, both", None, lambda e: number(stats(e)["bytes_per_simplex"]))
        table.add("triangulating, m:ss", "wall", lambda e: clock(median(e["triangulate"], "wall")))
        self.add_cpu(table, "triangulate")
        table.add("seconds a million points", "amortized", lambda e: number(
            median(e["triangulate"], "wall") / e["points"] * 1e6))
        table.add("… of the CPU", None, lambda e: number(
            median(e["triangulate"], "cpu") / e["points"] * 1e6))
        table.add("private memory", None, lambda e: size(median(e["triangulate"], "memory")))
        table.add("WAL", None, lambda e: size(median(e["triangulate"], "wal")))
        deleted, created = DELETED_CREATED[dimension]
        table.add("simplices deleted an insertion", [deleted] * len(table.theirs),
                  lambda e: number(stats(e)["deleted"] / stats(e)["insertions"]))
        table.add("… created", [created] * len(table.theirs),
                  lambda e: number(stats(e)["created"] / stats(e)["insertions"]))
        return table.markdown()

    def add_cpu(self, table, step):
        table.add("share of the time on the CPU", "utilization", lambda e: percent(
            median(e[step], "cpu") / median(e[step], "wall"), 0))
        table.add("user time, s", "user", lambda e: number(median(e[step], "user")))
        table.add("system time, s", "system", lambda e: number(median(e[step], "system")))


def stats(entry):
    return entry["triangulate"]["stats"]
