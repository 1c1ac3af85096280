#!/usr/bin/python3
"""The evaluation: figures beside the dissertation's, what traces and profiles are kept as, and that
docs/evaluation.md is what its results say."""
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "bench/suite"), str(ROOT / "bench/evaluation")]

import core_programs
import dissertation
import hot_functions
import results
from beside import Beside, clock, count, size
from evaluation_report import EvaluationReport

DOCUMENT = ROOT / "docs/evaluation.md"


def of(*measurements):
    machine = {"cpu": "one", "cores": 1, "memory_bytes": 1 << 30, "kernel": "6", "compiler": "c++",
               "flags": "-O3", "packages": {}, "commit": "0", "date": "today", "load": 0.0}
    return results.Results({"2d-1m": {"part": "2d-1m", "mode": "full", "seconds": 60, "machine": machine,
                                      "measurements": list(measurements)}})


def step(what, points, seconds, memory=None):
    return {"what": what, "dimension": 2, "set": "uniform", "points": points, "cache": 8, "memory": memory,
            "samples": [{"wall": seconds, "cpu": seconds / 2, "user": seconds / 2, "system": 0.0,
                         "read": 0, "written": 0, "memory": 1 << 20, "wal": 0}],
            "disk": {"simplices": 3000, "simplex_index": 400, "vertices": 50, "vertex_index": 6},
            "stats": {"simplices": 2 * points, "bytes_per_simplex": 12, "deleted": 4 * points,
                      "created": 6 * points, "insertions": points, "steps": 1000, "misses": 10,
                      "incircle_hits": 9, "incircle_tests": 10, "link_probes": 10, "loads": 1, "stores": 4,
                      "translation_ns": 1, "total_ns": 4}}


def engine(points, bytes_of_memory):
    return {"what": "incore", "engine": "cgal", "dimension": 2, "set": "uniform", "points": points,
            "samples": [{"wall": 1.0, "cpu": 1.0, "memory": bytes_of_memory, "simplices": 2 * points}]}


def row(markdown, *first):
    """The cells of the row that begins so."""
    for line in markdown.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if cells[:len(first)] == list(first):
            return cells[len(first):]
    raise LookupError(f"no row {first} in\n{markdown}")


class Tables(unittest.TestCase):
    def test_each_row_of_the_dissertation_has_a_value_for_each_data_set(self):
        for name, figure in dissertation.FIGURE.items():
            for label, values in figure.items():
                for found in values.values() if isinstance(values, dict) else [values]:
                    self.assertEqual(len(found), 6, f"{name}: {label}")

    def test_columns_are_theirs_and_ours(self):
        beside = Beside({"vertices": ["1 M", "10 M"]}, [10**6, 10**7],
                        [{"key": 10**7 + 1, "seconds": 5}, {"key": 20000, "seconds": 1}], count)
        beside.add("seconds", "vertices", lambda entry: entry["seconds"])
        beside.add("ours", None, lambda entry: None)
        text = beside.markdown()
        self.assertEqual(row(text, "", ""), ["20,000", "1 M", "10 M"])
        self.assertEqual(row(text, "seconds", "there"), ["–", "1 M", "10 M"])
        self.assertEqual(row(text, "", "here"), ["1", "–", "5"])
        self.assertEqual(row(text, "ours", "here"), ["–", "–", "–"])

    def test_figures_are_written_as_there(self):
        self.assertEqual([clock(3.64), clock(59.96), clock(155.2), clock(26232)],
                         ["0:03.6", "1:00", "2:35", "7:17:12"])
        self.assertEqual([count(20000), count(10118432), count(1.1e9)], ["20,000", "10.12 M", "1.1 B"])
        self.assertEqual([size(999), size(65000), size(24 * 10**6), size(24 * 10**9)],
                         ["999 B", "65.0 KB", "24.0 MB", "24.0 GB"])

    def test_memory_beyond_the_largest_measured_is_marked(self):
        report = EvaluationReport(of(step("stage", 10**6, 1), step("triangulate", 10**6, 3),
                                     engine(10**6, 150 * 10**6)), pathlib.Path("nowhere"))
        text = report.generators["figure-5-9"]()
        self.assertEqual(row(text, "… memory", "here")[:3], ["150 MB", "(1.50 GB)", "(6.00 GB)"])
        self.assertEqual(row(text, "Abacus: both", "there")[0], "0:00:19")
        self.assertIn("| 0:04.0 |", text)

    def test_slowdown_is_of_the_same_points(self):
        report = EvaluationReport(of(
            step("stage", 10**6, 1), step("triangulate", 10**6, 3),
            step("stage", 10**6, 2, memory=64), step("triangulate", 10**6, 4, memory=64),
            step("stage", 10**7, 2, memory=64), step("triangulate", 10**7, 4, memory=64)),
            pathlib.Path("nowhere"))
        text = report.generators["figure-5-13"]()
        lines = text.splitlines()
        below = lines[next(n for n, line in enumerate(lines) if line.startswith("| ÷ with all")) + 1]
        self.assertEqual([cell.strip() for cell in below.split("|")[3:5]], ["1.50", "–"])


class Programs(unittest.TestCase):
    def test_a_trace_is_kept_as_the_cells_with_requests(self):
        requests = [core_programs.Request(*line.split()) for line in
                    ("0.0 simplices read 0 0.0", "1.0 simplices read 99 0.5", "1.0 simplices read 98 0.99")]
        text = core_programs.cells(requests, 1.0, lambda request: request.block / 100)
        width, height = 1 / core_programs.COLUMNS, 1 / core_programs.ROWS
        found = sorted(core_programs.places(text))
        self.assertEqual(len(found), 3)
        for (x, y), (seconds, block) in zip(found, [(0, 0), (1, 0.98), (1, 0.99)]):
            self.assertLessEqual(abs(x - seconds), width)
            self.assertLessEqual(abs(y - block), height)
        self.assertEqual(core_programs.within(requests), {"1": 0.5, "100": 1.0})

    def test_functions_lose_their_arguments(self):
        self.assertEqual(hot_functions.bare("abacus::Insertion<2>::insert(abacus::Point<2> const&, long)"),
                         "Insertion<2>::insert")
        self.assertEqual(hot_functions.bare("abacus::(anonymous namespace)::sweep(int)"), "sweep")
        self.assertEqual(hot_functions.bare("XLogInsert"), "XLogInsert")
        self.assertEqual(hot_functions.bare("[unknown]"), "unknown")


class Page(unittest.TestCase):
    def test_it_is_what_its_results_say(self):
        text = DOCUMENT.read_text()
        with tempfile.TemporaryDirectory() as folder:
            pictures = pathlib.Path(folder) / "evaluation"
            found = results.Results.read(DOCUMENT.with_suffix("") / "results.json")
            self.assertEqual(EvaluationReport(found, pictures).fill(text), text)
            for picture in pictures.iterdir():
                self.assertEqual(picture.read_bytes(),
                                 (DOCUMENT.with_suffix("") / picture.name).read_bytes(), picture.name)


if __name__ == "__main__":
    unittest.main()
