"""bench.sh starts this, with a server in the environment unless it only reports:

python3 bench/suite full|quick|smoke [PART...], or report, or list
"""
import sys
import time

import machine
import paths
import server
from parts import PARTS
from report import Report
from results import Results, write_part


class Suite:
    """One run of some parts: its mode, and what the part at work has measured."""

    def __init__(self, mode):
        self.mode = mode
        self.folder = paths.RESULTS if mode == "full" else paths.RESULTS / mode
        self.measurements = []

    def say(self, text):
        print(text, flush=True)

    def run(self, part):
        self.say(f"\n== {part.name}: {part.what}")
        self.measurements = []
        start = time.monotonic()
        about = machine.describe()
        about["settings"] = server.settings()
        try:
            part.measure(self)
        except server.NoDisk as problem:
            self.say(f"left out: {problem}")
            return
        if self.measurements:
            write_part(self.folder, {
                "part": part.name, "mode": self.mode, "seconds": round(time.monotonic() - start),
                "machine": about, "measurements": self.measurements})
        else:
            self.say("nothing in this mode")


def chosen_parts(names):
    by_name = {part.name: part for part in PARTS}
    unknown = set(names) - set(by_name)
    if unknown:
        sys.exit(f"no part {', '.join(sorted(unknown))}; there are {', '.join(by_name)}")
    return [by_name[name] for name in names] or PARTS


def write_report(mode):
    """Of the full mode into docs/, together with what is there; of others beside their results."""
    text = paths.DOCUMENT.read_text()
    if mode == "full":
        results = Results.read(paths.COMMITTED).merge_files(paths.RESULTS)
        results.write(paths.COMMITTED)
        document = paths.DOCUMENT
    else:
        results = Results().merge_files(paths.RESULTS / mode)
        document = paths.RESULTS / mode / "benchmarks.md"
    document.write_text(Report(results, document.with_suffix("")).fill(text))
    print(f"\n{document.relative_to(paths.ROOT)} has been written")


def main():
    mode, *names = sys.argv[1:]
    if mode == "list":
        for part in PARTS:
            print(f"{part.name:14} {part.minutes:4g} min   {part.what}")
    elif mode == "report":
        write_report("full")
    else:
        suite = Suite(mode)
        for part in chosen_parts(names):
            suite.run(part)
        write_report(mode)


if __name__ == "__main__":
    main()
