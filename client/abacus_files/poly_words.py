"""What Triangle's .poly has no place for, in comments that other programs skip: `# abacus WORD …`.

    # abacus attributes ["id", "height"]    names of the points' attributes, of which id is the number that a mesh has for a point
    # abacus srid 25832                     of the coordinates
    # abacus line 100 soft part 2           a line: the segments below it, up to the next such comment. `soft` and `part` may be missing
    # abacus region "lake" lines 7 8        a region by outlines, whose seeds follow; without `lines` by the seeds themselves
"""
import bisect
import json
import re

from .epsg import GREATEST
from .psql import Failed
from .words import number

PREFIX = "# abacus "
LINE = re.compile(r"(-?\d+)(?: (soft))?(?: part (-?\d+))?")
REGION = re.compile(r'("(?:[^"\\]|\\.)*")(?: lines((?: -?\d+)+))?')


def line(number_, soft, part):
    return f"{PREFIX}line {number_}{' soft' if soft else ''}{'' if part is None else f' part {part}'}\n"


def region(name, lines):
    return f"{PREFIX}region {json.dumps(name)}{' lines ' + ' '.join(map(str, lines)) if lines else ''}\n"


class Said:
    """The comments of a file, each with its line."""

    def __init__(self, text):
        self.attributes, self.srid, self.lines, self.regions = None, 0, [], []
        for n, row in enumerate(text.split("\n"), 1):
            if row.startswith(PREFIX):
                word, _, rest = row[len(PREFIX):].strip().partition(" ")
                try:
                    self.take(n, word, rest)
                except (ValueError, TypeError) as error:
                    raise Failed(f"line {n}: the comment is not as abacus-export writes it: {row.strip()}") from error

    def take(self, n, word, rest):
        if word == "attributes":
            self.attributes = json.loads(rest)
            if not isinstance(self.attributes, list) or not all(isinstance(name, str) for name in self.attributes):
                raise ValueError
        elif word == "srid":
            self.srid = number(rest, int)
            if not 0 <= self.srid <= GREATEST:
                self.wrong()
        elif word == "line":
            found = LINE.fullmatch(rest)
            self.lines.append((n, int(found[1]), bool(found[2]), -1 if found[3] is None else int(found[3])) if found else self.wrong())
        elif word == "region":
            found = REGION.fullmatch(rest)
            self.regions.append((n, json.loads(found[1]), [int(line) for line in (found[2] or "").split()]) if found else self.wrong())
        else:
            self.wrong()

    def wrong(self):
        raise ValueError


def above(said, n):
    """The last comment above a line of the file, or None."""
    at = bisect.bisect_left(said, n, key=lambda entry: entry[0])
    return said[at - 1] if at else None
