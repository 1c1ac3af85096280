"""Runs parts, keeps their results, and makes a document of them: what the benchmarks and the
evaluation have in common.

    full|quick|smoke [PART...], or report, or list; or alone MODE PART, for one that needs no server:
    prints its results
"""
import dataclasses
import pathlib
import shutil
import signal
import subprocess
import sys
import time
import typing

import machine
import paths
import server
from results import Results, dump, write_part


@dataclasses.dataclass
class Part:
    name: str
    what: str
    minutes: float  # of the full mode, about
    measure: typing.Callable  # of a Suite
    only_named: bool = False
    needs_server: bool = True


@dataclasses.dataclass
class Book:
    """A document, what is measured for it, and what makes its regions and pictures of that."""
    parts: list
    document: pathlib.Path  # pictures and results.json lie beside it, in a folder with its name
    report: typing.Callable  # of the results and the folder for the pictures
    results: pathlib.Path  # a JSON file a part; quick/ and smoke/ have their own
    template: pathlib.Path = None  # that the document is made of, if it is not filled in itself

    @property
    def committed(self):
        return self.document.with_suffix("") / "results.json"


class Suite:
    """One run of some parts: its mode, and what the part at work has measured."""

    def __init__(self, mode, folder):
        self.mode = mode
        self.folder = folder if mode == "full" else folder / mode
        self.measurements, self.about = [], {}

    def say(self, text):
        print(text, flush=True)

    def measured(self, part):
        """What the file of a part holds."""
        self.say(f"\n== {part.name}: {part.what}")
        self.measurements = []
        start = time.monotonic()
        self.about = machine.describe()
        if part.needs_server:
            self.about["settings"] = server.settings()
        part.measure(self)
        return {"part": part.name, "mode": self.mode, "seconds": round(time.monotonic() - start),
                "machine": self.about, "measurements": self.measurements}

    def run(self, part):
        """Measures a part; false if that failed, which leaves its earlier results as they were."""
        try:
            content = self.measured(part)
        except machine.LeftOut as problem:
            self.say(f"left out: {problem}")
            return True
        except (server.Failure, subprocess.CalledProcessError) as problem:
            self.say(f"FAILED: {problem}")
            return False
        if self.measurements:
            write_part(self.folder, content)
        else:
            self.say("nothing in this mode")
        return True


class Alone(Suite):
    """Of a part that needs no server: what it says does not mix with its results on standard output."""

    def say(self, text):
        print(text, file=sys.stderr, flush=True)

    def print(self, part):
        try:
            print(dump(self.measured(part)))
        except machine.LeftOut as problem:
            self.say(f"left out: {problem}")
            sys.exit(77)


def chosen_parts(parts, names):
    by_name = {part.name: part for part in parts}
    unknown = set(names) - set(by_name)
    if unknown:
        sys.exit(f"no part {', '.join(sorted(unknown))}; there are {', '.join(by_name)}")
    return [by_name[name] for name in names] or [part for part in parts if not part.only_named]


def write_report(book, mode):
    """Of the full mode into docs/, together with what is there; of others beside their results."""
    text = (book.template or book.document).read_text()
    if mode == "full":
        results = Results.read(book.committed).merge_files(book.results)
        results.write(book.committed)
        document = book.document
    else:
        results = Results().merge_files(book.results / mode)
        document = book.results / mode / book.document.name
    pictures = document.with_suffix("")
    for picture in pictures.glob("*.svg"):  # pictures of parts that are no longer measured
        picture.unlink()
    document.write_text(book.report(results, pictures).fill(text))
    print(f"\n{document.relative_to(paths.ROOT)} has been written")


def main(book):
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that files of points and groups are removed
    mode, *names = sys.argv[1:]
    if mode == "list":
        for part in book.parts:
            print(f"{part.name:14} {part.minutes:4g} min   {part.what}")
        unnamed = sum(part.minutes for part in book.parts if not part.only_named)
        print(f"{'all':14} {unnamed:4g} min")
    elif mode == "report":
        write_report(book, "full")
    elif mode == "alone":
        mode, name = names
        Alone(mode, book.results).print(*chosen_parts(book.parts, [name]))
    else:
        suite = Suite(mode, book.results)
        if mode != "full" and not names:
            shutil.rmtree(suite.folder, ignore_errors=True)
        failed = [part.name for part in chosen_parts(book.parts, names) if not suite.run(part)]
        write_report(book, mode)
        if failed:
            sys.exit(f"failed: {', '.join(failed)}")
