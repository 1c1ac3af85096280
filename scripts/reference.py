#!/usr/bin/python3
"""Writes the signatures and one-line descriptions of the reference, from the SQL of the extensions.

    reference.py            writes them between their markers in docs
    reference.py --check    says what is not as the SQL has it; writes nothing

The signature of a function stands on its page after <!-- begin abacus_x abacus_y --> (abacus_x(text) means the forms
whose first argument has this type), and the table of all functions in
docs/reference/README.md after <!-- begin index -->. A description is the first sentence of the COMMENT. What follows it,
"Shapes: … Units: … Errors: …", is for psql's \\df+ and has its place in the text of the page. Forms whose COMMENT
begins with "the same" are left out: they take as text what another form takes as an array.
"""
import pathlib
import re
import sys
from dataclasses import dataclass

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDERS = {"abacus": "sql/install", "abacus_postgis": "sql/install_postgis", "abacus_postgis_raster": "sql/install_postgis_raster",
           "abacus_lab": "sql/install_lab"}
FUNCTION = re.compile(r"^CREATE (?:OR REPLACE )?(FUNCTION|PROCEDURE) (\w+)\((.*?)\)\s*\n?(?:RETURNS (\w[\w ]*(?:\[\])?)\s)?", re.M | re.S)
COMMENT = re.compile(r"^COMMENT ON (?:FUNCTION|PROCEDURE) (\w+)\((.*?)\) IS\s+'((?:[^']|'')*)';", re.M | re.S)
INSIDE = re.compile(r"^(_|abacus_page_|abacus_fdw_|abacus_tracked(_lines)?$|abacus_published$)")
SHORT = {"double precision": "float8", "SETOF": "setof"}
WIDTH = 118
REGION = re.compile(r"(<!-- begin ([\w() ]+) -->\n)(.*?)(<!-- end -->)", re.S)
PAGES = ["docs/reference/*.md", "docs/postgis.md", "docs/lab.md"]


@dataclass
class Argument:
    mode: str
    name: str
    type: str
    default: str


@dataclass
class Function:
    extension: str
    kind: str
    name: str
    arguments: list
    returns: str
    comment: str

    def description(self):
        return self.comment.split(". ", 1)[0].rstrip(".")

    def same(self):
        return self.comment.startswith("the same")

    def is_meant(self, name):
        return name == self.name or bool(self.arguments) and name == f"{self.name}({self.arguments[0].type})"

    def signature(self):
        """Lines of it: what fits, and arguments under arguments."""
        taken = [f"{argument.name} {argument.type}{argument.default}" for argument in self.arguments if argument.mode != "OUT"]
        given = [f"{argument.name} {argument.type}" for argument in self.arguments if argument.mode != "IN"]
        if given:
            result = f"setof ({', '.join(given)})" if self.returns.startswith("setof") else f"({', '.join(given)})"
        else:
            result = self.returns
        head = f"{'CALL ' if self.kind == 'PROCEDURE' else ''}{self.name}("
        lines = filled(head, taken, ")")
        if result:
            if len(lines[-1]) + len(result) + 3 <= WIDTH:
                lines[-1] += f" → {result}"
            elif given:
                opening = f"    → {result[:result.index('(') + 1]}"
                lines += filled(opening, given, ")")
            else:
                lines.append(f"    → {result}")
        return lines


def filled(opening, items, closing):
    lines, indent = [opening], " " * len(opening)
    for number, item in enumerate(items):
        item += closing if number == len(items) - 1 else ","
        if lines[-1].strip() != opening.strip() and len(lines[-1]) + 1 + len(item) > WIDTH:
            lines.append(indent + item)
        else:
            lines[-1] += item if lines[-1] in (opening, indent) else f" {item}"
    if not items:
        lines[-1] += closing
    return lines


def shortened(text):
    for long, short in SHORT.items():
        text = text.replace(long, short)
    return text


def split(text):
    """At commas outside of brackets and quotes."""
    items, depth, quoted, item = [], 0, False, ""
    for character in text:
        quoted ^= character == "'"
        depth += 0 if quoted else (character in "([{") - (character in ")]}")
        if character == "," and not depth and not quoted:
            items.append(item)
            item = ""
        else:
            item += character
    return [" ".join(item.split()) for item in [*items, item] if item.strip()]


def argument(text):
    mode, rest = re.fullmatch(r"(?:(OUT|INOUT) )?(.*)", text).groups()
    words, _, default = rest.partition(" DEFAULT ")
    name, _, kind = words.partition(" ")
    return Argument(mode or "IN", name, shortened(kind), shortened(f" DEFAULT {default}") if default else "")


