#!/usr/bin/python3
"""Reports of the benchmark suite: figures, ratios, verdicts, pictures, and that docs/benchmarks.md is what its
template and its results say."""
import json
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench/suite"))

import acceptance
import document
import heads
import plots
import ratios
import region_tables
import results
import tables
from report import Report

TEMPLATE = ROOT / "bench/suite/page.md.in"


def build(engine, points, *seconds, **labels):
    return {"what": "build", "engine": engine, "dimension": 2, "set": "uniform", "points": points} | labels | {
        "samples": [{"wall": wall, "cpu": wall, "memory": 1 << 20, "simplices": 2 * points}
                    for wall in seconds]}


def part(name, *measurements, **machine):
    machine = {"cpu": "one", "cores": 1, "memory_bytes": 1 << 30, "kernel": "6", "compiler": "c++", "abacus": "1.0",
               "flags": "-O3", "packages": {}, "commit": "0", "date": "today", "load": 0.0} | machine
    return {"part": name, "mode": "full", "seconds": 60, "machine": machine, "measurements": list(measurements)}


def of(*measurements):
    return results.Results({"part": part("part", *measurements)})


def page(found):
    with tempfile.TemporaryDirectory() as name:
        return Report(found, pathlib.Path(name) / "benchmarks").fill(TEMPLATE.read_text())


def verdict(number, found):
    wanted = acceptance.WANTED[number]
    return wanted.verdict(wanted.measured(found))


