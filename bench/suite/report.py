"""Makes docs/benchmarks.md, its pictures and its table of acceptance from results."""
import acceptance
import document
import plots
from document import number, size, spread, table
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


class Report:
    """The regions of the document, by name, and the pictures that they show."""

    def __init__(self, results, pictures):
        self.results, self.pictures = results, pictures
        self.generators = {"acceptance": self.acceptance, "machine": self.machine,
                           "builds": self.builds}

    def fill(self, text):
        return document.fill(text, self.generators)

    def picture(self, name, alternative):
        return f"![{alternative}]({self.pictures.name}/{name}.svg)\n"

    def acceptance(self):
        rows = []
        for wanted in acceptance.WANTED:
            value = wanted.measured(self.results)
            rows.append((wanted.what, f"{'≤' if wanted.at_most else '≥'} {wanted.limit:,}",
                         number(value), wanted.verdict(value)))
        return table(("", "wanted", "measured", ""), rows)

    def machine(self):
        """Of every part: they may have been measured on different days."""
        text, rows = "", []
        machines = {}
        for name, part in self.results.parts.items():
            about = part["machine"]
            rows.append((f"`{name}`", part["mode"], about["date"], about["commit"], number(about["load"]),
                         f"{part['seconds'] / 60:.1f}"))
            key = tuple(str(about[field]) for field in ("cpu", "cores", "memory_bytes", "kernel",
                                                        "compiler", "flags", "packages"))
            machines[key] = about
        for about in machines.values():
            packages = ", ".join(f"{name} {version}" for name, version in about["packages"].items())
            text += (f"{about['cores']} cores of {about['cpu']}, {size(about['memory_bytes'])} of memory,"
                     f" Linux {about['kernel']}; {about['compiler']}, `{about['flags']}`; {packages}.\n\n")
        return text + table(("part", "mode", "date", "commit", "load before", "minutes"), rows)

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
