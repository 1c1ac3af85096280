"""The parts of the suite: what is measured, with how many points, in which mode."""
import os

from ask import Ask
from builds import Contest
from carried import Carried
from core import core
from detail import Detail
from driver import Part
from edits import Edits, SharedDeletes, cancelled_builds
from goose import Goose
from gpu import Gpu
from lines import Lines
from location import location
from octrees import Octrees
from rasters import Raster
from regions import Regions
from rows import Rows
from sharded import Sharded
from shares import Shares
from shared_reading import SharedLoading, SharedReading
from surfaces import Surfaces
from terrain import Terrain
from thinning import Thin


def contests(*contests):
    def measure(suite):
        for contest in contests:
            contest.measure(suite)
    return measure


FEWER = {"full": 3, "quick": 1, "smoke": 1}

# One thread, two, and one for each processor, each number once; CGAL has threads in space only
COUNTS = sorted({1, 2, os.cpu_count()})
THREADS = tuple(f"threads:{count}" for count in COUNTS)
PARALLEL = tuple(f"cgal_parallel:{count}" for count in COUNTS)

# The cost of a point among very many is compared with this smaller build, just before and just after
BESIDE = Contest(2, "uniform", {"full": 1000000}, ("abacus:64",), what="beside")

PARTS = [
    Part("2d", "uniform points in the plane, all engines", 5, contests(
        Contest(2, "uniform", {"full": 1000000, "quick": 200000, "smoke": 20000},
                ("cgal", "abacus:default", "abacus:8", "abacus:64", "abacus:largest", "postgis",
                 "postgis:kept", "qhull")))),
    Part("2d-sets", "clusters and curves, and a grid", 3, contests(
        Contest(2, "curves", {"full": 1000000, "quick": 200000, "smoke": 20000},
                ("cgal", "abacus:default", "abacus:8", "postgis")),
        Contest(2, "grid", {"full": 1000000, "quick": 200000, "smoke": 20000},
                ("cgal", "abacus:default", "abacus:8", "postgis")))),
    Part("2d-10m", "ten times as many uniform points", 4.5, contests(
        Contest(2, "uniform", {"full": 10000000, "quick": 1000000},
                ("cgal", "abacus:default", "abacus:8", "abacus:largest"), {"full": 5, "quick": 1}))),
    Part("shorelines", "shorelines, borders and rivers of the world", 3, contests(
        Contest(2, "shorelines", {"full": 0},
                ("cgal", "abacus:default", "abacus:8"), FEWER))),
    Part("lines", "shorelines, borders and rivers with all their segments as fixed edges, 8 MB of cache", 25, Lines(
        {"full": ("f", None), "quick": ("h", 1000000), "smoke": ("h", 20000)}, FEWER).measure),
    Part("regions", "within a region and a polygon; a terrain with breaklines and regions, from tables to contours", 8, contests(
        Regions({"full": (10000000, 1000000), "quick": (1000000, 100000), "smoke": (20000, 2000)}),
        Terrain({"full": (500000, 20000, 300), "quick": (50000, 2000, 30), "smoke": (5000, 200, 4)}, FEWER))),
    Part("3d", "uniform points in space, all engines", 6, contests(
        Contest(3, "uniform", {"full": 1000000, "quick": 100000, "smoke": 5000},
                ("cgal", "abacus:default", "abacus:16", "abacus:largest", THREADS[-1], PARALLEL[-1], "tetgen", "qhull")))),
    Part("3d-quake", "points of an earthquake model", 4.5, contests(
        Contest(3, "quake", {"full": 1000000, "quick": 130000, "smoke": 5000},
                ("cgal", "abacus:default", "abacus:largest", "tetgen")))),
    Part("2d-100m", "a hundred times as many uniform points, 64 MB of cache", 9, contests(
        BESIDE, Contest(2, "uniform", {"full": 100000000}, ("abacus:64",), FEWER, disk=16 << 30), BESIDE)),
    Part("threads", "the same builds, deletions, checks, locations, sorts and loads by one thread, by two, and by all processors", 12, contests(
        Contest(2, "uniform", {"full": 10000000, "quick": 1000000, "smoke": 100000},
                THREADS, FEWER, what="threads"),
        Contest(3, "uniform", {"full": 1000000, "quick": 100000, "smoke": 20000},
                THREADS + PARALLEL, FEWER, what="threads"),
        SharedReading(2, {"full": (1000000, 1000000), "quick": (200000, 200000), "smoke": (40000, 20000)}, FEWER),
        SharedReading(3, {"full": (500000, 500000), "quick": (50000, 100000), "smoke": (20000, 20000)}, FEWER),
        SharedLoading(2, {"full": 1000000, "quick": 100000, "smoke": 20000}, FEWER),
        SharedLoading(3, {"full": 1000000, "quick": 100000, "smoke": 20000}, FEWER),
        SharedDeletes(2, {"full": 10000000, "quick": 1000000, "smoke": 100000}),
        SharedDeletes(3, {"full": 1000000, "quick": 100000, "smoke": 20000}))),
    Part("locate-2d", "places in a mesh in the plane, warm and cold", 3, location(
        2, {"full": (10000000, 1000000), "quick": (500000, 200000), "smoke": (20000, 5000)})),
    Part("locate-3d", "places in a mesh in space, warm and cold", 1.5, location(
        3, {"full": (1000000, 500000), "quick": (100000, 100000), "smoke": (5000, 2000)})),
    Part("surfaces", "isosurface beside VTK's, section, picture of the inside", 3,
         Surfaces({"full": 0.218, "quick": 0.1, "smoke": 0.03}).measure),
    Part("ask", "values, contours and windows, beside SciPy and matplotlib", 7, Ask(
        {"full": (1000000, 1000000, 10000000, 20000), "quick": (100000, 100000, 1000000, 20000),
         "smoke": (5000, 2000, 20000, 1000)}).measure),
    Part("raster", "a raster of 4096² pixels, beside gdal_grid's", 12, Raster(
        {"full": (1000000, 4096), "quick": (100000, 512), "smoke": (5000, 64)}).measure),
    Part("thin", "a raster of 4096² heights thinned, beside delatin", 12, Thin(
        {"full": 4096, "quick": 512, "smoke": 64}).measure),
    Part("detail", "six levels of detail beside the build of their mesh, and tiles of terrain of triangles", 10, Detail(
        {"full": (1000000, 10000000), "quick": (100000, 1000000), "smoke": (5000,)}).measure),
    Part("shares", "a mesh cut for the ranks of a parallel program, beside METIS; shares, and steps of a solution", 3, Shares(
        {"full": 0.25, "quick": 0.1, "smoke": 0.02}).measure),
    Part("shards", "one mesh over four databases beside one in a single database: processor time, and what travels", 6, Sharded(
        {"full": ((2, 1000000), (2, 10000000), (3, 1000000)), "quick": ((2, 200000), (3, 50000)), "smoke": ((2, 5000), (3, 2000))},
        {"full": 1, "quick": 1, "smoke": 1}).measure),
    Part("carried", "windows of a foreign table, tiles of web maps, facets with markers, files", 5, Carried(
        {"full": (1000000, 800000), "quick": (100000, 50000), "smoke": (5000, 500)}, FEWER).measure),
    Part("octree", "octrees of points: made, balanced, extracted, asked, beside p4est", 8, Octrees(
        {"full": 5000000, "quick": 200000, "smoke": 3000}).measure),
    Part("gpu", "CuPy on an NVIDIA GPU beside the core by 1 to 16 threads; skipped elsewhere", 4, Gpu(
        {"full": (("uniform", 1000000), ("curves", 1000000), ("uniform", 10000000)),
         "quick": (("uniform", 1000000), ("curves", 1000000)), "smoke": (("uniform", 20000),)},
        {"full": 1000000, "quick": 1000000, "smoke": 5000}, {"full": 5, "quick": 3, "smoke": 1}).measure, needs_server=False),
    Part("goose", "insertion by an R-tree (chapter 2), in the plane", 4, Goose(
        2, {"full": (25000, 50000, 100000, 200000), "quick": (10000, 20000), "smoke": (1000,)}, FEWER).measure),
    Part("goose-3d", "insertion by an R-tree (chapter 2), in space", 4, Goose(
        3, {"full": (5000, 10000, 20000), "quick": (2000, 4000), "smoke": (200,)}, FEWER).measure),
    Part("rows", "location in a table of one row a triangle", 4.5, Rows(
        {"full": (1000000, 200000), "quick": (100000, 50000), "smoke": (2000, 1000)}, FEWER).measure),
    Part("edit-2d", "points in and out of a finished mesh in the plane", 5, Edits(
        2, {"full": 1000000, "quick": 100000, "smoke": 5000}).measure),
    Part("edit-3d", "points in and out of a finished mesh in space", 6, Edits(
        3, {"full": 500000, "quick": 30000, "smoke": 2000}).measure),
    Part("cancel", "how long a cancel takes", 0.5, cancelled_builds(
        2, {"full": 1000000, "quick": 500000, "smoke": 50000})),
    Part("core", "parts of the core by themselves", 3.5, core),
    Part("rows-10m", "location in rows, ten times as many", 26, Rows(
        {"full": (10000000, 1000000, 200000)}, FEWER, ("rows", "exact_rows"), disk=12 << 30).measure),
]