class Verdicts(unittest.TestCase):
    def test_a_ratio_of_medians_is_held_or_missed(self):
        cgal = build("cgal", 10**6, 9, 1.0, 0.1)
        self.assertEqual(verdict(0, of(cgal, build("abacus", 10**6, 1.0, cache="default"))), "held")
        self.assertEqual(verdict(0, of(cgal, build("abacus", 10**6, 0.5, 1.1, 7, cache="default"))), "**missed**")

    def test_the_ratio_of_cpu_times_is_told_beside_it(self):
        cgal, abacus = build("cgal", 10**6, 1.0), build("abacus", 10**6, 2.0, cache="default")
        abacus["samples"][0]["cpu"] = 0.5
        self.assertEqual(acceptance.WANTED[0].by_cpu(of(cgal, abacus)), 0.5)
        self.assertEqual(verdict(0, of(cgal, abacus)), "**missed**")

    def test_what_was_not_measured_is_not_held(self):
        self.assertEqual(verdict(0, of()), "not measured")
        self.assertEqual(verdict(0, of(build("cgal", 10**6, 1))), "not measured")
        # A different cache, and a different number of points
        self.assertEqual(verdict(0, of(build("cgal", 10**6, 1), build("abacus", 10**6, 1, cache="8"))),
                         "not measured")
        self.assertEqual(verdict(0, of(build("cgal", 10**5, 1), build("abacus", 10**5, 1, cache="default"))),
                         "not measured")

    def test_a_rate_must_be_reached(self):
        def found(seconds):
            return of({"what": "locate", "engine": "abacus", "dimension": 2, "points": 10**7, "order": "ordered",
                       "cache": "largest", "form": "a_call_each", "places": 10**6, "samples": [{"wall": seconds}]})
        number = next(i for i, wanted in enumerate(acceptance.WANTED) if wanted.limit == 700000)
        self.assertEqual(verdict(number, found(1.0)), "held")
        self.assertEqual(verdict(number, found(2.0)), "**missed**")

    def test_goose_is_extrapolated_by_the_growth_of_both(self):
        def run(engine, points, seconds):
            return {"what": "goose", "engine": engine, "dimension": 2, "points": points,
                    "samples": [{"cpu": seconds}]}
        found = of(run("goose", 10**4, 1.0), run("abacus", 10**4, 1.0),
                   run("goose", 10**5, 20.0), run("abacus", 10**5, 10.0))
        number = next(i for i, wanted in enumerate(acceptance.WANTED) if wanted.what.startswith("Goose ÷ Abacus, 1 M"))
        self.assertAlmostEqual(acceptance.WANTED[number].measured(found), 4)
        self.assertEqual(verdict(number, found), "–")

    def test_rows_are_compared_in_the_largest_mesh_at_the_most_places(self):
        def run(engine, points, seconds, places=10**6, order="ordered"):
            return {"what": "rows", "engine": engine, "points": points, "places": places, "order": order,
                    "samples": [{"cpu": seconds}]}
        found = of(run("abacus", 10**6, 1.0), run("exact_rows", 10**6, 50.0), run("abacus", 10**7, 2.0),
                   run("exact_rows", 10**7, 40.0), run("exact_rows", 10**7, 99.0, order="places"),
                   run("abacus", 10**7, 1.0, 10**5), run("exact_rows", 10**7, 7.0, 10**5),
                   run("rows", 10**6, 10.0))
        number = next(i for i, wanted in enumerate(acceptance.WANTED) if "the exact test" in wanted.what)
        self.assertEqual(acceptance.WANTED[number].measured(found), 20)
        self.assertEqual(acceptance.WANTED[number + 1].measured(found), 10)
        self.assertEqual(verdict(number, found), "**missed**")

    def test_growth_is_that_of_a_point_beside_builds_before_and_after(self):
        large = build("abacus", 10**8, 120.0, cache="64")
        before, after = ({**build("abacus", 10**6, *seconds, cache="64"), "what": "beside"}
                         for seconds in ((0.5, 1.0), (1.5,)))
        number = next(i for i, wanted in enumerate(acceptance.WANTED) if wanted.measured is acceptance.growth)
        self.assertAlmostEqual(acceptance.WANTED[number].measured(of(large, before, after)), 1.2)
        self.assertEqual(verdict(number, of(large)), "not measured")

    def test_insertions_are_compared_with_a_build_of_the_same_points(self):
        def run(change, dimension, seconds):
            return {"what": "edit", "change": change, "dimension": dimension, "changed": 10**6,
                    "samples": [{"wall": seconds, "cpu": seconds}]}
        number = next(i for i, wanted in enumerate(acceptance.WANTED) if "into a mesh" in wanted.what)
        insert, build_ = run("insert many", 2, 1.2), run("build many", 2, 1.0)
        self.assertEqual(verdict(number, of(insert, build_)), "held")
        self.assertEqual(verdict(number, of(run("insert many", 2, 1.4), build_)), "**missed**")
        self.assertEqual(verdict(number, of(insert)), "not measured")
        self.assertEqual(verdict(number + 1, of(insert, build_)), "not measured")

    def test_what_is_within_a_region_is_compared_with_all(self):
        def asked(within, seconds, points=10**7):
            return {"what": "within", "question": "contours", "within": within, "points": points, "samples": [{"wall": seconds}]}
        number = next(i for i, wanted in enumerate(acceptance.WANTED) if wanted.what.startswith("`abacus_contours` within a region"))
        self.assertEqual(verdict(number, of(asked("all", 2.0), asked("region", 0.28))), "held")
        self.assertEqual(verdict(number, of(asked("all", 2.0), asked("region", 0.32))), "**missed**")
        self.assertEqual(verdict(number, of(asked("all", 2.0, 10**6), asked("region", 0.28, 10**6))), "not measured")
        self.assertEqual(verdict(number + 1, of(asked("all", 2.0), asked("polygon", 0.32))), "**missed**")

    def test_a_terrain_with_lines_is_compared_with_its_points(self):
        def built(way, seconds):
            return {"what": "terrain", "way": way, "points": 500000, "samples": [{"wall": seconds}]}
        number = next(i for i, wanted in enumerate(acceptance.WANTED) if wanted.what.startswith("Terrain"))
        found = of(built("points alone", 1.0), built("points and lines in one call", 1.9), built("points, then lines", 2.1))
        self.assertEqual(verdict(number, found), "held")
        self.assertEqual(verdict(number + 1, found), "**missed**")

    def test_the_largest_size_after_replacing_decides(self):
        def run(sizes, at_once):
            return {"what": "edit", "change": "space", "dimension": 3, "at_once": at_once, "samples": [sizes]}
        found = of(run({"fresh": 10, "moved": 14}, 1000), run({"fresh": 10, "moved": 16}, 25000))
        self.assertEqual(acceptance.WANTED[-1].measured(found), 1.6)
        self.assertEqual(verdict(-1, found), "**missed**")
        self.assertEqual(verdict(-1, of()), "not measured")

    def test_deletions_are_compared_by_the_point(self):
        core = {"what": "core", "benchmark": "CgalRemove<2>/1000000/1", "samples": [{"wall": 2e-6, "cpu": 1e-6}]}
        edit = {"what": "edit", "change": "delete many", "dimension": 2, "changed": 500000,
                "samples": [{"wall": 3.0, "cpu": 2.0}]}
        number = next(i for i, wanted in enumerate(acceptance.WANTED) if "deleted" in wanted.what)
        self.assertAlmostEqual(acceptance.WANTED[number].measured(of(core, edit)), 3)
        self.assertAlmostEqual(acceptance.WANTED[number].by_cpu(of(core, edit)), 4)
        self.assertEqual(verdict(number, of(edit)), "not measured")


    def test_aims_have_a_line_each_measured_or_not(self):
        text = acceptance.aims(of(build("cgal", 10**6, 1.0), build("abacus", 10**6, 2.0, cache="default")))
        self.assertEqual(len(text.splitlines()), 2 + len(acceptance.WANTED))
        self.assertIn("| ≤ 1.0 | 2.00 | 2.00 | **missed** |", text)
        self.assertIn("| ≤ 0.8 | – | – | not measured |", text)


