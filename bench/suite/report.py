"""Makes docs/benchmarks.md, its pictures and its table of acceptance from results."""
import acceptance
import habits
import plots
from document import Document, number, size, spread, table
from results import median, ratio
from results import spread as spread_of

ENGINES = {"cgal": "CGAL", "tetgen": "TetGen", "qhull": "Qhull", "postgis": "PostGIS"}
SETS = {"uniform": "uniform", "curves": "clusters and curves", "grid": "grid",
        "shorelines": "shorelines of the world", "quake": "earthquake model"}


def engine_name(measurement):
    if measurement["engine"] != "abacus":
        return ENGINES[measurement["engine"]]
    cache = measurement["cache"]
    return "Abacus, " + {"default": "128 MB", "largest": "no limit"}.get(cache, f"{cache} MB")


class Report(Document):
    def __init__(self, results, pictures):
        super().__init__(results, pictures)
        self.generators |= {"acceptance": self.acceptance, "builds": self.builds,
                            "goose": lambda: habits.goose(results), "rows": lambda: habits.rows(results)}

    def acceptance(self):
        rows = []
        for wanted in acceptance.WANTED:
            value = wanted.measured(self.results)
            rows.append((wanted.what, f"{'≤' if wanted.at_most else '≥'} {wanted.limit:,}",
                         number(value), wanted.verdict(value)))
        return table(("", "wanted", "measured", ""), rows)

    def builds(self):
        """A table for each set of points, engines below one another; a plot of those with many."""
        contests = {}
        for measurement in self.results.all(what="build"):
            key = (measurement["dimension"], measurement["set"], measurement["points"])
            contests.setdefault(key, []).append(measurement)
        text = ""
        for (dimension, set_name, count), measurements in sorted(contests.items()):
            text += f"### {dimension}D, {SETS[set_name]}, {count:,} points\n\n"
            text += self.contest(measurements) + "\n"
            if len(measurements) > 3:
                name = f"build-{dimension}d-{set_name}-{count}"
                rows = [(engine_name(m), *spread_of(m, "wall"))
                        for m in measurements]
                plots.bars(self.pictures / f"{name}.svg", f"{dimension}D, {SETS[set_name]}, {count:,} points",
                           "seconds, median and spread", rows)
                text += self.picture(name, f"Seconds of each engine, {count:,} points") + "\n"
        return text

    def contest(self, measurements):
        cgal = next((m for m in measurements if m["engine"] == "cgal"), None)
        rows = []
        for m in measurements:
            simplices = m["samples"][-1]["simplices"]
            disk = m.get("disk")
            rows.append((
                engine_name(m), spread(spread_of(m, "wall")), number(median(m, "cpu")),
                number(cgal and ratio(median(m, "wall"), median(cgal, "wall"))),
                number(cgal and ratio(median(m, "cpu"), median(cgal, "cpu"))),
                size(median(m, "memory")),
                size(disk and sum(disk.values())),
                number(disk and (disk["simplices"] + disk["index"]) / simplices),
                size(median(m, "wal")), f"{simplices:,}", len(m["samples"])))
        return table(("engine", "wall s", "CPU s", "wall ÷ CGAL", "CPU ÷ CGAL", "memory", "disk",
                      "bytes a simplex", "WAL", "simplices", "runs"), rows)
