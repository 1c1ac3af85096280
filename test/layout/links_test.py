"""Do the links of the documents lead anywhere? Files that they name are tracked, and anchors are headings."""
import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINK = re.compile(r"\]\(([^()\s]+(?:\([^()\s]*\)[^()\s]*)*)\)")
ANCHOR = re.compile(r'<a id="([^"]+)"></a>')
HEADING = re.compile(r"^#{1,6} +(.*?) *#*$", re.MULTILINE)
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"(`+)(?!`).+?(?<!`)\1(?!`)")


def tracked():
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=ROOT, stdout=subprocess.PIPE,
                            text=True, check=True)
    return {ROOT / line for line in listed.stdout.splitlines() if (ROOT / line).exists()}


def prose(text):
    """Without examples."""
    return FENCE.sub("", text)


def anchors(text):
    """As GitHub makes them of headings, of which a second one with the same words gets a number; and those written out."""
    found = set(ANCHOR.findall(text))
    for heading in HEADING.findall(prose(text)):
        words = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading)
        anchor = re.sub(r"[^\w\- ]", "", words.lower()).replace(" ", "-")
        number = 0
        while (unique := f"{anchor}-{number}" if number else anchor) in found:
            number += 1
        found.add(unique)
    return found


def targets(text):
    """Where links and pictures lead, within the repository."""
    for target in LINK.findall(CODE.sub("", prose(text))):
        if not re.match(r"[a-z]+:", target):
            yield target


def installed(files):
    """Those of the files that Debian's packages install as documents: dh_installdocs gets files, folders and -X with parts of paths."""
    words = re.search(r"\tdh_installdocs --all ((?:[^\n\\]|\\\n)+)", (ROOT / "debian/rules").read_text()).group(1).replace("\\\n", " ").split()
    left_out = [word[2:] for word in words if word.startswith("-X")]
    listed = [ROOT / word for word in words if not word.startswith("-X")]
    return {file for file in files if any(one == file or one in file.parents for one in listed)
            and not any(part in file.relative_to(ROOT).as_posix() for part in left_out)}


def wrong_links(documents, files):
    """(document, link, what is wrong with it) of {path: text}."""
    folders = {folder for file in files for folder in file.parents}
    headings = {document: anchors(text) for document, text in documents.items()}
    for document, text in documents.items():
        for target in targets(text):
            path, _, anchor = target.partition("#")
            file = (document.parent / path).resolve() if path else document
            if file not in files and file not in folders:
                yield document, target, "no such file"
            elif anchor and file.suffix == ".md" and anchor not in headings[file]:
                yield document, target, "no such heading"


class Links(unittest.TestCase):
    def test_links_lead_somewhere(self):
        files = tracked()
        documents = {file: file.read_text() for file in files if file.suffix == ".md"}
        self.assertGreater(sum(len(list(targets(text))) for text in documents.values()), 300)
        wrong = [f"{document.relative_to(ROOT)}: {target}: {why}" for document, target, why in wrong_links(documents, files)]
        self.assertEqual(wrong, [])

    def test_links_of_installed_documents_lead_somewhere(self):
        """All but those to the source itself."""
        files = installed(tracked())
        documents = {file: file.read_text() for file in files if file.suffix == ".md"}
        self.assertGreater(len(documents), 40)
        wrong = {(document.parent / target).resolve().relative_to(ROOT).as_posix() for document, target, _ in wrong_links(documents, files)}
        self.assertEqual(wrong, {"CONTRIBUTING.md", "LICENSE", "scripts/guide_pictures.py", "viewer/queries.js"})
        self.assertIn("\tdh_compress -X.md -X.json\n", (ROOT / "debian/rules").read_text())

    def test_what_is_wrong_is_found(self):
        page = ROOT / "page.md"
        documents = {page: "# A `b_c(x)`, d\n## Twice\n## Twice\n```\n[no](link)\n# no heading\n```\n`[no](link)` "
                           "[a](#a-b_cx-d) [b](page.md#twice-1) [c](#twice-2) [d](gone.md) [e](#no-heading) [f](https://x.org/#y) [g](docs)"}
        wrong = wrong_links(documents, {page, ROOT / "docs/guide.md"})
        self.assertEqual([(target, why) for _, target, why in wrong],
                         [("#twice-2", "no such heading"), ("gone.md", "no such file"), ("#no-heading", "no such heading")])


if __name__ == "__main__":
    unittest.main()