def ask(engine, question, seconds, places=None):
    return {"what": "ask", "engine": engine, "question": question, "points": 10**6,
            "samples": [{"wall": seconds, "cpu": seconds}]} | ({"places": places} if places else {})


class Ratios(unittest.TestCase):
    def of(self, what, *measurements):
        """(peer, elapsed) of the rows of such work."""
        text, _ = ratios.ratios(of(*measurements))
        cells = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines()]
        return [(row[1], row[2]) for row in cells if what in row[0]]

    def test_only_what_was_measured_has_a_row(self):
        self.assertEqual(ratios.ratios(of()), ("", set()))
        text, engines = ratios.ratios(of(build("abacus", 10**6, 1.0, cache="default"), build("postgis", 10**6, 20.0)))
        self.assertEqual(len(text.splitlines()), 3)
        self.assertIn("| triangulation of 1 M uniform points | PostGIS, to a geometry | 1/20 | 1/20 |", text)
        self.assertEqual(engines, {"postgis"})

    def test_interpolation_is_compared_by_the_place(self):
        found = [ask("abacus", "interpolate", 1.0, 10**6), ask("abacus", "interpolate", 0.1, 20000),
                 ask("scipy", "interpolate", 0.08, 20000), ask("scipy", "build", 4.0)]
        self.assertEqual([elapsed for _, elapsed in self.of("interpolation", *found)], ["0.250", "1.25", "0.125"])
        self.assertEqual(self.of("interpolation", *found[:2]), [])
        self.assertEqual(len(self.of("interpolation", *found[:3])), 2)

    def test_threads_are_compared_with_as_many(self):
        def by(engine, threads, seconds, what="threads"):
            return build(engine, 10**6, seconds, what=what, dimension=3, threads=threads)
        found = [by("abacus", "1", 3.0), by("abacus", "2", 2.0), by("cgal_parallel", "1", 6.0), by("cgal_parallel", "2", 2.5)]
        self.assertEqual([elapsed for _, elapsed in self.of("thread", *found)], ["0.500", "0.800"])
        # The part 3d has builds by threads beside those by one, which stay what is compared with CGAL
        beside = [by("abacus", "2", 9.0, "build"), build("abacus", 10**6, 1.0, dimension=3, cache="default"),
                  build("cgal", 10**6, 2.0, dimension=3), by("cgal_parallel", "2", 3.0, "build")]
        self.assertEqual(self.of("of 1 M uniform points", *beside), [("CGAL, in memory", "0.500")])
        self.assertEqual([elapsed for _, elapsed in self.of("by 2 threads", *beside)], ["3.00"])

    def test_the_gpu_is_compared_with_most_threads(self):
        def on(engine, seconds, **more):
            return {"what": "gpu", "engine": engine, "set": "uniform", "points": 10**6, "places": 10**6,
                    "samples": [{"wall": seconds, "interpolate": seconds / 2, "missing": 455}]} | more
        found = [on("cupy", 0.05), on("abacus", 1.0, threads=1), on("abacus", 0.5, threads=16)]
        self.assertEqual([elapsed for _, elapsed in self.of("16 threads", *found)], ["10.0", "10.0"])
        text = tables.gpu(of(*found))
        self.assertIn("| 1 M points, uniform; 1 M places | CuPy | 0.0500 s | 1.00 | 455 | 0.0250 s | 1.00 | 1 |", text)
        self.assertIn("| Abacus, 16 threads | 0.500 s | 10.0 |", text)


