"""Parts that compare builds: the same points, engine after engine, round after round."""
import contextlib
import dataclasses

import engines
import server
from points import PointSet

SLOW = 60  # seconds: an engine that takes longer runs three times, or once
EXACT = ("cgal", "cgal_parallel", "abacus")


@dataclasses.dataclass
class Contest:
    """Engines that make the triangulation of the same points, in turns."""
    dimension: int
    set: str
    sizes: dict  # by mode; a mode without a size leaves the contest out
    engines: tuple
    runs: dict = dataclasses.field(default_factory=lambda: {"full": 5, "quick": 3, "smoke": 1})
    disk: int = 0  # bytes that must be free, if there are very many points
    what: str = "build"  # another word keeps it out of the tables of builds

    def measure(self, suite):
        if suite.mode not in self.sizes:
            return
        server.require_disk(self.disk)
        points = PointSet(self.dimension, self.set, self.sizes[suite.mode])
        contestants = [contestant for name in self.engines
                       if (contestant := engines.engine(name, suite.say)) is not None]
        in_core = any(isinstance(contestant, engines.Program) for contestant in contestants)
        with points.in_file() if in_core else contextlib.nullcontext():
            count = points.create_table()
            suite.say(f"{count:,} points in {self.dimension}D, {self.set}")
            measurements = [{"what": self.what, **contestant.labels, "dimension": self.dimension,
                             "set": self.set, "points": count, "samples": []}
                            for contestant in contestants]
            for run in range(self.runs[suite.mode]):
                for contestant, measurement in zip(contestants, measurements):
                    if run < runs_at_most(measurement["samples"]):
                        self.take_sample(suite, contestant, points, measurement)
        compare_counts(measurements)
        suite.measurements += measurements
        server.drop("mesh", "mesh_vertices", "points")

    def take_sample(self, suite, contestant, points, measurement):
        sample = contestant.sample(points)
        measurement["samples"].append(sample)
        measurement.update(contestant.details())
        suite.say(f"  {' '.join(contestant.labels.values()):18} {sample['wall']:9.3f} s"
                  f"   CPU {sample['cpu']:9.3f} s   {sample['memory'] / 2**20:7.0f} MB")


def runs_at_most(samples):
    longest = max((sample["wall"] for sample in samples), default=0)
    return 1 if longest > 3 * SLOW else 3 if longest > SLOW else 5


def compare_counts(measurements):
    """Exact engines must have made the same number of simplices."""
    counts = {sample["simplices"] for measurement in measurements
              if measurement["engine"] in EXACT for sample in measurement["samples"]}
    if len(counts) > 1:
        raise server.Failure(f"numbers of simplices differ: {counts}")
