"""Makes docs/benchmarks.md, its pictures and its table of acceptance from results."""
import acceptance
import habits
import plots
import tables
from document import Document, number, points, size, spread, table
from results import median, ratio
from results import spread as spread_of

ENGINES = {"cgal": "CGAL", "tetgen": "TetGen", "qhull": "Qhull", "postgis": "PostGIS",
           "postgis_kept": "PostGIS, triangles kept"}
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
        self.generators |= {"acceptance": self.acceptance, "builds": self.builds, "growth": self.growth,
                            "caches": self.caches,
                            "goose": lambda: habits.goose(results), "rows": lambda: habits.rows(results)}
        for name in ("location", "cold", "asking", "surfaces", "octrees", "threads", "edits", "cancels", "core"):
            make = getattr(tables, name)
            self.generators[name] = lambda make=make: make(results)

    def acceptance(self):
        rows = []
        for wanted in acceptance.WANTED:
            value = wanted.measured(self.results)
            rows.append((wanted.what, wanted.wanted(), number(value), number(wanted.by_cpu(self.results)),
                         wanted.verdict(value)))
        return table(("", "wanted", "measured", "by CPU time", ""), rows)

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

    def microseconds(self, measurement):
        """Of a point: median, least, greatest."""
        return tuple(1e6 * value / measurement["points"] for value in spread_of(measurement, "wall"))

    def growth(self):
        """Cost of a point over the number of points, uniform in the plane."""
        lines = {}
        for m in self.results.all(what="build", dimension=2, set="uniform"):
            if m["engine"] in ("abacus", "cgal"):
                lines.setdefault(engine_name(m), []).append((m["points"], *self.microseconds(m)))
        if len({point[0] for line in lines.values() for point in line}) < 2:
            return "One number of points was measured.\n"
        plots.lines(self.pictures / "growth.svg", "2D, uniform: cost of a point", "points",
                    "microseconds a point", lines, "x", "bottom left")
        return self.picture("growth", "Microseconds a point over the number of points")

    def caches(self):
        """Time over the size of the cache, relative to that without a limit."""
        lines = {}
        for unlimited in self.results.all(what="build", engine="abacus", cache="largest"):
            labels = {key: unlimited[key] for key in ("dimension", "set", "points")}
            base = median(unlimited, "wall")
            name = f"{labels['dimension']}D, {SETS[labels['set']]}, {points(labels['points'])}"
            for m in self.results.all(what="build", engine="abacus", **labels):
                if m["cache"] != "largest":
                    megabytes = 128 if m["cache"] == "default" else int(m["cache"])
                    lines.setdefault(name, []).append(
                        (megabytes, *(value / base for value in spread_of(m, "wall"))))
        if not lines:
            return ""
        plots.lines(self.pictures / "caches.svg", "Time with a small cache", "abacus.cache_size, MB",
                    "time, 1 = no limit", lines, "x", "bottom right")
        return self.picture("caches", "Time over the size of the cache")
