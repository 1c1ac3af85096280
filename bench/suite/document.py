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


def table(head, rows):
    """A table of GitHub's Markdown; columns after the first are right-aligned."""
    lines = ["| " + " | ".join(head) + " |", "|---|" + "---:|" * (len(head) - 1)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def number(value):
    """With three significant digits or none behind the point; a dash for None."""
    if value is None:
        return "–"
    if value == 0:
        return "0"
    return f"{value:,.0f}" if abs(value) >= 100 else f"{value:#.3g}"


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
