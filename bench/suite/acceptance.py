"""What was wanted of the figures, what they are, and whether that was held or missed: for contributors, whom
`scripts/bench.sh aims` shows it."""
import dataclasses
import statistics
import typing

import habits
from document import number, table
from results import median, ratio

SHORELINES = 14353294


@dataclasses.dataclass
class Wanted:
    what: str
    limit: float | None  # None: it is only reported
    at_most: bool
    measured: typing.Callable  # of Results: the figure, or None

    def wanted(self):
        return "–" if self.limit is None else f"{'≤' if self.at_most else '≥'} {self.limit:,}"

    def verdict(self, value):
        if value is None:
            return "not measured"
        if self.limit is None:
            return "–"
        held = value <= self.limit if self.at_most else value >= self.limit
        return "held" if held else "**missed**"

    def by_cpu(self, results):
        """Where it is about time: the same by the CPU time, which other work on the machine changes less."""
        return None


class Timed(Wanted):
    """A figure that `measured` takes from wall or CPU time, as told."""

    def by_cpu(self, results):
        return self.measured(results, "cpu")


def build(results, engine, dimension, set, points, **labels):
    """A build, or None. So many points are meant about: a quake set has what it has. Builds by a given number
    of threads have others beside them."""
    labels = {"threads": None} | labels
    found = [measurement for measurement in
             results.all(what="build", engine=engine, dimension=dimension, set=set, **labels)
             if abs(measurement["points"] - points) <= 0.05 * points]
    if len(found) > 1:
        raise LookupError(f"{len(found)} builds: {engine} {set} {points}")
    return found[0] if found else None


def times(engine, other, dimension, set, points, cache="default", other_cache=None):
    """Ratio of the times of two engines."""
    def measured(results, figure="wall"):
        labels = {"cache": cache} if engine == "abacus" else {}
        other_labels = {"cache": other_cache} if other == "abacus" else {}
        one = build(results, engine, dimension, set, points, **labels)
        two = build(results, other, dimension, set, points, **other_labels)
        return ratio(one and median(one, figure), two and median(two, figure))
    return measured


def bytes_a_simplex(dimension, points):
    def measured(results):
        found = build(results, "abacus", dimension, "uniform", points, cache="default")
        if found is None:
            return None
        disk = found["disk"]
        return (disk["simplices"] + disk["index"]) / found["samples"][-1]["simplices"]
    return measured


def growth(results, figure="wall"):
    """Cost of a point at 100 M to that at 1 M, built before and after it, with 64 MB of cache."""
    beside = [sample[figure] / m["points"] for m in results.all(what="beside") for sample in m["samples"]]
    large = build(results, "abacus", 2, "uniform", 10**8, cache="64")
    return ratio(large and median(large, figure) / large["points"], statistics.median(beside) if beside else None)


def places_a_second(order, cache, **labels):
    labels = labels or {"form": "a_call_each"}

    def measured(results, figure="wall"):
        found = results.one(what="locate", dimension=2, points=10**7, order=order, cache=cache, **labels)
        return found and statistics.median(found["places"] / sample[figure] for sample in found["samples"])
    return measured


def cold_pages(question):
    """Heap and index leaf pages, on average."""
    def measured(results):
        found = results.one(what="cold", dimension=2, points=10**7, question=question)
        return found and statistics.mean(sample["heap"] + sample["leaf"] for sample in found["samples"])
    return measured


def inserted(dimension):
    """Points inserted into a mesh of as many, to a first build of them."""
    def measured(results, figure="wall"):
        return ratio(*(results.median(figure, what="edit", change=change, dimension=dimension)
                       for change in ("insert many", "build many")))
    return measured


