"""Is every suite of scripts/test.sh in the table of sizes, and does each size have what it should?"""
import pathlib
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = [line.split() for line in (ROOT / "test/sizes").read_text().splitlines()
         if line and not line.startswith("#")]
SIZES = ["quick", "usual", "everything"]
# Kinds of tests, and the suite that runs each: a new kind must get a suite.
KINDS = {"test/unit": "unit", "test/pgtap": "pgtap", "test/tap": "tap", "test/isolation": "isolation",
         "test/oracle": "oracles", "test/viewer": "viewer", "test/fuzz": "fuzz", "test/suite": "reports",
         "test/layout": "layout", "test/support": "unit"}


def listed(*size, seed=0):
    rows = subprocess.run([ROOT / "scripts/test.sh", "list", *size], env={"PATH": "/usr/bin:/bin", "ABACUS_SEED": str(seed)},
                          stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()
    return [row.split()[0] for row in rows]


class Sizes(unittest.TestCase):
    def test_every_suite_has_a_row(self):
        self.assertEqual(sorted(row[0] for row in TABLE), sorted(listed()))

    def test_every_row_is_understood(self):
        for name, size, *turns in TABLE:
            self.assertIn(size, SIZES, name)
            for turn in turns:
                self.assertRegex(turn, r"^(one:\w+|with:[\w-]+|1/[2-9]|kills:[1-9]\d*)$", name)

    def test_sizes_grow(self):
        quick, usual, everything = (set(listed(size)) for size in SIZES)
        self.assertLess(quick, usual)
        self.assertLess(usual, everything)
        self.assertEqual(everything, set(listed()))

    def test_everything_has_its_turn(self):
        usual = {name for name, size, *_ in TABLE if size != "everything"}
        self.assertEqual(set().union(*(listed("usual", seed=seed) for seed in range(5))), usual)

    def test_every_part_has_its_turn(self):
        turns = subprocess.run(["bash", "-c", """. scripts/common.sh; . scripts/sizes.sh
            for seed in {100..180}; do
                for name in $(suites_of usual "$seed"); do echo "$name $(share_of "$name" "$seed")"; done
            done"""], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()
        known = {(name, f"{part}/{turn[2:]}") for name, _, *turns in TABLE for turn in turns if turn.startswith("1/")
                 for part in range(int(turn[2:]))}
        self.assertEqual({tuple(row.split()) for row in turns if "/" in row}, known)

    def test_seeds_that_are_none(self):
        for seed in ["abc", "-1", "08", "1.5"]:
            ran = subprocess.run([ROOT / "scripts/test.sh", "list", "usual"], env={"PATH": "/usr/bin:/bin", "ABACUS_SEED": seed},
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.assertEqual((ran.returncode, ran.stdout), (1, ""), seed)
            self.assertIn("whole number", ran.stderr)

    def test_kinds_of_tests_have_suites(self):
        folders = {path.relative_to(ROOT).as_posix() for path in (ROOT / "test").iterdir()
                   if path.is_dir() and path.name != "__pycache__"}
        self.assertEqual(folders, set(KINDS))
        self.assertLessEqual(set(KINDS.values()), set(listed()))


if __name__ == "__main__":
    unittest.main()
