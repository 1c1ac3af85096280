"""2DM of SMS: nodes and triangles as text. The first material of a triangle is its label."""
import numpy

from .grid import Grid
from .psql import Failed
from .words import Places, numbers, read_text

suffixes = (".2dm",)
# {card: (name of meshio, corners)}
CELLS = {"E3T": ("triangle", 3), "E6T": ("triangle6", 6), "E4Q": ("quad", 4), "E8Q": ("quad8", 8), "E9Q": ("quad9", 9), "E2L": ("line", 2),
         "E3L": ("line3", 3)}
SILENT = ("MESH2D", "MESHNAME", "BEGPARAMDEF", "ENDPARAMDEF", "GM", "TIME", "DY", "TU", "TD", "KEY", "SI", "NUME",
          "BGPGC", "BEDISP", "BEFONT", "BCPGC", "BEGCURVE", "ENDCURVE")
MATERIALS = "NUM_MATERIALS_PER_ELEM"


class Cards:
    """The words of cards of a kind, and their lines. `width`: how many words count; None: those of the first line."""

    def __init__(self, width=None):
        self.width, self.words, self.lines = width, [], []

    def add(self, n, words):
        self.width = self.width or len(words)
        if len(words) < self.width:
            raise Failed(f"line {n}: the line is cut off, or shorter than others of its kind")
        self.words += words[: self.width]
        self.lines.append(n)

    def column(self, begin, end, kind):
        """Some words of each card as numbers."""
        table = numpy.array(self.words, dtype=object).reshape(-1, self.width)[:, begin: end]
        count = table.shape[1]
        return numbers(table.reshape(-1).tolist(), kind, lambda at: self.lines[at // count]).reshape(-1, count)


def cards(text):
    """Nodes, {card: cells}, how many materials the file says that a cell has, and the cards that are left out."""
    nodes, cells, materials, left = Cards(4), {}, None, []
    for n, line in enumerate(text.split("\n"), 1):
        words = line.split("#", 1)[0].split()
        if not words:
            continue
        if words[0] == "ND":
            if len(words) < 5:
                raise Failed(f"line {n}: the line is cut off: {line.strip()}")
            nodes.add(n, words[1:])
        elif words[0] in CELLS:
            if len(words) < 2 + CELLS[words[0]][1]:
                raise Failed(f"line {n}: the line is cut off: {line.strip()}")
            cells.setdefault(words[0], Cards()).add(n, words[1:])
        elif words[0] == MATERIALS:
            materials = words[1:]
        elif words[0] not in SILENT:
            left.append(words[0])
    return nodes, cells, materials, left


def materials_of(cells, first, said):
    """{name: materials}; cells that all have the one material 1 say nothing, unless the file says that they have some."""
    found = {}
    for k in range(first, cells.width):
        values = cells.column(k, k + 1, float)[:, 0]
        if (values != 1).any() or said not in (None, ["0"]):
            found["material" if k == first else f"material_{k - first + 1}"] = values
    return found


def read(path):
    nodes, cells, said, left = cards(read_text(path))
    if not nodes.lines:
        raise Failed("has no nodes (ND)")
    if not cells:
        raise Failed("has no triangles (E3T)")
    ids = nodes.column(0, 1, int)[:, 0]
    places = Places(ids, nodes.lines.__getitem__)
    found, labels = {}, {}
    for card, of in cells.items():
        kind, corners = CELLS[card]
        found[kind] = places.of(of.column(1, 1 + corners, int), lambda n, of=of, corners=corners: of.lines[n // corners])
        labels.update({(kind, name): values for name, values in materials_of(of, 1 + corners, said).items()})
    notes = [f"left out: {', '.join(dict.fromkeys(left))}" + (" (NS: node strings)" if "NS" in left else "")] if left else []
    return Grid(nodes.column(1, 4, float), found, ids=ids, labels=labels, notes=notes,
                lines={"points": nodes.lines.__getitem__})
