"""Does the tree look as docs/architecture.md says?

The table of rooms in that page is the only list of what a room may use. Here it is compared with
the includes of every file below src, and the names of files in the documents with the files that
there are.
"""
import collections
import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MAP = ROOT / "docs/architecture.md"
ROW = re.compile(r"^\| `(src[\w/]*)` \|[^|]*\|([^|]*)\|$", re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
# Folders with many small files that are alike.
MANY = {"src/geometry", "src/capi"}
SOURCES = {".c", ".h", ".cpp", ".hpp"}
SERVER = re.compile(r"^(postgres|fmgr|miscadmin|pgstat|port|access/|catalog/|commands/|executor/|"
                    r"lib/|libpq/|nodes/|optimizer/|parser/|storage/|tcop/|utils/)")
DOCUMENTS = ["README.md", "CONTRIBUTING.md", "docs/architecture.md", "docs/evaluation.md",
             *(page.relative_to(ROOT).as_posix() for folder in ("docs", "docs/design", "docs/cookbook", "docs/reference")
               for page in (ROOT / folder).glob("*.md"))]


def rooms():
    """{room: rooms that it may use, itself included}, as the map has it."""
    region = MAP.read_text().split("<!-- begin rooms -->")[1].split("<!-- end rooms -->")[0]
    table = {room: set(re.findall(r"`(src[\w/]*)`", uses)) for room, uses in ROW.findall(region)}
    below = {}

    def all_below(room, path=()):
        if room in path:
            raise AssertionError("a circle of rooms: " + " → ".join([*path, room]))
        if room not in below:
            below[room] = {room}.union(*(all_below(use, (*path, room)) for use in table[room]))
        return below[room]

    for room in table:
        all_below(room)
    return below


def tracked(*patterns):
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard",
                             *patterns], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    return [pathlib.Path(line) for line in listed.stdout.splitlines() if (ROOT / line).exists()]


def sources():
    return [path for path in tracked("src", "include") if path.suffix in SOURCES]


def includes(path):
    return INCLUDE.findall((ROOT / path).read_text())


def functions(path):
    """Place and lines of each function, by the layout that the formatters give them."""
    is_c = path.suffix in (".c", ".h")
    head = re.compile(r"\{" if is_c else r"[^=]*\)[^=]*\{")
    open_ones = []  # (indent, line), the innermost last
    for number, line in enumerate((ROOT / path).read_text().splitlines(), 1):
        text = line.lstrip(" ")
        indent = len(line) - len(text)
        if text.startswith("}"):
            first = None
            while open_ones and open_ones[-1][0] >= indent:  # a head of several lines is indented
                first = open_ones.pop()[1]
            if first:
                yield f"{path}:{first}", number - first + 1
        if head.fullmatch(line):
            open_ones.append((indent, number))


class Layout(unittest.TestCase):
    def test_every_file_has_a_room(self):
        known = rooms()
        for path in sources():
            if path.parts[0] == "src":
                self.assertIn(path.parent.as_posix(), known, f"{path} is in no room of the map")

    def test_rooms_use_only_rooms_below(self):
        below = rooms()
        wrong = []
        for path in sources():
            if path.parts[0] != "src":
                continue
            room = path.parent.as_posix()
            for _, name in includes(path):
                if not (ROOT / "src" / name).exists():
                    continue
                used = (pathlib.Path("src") / name).parent.as_posix()
                if used not in below.get(room, ()):
                    wrong.append(f"{path}: {name}")
        self.assertEqual(wrong, [])

    def test_the_core_knows_no_server(self):
        wrong = [f"{path}: {name}" for path in sources() if path.parts[:2] != ("src", "pg")
                 for mark, name in includes(path)
                 if SERVER.match(name) and not (ROOT / "src" / name).exists()]
        self.assertEqual(wrong, [])

    def test_server_code_knows_the_bridge_alone(self):
        wrong = [f"{path}: {name}" for path in sources() if path.parts[:2] == ("src", "pg")
                 for _, name in includes(path)
                 if (ROOT / "src" / name).exists() and not name.startswith("pg/")]
        self.assertEqual(wrong, [])

    def test_the_bridge_is_complete_and_its_names_are_its_own(self):
        bridge = {path.name for path in tracked("include/abacus")}
        named = {name for _, name in includes("include/abacus/abacus.h")}
        self.assertEqual(named, {f"abacus/{name}" for name in bridge - {"abacus.h"}})
        self.assertEqual([str(path) for path in sources()
                          if path.parts[0] == "src" and path.name in bridge - {"abacus.h"}], [])

    def test_no_room_is_too_big(self):
        count = collections.Counter(path.parent.as_posix() for path in sources())
        self.assertEqual({room: files for room, files in count.items()
                          if files > 40 and room not in MANY}, {})

    def test_no_file_is_too_long(self):
        lines = {str(path): len((ROOT / path).read_text().splitlines()) for path in sources()}
        self.assertEqual({path: count for path, count in lines.items() if count > 450}, {})

    def test_no_function_is_too_long(self):
        self.assertEqual({place: count for path in sources() for place, count in functions(path)
                          if count > 80}, {})

    def test_only_the_port_asks_for_the_version(self):
        wrong = [str(path) for path in sources() if "PG_VERSION_NUM" in (ROOT / path).read_text()
                 and path.parent.as_posix() != "src/pg/port"]
        self.assertEqual(wrong, [])

    def test_rows_of_catalogues_are_read_with_their_header(self):
        """PostgreSQL 19 does not bring this header along with others, and most runs compile with earlier versions."""
        for path in sources():
            if "GETSTRUCT(" in (ROOT / path).read_text():
                with self.subTest(path=str(path)):
                    self.assertIn(('"', "access/htup_details.h"), includes(path))

    def test_libraries_of_the_package_are_named_everywhere(self):
        libraries = set(re.findall(r"^ (lib[\w-]+-dev)", (ROOT / "debian/control.in").read_text(), re.MULTILINE))
        self.assertGreater(len(libraries), 5)
        for name in ("Dockerfile", "docs/install.md", "scripts/install-dependencies.sh"):
            self.assertEqual(libraries - set(re.findall(r"lib[\w-]+-dev", (ROOT / name).read_text())), set(), name)

    def test_documents_name_files_that_exist(self):
        wrong = []
        for name in DOCUMENTS:
            text = (ROOT / name).read_text()
            for path in re.findall(r"`((?:src|include|test|scripts|sql|bench|docs)/[\w./-]*\w)`", text):
                if not list(ROOT.glob(path)) and not list(ROOT.glob(path + ".*")):
                    wrong.append(f"{name}: {path}")
            for path in re.findall(r"\]\((?!https?:)([^)#\s]+)", text):
                if not ((ROOT / name).parent / path).exists():
                    wrong.append(f"{name}: {path}")
        self.assertEqual(wrong, [])


if __name__ == "__main__":
    unittest.main()
