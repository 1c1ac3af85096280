"""2DM of SMS: nodes and triangles as text."""
import numpy

from .grid import Grid
from .psql import Failed
from .words import floats, integers, places

suffixes = (".2dm",)
OTHERS = {"E4Q": "quad", "E6T": "triangle6", "E8Q": "quad8", "E9Q": "quad9"}


def read(path):
    numbers, nodes, corners = [], [], []
    with open(path, encoding="utf-8", errors="replace") as file:
        for line in file:
            words = line.split("#", 1)[0].split()
            if words and words[0] in OTHERS:
                raise Failed(f"has {words[0]} cells ({OTHERS[words[0]]}); only triangles make a mesh")
            if words and words[0] in ("ND", "E3T"):
                if len(words) < 5:
                    raise Failed(f"a line is cut off: {line.strip()}")
                if words[0] == "ND":
                    numbers.append(words[1])
                    nodes.extend(words[2:5])
                else:
                    corners.extend(words[2:5])
    if not numbers:
        raise Failed("has no nodes (ND)")
    if not corners:
        raise Failed("has no triangles (E3T)")
    ids = integers(numbers)
    return Grid(floats(nodes).reshape(-1, 3), {"triangle": places(integers(corners).reshape(-1, 3), ids)}, ids=ids)
