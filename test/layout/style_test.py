"""Is it English? The worst phrases of docs/style.md are in no document, comment or text that a user sees.

What is looked through: documents but the notebook and the history, all of the code with its comments and messages, the SQL of the
extensions, the viewer, the clients, the scripts. Of tests and benchmarks, only comments and docstrings: their strings may be titles and
expected messages. A phrase that must stay, since a test has to name it, stands in a file that EXCEPT lists.
"""
import ast
import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOUNS = ("mesh|meshes|points?|vertex|vertices|simplex|simplices|page|pages|octree|triangles?|plain|neighbours|fault|oracle|part|number|"
         "list|plane|header|facet|polygon|geometry|area|line|good|use")
# What a native speaker does not write, and what to write instead.
PHRASES = {
    "is told": (r"\b(?:is|are|was|were|be|been|being) (?:not )?told\b(?! (?:apart|to|so|otherwise))|\btold (?:by|of)\b", "identified by, known from, said, returned"),
    "whoever": (r"\bwhoever\b", "anyone who, the caller"),
    "asks for the triangle": (r"\bask(?:s|ed)? for the (?:triangle|simplex)\b", "asks which triangle"),
    "told by threads": (r"\b(?:told|made|asked|answered|looked for|looked at|counted) by (?:several )?threads\b", "threads do it"),
    "what … what": (r"\b[Ww]hat\b[^.,;:|`()\"]{0,40}\b(?:is|are|was|of|makes?) what\b|\bwhat there is (?:is|and)\b", "name the thing"),
    "is no mesh": (rf"(?<![Tt]here\s)\b(?:is|are|was|were) no (?:{NOUNS})\b", "is not a mesh"),
    "Of those": (r"(?:^|\. |\| |[*/#] )Of (?:those|them|what|which|these|it)\b", "start with the subject"),
    "of those may": (r"\b[Oo]f [^.,;|`]{1,40}\bthose (?:may|are|come)\b", "name the thing once"),
    "has not a": (r"\b(?:has|have|had) not (?:a|an|the|any)\b", "does not have a, has no"),
    "is heard of": (r"\b(?:is|are|was|were|not|to) heard? (?:of|from)\b|\bhears of\b", "sees, notices"),
    "gives out": (r"\b(?:gives?|given|giving) out\b", "returns"),
    "is not looked at": (r"\b(?:is|are|was|were) not looked (?:at|for|into)\b", "is ignored, is not checked"),
    "who wants": (r"(?:\. |^)Who (?:wants|has|needs|calls|asks|reads)\b", "anyone who, if you want"),
    "for no": (r", for (?:no|it has|they are|they have) \w+", "because, since"),
    "so much for": (r"\bso much for\b", "say what it does"),
    "that which": (r"\bthat which\b", "the one that"),
    "none any more": (r"\bnone any ?more\b", "no longer"),
    "is none of": (r"\b(?:is|are) none of\b", "belongs to no, is not in"),
    "be it a": (r"\bbe it (?:a|an|the)\b|\band be it\b", "even if only"),
    "as … as can be": (r"\bas (?:\w+) as can be\b", "as … as possible"),
    "tells of": (r"\btells? of\b", "says, shows"),
}
FOLDERS = ("README.md", "CONTRIBUTING.md", "docs", "src", "include", "client", "scripts", "viewer", "sql/install", "sql/install_lab",
           "sql/install_postgis", "sql/install_postgis_raster", "sql/upgrade", "debian")
COMMENTS_ONLY = ("test", "bench")
EXCEPT = ("docs/notebook/", "docs/style.md", "docs/images/", "docs/evaluation/", "docs/benchmarks/", "test/layout/style_test.py")
KINDS = {".md", ".c", ".h", ".cpp", ".hpp", ".py", ".sh", ".sql", ".js", ".html", ".css", ".pl", ".pm", ".spec", ""}
# How a comment begins; in the C family there are also /* … */. A Perl test has SQL within it.
COMMENT = {".c": "///?", ".h": "///?", ".cpp": "///?", ".hpp": "///?", ".js": "///?", ".sql": "--", ".pl": "#|--", ".pm": "#|--"}
# Between two words: a space, or the end of a line and the beginning of the next one in a comment.
GAP = r"(?: |\s*\n[ \t]*(?:(?:///?|[*#]|--|-)[ \t]+)?)"


