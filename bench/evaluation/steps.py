"""Staging and triangulating, apart and timed: the dissertation's two steps (§5.3.1, §5.3.2)."""
import contextlib
import dataclasses
import json
import os
import pathlib

import memory_group
import point_sets
import server

TICK = os.sysconf("SC_CLK_TCK")
MEGABYTE = 1 << 20


@dataclasses.dataclass
class Steps:
    """The two steps for the same points, with computational caches of so many megabytes, in turns.

    `memory`: None, or the megabytes of a control group that the server is confined to.
    """
    points: object
    caches: tuple
    runs: int = 1
    memory: int = None

    def measure(self, suite):
        point_sets.require_disk(self.points)
        count = self.points.create_table()
        suite.say(f"{count:,} points in {self.points.dimension}D, {self.points.name}"
                  + (f", {self.memory} MB of memory" if self.memory else ""))
        measurements = [{"what": step, **point_sets.labels(self.points), "cache": cache,
                         "memory": self.memory, "samples": []}
                        for cache in self.caches for step in ("stage", "triangulate")]
        with confined(self.memory) as group:
            for _ in range(self.runs):
                for steps in zip(measurements[::2], measurements[1::2]):
                    self.run(suite, *steps, group)
        suite.measurements += measurements
        server.drop("mesh", "mesh_vertices", "points")

    def run(self, suite, stage, triangulate, group):
        points = self.points
        server.drop("mesh", "mesh_vertices")
        server.query(f"SELECT abacus_create('mesh', {points.dimension})")
        for step, sql in ((stage, f"SELECT abacus_stage('mesh', 'SELECT id, {points.columns} FROM points')"),
                          (triangulate, "SELECT abacus_triangulate('mesh')")):
            server.settle()
            sample = timed(sql, step["cache"], group)
            sample["counted"] = int(sample.pop("printed"))
            step["samples"].append(sample)
            step["disk"] = disk()
            suite.say(f"  {step['what']:12} {step['cache']:5} MB  {sample['wall']:9.3f} s"
                      f"   CPU {sample['cpu']:9.3f} s   {sample['memory'] / MEGABYTE:6.0f} MB")
        triangulate["stats"] = json.loads(server.query(
            "SELECT json_object_agg(name, value) FROM abacus_stats('mesh')"))


def timed(sql, cache, group=None):
    """A sample of a statement in a session of its own."""
    if group:
        group.start()
    with server.Session(abacus__cache_size=f"{cache}MB") as session:
        before = Usage.of(session.backend)
        sample = session.timed(sql)
        sample.update(Usage.of(session.backend).since(before))
    if group:
        sample.update(group.figures())
    return sample


def disk():
    """Bytes of the two tables and their indexes."""
    return json.loads(server.query(
        "SELECT json_build_object("
        "'simplices', pg_table_size('mesh'), 'simplex_index', pg_indexes_size('mesh'),"
        "'vertices', pg_table_size('mesh_vertices'), 'vertex_index', pg_indexes_size('mesh_vertices'))"))


@dataclasses.dataclass
class Usage:
    """What a process has taken so far."""
    user: float    # seconds, as the kernel's clock ticks
    system: float
    read: int      # bytes from the disk, not from the kernel's cache
    written: int

    @classmethod
    def of(cls, process):
        fields = pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
        try:
            lines = pathlib.Path(f"/proc/{process}/io").read_text().splitlines()
            counts = {name: int(value) for name, value in (line.split(": ") for line in lines)}
        except PermissionError:
            counts = {"read_bytes": 0, "write_bytes": 0}
        return cls(int(fields[11]) / TICK, int(fields[12]) / TICK, counts["read_bytes"],
                   counts["write_bytes"])

    def since(self, before):
        return {field.name: round(getattr(self, field.name) - getattr(before, field.name), 2)
                for field in dataclasses.fields(self)}


class Confinement:
    """The server in a control group."""

    def __init__(self, group):
        self.group = group

    def start(self):
        memory_group.drop_page_cache()
        self.group.forget_peak()

    def figures(self):
        return {"group": self.group.figures()}


class DroppedCache:
    """If no group can be made: drops the kernel's cache before each step, and reports how large it is
    at the end."""

    def start(self):
        self.dropped = memory_group.drop_page_cache()
        self.before = memory_group.page_cache()

    def figures(self):
        return {"dropped": self.dropped, "page_cache": memory_group.page_cache() - self.before}


@contextlib.contextmanager
def confined(megabytes):
    """The server with so little memory, of which its shared buffers take a quarter."""
    if megabytes is None:
        yield None
        return
    # ANALYZE, which autovacuum may start, holds 300 rows for each unit of the target; here each is
    # a page.
    server.restart(shared_buffers=f"{megabytes // 4}MB", maintenance_work_mem=f"{megabytes // 8}MB",
                   default_statistics_target=1)
    try:
        with contextlib.ExitStack() as stack:
            try:
                group = stack.enter_context(memory_group.MemoryGroup(megabytes * MEGABYTE))
                group.adopt(postmaster())
                confinement = Confinement(group)
            except OSError as error:
                print(f"  no control group ({error}): the page cache is dropped instead", flush=True)
                confinement = DroppedCache()
            yield confinement
    finally:
        server.restart()


def postmaster():
    folder = server.query("SHOW data_directory")
    return int(pathlib.Path(folder, "postmaster.pid").read_text().split()[0])
