"""Makes docs/benchmarks.md and its pictures from results and from page.md.in, its template."""
import detail_tables
import document
import habits
import plots
import ratios
import region_tables
import tables
from document import Document, number, points, size, spread, table
from heads import head
from results import median, ratio
from results import spread as spread_of

ENGINES = {"cgal": "CGAL", "tetgen": "TetGen", "qhull": "Qhull", "postgis": "PostGIS",
           "postgis_kept": "PostGIS, triangles kept", "cgal_parallel": "CGAL, parallel"}
SETS = {"uniform": "uniform", "curves": "clusters and curves", "grid": "grid",
        "shorelines": "shorelines of the world", "quake": "earthquake model"}

# Tables by themselves, and the measurements that each has
TABLES = {"location": (tables.location, ("locate",)), "cold": (tables.cold, ("cold",)), "asking": (tables.asking, ("ask",)),
          "shares": (tables.shares, ("share",)), "sharded": (tables.sharded, ("sharded",)), "sharded_reading": (tables.sharded_reading, ("sharded reading",)),
          "surfaces": (tables.surfaces, ("surface",)), "octrees": (tables.octrees, ("octree",)), "gpu": (tables.gpu, ("gpu",)),
          "lines": (tables.lines, ("lines", "line insert")),
          "within": (region_tables.within, ("within", "region step")), "terrain": (region_tables.terrain, ("terrain", "region edit")),
          "levels": (detail_tables.levels, ("levels", "tile mesh")),
          "threads": (tables.threads, ("threads", "shared reading")), "edits": (tables.edits, ("edit",)),
          "cancels": (tables.cancels, ("cancel",)), "core": (tables.core, ("core",)),
          "goose": (habits.goose, ("goose",)), "rows": (habits.rows, ("rows",))}


def engine_name(measurement):
    if measurement["engine"] == "abacus":
        cache = measurement["cache"]
        name = "Abacus, " + {"default": "128 MB", "largest": "no limit"}.get(cache, f"{cache} MB")
    else:
        name = ENGINES[measurement["engine"]]
    threads = measurement.get("threads")
    return f"{name}, {threads} thread{'s' * (threads != '1')}" if threads else name


def engines_of(measurements):
    """Those whose versions stand above a table of them."""
    found = {m.get("engine") for m in measurements}
    return found | ({"cgal"} if any(m.get("benchmark", "").startswith("Cgal") for m in measurements) else set())


class Report(Document):
    def __init__(self, results, pictures):
        super().__init__(results, pictures)
        self.generators |= {"ratios": self.ratios, "builds": self.builds, "growth": self.growth, "caches": self.caches}
        for name, (make, kinds) in TABLES.items():
            self.generators[name] = lambda make=make, kinds=kinds: self.headed(make, kinds)

    def fill(self, template):
        return document.make(template, self.generators)

    def headed(self, make, kinds):
        """A table for each machine and each set of versions, if there are several; below a line with them."""
        text = ""
        for about, results in self.results.groups():
            made = make(results)
            if made:
                measurements = [m for kind in kinds for m in results.all(what=kind)]
                text += head(about, engines_of(measurements)) + made.rstrip("\n") + "\n\n"
        return text

    def ratios(self):
        text = ""
        for about, results in self.results.groups():
            made, engines = ratios.ratios(results)
            if made:
                text += head(about, engines) + made + "\n"
        return text

    def builds(self):
        """A table for each set of points, engines below one another; a plot of those with many."""
        contests = {}
        for about, results in self.results.groups():
            for measurement in results.all(what="build"):
                key = (measurement["dimension"], measurement["set"], measurement["points"])
                contests.setdefault(key, (about, []))[1].append(measurement)
        text = ""
        for (dimension, set_name, count), (about, measurements) in sorted(contests.items(), key=lambda contest: contest[0]):
            text += f"### {dimension}D, {SETS[set_name]}, {count:,} points\n\n"
            text += head(about, engines_of(measurements)) + self.contest(measurements) + "\n"
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
        for m in self.results.all(what="build", dimension=2, set="uniform", threads=None):
            if m["engine"] in ("abacus", "cgal"):
                lines.setdefault(engine_name(m), []).append((m["points"], *self.microseconds(m)))
        if len({point[0] for line in lines.values() for point in line}) < 2:
            return ""
        plots.lines(self.pictures / "growth.svg", "2D, uniform: cost of a point", "points",
                    "microseconds a point", lines, "x", "bottom left")
        return self.picture("growth", "Microseconds a point over the number of points")

    def caches(self):
        """Time over the size of the cache, relative to that without a limit."""
        lines = {}
        for unlimited in self.results.all(what="build", engine="abacus", cache="largest", threads=None):
            labels = {key: unlimited[key] for key in ("dimension", "set", "points")}
            base = median(unlimited, "wall")
            name = f"{labels['dimension']}D, {SETS[labels['set']]}, {points(labels['points'])}"
            for m in self.results.all(what="build", engine="abacus", threads=None, **labels):
                if m["cache"] != "largest":
                    megabytes = 128 if m["cache"] == "default" else int(m["cache"])
                    lines.setdefault(name, []).append(
                        (megabytes, *(value / base for value in spread_of(m, "wall"))))
        if not lines:
            return ""
        plots.lines(self.pictures / "caches.svg", "Time with a small cache", "abacus.cache_size, MB",
                    "time, 1 = no limit", lines, "x", "bottom right")
        return self.picture("caches", "Time over the size of the cache")
