"""Can the documents be read? No page is long, and every job of the cookbook takes one short page."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Pages that are not for users, or that a program makes.
LONG = ("docs/notebook", "docs/design", "docs/benchmarks.md", "docs/evaluation.md")


def words(page):
    return len(page.read_text().split())


class Pages(unittest.TestCase):
    def test_pages_are_short(self):
        pages = [page for page in (ROOT / "docs").rglob("*.md") if not page.relative_to(ROOT).as_posix().startswith(LONG)]
        self.assertGreater(len(pages), 20)
        self.assertEqual([(page.name, words(page)) for page in pages if words(page) > 4000], [])

    def test_recipes_are_shorter(self):
        self.assertEqual([(page.name, words(page)) for page in (ROOT / "docs/cookbook").glob("*.md") if words(page) >= 1500], [])

    def test_the_guide_and_the_readme_are_short(self):
        self.assertLessEqual(words(ROOT / "docs/guide.md"), 3000)
        self.assertLessEqual(len((ROOT / "README.md").read_text().splitlines()), 220)

    def test_figures_of_the_readme_and_of_compared_are_those_of_the_benchmarks(self):
        """Seconds, bytes, counts and ratios. Others have their source beside them: a link, or the note on the GPU."""
        measured = set(re.findall(r"[\d.,]*\d", (ROOT / "docs/benchmarks.md").read_text()))
        readme = (ROOT / "README.md").read_text().split("## 60 seconds")[0] + (ROOT / "README.md").read_text().split("## What else")[1]
        compared = (ROOT / "docs/compared.md").read_text().split("## A GPU")[0]
        wrong = []
        for text in (readme.split("## When not")[0], re.sub(r"[^\n]*\n?[^\n]*\]\(https[^)]*\)[^\n]*", "", compared)):
            for figure, unit in re.findall(r"(?<![\w.,])(\d[\d,.]*\d|\d) (s|MB|GB|points|triangles|tetrahedra)\b", text):
                if figure not in measured:
                    wrong.append(f"{figure} {unit}")
            wrong += [figure for figure in re.findall(r"(?<![\w.,])\d\.\d{3}(?= of)", text) if figure not in measured]
        self.assertEqual(wrong, [])

    def test_old_links_lead_somewhere(self):
        """docs/sql.md has the anchors that it had as the whole manual, and little else."""
        text = (ROOT / "docs/sql.md").read_text()
        anchors = re.findall(r'^\| <a id="([^"]+)"></a>[^|]+ \| \[[^]]+\]\([^)]+\) \|$', text, re.MULTILINE)
        self.assertGreater(len(anchors), 90)
        self.assertIn("abacus_locate", anchors)

    def test_the_index_is_for_users(self):
        """It has all their pages, and none about how Abacus is made."""
        text = (ROOT / "docs/README.md").read_text()
        pages = {page.name for page in (ROOT / "docs").glob("*.md")} - {"README.md", "architecture.md", "evaluation.md", "releasing.md", "style.md"}
        self.assertEqual({page for page in pages if f"]({page})" not in text}, set())
        self.assertEqual([word for word in ("](evaluation", "](notebook", "](design", "](architecture", "](releasing") if word in text], [])

    def test_every_recipe_is_listed(self):
        text = (ROOT / "docs/cookbook/README.md").read_text()
        self.assertEqual([page.name for page in (ROOT / "docs/cookbook").glob("*.md")
                          if page.name != "README.md" and f"]({page.name})" not in text], [])


if __name__ == "__main__":
    unittest.main()
