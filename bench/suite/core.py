"""A part that runs the micro-benchmarks of the core (bench/*_benchmark.cpp), as Google Benchmark does."""
import json
import subprocess

import paths

STEPS = "^(Orientation|InSphere|Code|Decode|Load|Store|Evict|Split|Insert)"
WHOLE = "^(Stage|Build|Locate|Remove|CgalRemove)"
UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}


def core(suite):
    """Steps take nanoseconds to milliseconds and run often; whole runs take seconds."""
    if suite.mode == "full":
        run(suite, STEPS, 5, 0.1)
        run(suite, WHOLE, 1, 0.1)
    else:
        run(suite, STEPS, {"quick": 3, "smoke": 1}[suite.mode], {"quick": 0.05, "smoke": 0.001}[suite.mode])


def run(suite, filter, repetitions, seconds):
    done = subprocess.run(
        [paths.PROGRAMS / "abacus_benchmarks", f"--benchmark_filter={filter}", "--benchmark_format=json",
         f"--benchmark_repetitions={repetitions}", f"--benchmark_min_time={seconds}"],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
    measurements = {}
    for run in json.loads(done.stdout)["benchmarks"]:
        if run["run_type"] != "iteration":
            continue
        measurement = measurements.setdefault(run["run_name"].removesuffix("/manual_time"), {
            "what": "core", "benchmark": run["run_name"].removesuffix("/manual_time"), "samples": []})
        measurement["samples"].append(sample_of(run))
    for name, measurement in measurements.items():
        suite.say(f"  {name:32} {1e6 * measurement['samples'][0]['wall']:12.4f} us an item")
    suite.measurements += measurements.values()


def sample_of(run):
    """Seconds of an item: what the benchmark works on, a point or a page; or of a call, if it has none."""
    items = run.get("items_per_second")
    if run["name"].endswith("/manual_time"):  # a part of the work was timed, with a clock on the wall
        return {"wall": 1 / items}
    unit = UNITS[run["time_unit"]]
    cpu = 1 / items if items else unit * run["cpu_time"]
    return {"wall": cpu * run["real_time"] / run["cpu_time"], "cpu": cpu}
