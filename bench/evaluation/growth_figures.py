"""Figures 5.9 to 5.14: the time a million points take, as sets grow, with much and little memory,
beside engines in core."""
import itertools

import plots
from beside import clock, count, number, percent, size
from dissertation import FIGURE, POINTS_2D, POINTS_3D, numbers
from document import table
from evaluation_parts import SMALL_MEMORY
from point_sets import QUAKE_POINTS
from results import median

IN_CORE = {"cgal": "CGAL", "qhull": "Qhull", "tetgen": "TetGen"}
PER_MILLION = "seconds a million points"


class GrowthFigures:
    def __init__(self, report):
        self.report = report
        self.generators = {
            "figure-5-9": lambda: self.comparison(2, FIGURE["5.9"], ("Triangle (ii)", "Triangle (dc)")),
            "figure-5-10": lambda: self.growth(2, "5.9", POINTS_2D, ("Triangle (ii)", "Triangle (dc)")),
            "figure-5-11": lambda: self.comparison(3, FIGURE["5.11"], ("Pyramid",)),
            "figure-5-12": lambda: self.growth(3, "5.11", POINTS_3D, ("Pyramid",)),
            "figure-5-13": self.small_memory, "figure-5-14": self.small_memory_plot,
            "caches": self.caches, "wall": self.wall}

    def in_core(self, dimension, engine):
        """Entries {key, points, measurement} of an engine, in the order of their size."""
        found = self.report.results.all(what="incore", dimension=dimension, engine=engine)
        return sorted(({"key": m.get("frequency", m["points"]), "points": m["points"], "measurement": m}
                       for m in found), key=lambda entry: entry["points"])

    def comparison(self, dimension, figure, theirs):
        engines = {name: self.in_core(dimension, engine) for engine, name in IN_CORE.items()}
        beside = self.report.beside(dimension, figure, self.report.steps(dimension),
                                    itertools.chain(*engines.values()))
        beside.add("points", "vertices", lambda e: count(e["points"]))
        beside.add("Abacus: staging", "stage", lambda e: clock(median(e["stage"], "wall")))
        beside.add("Abacus: triangulating", "triangulate",
                   lambda e: clock(median(e["triangulate"], "wall")))
        beside.add("Abacus: both", "total", lambda e: clock(both(e)))
        beside.add(f"Abacus: {PER_MILLION}", "amortized", lambda e: number(a_million(e)))
        beside.add("… of the CPU", None, lambda e: number(a_million(e, "cpu")))
        for name in theirs:
            beside.add(name, figure[name]["wall"])
            beside.add(f"{name}: memory", figure[name]["memory"])
            beside.add(f"{name}: {PER_MILLION}", figure[name]["amortized"])
        for name, found in engines.items():
            if found:
                self.add_in_core(beside, dimension, name, found)
        return beside.markdown()

    def add_in_core(self, beside, dimension, name, found):
        """Its rows; memory in parentheses is what follows from the largest set that was measured."""
        largest = found[-1]
        a_point = median(largest["measurement"], "memory") / largest["points"]

        def memory(entry):
            if "measurement" in entry:
                return size(median(entry["measurement"], "memory"))
            return f"({size(a_point * entry['points'])})" if entry["points"] > largest["points"] else None

        entries = beside.by_column(found)
        unmeasured = {key: {"points": key if dimension == 2 else QUAKE_POINTS.get(key, 0)}
                      for key in beside.keys}
        beside.add(name, None, lambda e: clock(median(e["measurement"], "wall")), entries)
        beside.add("… memory", None, memory, unmeasured | entries)
        for label, time in ((f"… {PER_MILLION}", "wall"), ("… of the CPU", "cpu")):
            beside.add(label, None, lambda e, time=time: number(
                median(e["measurement"], time) / e["points"] * 1e6), entries)

    def growth(self, dimension, figure, keys, theirs):
        """A plot of the seconds a million points take, and where memory ends."""
        series = {"Abacus, here": [plain(e["points"], a_million(e)) for e in self.report.steps(dimension)]}
        wall = None
        for engine, name in IN_CORE.items():
            found = self.in_core(dimension, engine)
            if found:
                series[f"{name}, here"] = [
                    plain(e["points"], median(e["measurement"], "wall") / e["points"] * 1e6) for e in found]
            if found and engine == "cgal":
                a_point = median(found[-1]["measurement"], "memory") / found[-1]["points"]
                wall = self.memory_bytes() / a_point
        for name, values in [("Abacus, there", numbers(figure, "amortized")),
                             *((f"{name}, there", numbers(figure, "amortized", name)) for name in theirs)]:
            series[name] = [plain(key, value) for key, value in zip(keys, values) if value]
        if wall:
            series["memory of the machine, CGAL"] = [plain(wall, 0.5), plain(wall, 300)]
        name = f"growth-{dimension}d"
        plots.lines(self.report.pictures / f"{name}.svg", f"{dimension}D: {PER_MILLION}", "points",
                    PER_MILLION, {label: rows for label, rows in series.items() if rows},
                    logarithmic="xy", key="outside right")
        return self.report.picture(name, f"{PER_MILLION}, by the number of points, in {dimension}D")

    def memory_bytes(self):
        return max(part["machine"]["memory_bytes"] for part in self.report.results.parts.values())

    def small(self):
        return self.report.steps(2, memory=SMALL_MEMORY)

    def small_memory(self):
        figure, entries = FIGURE["5.13"], self.small()
        with_all = {entry["key"]: entry for entry in self.report.steps(2)}
        beside = self.report.beside(2, figure, entries)
        beside.add("points", "vertices", lambda e: count(e["points"]))
        beside.add("tables and B-trees", "database", lambda e: size(sum(e["triangulate"]["disk"].values())))
        beside.add("staging", "stage", lambda e: clock(median(e["stage"], "wall")))
        beside.add("triangulating", "triangulate", lambda e: clock(median(e["triangulate"], "wall")))
        beside.add("both", "total", lambda e: clock(both(e)))
        beside.add(PER_MILLION, "amortized", lambda e: number(a_million(e)))
        beside.add("÷ with all of the memory", "slowdown", lambda e: with_all.get(e["key"]) and number(
            both(e) / both(with_all[e["key"]])))
        beside.add("share of the time on the CPU, triangulating", None, lambda e: percent(
            median(e["triangulate"], "cpu") / median(e["triangulate"], "wall"), 0))
        beside.add("read from the disk, both steps", None, lambda e: size(both(e, "read")))
        beside.add("written to it", None, lambda e: size(both(e, "written")))
        beside.add("most memory of the group", None, lambda e: size(of_group(e, "peak")))
        return beside.markdown() + "\n" + self.how_confined(entries)

    def how_confined(self, entries):
        samples = [sample for e in entries for sample in e["triangulate"]["samples"]]
        if not samples:
            return ""
        if all("group" in sample for sample in samples):
            return (f"Measured in a control group of {SMALL_MEMORY} MB; no process was killed.\n"
                    if not any(sample["group"]["killed"] for sample in samples) else
                    f"Measured in a control group of {SMALL_MEMORY} MB; processes were killed.\n")
        cached = max(sample.get("page_cache", 0) for sample in samples)
        return ("No control group could be made: what the kernel had cached of files was dropped before"
                f" each step, and it cached up to {size(cached)} again.\n")

    def small_memory_plot(self):
        series = {"here, all of the memory": [plain(e["points"], a_million(e)) for e in self.report.steps(2)],
                  f"here, {SMALL_MEMORY} MB": [plain(e["points"], a_million(e)) for e in self.small()],
                  "there, 8 GB": [plain(*pair) for pair in zip(POINTS_2D, numbers("5.9", "amortized"))],
                  "there, 64 MB": [plain(*pair) for pair in zip(POINTS_2D, numbers("5.13", "amortized"))]}
        plots.lines(self.report.pictures / "memory.svg", f"2D: {PER_MILLION}, 8 MB of cache", "points",
                    PER_MILLION, {label: rows for label, rows in series.items() if rows},
                    logarithmic="xy", key="outside right")
        return self.report.picture("memory", f"{PER_MILLION} with all of the memory and with little")

    def caches(self):
        """The same points with caches of several sizes."""
        rows, seen = [], {(m["dimension"], m["points"])
                          for name, part in self.report.results.parts.items()
                          if name.startswith("caches-") for m in part["measurements"]}
        for m in self.report.results.all(what="triangulate", memory=None):
            if (m["dimension"], m["points"]) in seen:
                rows.append((f"{m['dimension']}D, {count(m['points'])}", m["cache"], m))
        rows.sort(key=lambda row: (row[0], row[1]))
        first = {}
        text = []
        for name, cache, m in rows:
            wall, cpu = median(m, "wall"), median(m, "cpu")
            first.setdefault(name, (wall, cpu))
            text.append((name, f"{cache:,} MB", number(wall), number(wall / first[name][0]), number(cpu),
                         number(cpu / first[name][1]), size(median(m, "memory")),
                         f"{m['stats']['misses']:,.0f}"))
        return table(("points", "cache", "triangulating, s", "÷ the smallest's", "CPU s",
                      "÷ the smallest's", "private memory", "misses"), text) if text else ""

    def wall(self):
        rows = []
        for m in self.report.results.all(what="wall"):
            sample = m["samples"][0]
            rows.append((IN_CORE[m["engine"]], count(m["points"]), f"{m['memory']:,} MB",
                         clock(sample["wall"]) if "wall" in sample else
                         "killed: out of memory" if sample["group"]["killed"] else
                         f"ended by {sample['returned']}"))
            rows += [("Abacus", count(e["points"]), f"{m['memory']:,} MB", clock(both(e)))
                     for e in self.report.steps(m["dimension"], m["cache"], m["memory"])
                     if e["points"] == m["points"]]
        return table(("engine", "points", "memory", "time"), rows) if rows else ""


def both(entry, figure="wall"):
    return median(entry["stage"], figure) + median(entry["triangulate"], figure)


def a_million(entry, figure="wall"):
    return both(entry, figure) / entry["points"] * 1e6


def of_group(entry, figure):
    samples = [sample["group"] for step in ("stage", "triangulate") for sample in entry[step]["samples"]
               if "group" in sample]
    return max((sample[figure] for sample in samples if sample[figure] is not None), default=None)


def plain(x, y):
    """A point of a plot without a spread."""
    return (x, y, y, y)