def deleted(dimension, points, order):
    """A point of many that a statement deletes, to one that CGAL's remove() takes from a mesh of so many,
    in the order of the curve (0) or at random (1)."""
    def measured(results, figure="wall"):
        ours = results.one(what="edit", change="delete many", dimension=dimension)
        cgal = results.median(figure, what="core", benchmark=f"CgalRemove<{dimension}>/{points}/{order}")
        return ratio(ours and median(ours, figure) / ours["changed"], cgal)
    return measured


def milliseconds(change, dimension):
    """Of one point in a transaction of its own."""
    def measured(results):
        seconds = results.median("wall", what="edit", change=f"{change} one", dimension=dimension)
        return seconds and 1000 * seconds
    return measured


def space(dimension):
    """Size after VACUUM to that before, where statements of many points have replaced half of the points."""
    def measured(results):
        found = results.all(what="edit", change="space", dimension=dimension)
        return max((m["samples"][0]["moved"] / m["samples"][0]["fresh"] for m in found), default=None)
    return measured


def surface(results, figure="wall"):
    """Ratio to VTK of an isosurface in the largest quake set there is."""
    points = max((m["points"] for m in results.all(what="surface")), default=None)
    return ratio(*(results.median(figure, what="surface", question="isosurface", engine=engine, points=points)
                   for engine in ("abacus", "vtk")))


def interpolated(as_many=False, builds=False):
    """Linear interpolation in a mesh of 1 M points, the most places in one call, or as many as SciPy got: time of
    a place to SciPy's, whose triangulation may count, too."""
    def measured(results, figure="wall"):
        labels = {"what": "ask", "points": 10**6}
        scipy = results.one(engine="scipy", question="interpolate", **labels)
        ours = results.all(engine="abacus", question="interpolate", **labels)
        if as_many and scipy:
            ours = [m for m in ours if m["places"] == scipy["places"]]
        if not scipy or not ours:
            return None
        most = max(ours, key=lambda m: m["places"])
        theirs = median(scipy, figure) / scipy["places"]
        if builds:
            build = results.median(figure, engine="scipy", question="build", **labels)
            if build is None:
                return None
            theirs += build / most["places"]
        return median(most, figure) / most["places"] / theirs
    return measured


def asked(question, other, other_engine="abacus"):
    """Ratio of the times of two questions to a mesh of 1 M points."""
    def measured(results, figure="wall"):
        def time(question, engine):
            return results.median(figure, what="ask", points=10**6, question=question, engine=engine)
        return ratio(time(question, "abacus"), time(other, other_engine))
    return measured


def rate_of(question, other):
    """How many places a second, to those of another question."""
    return asked(other, question)


def natural_a_second(results, figure="wall"):
    seconds = results.median(figure, what="ask", points=10**6, question="natural, a call each")
    found = results.one(what="ask", points=10**6, question="natural, a call each")
    return seconds and found["places"] / seconds


def window_share(figure):
    """Of a window of a hundredth of a mesh of 10 M points, to all of it."""
    def measured(results):
        return ratio(*(results.median(figure, what="ask", points=10**7, question=question) for question in ("window", "whole")))
    return measured


def within(question, part):
    """Within a region or a polygon of a tenth of the area, to all of a mesh of 10 M points."""
    def measured(results, figure="wall"):
        return ratio(*(results.median(figure, what="within", points=10**7, question=question, within=found) for found in (part, "all")))
    return measured


def with_lines(way):
    """From three tables to contours, to the same without lines and regions."""
    def measured(results, figure="wall"):
        return ratio(*(results.median(figure, what="terrain", points=500000, way=found) for found in (way, "points alone")))
    return measured


def levels(results, figure="wall"):
    """Six levels of a mesh of 10 M points, to its build."""
    return ratio(*(results.median(figure, what="levels", points=10**7, made=made) for made in ("levels", "mesh")))


def tile_meshes(figure, points):
    """The medians of all zooms."""
    def measured(results):
        found = [median(measurement, figure) for measurement in results.all(what="tile mesh", points=points)]
        return max(found) if found else None
    return measured