def types(arguments):
    return ", ".join(argument.type for argument in arguments if argument.mode != "OUT")


def functions():
    found = []
    for extension, folder in FOLDERS.items():
        for file in sorted((ROOT / folder).glob("*.sql")):
            text = file.read_text()
            comments = {(name, shortened(" ".join(of.split()))): comment.replace("''", "'") for name, of, comment in COMMENT.findall(text)}
            for kind, name, arguments, returns in FUNCTION.findall(text):
                if INSIDE.search(name) or "internal" in arguments:
                    continue
                arguments = [argument(text) for text in split(arguments)]
                comment = comments.get((name, types(arguments)))
                if comment is None:
                    sys.exit(f"{file}: {name}({types(arguments)}) has no comment")
                found.append(Function(extension, kind, name, arguments, shortened(returns.strip()), comment))
    return found


def wrapped(text):
    lines = ["--"]
    for word in text.split():
        if len(lines[-1]) + 1 + len(word) > WIDTH:
            lines.append("--")
        lines[-1] += f" {word}"
    return lines


def block(chosen):
    lines, last = ["```"], None
    for function in chosen:
        if function.description() != last:
            lines += wrapped(function.description())
            last = function.description()
        lines += function.signature()
    return "\n".join([*lines, "```"]) + "\n"


def homes(pages):
    """{(extension, function): where its signature stands}."""
    found = {}
    for page in pages:
        text = page.read_text()
        extension = {"postgis.md": "abacus_postgis", "lab.md": "abacus_lab"}.get(page.name, "abacus")
        for opening in re.finditer(r"<!-- begin ([\w() ]+) -->", text):
            heading = re.findall(r"^##+ (.*)$", text[:opening.start()], re.M)
            anchor = re.sub(r"[^\w\- ]", "", heading[-1].lower()).replace(" ", "-") if heading else ""
            for name in opening[1].split():
                found.setdefault((extension, name.split("(")[0]), (page, anchor))
    return found


def relative(page, folder=ROOT / "docs/reference"):
    return page.name if page.parent == folder else f"../{page.name}"


def index(known, where):
    lines = ["| function | |", "|---|---|"]
    for name in sorted({function.name for function in known if function.extension == "abacus"}):
        first = next(function for function in known if function.name == name and not function.same())
        page, anchor = where["abacus", name]
        description = first.description().replace("|", "\\|").replace("<", "&lt;")
        lines.append(f"| [`{name}`]({relative(page)}#{anchor}) | {description} |")
    for extension in ("abacus_postgis", "abacus_postgis_raster", "abacus_lab"):
        for name in sorted({function.name for function in known if function.extension == extension}):
            first = next(function for function in known if (function.extension, function.name) == (extension, name))
            page, anchor = where["abacus_lab" if extension == "abacus_lab" else "abacus_postgis", name]
            description = first.description().replace("|", "\\|").replace("<", "&lt;")
            lines.append(f"| [`{name}`]({relative(page)}#{anchor}) ({extension}) | {description} |")
    return "\n".join(lines) + "\n"


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__)
    known = functions()
    pages = [page for pattern in PAGES for page in sorted(ROOT.glob(pattern))]
    where = homes(pages)
    wrong = [f"no page has the signature of {function.name} ({function.extension})" for function in known
             if ("abacus_postgis" if "postgis" in function.extension else function.extension, function.name) not in where]
    for page in pages:
        extensions = {"postgis.md": ("abacus_postgis", "abacus_postgis_raster"), "lab.md": ("abacus_lab",)}.get(page.name, ("abacus",))

        def region(match):
            if match[2] == "index":
                return match[1] + index(known, where) + match[4]
            chosen = [function for name in match[2].split() for function in known
                      if function.is_meant(name) and function.extension in extensions and not function.same()]
            unknown = {name.split("(")[0] for name in match[2].split()} - {function.name for function in chosen}
            wrong.extend(f"{page.relative_to(ROOT)}: there is no {name}" for name in sorted(unknown))
            return match[1] + block(chosen) + match[4]

        text = page.read_text()
        if wrong:
            continue
        new = REGION.sub(region, text)
        if new != text:
            if check:
                wrong.append(f"{page.relative_to(ROOT)} differs from the SQL: scripts/reference.py writes it")
            else:
                page.write_text(new)
    print("\n".join(wrong), end="\n" if wrong else "")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
