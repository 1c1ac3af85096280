"""Regions of docs/benchmarks.md that are tables alone: location, changes, cancels, the core."""
import statistics

from document import number, points, size, spread, table
from results import ratio
from results import spread as spread_of
from results import values


def mesh_name(measurement):
    return f"{measurement['dimension']}D, {points(measurement['points'])} points"


SETS = {"curves": "clusters and curves"}  # whose names say too little
CACHES = {"largest": "of any size", "tenth": "a tenth of the mesh"}
ORDERS = {"ordered": "along the curve", "places": "at random"}
FORMS = {"a_call_each": "each a call", "one_call": "in one call"}


def location(results):
    rows = []
    for m in results.all(what="locate"):
        rates = sorted(m["places"] / sample["wall"] for sample in m["samples"])
        by_cpu = statistics.median(m["places"] / sample["cpu"] for sample in m["samples"])
        rows.append((mesh_name(m), f"{ORDERS[m['order']]}, {FORMS[m['form']]}", CACHES[m["cache"]],
                     f"{m['places']:,}", spread((statistics.median(rates), rates[0], rates[-1])),
                     number(by_cpu), size(max(values(m, "memory"))), len(rates)))
    return table(("mesh", "places", "cache", "places a statement", "places a second",
                  "places a CPU second", "memory", "runs"), rows)


QUESTIONS = {"first": "the first of a session: finds the mesh, too", "next": "one far away, after that",
             "each": "each of 100 at random in a session, the first included"}


def mean(measurement, figure):
    return sum(values(measurement, figure)) / len(measurement["samples"])


def cold(results):
    rows = [(mesh_name(m), QUESTIONS[m["question"]], *(number(mean(m, kind)) for kind in ("heap", "leaf", "inner")),
             number(mean(m, "heap") + mean(m, "leaf")), len(m["samples"]))
            for m in results.all(what="cold")]
    return table(("mesh", "question", "heap pages", "leaf pages", "inner pages", "heap and leaf", "runs"), rows)


def surfaces(results):
    engines = {"abacus": "Abacus", "vtk": "VTK"}
    rows = [(points(m["points"]), m["question"], engines[m["engine"]], f"{m['samples'][0]['answers']:,}",
             f"{spread(spread_of(m, 'wall'))} s", f"{number(statistics.median(values(m, 'cpu')))} s", len(m["samples"]))
            for m in results.all(what="surface")]
    return table(("points", "question", "", "rows or bytes", "wall", "CPU", "runs"), rows)


def octrees(results):
    """Nodes and elements are one step of p4est, which stands beside the nodes."""
    steps = {"construct": "leaves with one point at most", "balance": "balance across corners", "nodes": "nodes",
             "elements": "elements", "simplices": "triangles or tetrahedra", "locate": "leaves at the points, in one call"}
    engines = {"abacus": "Abacus", "p4est": "p4est"}
    rows = []
    for m in results.all(what="octree"):
        sizes = values(m, "bytes")
        rows.append((f"{m['dimension']}D, {points(m['points'])} points: {steps[m['step']]}", engines[m["engine"]],
                     number(m["samples"][0].get("answers")), f"{spread(spread_of(m, 'wall'))} s",
                     f"{number(statistics.median(values(m, 'cpu')))} s" if values(m, "cpu") else "–",
                     number(sizes[-1] / m["leaves"]) if sizes else "–", len(m["samples"])))
    return table(("step", "", "rows", "wall", "CPU", "bytes an octant", "runs"), rows)


ENGINES = {"abacus": "Abacus", "scipy": "SciPy", "matplotlib": "matplotlib", "gdal": "gdal_grid", "delatin": "delatin",
           "metis": "gpmetis", "copy": "COPY"}


def asking(results):
    rows = []
    for m in results.all(what="ask"):
        wall, pages = spread_of(m, "wall"), spread_of(m, "pages")
        places = f", {m['places']:,} places" if "places" in m else ""
        rows.append((f"{points(m['points'])} points: {m['question']}{places}", ENGINES[m["engine"]], f"{spread(wall)} s",
                     f"{number(statistics.median(values(m, 'cpu')))} s" if values(m, "cpu") else "–",
                     number(m["places"] / wall[0]) if places else "–",
                     number(pages and pages[0]), number(rate(m)) if m.get("written") else "–", len(m["samples"])))
    return table(("question", "", "wall", "CPU", "places a second", "pages", "MB a second", "runs"), rows)


