"""Markdown with regions that are made from results.

A document is written by hand, except for what stands between

    <!-- begin NAME -->
    <!-- end NAME -->

which `fill` replaces by what the generator of that name returns. `make` makes a document of a template
with such regions: the marks are left out, and so are the sections in which nothing was measured.
"""
import re

REGION = re.compile(r"(<!-- begin ([\w-]+) -->\n).*?(<!-- end \2 -->)", re.DOTALL)
NOTE = re.compile(r"\A<!--.*?-->\n", re.DOTALL)  # of a template, about itself
SECTION = re.compile(r"^(?=##)", re.MULTILINE)


def contents(text, generators):
    """What is to stand in each region; generators: {name: function without arguments}."""
    names = set(match[2] for match in REGION.finditer(text))
    if names != set(generators):
        raise LookupError(f"regions without generators, or the other way round: {names ^ set(generators)}")
    return {name: generators[name]().rstrip("\n") for name in sorted(names)}


def fill(text, generators):
    """The document with every region made anew."""
    made = contents(text, generators)
    return REGION.sub(lambda match: match[1] + made[match[2]] + "\n" + match[3], text)


def make(template, generators):
    """The document of a template, with the sections that have something to say."""
    made = contents(template, generators)
    kept, below = [], False  # from the last section to the first: whether one below the next heading is kept
    for section in reversed(SECTION.split(NOTE.sub("", template))):
        regions = [made[match[2]] for match in REGION.finditer(section)]
        is_top = not section.startswith("###")
        if not regions or any(regions) or (is_top and below):
            kept.insert(0, section)
            below = not is_top
        elif is_top:
            below = False
    text = REGION.sub(lambda match: made[match[2]], "".join(kept))
    return re.sub(r"\n{3,}", "\n\n", text).rstrip("\n") + "\n"


class Document:
    """The generators of a document's regions, by name, and the pictures that they draw."""

    def __init__(self, results, pictures):
        self.results, self.pictures = results, pictures
        self.generators = {"machine": self.machine}

    def fill(self, text):
        return fill(text, self.generators)

    def picture(self, name, alternative):
        return f"![{alternative}]({self.pictures.name}/{name}.svg)\n"

    def machine(self):
        """Of every part: they may have been measured on different days."""
        text, rows = "", []
        machines = {}
        for name, part in self.results.parts.items():
            about = part["machine"]
            rows.append((f"`{name}`", part["mode"], about["date"], about["commit"], number(about["load"]),
                         f"{part['seconds'] / 60:.1f}"))
            key = tuple(str(about.get(field)) for field in ("abacus", "cpu", "cores", "gpu", "memory_bytes", "kernel",
                                                            "compiler", "flags", "packages"))
            machines[key] = about
        for about in machines.values():
            packages = ", ".join(f"{name} {version}" for name, version in about["packages"].items())
            version = f"Abacus {about['abacus']}; " if about.get("abacus") else ""
            gpu = f"one {about['gpu']}, " if about.get("gpu") else ""
            text += (f"{version}{about['cores']} cores of {about['cpu']}, {gpu}{size(about['memory_bytes'])} of memory,"
                     f" Linux {about['kernel']}; {about['compiler']}, `{about['flags']}`; {packages}.\n\n")
        return text + table(("part", "mode", "date", "commit", "load before", "minutes"), rows)


def table(head, rows):
    """A table of GitHub's Markdown; columns after the first are right-aligned. Nothing without rows."""
    if not rows:
        return ""
    lines = ["| " + " | ".join(head) + " |", "|---|" + "---:|" * (len(head) - 1)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def number(value):
    """With three significant digits or none behind the point; a dash for None."""
    if value is None:
        return "–"
    if value == 0:
        return "0"
    return f"{value:,.0f}" if abs(value) >= 100 else f"{value:#.3g}".rstrip(".")


def spread(triple):
    """`median (least–greatest)`."""
    if triple is None:
        return "–"
    middle, least, greatest = (number(value) for value in triple)
    return middle if least == greatest else f"{middle} ({least}–{greatest})"


def size(count):
    """Bytes, in MB or GB of powers of two."""
    if count is None:
        return "–"
    return f"{count / 2**30:.2f} GB" if count >= 2**30 else f"{number(count / 2**20)} MB"


def points(count):
    """A number of points as people say it."""
    if count >= 10**6:
        return f"{count / 10**6:.4g} M"
    return f"{count:,}"