def pages_of_tiles(results):
    """The zoom at which pages differ most between meshes of 10 M and of 1 M points."""
    ratios = [ratio(median(measurement, "pages"), results.median("pages", what="tile mesh", points=10**6, zoom=measurement["zoom"]))
              for measurement in results.all(what="tile mesh", points=10**7)]
    return max((found for found in ratios if found is not None), default=None)


WANTED = [
    Timed("2D, 1 M uniform: table to committed mesh ÷ CGAL in core", 1.0, True,
          times("abacus", "cgal", 2, "uniform", 10**6)),
    Timed("2D, 10 M uniform: … ÷ CGAL in core", 0.8, True,
          times("abacus", "cgal", 2, "uniform", 10**7)),
    Timed("2D, shorelines: … ÷ CGAL in core", 0.9, True,
          times("abacus", "cgal", 2, "shorelines", SHORELINES)),
    Timed("2D, 1 M uniform: … ÷ PostGIS", 0.05, True,
          times("abacus", "postgis", 2, "uniform", 10**6)),
    Timed("… ÷ PostGIS to committed and indexed rows", 0.05, True,
          times("abacus", "postgis_kept", 2, "uniform", 10**6)),
    Timed("3D, 1 M uniform: … ÷ CGAL in core", 0.9, True,
          times("abacus", "cgal", 3, "uniform", 10**6)),
    Timed("3D, quake set of 1 M: … ÷ CGAL in core", 0.9, True,
          times("abacus", "cgal", 3, "quake", 1016926)),
    Timed("2D, 10 M uniform: cache of 8 MB ÷ unlimited", 1.3, True,
          times("abacus", "abacus", 2, "uniform", 10**7, "8", "largest")),
    Timed("2D: cost of a point at 100 M ÷ at 1 M, before and after, cache of 64 MB", 1.25, True, growth),
    Wanted("2D, 10 M uniform: bytes a triangle, index included", 18, True, bytes_a_simplex(2, 10**7)),
    Wanted("3D, 1 M uniform: bytes a tetrahedron, index included", 24, True, bytes_a_simplex(3, 10**6)),
    Timed("`abacus_locate`, 10 M, warm, along the curve: places a second", 700000, False,
          places_a_second("ordered", "largest")),
    Timed("`abacus_locate`, 10 M, at random, cache a tenth of the mesh, mesh in shared buffers: places a"
          " second", 250000, False, places_a_second("places", "tenth")),
    Timed("… a million of them in one call", 250000, False,
          places_a_second("places", "tenth", form="one_call", places=10**6)),
    Wanted("`abacus_locate`, 10 M, cold, first of a session: heap and index leaf pages", 2, True,
           cold_pages("first")),
    Wanted("`abacus_locate`, 10 M, cold, mesh found before: heap and index leaf pages", 2, True,
           cold_pages("next")),
    Wanted("… each of 100 at random in a session, the first included", 2, True, cold_pages("each")),
    Wanted("`abacus_locate`, warm, along the curve ÷ rows of triangles with the exact test, by CPU time",
           30, False, habits.times_rows("exact_rows")),
    Wanted("… ÷ rows of triangles with a test in double precision", 30, False, habits.times_rows("rows")),
    Wanted("… ÷ polygons of PostGIS", 30, False, habits.times_rows("postgis")),
    Wanted("Goose ÷ Abacus, 100,000 points, by CPU time", None, True,
           habits.times_abacus),
    Wanted("Goose ÷ Abacus, 1 M points, extrapolated by the growth of both", None, True,
           habits.times_abacus_extrapolated),
    Timed("`abacus_interpolate`, linear, along the curve: rate ÷ that of `abacus_locate`", 0.85, False,
          rate_of("linear, a call each", "locate, a call each")),
    Timed("… a million places in one call: rate ÷ that of `abacus_locate`", 0.85, False,
          rate_of("linear, one call", "locate, one call")),
    Timed("`abacus_interpolate`, natural, along the curve: places a second", 300000, False, natural_a_second),
    Timed("A million values in one call, from table to rows ÷ SciPy's `LinearNDInterpolator`, built, a place", 1, True,
          interpolated()),
    Timed("… ÷ with its build", 0.1, True, interpolated(builds=True)),
    Timed("`abacus_contours`, mesh of 1 M, 20 levels ÷ matplotlib's, mesh in memory", 0.5, True,
          asked("contours", "contours", other_engine="matplotlib")),
    Timed("`abacus_raster`, 4096² pixels, 1 M points ÷ `gdal_grid` from the points", 0.05, True,
          asked("raster of 4096²", "raster of 4096²", other_engine="gdal")),
    Wanted("`abacus_cells`, a window of 1 % of a mesh of 10 M ÷ the whole: time", 0.015, True, window_share("wall")),
    Wanted("… pages", 0.015, True, window_share("pages")),
    Timed("2D, 1 M points into a mesh of 1 M, one statement ÷ first build of the same points", 1.3, True,
          inserted(2)),
    Timed("3D, 500,000 points into a mesh of as many … ÷ first build of the same points", 1.3, True, inserted(3)),
    Timed("2D, half of 1 M points deleted, one statement ÷ CGAL's `remove` in core, in random order", 2, True,
          deleted(2, 1000000, 1)),
    Timed("… ÷ CGAL's `remove`, in the order of the curve, its vertices known", None, True, deleted(2, 1000000, 0)),
    Timed("3D, half of 500,000 points deleted … ÷ CGAL's `remove`, mesh of 200,000, in random order", 2, True,
          deleted(3, 200000, 1)),
    Timed("… ÷ CGAL's `remove`, in the order of the curve, its vertices known", None, True, deleted(3, 200000, 0)),
    Wanted("2D, 1 M points: one point inserted, a transaction, ms", 1, True, milliseconds("insert", 2)),
    Wanted("… one deleted, ms", 1, True, milliseconds("delete", 2)),
    Wanted("3D, 500,000 points: one point inserted, a transaction, ms", 3, True, milliseconds("insert", 3)),
    Wanted("… one deleted, ms", 3, True, milliseconds("delete", 3)),
    Timed("`abacus_isosurface`, quake set of 1 M ÷ VTK's contour filter, grid in memory", 1, True, surface),
    *(Timed(f"{what} within a {part} of a tenth of the area, mesh of 10 M ÷ of all", 0.15, True, within(question, part))
      for question, what in (("contours", "`abacus_contours`"), ("volume", "`abacus_volume`")) for part in ("region", "polygon")),
    Timed("Terrain of 500,000 points, 20,000 breaklines, 300 regions: tables to contours, lines in the call ÷ points alone", 2, True,
          with_lines("points and lines in one call")),
    Timed("… points first, then lines ÷ points alone", 2, True, with_lines("points, then lines")),
    Timed("Six levels of a mesh of 10 M points ÷ its build", 2, True, levels),
    Wanted("`abacus_tile_mesh`, levels of a mesh of 10 M, the slowest zoom: median CPU time, s", 0.015, True, tile_meshes("cpu", 10**7)),
    Wanted("… pages of a tile at 10 M points ÷ at 1 M, the greatest of all zooms", 1.2, True, pages_of_tiles),
    Wanted("2D, 1 M points: size after half of them were replaced and VACUUM ÷ fresh", 1.5, True, space(2)),
    Wanted("3D, 500,000 points: … ÷ fresh", 1.5, True, space(3)),
]


def aims(results):
    """A table of all of them."""
    rows = []
    for wanted in WANTED:
        value = wanted.measured(results)
        rows.append((wanted.what, wanted.wanted(), number(value), number(wanted.by_cpu(results)), wanted.verdict(value)))
    return table(("", "wanted", "measured", "by CPU time", ""), rows)
