"""Engines that hold everything in memory (§5.3.3), up to what there is of it."""
import dataclasses
import json
import subprocess

import machine
import memory_group
import paths
import point_sets
import steps

MEGABYTE = 1 << 20


def program(engine):
    return paths.PROGRAMS / f"bench_{engine}"


@dataclasses.dataclass
class InCore:
    """Engines over the same points, each up to where it would take more memory than there is."""
    engines: tuple
    sets: list

    def measure(self, suite):
        for engine in self.engines:
            suite.measurements += self.grow(suite, engine)

    def grow(self, suite, engine):
        measurements = []
        for points in self.sets:
            if measurements:
                last = measurements[-1]
                wanted = last["samples"][0]["memory"] / last["points"] * points.size
                if wanted > 0.9 * available_memory():
                    suite.say(f"{engine}: {points.size:,} points want {wanted / 2**30:.1f} GB of memory")
                    break
            with points.in_file():
                done = subprocess.run([program(engine), str(points.dimension), points.file],
                                      stdout=subprocess.PIPE, text=True)
            if done.returncode != 0:
                suite.say(f"{engine}: {points.size:,} points end it ({done.returncode})")
                break
            sample = json.loads(done.stdout)
            suite.say(f"{engine:8} {points.size:12,} points {sample['wall']:9.3f} s"
                      f"   {sample['memory'] / MEGABYTE:7.0f} MB")
            measurements.append({"what": "incore", "engine": engine, **point_sets.labels(points),
                                 "samples": [sample]})
        return measurements


def available_memory():
    return int(machine.field("/proc/meminfo", "MemAvailable").split()[0]) << 10


@dataclasses.dataclass
class Wall:
    """An engine in core, and Abacus, with less memory than the former takes."""
    engine: str
    points: object
    cache: int
    memory: int  # megabytes

    def measure(self, suite):
        try:
            with memory_group.MemoryGroup(self.memory * MEGABYTE) as group, self.points.in_file():
                done = subprocess.run(group.command(program(self.engine), self.points.dimension,
                                                    self.points.file), stdout=subprocess.PIPE, text=True)
                sample = json.loads(done.stdout) if done.returncode == 0 else {}
                sample.update(returned=done.returncode, group=group.figures())
        except OSError as error:
            suite.say(f"no control group ({error}): left out")
            return
        suite.say(f"{self.engine} within {self.memory} MB: " +
                  (f"{sample['wall']:.3f} s" if "wall" in sample else f"ended by {done.returncode}"))
        suite.measurements.append({"what": "wall", "engine": self.engine, "memory": self.memory,
                                   "cache": self.cache, **point_sets.labels(self.points),
                                   "samples": [sample]})
        steps.Steps(self.points, (self.cache,), memory=self.memory).measure(suite)