class Heads(unittest.TestCase):
    PACKAGES = {"postgresql-15": "15.20-0+deb12u1", "libcgal-dev": "5.5.1-2", "postgresql-15-postgis-3": "3.3.2+dfsg-1+b1",
                "libgeos3.11.1": "3.11.1-1", "gdal-bin": "1:3.6.2+dfsg-1"}

    def test_it_says_versions_and_machine(self):
        about = part("part", packages=self.PACKAGES)["machine"]
        self.assertEqual(heads.head(about, {"abacus", "postgis", "postgis_kept"}),
                         "Abacus 1.0, PostgreSQL 15.20, PostGIS 3.3.2, GEOS 3.11.1; 1 core of one, 1.00 GB of memory:\n\n")
        self.assertEqual(heads.versions(about, {"cgal", "cgal_parallel", "gdal"}),
                         ["Abacus 1.0", "PostgreSQL 15.20", "CGAL 5.5.1", "GDAL 3.6.2"])

    def test_a_table_has_one_machine(self):
        def edit(dimension):
            return {"what": "edit", "change": "insert many", "dimension": dimension, "points": 9, "changed": 9,
                    "samples": [{"wall": 1.0, "wal": 9}]}
        found = results.Results({"edit-2d": part("edit-2d", edit(2)), "edit-3d": part("edit-3d", edit(3), cpu="another"),
                                 "edit": part("edit", edit(2), packages={"gdal-bin": "3"})})
        self.assertEqual([list(group.parts) for _, group in found.groups()], [["edit-2d", "edit"], ["edit-3d"]])
        text = page(found)
        self.assertEqual(text.count("| mesh | change |"), 2)
        self.assertIn("core of another, 1.00 GB of memory:\n\n| mesh | change |", text)

    def test_other_versions_are_another_group(self):
        found = results.Results({"a": part("a", packages={"gdal-bin": "3"}), "b": part("b", packages={"gdal-bin": "4"}),
                                 "c": part("c", abacus="2.0")})
        self.assertEqual(len(found.groups()), 3)