def hits(text):
    """(line, phrase, instead)."""
    for phrase, (pattern, instead) in PHRASES.items():
        for match in re.finditer(pattern.replace(" ", GAP), text, re.MULTILINE):
            yield text.count("\n", 0, match.start()) + 1, phrase, instead


def comments(text, suffix):
    """Only the comments and docstrings of the text, each on its line, with a full stop in each line between them.

    A comment has spaces around its sign, so the // of an address is not one.
    """
    lines = text.split("\n")
    begin = COMMENT.get(suffix, "#")
    matches = [re.search(rf"(?:^|\s)(?:{begin})(?:\s.*)?$", line) for line in lines]
    kept = [match[0] if match else "." for match in matches]
    blocks = []
    if begin == "///?":
        blocks = [(text.count("\n", 0, match.start()), text.count("\n", 0, match.end()) + 1)
                  for match in re.finditer(r"^[ \t]*/\*.*?\*/", text, re.DOTALL | re.MULTILINE)]
    elif suffix == ".py":
        blocks = [(node.body[0].lineno - 1, node.body[0].end_lineno) for node in ast.walk(ast.parse(text))
                  if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and ast.get_docstring(node)]
    for first, end in blocks:
        kept[first:end] = lines[first:end]
    return "\n".join(kept)


def texts():
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", *FOLDERS, *COMMENTS_ONLY], cwd=ROOT,
                            stdout=subprocess.PIPE, text=True, check=True)
    for name in listed.stdout.splitlines():
        file = ROOT / name
        if file.suffix in KINDS and file.exists() and not name.startswith(EXCEPT):
            try:
                text = file.read_text()
            except UnicodeDecodeError:
                continue
            yield name, comments(text, file.suffix) if name.split("/")[0] in COMMENTS_ONLY and file.suffix != ".md" else text


class Style(unittest.TestCase):
    def test_the_worst_phrases_are_nowhere(self):
        found = [f"{name}:{line}: “{phrase}”: write {instead} (docs/style.md)" for name, text in texts() for line, phrase, instead in hits(text)]
        self.assertEqual(found, [])

    def test_the_phrases_are_found(self):
        wrong = ["A simplex is told by its code.", "whoever asks", "It asks for the triangle", "answered by threads", "What is tested is what is installed.",
                 "The table is no mesh", "Of those only one", "Of a window those may be left out", "have not a label", "is not heard of", "gives out values",
                 "are not looked at", "Who wants a list", "always, for no trigger", "so much for that", "that which was", "is none any more", "and be it a corner", "facet 1 is none of any simplex",
                 "as few as can be", "tells of it"]
        self.assertEqual([sentence for sentence in wrong if not list(hits(sentence))], [])
        right = ["told apart by their ids", "there is no mesh", "It has no neighbours.", "what is wrong, and what to do about it", "looked for by code"]
        self.assertEqual([sentence for sentence in right if list(hits(sentence))], [])

    def test_only_the_comments_of_a_test_are_read(self):
        code = 'int a;  // one\n/// two\n/** three\n    four */\nf("// five", "http://six");'
        self.assertEqual(comments(code, ".cpp").split("\n"), [" // one", "/// two", "/** three", "    four */", "."])
        code = 'def f():\n    """One."""\n    return "two"  # three'
        self.assertEqual(comments(code, ".py").split("\n"), [".", '    """One."""', " # three"])
        self.assertEqual(comments("SELECT 'one' -- two\n-- three", ".sql").split("\n"), [" -- two", "-- three"])

    def test_the_page_names_each_phrase(self):
        page = (ROOT / "docs/style.md").read_text()
        self.assertGreaterEqual(len(re.findall(r"^\| .* \| .* \|$", page, re.MULTILINE)) - 2, 20)


if __name__ == "__main__":
    unittest.main()
