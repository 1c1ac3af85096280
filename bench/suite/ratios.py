"""The ratios on the page: the time of Abacus to that of a peer, for the same work."""
import dataclasses
import typing

import acceptance
import habits
from acceptance import SHORELINES, asked, deleted, interpolated, surface, times
from document import points, table
from results import median, ratio


@dataclasses.dataclass
class Ratio:
    what: str
    peer: str
    engine: str  # that of the peer's measurements
    measured: typing.Callable  # of Results and `wall` or `cpu`: the ratio, or None


def built(what, dimension, set, count):
    """Ratios of a build of so many points: to each peer that makes it."""
    peers = (("cgal", "CGAL, in memory"), ("postgis", "PostGIS, to a geometry"),
             ("postgis_kept", "PostGIS, to rows with an index"), ("tetgen", "TetGen, in memory"),
             ("qhull", "Qhull, in memory"))
    return [Ratio(what, peer, engine, times("abacus", engine, dimension, set, count)) for engine, peer in peers]


def located(habit):
    """Location along the curve, in the largest mesh of which there are such rows."""
    def measured(results, figure):
        return ratio(1, habits.times_rows(habit, figure)(results))
    return measured


def goose(results, figure):
    return ratio(1, habits.times_abacus(results, figure))


def octree(dimension, step):
    def measured(results, figure):
        return ratio(*(results.median(figure, what="octree", dimension=dimension, engine=engine, step=step)
                       for engine in ("abacus", "p4est")))
    return measured


def area_within(results, figure):
    return ratio(*(results.median(figure, what="within", points=10**6, question="area", engine=engine) for engine in ("abacus", "postgis")))


RATIOS = [
    *built("triangulation of 1 M uniform points", 2, "uniform", 10**6),
    *built("triangulation of 10 M uniform points", 2, "uniform", 10**7),
    *built("triangulation of the world's shorelines, 14.35 M points", 2, "shorelines", SHORELINES),
    *built("tetrahedra of 1 M uniform points", 3, "uniform", 10**6),
    *built("tetrahedra of an earthquake model, 1.02 M points", 3, "quake", 1016926),
    Ratio("triangulation of 100,000 uniform points", "Goose: insertion by an R-tree, the dissertation's chapter 2", "goose", goose),
    Ratio("location of places along the curve", "rows of triangles under GiST, exact test", "exact_rows", located("exact_rows")),
    Ratio("location of places along the curve", "rows of triangles under GiST, test in double precision", "rows", located("rows")),
    Ratio("location of places along the curve", "polygons of PostGIS under GiST", "postgis", located("postgis")),
    Ratio("linear interpolation, time of a place in a call for a million", "SciPy, triangulated before; of a place among 20,000", "scipy",
          interpolated()),
    Ratio("linear interpolation, 20,000 places in one call", "SciPy, triangulated before", "scipy", interpolated(as_many=True)),
    Ratio("linear interpolation, a million places in one call", "SciPy, which triangulates first; by its time for 20,000", "scipy",
          interpolated(builds=True)),
    Ratio("contours of a mesh of 1 M points, 20 levels", "matplotlib, mesh in memory", "matplotlib",
          asked("contours", "contours", other_engine="matplotlib")),
    Ratio("raster of 4096² pixels, 1 M points", "gdal_grid, which triangulates first", "gdal",
          asked("raster of 4096²", "raster of 4096²", other_engine="gdal")),
    Ratio("isosurface in an earthquake model", "VTK's contour filter, grid in memory", "vtk", surface),
    Ratio("area of a mesh of 1 M points within a polygon of 64 corners", "PostGIS, triangles under GiST cut by `ST_Intersection`", "postgis", area_within),
    Ratio("half of 1 M points in the plane deleted, a point", "CGAL's `remove`, in random order", "cgal", deleted(2, 1000000, 1)),
    Ratio("half of 1 M points in the plane deleted, a point", "CGAL's `remove`, along the curve, vertices known", "cgal", deleted(2, 1000000, 0)),
    Ratio("half of 500,000 points in space deleted, a point", "CGAL's `remove` from 200,000, in random order", "cgal",
          deleted(3, 200000, 1)),
    Ratio("half of 500,000 points in space deleted, a point", "CGAL's `remove`, along the curve, vertices known", "cgal", deleted(3, 200000, 0)),
    *(Ratio(f"{tree} of points: {what}", "p4est, in memory", "p4est", octree(dimension, step))
      for dimension, tree in ((2, "quadtree"), (3, "octree"))
      for step, what in (("construct", "leaves with one point at most"), ("balance", "balance across corners"))),
]


def parallel(results):
    """To CGAL's parallel triangulation, with as many threads: of the part `threads`, else of `3d`."""
    found = results.all(what="threads", engine="cgal_parallel") or results.all(what="build", engine="cgal_parallel")
    for cgal in found:
        labels = {key: cgal[key] for key in ("what", "dimension", "set", "points", "threads")}

        def measured(results, figure, cgal=cgal, labels=labels):
            abacus = results.one(engine="abacus", **labels)
            return ratio(abacus and median(abacus, figure), median(cgal, figure))
        threads = cgal["threads"]
        yield Ratio(f"tetrahedra of {points(cgal['points'])} points by {threads} thread{'s' * (threads != '1')}",
                    "CGAL's parallel triangulation, in memory, as many threads", "cgal_parallel", measured)


def on_gpu(results):
    """The core alone with most threads, to CuPy."""
    for cupy in results.all(what="gpu", engine="cupy"):
        ours = results.all(what="gpu", engine="abacus", set=cupy["set"], points=cupy["points"])
        if not ours:
            continue
        most = max(ours, key=lambda m: m["threads"])
        named = f"{points(cupy['points'])} points ({cupy['set']})"
        for what, name in (("wall", f"triangulation of {named}"),
                           ("interpolate", f"linear interpolation at {points(cupy['places'])} places among {named}")):
            def measured(results, figure, what=what, most=most, cupy=cupy):
                return ratio(median(most, what), median(cupy, what)) if figure == "wall" else None
            yield Ratio(f"{name}, the core alone, {most['threads']} threads", "CuPy, on a GPU", "cupy", measured)


def written(value):
    """A small ratio as a fraction."""
    if value is None:
        return "–"
    return f"{value:#.3g}".rstrip(".") if value >= 0.1 else f"1/{1 / value:,.0f}"


def ratios(results):
    """The table of those that were measured, and the engines of the peers in it."""
    rows, engines = [], set()
    for one in [*RATIOS, *parallel(results), *on_gpu(results)]:
        wall, cpu = (one.measured(results, figure) for figure in ("wall", "cpu"))
        if wall is not None or cpu is not None:
            rows.append((one.what, one.peer, written(wall), written(cpu)))
            engines.add(one.engine)
    return table(("", "beside", "elapsed time", "processor time"), rows), engines