class Tables(unittest.TestCase):
    def test_threads_stand_beside_one(self):
        def read(threads, seconds):
            return {"what": "shared reading", "question": "check", "threads": threads, "dimension": 3, "points": 5000, "places": 0,
                    "samples": [{"wall": seconds, "cpu": 2.0}]}
        text = tables.threads(of(build("abacus", 10**6, 3.0, what="threads", threads="1"),
                                 build("abacus", 10**6, 2.0, what="threads", threads="2"), read("1", 1.0), read("2", 0.5)))
        self.assertIn("| 2D, 1 M points: `abacus_triangulate` | 2 | 2.00 s | 2.00 s | 1.50 | 1 |", text)
        self.assertIn("| 3D, 5,000 points: `abacus_check` | 1 | 1.00 s | 2.00 s | 1.00 | 1 |", text)
        self.assertIn("| 3D, 5,000 points: `abacus_check` | 2 | 0.500 s | 2.00 s | 2.00 | 1 |", text)

    def test_lines_are_compared_with_no_lines_and_with_cgal(self):
        def made(engine, has_lines, seconds):
            return {"what": "lines", "engine": engine, "lines": has_lines, "points": 10**6, "segments": 900000, "left_out": 28,
                    "samples": [{"wall": seconds, "cpu": seconds, "memory": 1 << 20}]}
        def insert(has_lines, seconds):
            return {"what": "line insert", "engine": "abacus", "lines": has_lines, "points": 10**6, "segments": 900000, "transactions": 20,
                    "samples": [{"wall": seconds}]}
        text = tables.lines(of(made("cgal", False, 1.0), made("cgal", True, 2.0), made("abacus", False, 0.5), made("abacus", True, 4.0),
                               insert(True, 0.003), insert(False, 0.002)))
        self.assertIn("| CGAL, in memory: 1 M points | 900,000 | 2.00 s | 2.00 s | 2.00 | 1.00 |", text)
        self.assertIn("| Abacus: 1 M points | 900,000 | 4.00 s | 4.00 s | 8.00 | 2.00 |", text)
        self.assertIn("| Abacus: 1 M points | – | 0.500 s | 0.500 s | – | 0.500 |", text)
        self.assertIn("| a point beside lines, median of 20 | 900,000 | 3.00 ms | – | 1.50 | – |", text)
        self.assertIn("| a point without lines, median of 20 | – | 2.00 ms | – | – | – |", text)

    def test_what_is_asked_within_a_region_stands_beside_all(self):
        def asked(within, seconds, **labels):
            return {"what": "within", "engine": "abacus", "question": "volume", "within": within, "points": 10**6} | labels | {
                "samples": [{"wall": seconds, "cpu": seconds / 2}]}
        step = {"what": "region step", "step": "region of a seed", "points": 10**6, "samples": [{"wall": 2.0, "cpu": 1.0, "memory": 1 << 20}]}
        text = region_tables.within(of(asked("all", 4.0), asked("region", 1.0), asked("polygon", 8.0, engine="postgis", question="area"), step))
        self.assertIn("| 1 M points: volume in all | Abacus | 4.00 s | 2.00 s | – | – | 1 |", text)
        self.assertIn("| 1 M points: volume in the region | Abacus | 1.00 s | 0.500 s | 0.250 | 0.250 | 1 |", text)
        self.assertIn("| 1 M points: area in the polygon | PostGIS, triangles under GiST | 8.00 s | 4.00 s | – | – | 1 |", text)
        self.assertIn("\n\n| step |", text)
        self.assertIn("| 1 M points: region of a seed | 2.00 s | 1.00 s | 1.00 MB | 1 |", text)

    def test_a_terrain_stands_beside_its_points_alone(self):
        def built(way, seconds, **steps):
            return {"what": "terrain", "way": way, "points": 9, "samples": [{"wall": seconds, "cpu": seconds, "memory": 1 << 20, **steps}]}
        def edit(inside, seconds):
            return {"what": "region edit", "edit": "line", "inside": inside, "points": 9, "transactions": 50, "percentile99": 0.1,
                    "samples": [{"wall": seconds}]}
        text = region_tables.terrain(of(built("points alone", 2.0, triangulate=1.5, contours=0.5), edit(True, 0.06), edit(False, 0.03),
                                        built("points, then lines", 5.0, triangulate=1.5, constrain=2.0, region=1.0, contours=0.5, each=7.0)))
        self.assertIn("| points alone | 1.50 | – | – | 0.500 | 2.00 | – | – | – | 1.00 MB | 1 |", text)
        self.assertIn("| points, then lines | 1.50 | 2.00 | 1.00 | 0.500 | 5.00 | 2.50 | 2.50 | 7.00 | 1.00 MB | 1 |", text)
        self.assertIn("| a line into a region, median of 50 | 60.0 ms | 100 ms | 2.00 |", text)
        self.assertIn("| a line where there are neither, median of 50 | 30.0 ms | 100 ms | – |", text)

    def test_files_have_a_rate(self):
        written = {"what": "ask", "question": "PLY of 8 triangles", "engine": "abacus", "points": 9, "written": True,
                   "samples": [{"wall": 2.0, "cpu": 1.0, "bytes": 10**7}]}
        self.assertIn("| 9 points: PLY of 8 triangles | Abacus | 2.00 s | 1.00 s | – | – | 5.00 | 1 |", tables.asking(of(written)))

    def test_places_have_a_rate(self):
        self.assertIn("| 1 M points: interpolate, 20,000 places | SciPy | 2.00 s | 2.00 s | 10,000 |",
                      tables.asking(of(ask("scipy", "interpolate", 2.0, 20000))))

    def test_without_rows_there_is_no_table(self):
        self.assertEqual(document.table(("a", "b"), []), "")
        for name in "asking", "threads", "surfaces", "gpu", "location", "lines":
            self.assertEqual(getattr(tables, name)(of()), "")
        for make in region_tables.within, region_tables.terrain:
            self.assertEqual(make(of()), "")