def shares(results):
    """Parts of a mesh beside METIS, shares, and steps of a solution."""
    rows = []
    for m in results.all(what="share"):
        facets = values(m, "facets")
        rows.append((f"{points(m['points'])} points: {m['question']}", ENGINES[m["engine"]], f"{spread(spread_of(m, 'wall'))} s",
                     f"{number(statistics.median(values(m, 'cpu')))} s" if values(m, "cpu") else "–",
                     number(m["values"] / statistics.median(values(m, "cpu"))) if "values" in m else "–", f"{statistics.median(facets):,}" if facets else "–", len(m["samples"])))
    return table(("what", "", "wall", "CPU", "values a second of CPU", "facets between parts", "runs"), rows)


def sharded(results):
    """One mesh over several servers, beside one server, with the ratios of processor time: of all, and of the slowest server."""
    rows, alone = [], {}
    for m in results.all(what="sharded"):
        cpu, what = statistics.median(values(m, "cpu")), mesh_name(m)
        if m["shards"] == 1:
            alone[what] = cpu
        sent, slowest, rounds = (values(m, figure) for figure in ("sent", "slowest", "rounds"))
        rows.append((what, m["source"], f"{number(cpu)} s", number(ratio(cpu, alone.get(what))) if sent else "–",
                     number(ratio(statistics.median(slowest), alone.get(what))) if sent else "–",
                     f"{statistics.median(rounds)}" if sent else "–", f"{sent[-1]:,}" if sent else "–",
                     f"{100 * sent[-1] / m['points']:.2f} %" if sent else "–", len(m["samples"])))
    return table(("", "source", "CPU", "÷ one server", "slowest server ÷ one", "rounds", "vertices sent", "of all points", "runs"), rows)


def sharded_reading(results):
    """Questions about a mesh over several servers, beside one on one server."""
    rows, alone = [], {}
    for m in results.all(what="sharded reading"):
        wall, what = statistics.median(values(m, "wall")), (mesh_name(m), m["question"])
        if m["shards"] == 1:
            alone[what] = wall
        else:
            rows.append((*what, f"{number(alone[what])} s", f"{number(wall)} s", number(ratio(wall, alone[what])), len(m["samples"])))
    return table(("", "question", "one server", "four shards", "÷ one server", "runs"), rows)


def rate(measurement):
    """Megabytes of a file a second of elapsed time."""
    return statistics.median(sample["bytes"] / sample["wall"] for sample in measurement["samples"]) / 1e6


SHARED = {"build": "`abacus_triangulate`", "check": "`abacus_check`", "locate": "`abacus_locate`, in one call", "natural": "`abacus_weights`, natural, in one call",
          "nearest": "`abacus_nearest`, 4 of each, in one call", "sort": "`abacus_stage`", "load": "`abacus_load`"}


def threads(results):
    """Builds, readings and loads by several numbers of threads, each beside one thread."""
    rows, alone = [], {}
    for m in [*results.all(what="threads"), *results.all(what="shared reading")]:
        work = "CGAL's parallel triangulation, in memory" if m.get("engine") == "cgal_parallel" else SHARED[m.get("question", "build")]
        what = f"{mesh_name(m)}: {work}"
        wall = spread_of(m, "wall")
        if m["threads"] == "1":
            alone[what] = wall[0]
        rows.append((what, m["threads"], f"{spread(wall)} s", f"{number(statistics.median(values(m, 'cpu')))} s",
                     number(ratio(alone.get(what), wall[0])), len(m["samples"])))
    return table(("", "threads", "wall", "CPU", "times as fast", "runs"), rows)


def gpu(results):
    """CuPy, and the core by several numbers of threads, each beside CuPy."""
    rows = []
    for m in results.all(what="gpu"):
        cupy = results.one(what="gpu", engine="cupy", set=m["set"], points=m["points"])
        times = []
        for figure in "wall", "interpolate":
            found = spread_of(m, figure)
            times += [f"{spread(found)} s", number(ratio(found[0], spread_of(cupy, figure)[0]) if cupy else None)]
        rows.append((f"{points(m['points'])} points, {SETS.get(m['set'], m['set'])}; {points(m['places'])} places",
                     "CuPy" if m["engine"] == "cupy" else f"Abacus, {m['threads']} thread{'s' * (m['threads'] > 1)}",
                     *times[:2], f"{m['samples'][-1]['missing']:,}", *times[2:], len(m["samples"])))
    return table(("points", "", "triangulation", "÷ CuPy", "points in no triangle", "interpolation", "÷ CuPy", "runs"), rows)


