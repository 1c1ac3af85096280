"""The parts of the evaluation: what is measured for which figures, with how many points."""
from core_programs import Probing, Trace
from driver import Part
from hot_functions import HotFunctions
from incore import InCore, Wall
from point_sets import Quake, uniform
from steps import Steps

K, M = 10**3, 10**6
CACHE_2D = (8,)    # MB, the dissertation's
CACHE_3D = (128,)  # the default; the dissertation's is 6 GB
TINY = (1,)
SMALL_MEMORY = 64  # MB


def part(name, what, minutes, full=(), quick=(), smoke=(), only_named=False):
    """A part whose modes are lists of what is measured one after the other."""
    def measure(suite):
        for measurement in {"full": full, "quick": quick, "smoke": smoke}[suite.mode]:
            measurement.measure(suite)
    return Part(name, what, minutes, measure, only_named)


PARTS = [
    part("2d-1m", "5.5, 5.7, 5.17: 1 M points in the plane", 0.3,
         full=[Steps(uniform(1 * M), CACHE_2D, runs=5)],
         quick=[Steps(uniform(1 * M), CACHE_2D)],
         smoke=[Steps(uniform(20 * K), TINY)]),
    part("2d-10m", "… 10 M", 1, full=[Steps(uniform(10 * M), CACHE_2D, runs=2)],
         quick=[Steps(uniform(10 * M), CACHE_2D)]),
    part("2d-40m", "… 40 M", 2.5, full=[Steps(uniform(40 * M), CACHE_2D)]),
    part("2d-100m", "… 100 M", 6, full=[Steps(uniform(100 * M), CACHE_2D)]),
    part("3d-0.25", "5.6, 5.8, 5.18: the earthquake model for 0.25 Hz", 0.5,
         full=[Steps(Quake(0.25), CACHE_3D, runs=2)],
         quick=[Steps(Quake(0.25), CACHE_3D)],
         smoke=[Steps(Quake(0.05), TINY)]),
    part("3d-0.5", "… for 0.5 Hz", 1.5, full=[Steps(Quake(0.5), CACHE_3D)]),
    part("3d-0.75", "… for 0.75 Hz", 4, full=[Steps(Quake(0.75), CACHE_3D)]),
    part("3d-1", "… for 1 Hz", 9, full=[Steps(Quake(1), CACHE_3D)]),
    part("caches-3d", "§5.3.2: other caches, in space", 3,
         full=[Steps(Quake(0.25), (16, 1024)), Steps(Quake(0.5), (1024, 6144))]),
    part("caches-2d", "§5.3.2: larger caches, in the plane", 1.5,
         full=[Steps(uniform(10 * M), (16, 64, 256, 1024, 4096))],
         quick=[Steps(uniform(1 * M), (16, 64, 1024))],
         smoke=[Steps(uniform(20 * K), (8,))]),
    part("memory", "5.13, 5.14: 64 MB of memory", 3,
         full=[Steps(uniform(size), CACHE_2D, memory=SMALL_MEMORY) for size in (1 * M, 10 * M, 40 * M)],
         quick=[Steps(uniform(1 * M), CACHE_2D, memory=SMALL_MEMORY)],
         smoke=[Steps(uniform(20 * K), TINY, memory=SMALL_MEMORY)]),
    part("memory-100m", "… 100 M", 7, full=[Steps(uniform(100 * M), CACHE_2D, memory=SMALL_MEMORY)]),
    part("incore-2d", "5.9, 5.10: engines in core, in the plane", 6,
         full=[InCore(("cgal", "qhull"), [uniform(size) for size in (1 * M, 10 * M, 40 * M, 100 * M)])],
         quick=[InCore(("cgal", "qhull"), [uniform(1 * M)])],
         smoke=[InCore(("cgal", "qhull"), [uniform(20 * K)])]),
    part("incore-3d", "5.11, 5.12: engines in core, in space", 5,
         full=[InCore(("cgal", "tetgen"), [Quake(0.25), Quake(0.5)])],
         quick=[InCore(("cgal",), [Quake(0.1)])],
         smoke=[InCore(("cgal", "tetgen"), [Quake(0.05)])]),
    part("wall", "§5.3.3: more points than memory holds, in core and not", 1.5,
         full=[Wall("cgal", uniform(10 * M), 8, 1024)],
         quick=[Wall("cgal", uniform(2 * M), 8, 256)],
         smoke=[Wall("cgal", uniform(500 * K), 8, 64)]),
    part("trace", "5.15, 5.16: requests of pages", 3,
         full=[Trace(uniform(100 * M), 8)],
         quick=[Trace(uniform(10 * M), 8)],
         smoke=[Trace(uniform(20 * K), 1)]),
    part("probing-2d", "5.19: links not stored, in the plane", 1,
         full=[Probing(uniform(size), 8) for size in (1 * M, 10 * M)],
         quick=[Probing(uniform(1 * M), 8)],
         smoke=[Probing(uniform(300 * K), 1)]),
    part("probing-3d", "5.20: links not stored, in space", 2,
         full=[Probing(Quake(frequency), 128) for frequency in (0.25, 0.5)],
         quick=[Probing(Quake(0.1), 16)],
         smoke=[Probing(Quake(0.05), 1)]),
    part("functions", "5.21: the functions that take most time", 3,
         full=[HotFunctions(uniform(40 * M), 16)],
         quick=[HotFunctions(uniform(1 * M), 16)],
         smoke=[HotFunctions(uniform(300 * K), 16)]),
    part("2d-1b", "5.5, 5.7: 1 B points in the plane, when named only", 60,
         full=[Steps(uniform(1000 * M), CACHE_2D)], only_named=True),
]
