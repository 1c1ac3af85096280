"""Is the reference what the SQL says? Signatures, one-line descriptions, and what every COMMENT must tell."""
import pathlib
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts"), str(pathlib.Path(__file__).parent)]
import links_test  # noqa: E402
import reference  # noqa: E402


class Reference(unittest.TestCase):
    def test_signatures_and_descriptions_are_those_of_the_sql(self):
        run = subprocess.run([ROOT / "scripts/reference.py", "--check"], stdout=subprocess.PIPE, text=True, check=False)
        self.assertEqual((run.returncode, run.stdout), (0, ""))

    def test_comments_give_shapes_units_and_errors(self):
        wrong = []
        for function in reference.functions():
            if function.same():
                continue
            types = {argument.name: argument.type for argument in function.arguments}
            arrays = [name for name, kind in types.items() if kind.endswith("[]") or name in ("query", "vertices")]
            plain = [name for name, kind in types.items() if kind == "float8"]
            if arrays and ". Shapes: " not in function.comment:
                wrong.append(f"{function.name}: no shapes of {', '.join(arrays)}")
            if plain and ". Units: " not in function.comment:
                wrong.append(f"{function.name}: no units of {', '.join(plain)}")
            if ". Errors: " not in function.comment:
                wrong.append(f"{function.name}: no errors")
        self.assertEqual(wrong, [])

    def test_descriptions_are_one_line(self):
        self.assertEqual([function.name for function in reference.functions() if len(function.description()) > 200], [])

    def test_every_function_is_two_clicks_from_the_readme(self):
        pages = {ROOT / "README.md"}
        for _ in range(2):
            pages |= {(page.parent / target.partition("#")[0]).resolve() for page in pages if page.suffix == ".md"
                      for target in links_test.targets(page.read_text()) if target.partition("#")[0]}
        homes = reference.homes([page for pattern in reference.PAGES for page in ROOT.glob(pattern)])
        self.assertGreater(len(homes), 80)
        self.assertEqual({page.name for page, _ in homes.values() if page not in pages}, set())

    def test_the_manual_page_is_found(self):
        known = reference.functions()
        self.assertIn(("abacus", "abacus_locate"), {(function.extension, function.name) for function in known})
        (function,) = [function for function in known if function.name == "abacus_walk"]
        self.assertEqual(function.signature(), ["abacus_walk(mesh regclass, simplex abacus_simplex, facet integer) → abacus_simplex"])


if __name__ == "__main__":
    unittest.main()
