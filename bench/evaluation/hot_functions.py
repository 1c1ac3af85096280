"""Where the CPU time goes, by function (Figure 5.21): perf looks at the backend while it works."""
import collections
import dataclasses
import os
import re
import shutil
import subprocess

import paths
import point_sets
import server

SAMPLES_A_SECOND = 199
MOST = 10


@dataclasses.dataclass
class HotFunctions:
    points: object
    cache: int

    def measure(self, suite):
        if shutil.which("perf") is None:
            suite.say("perf (linux-perf) is not installed: left out")
            return
        point_sets.require_disk(self.points)
        self.points.create_table()
        server.query(f"SELECT abacus_create('mesh', {self.points.dimension})")
        server.query(f"SELECT abacus_stage('mesh', 'SELECT id, {self.points.columns} FROM points')")
        server.settle()
        paths.DATA.mkdir(parents=True, exist_ok=True)
        record = paths.DATA / "perf.data"
        with server.Session(abacus__cache_size=f"{self.cache}MB") as session:
            recording = Recording(record, session.backend)
            session.run("SELECT abacus_triangulate('mesh')")
        complaint = recording.end()
        if not record.exists():
            suite.say(f"perf has failed: {complaint}")
            return
        functions, modules = shares(record)
        record.unlink()
        for name, share in functions[:MOST]:
            suite.say(f"  {100 * share:5.1f} %  {name}")
        suite.measurements.append({
            "what": "functions", **point_sets.labels(self.points), "cache": self.cache,
            "functions": functions[:MOST], "modules": modules})
        server.drop("mesh", "mesh_vertices", "points")


class Recording:
    """perf, which looks at a process from when this has been made to the end of the process: perf
    says itself when it has begun, for on a busy machine that takes longer than a short build."""

    def __init__(self, record, process):
        told, self.command = os.pipe()  # open until perf ends: it fails if they are closed before
        self.answer, says = os.pipe()
        self.perf = subprocess.Popen(
            ["perf", "record", "-q", "-e", "cpu-clock", "-F", str(SAMPLES_A_SECOND), "-o", record, "--delay=-1",
             f"--control=fd:{told},{says}", "-p", str(process)],
            stderr=subprocess.PIPE, text=True, pass_fds=(told, says))
        os.close(told)
        os.close(says)
        try:
            os.write(self.command, b"enable\n")
            os.read(self.answer, 16)  # empty if perf has ended
        except BrokenPipeError:
            pass  # end() reports why

    def end(self):
        """What perf complained of."""
        complaint = self.perf.communicate()[1].strip()
        os.close(self.command)
        os.close(self.answer)
        return complaint


def shares(record):
    """Of the samples: by function, and by what it is part of; the greatest first."""
    functions, modules = collections.Counter(), collections.Counter()
    script = subprocess.run(["perf", "script", "-i", record, "-F", "ip,sym,dso"],
                            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=True)
    for line in script.stdout.splitlines():
        match = re.match(r"\s*[0-9a-f]+ (.*) \((.*)\)$", line)
        if match is None:
            continue
        module = match[2].rpartition("/")[2]
        kernel = match[2].startswith("[")
        modules["kernel" if kernel else module] += 1
        functions["the kernel, as a whole" if kernel else bare(match[1])] += 1
    total = sum(modules.values())
    return tuple([(name, round(count / total, 4)) for name, count in counter.most_common()]
                 for counter in (functions, modules))


def bare(symbol):
    """A function without its arguments and namespace."""
    name = re.sub(r"\(.*", "", symbol.replace("(anonymous namespace)::", ""))
    return name.removeprefix("abacus::") if not name.startswith("[") else "unknown"
