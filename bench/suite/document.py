"""Markdown with regions that are made from results.

A document is written by hand, except for what stands between

    <!-- begin NAME -->
    <!-- end NAME -->

which `fill` replaces by what the generator of that name returns.
"""
import re

REGION = re.compile(r"(<!-- begin ([\w-]+) -->\n).*?(<!-- end \2 -->)", re.DOTALL)


def fill(text, generators):
    """The document with every region made anew; generators: {name: function without arguments}."""
    names = set(match[2] for match in REGION.finditer(text))
    if names != set(generators):
        raise LookupError(f"regions without generators, or the other way round: {names ^ set(generators)}")
    return REGION.sub(lambda match: match[1] + generators[match[2]]().rstrip("\n") + "\n" + match[3], text)


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
            key = tuple(str(about[field]) for field in ("cpu", "cores", "memory_bytes", "kernel",
                                                        "compiler", "flags", "packages"))
            machines[key] = about
        for about in machines.values():
            packages = ", ".join(f"{name} {version}" for name, version in about["packages"].items())
            text += (f"{about['cores']} cores of {about['cpu']}, {size(about['memory_bytes'])} of memory,"
                     f" Linux {about['kernel']}; {about['compiler']}, `{about['flags']}`; {packages}.\n\n")
        return text + table(("part", "mode", "date", "commit", "load before", "minutes"), rows)


def table(head, rows):
    """A table of GitHub's Markdown; columns after the first are right-aligned. An empty one says what it waits for."""
    lines = [] if rows else ["Not measured yet on the machine of this page.", ""]
    lines += ["| " + " | ".join(head) + " |", "|---|" + "---:|" * (len(head) - 1)]
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