def lines(results):
    """Builds with lines and without, of one engine one below the other, with the ratio of the two; then points beside lines."""
    rows = []
    for m in [*results.all(what="lines"), *results.all(what="line insert")]:
        labels = {key: m[key] for key in ("what", "engine", "points")}
        without = results.one(**labels, lines=False)
        wall, base = spread_of(m, "wall"), spread_of(without, "wall") if without else None
        is_build = m["what"] == "lines"
        cgal = results.one(what="lines", engine="cgal", points=m["points"], lines=m["lines"]) if is_build else None
        what = (f"{ENGINES.get(m['engine'], 'CGAL, in memory')}: {points(m['points'])} points" if is_build
                else f"a point {'beside' if m['lines'] else 'without'} lines, median of {m['transactions']:,}")
        rows.append((what, points(m["segments"]) if m["lines"] else "–", f"{spread(wall)} s" if is_build else f"{number(1000 * wall[0])} ms",
                     f"{number(statistics.median(values(m, 'cpu')))} s" if is_build else "–",
                     number(ratio(wall[0], base and base[0])) if m["lines"] else "–",
                     number(ratio(wall[0], spread_of(cgal, "wall")[0])) if cgal else "–",
                     size(max(values(m, "memory"))) if is_build else "–", len(m["samples"])))
    return table(("", "segments", "wall", "CPU", "÷ without lines", "÷ CGAL", "memory", "runs"), rows)


def edits(results):
    rows = []
    for m in results.all(what="edit"):
        if m["change"].endswith("many"):
            wall = spread_of(m, "wall")
            threads = m.get("threads")
            by = f" by {threads} thread{'s' * (threads > 1)}" if threads else ""
            how = f"from one tile to all {m['tiles']}, a statement each" if "tiles" in m else "in one statement"
            rows.append((mesh_name(m), f"{m['change'].split()[0]} {m['changed']:,} {how}{by}",
                         f"{spread(wall)} s", f"{number(1e6 * wall[0] / m['changed'])} µs",
                         f"{number(spread_of(m, 'wal')[0] / m['changed'])}"))
        elif m["change"].endswith("one"):
            rows.append((mesh_name(m), f"{m['change'].split()[0]} one, median of {m['transactions']:,};"
                         f" 99 of 100 take at most {number(1000 * m['percentile99'])} ms", "–",
                         f"{number(1e6 * spread_of(m, 'wall')[0])} µs", "–"))
        else:
            sample = m["samples"][0]
            sizes = [f"× {number(sample[which] / sample['fresh'])}{after}" for which, after in (
                ("after", ""), ("vacuumed", " after VACUUM that moves no pages"), ("moved", " after VACUUM"),
                ("compacted", " after abacus_build and VACUUM"))
                     if which in sample]
            rows.append((mesh_name(m), f"{m['changed']:,} out and in at random places,"
                         f" {m['at_once']:,} in a statement: size {', '.join(sizes)}", "–", "–",
                         number(sample["wal"] / m["changed"])))
    return table(("mesh", "change", "time", "a point", "WAL bytes a point"), rows)


def cancels(results):
    return "".join(
        f"{mesh_name(m)}: longest {number(1000 * max(values(m, 'wall')))} ms, median"
        f" {number(1000 * spread_of(m, 'wall')[0])} ms, of {len(m['samples'])} cancels at different moments.\n"
        for m in results.all(what="cancel"))


def seconds(value):
    for unit, factor in (("s", 1), ("ms", 1e3), ("µs", 1e6), ("ns", 1e9)):
        if value * factor >= 1 or unit == "ns":
            return f"{number(value * factor)} {unit}"


def core(results):
    rows = []
    for m in results.all(what="core"):
        middle, least, greatest = spread_of(m, "wall")
        rows.append((f"`{m['benchmark']}`", seconds(middle), seconds(least), seconds(greatest), len(m["samples"])))
    return table(("benchmark", "median", "least", "greatest", "runs"), rows)