class Storage(unittest.TestCase):
    def test_json_comes_back(self):
        content = {"a": [{"b": 1, "c": "é"}, {"d": [1, 2], "e": {}}], "f": [], "g": None}
        text = results.dump(content)
        self.assertEqual(json.loads(text), content)
        self.assertIn('{"b": 1, "c": "é"}', text)  # one line for each sample

    def test_a_part_measured_again_takes_the_place_of_the_earlier(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            old = of(build("cgal", 10**6, 1))
            new = of(build("cgal", 10**6, 2)).parts["part"]
            results.write_part(folder, new)
            self.assertEqual(old.merge_files(folder).median("wall", engine="cgal"), 2)
            old.write(folder / "all" / "results.json")
            self.assertEqual(results.Results.read(folder / "all" / "results.json").parts, {"part": new})

    def test_two_measurements_of_the_same_are_not_mixed(self):
        with self.assertRaises(LookupError):
            of(build("cgal", 1, 1), build("cgal", 1, 2)).one(engine="cgal")


class Documents(unittest.TestCase):
    def test_regions_are_replaced_and_nothing_else(self):
        text = "a\n<!-- begin x -->\nold\n<!-- end x -->\nb\n"
        self.assertEqual(document.fill(text, {"x": lambda: "new\n"}),
                         "a\n<!-- begin x -->\nnew\n<!-- end x -->\nb\n")

    def test_a_region_without_generator_is_an_error(self):
        with self.assertRaises(LookupError):
            document.fill("<!-- begin x -->\n<!-- end x -->\n", {})
        with self.assertRaises(LookupError):
            document.fill("", {"x": str})

    def test_sections_without_a_measurement_are_left_out(self):
        template = ("<!-- about\nthe template -->\n# A\ntext\n\n## B\nof b\n\n<!-- begin b -->\n<!-- end b -->\n\n### C\nof c\n"
                    "<!-- begin c -->\n<!-- end c -->\n## D\nby hand\n")
        def made(b, c):
            return document.make(template, {"b": lambda: b, "c": lambda: c})
        self.assertEqual(made("", ""), "# A\ntext\n\n## D\nby hand\n")
        self.assertEqual(made("new\n", ""), "# A\ntext\n\n## B\nof b\n\nnew\n\n## D\nby hand\n")
        # A section stays for one below it
        self.assertEqual(made("", "new"), "# A\ntext\n\n## B\nof b\n\n### C\nof c\nnew\n## D\nby hand\n")

    def test_the_page_says_nothing_of_what_was_not_measured(self):
        text = page(of(build("abacus", 10**6, 1.0, cache="default"), build("cgal", 10**6, 2.0)))
        self.assertIn("| triangulation of 1 M uniform points | CGAL, in memory | 0.500 | 0.500 |", text)
        for word in "not measured", "missed", "wanted", "## Threads", "## Beside a GPU", "<!--", "\n\n\n":
            self.assertNotIn(word, text.replace("Not measured", "not measured"))

    def test_numbers(self):
        self.assertEqual([document.number(x) for x in (None, 0, 0.01234, 1.5, 99.96, 123.4, 1234567)],
                         ["–", "0", "0.0123", "1.50", "100", "123", "1,234,567"])
        self.assertEqual(document.spread((2.0, 1.0, 3.0)), "2.00 (1.00–3.00)")

    def test_pictures_are_the_same_every_time(self):
        with tempfile.TemporaryDirectory() as name:
            one, two = pathlib.Path(name) / "one.svg", pathlib.Path(name) / "two.svg"
            for path in one, two:
                plots.bars(path, "title", "seconds", [("a", 1, 0.5, 2), ("b \"quoted\"", 3, 3, 3)])
            self.assertEqual(one.read_bytes(), two.read_bytes())
            self.assertIn(b"<svg", one.read_bytes())

    def test_the_page_is_what_the_results_say(self):
        text = (ROOT / "docs/benchmarks.md").read_text()
        with tempfile.TemporaryDirectory() as name:
            pictures = pathlib.Path(name) / "benchmarks"
            found = results.Results.read(ROOT / "docs/benchmarks/results.json")
            self.assertEqual(Report(found, pictures).fill(TEMPLATE.read_text()), text,
                             "scripts/bench.sh report makes it anew, of bench/suite/page.md.in")
            for picture in pictures.glob("*.svg"):
                self.assertEqual(picture.read_bytes(), (ROOT / "docs/benchmarks" / picture.name).read_bytes(),
                                 f"{picture.name}: scripts/bench.sh report makes it anew")


if __name__ == "__main__":
    unittest.main()
