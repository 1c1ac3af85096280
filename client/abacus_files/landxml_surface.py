"""A surface of LandXML as it stands in the file."""
import numpy

from .english import counted
from .psql import Failed
from .words import Words, numbers
from .xml_stream import local

LISTS = {"PntList2D": 2, "PntList3D": 3}
CHAINS = ("Breakline", "Boundary", "Contour")
ATTRIBUTES = {"P": {"id"}, "F": {"i", "n"}, "Breakline": {"brkType", "name"}, "Contour": {"elev", "name"}, "Boundary": {"bndType", "edgeTrim", "name"}}
SILENT = ("Surfaces", "SourceData", "Definition", "Pnts", "Faces", "Breaklines", "Boundaries", "Contours", "DataPoints", "Feature", "Property",
          "Surface", "P", "F", *CHAINS, *LISTS)


class Chain:
    """A Breakline, a Boundary or a Contour: its `line` in the file, its attributes, `places` (northing, easting, elevation, line), and properties."""

    def __init__(self, line, attributes):
        self.line, self.attributes, self.places, self.properties = line, attributes, [], {}


def lines_of(text, line, width):
    """The line of each point of a list, which begins in `line`."""
    counts = [len(row.split()) for row in text.split("\n")]
    return numpy.repeat(numpy.arange(line, line + len(counts)), counts)[::width].tolist()


class Surface:
    """`ids`, `points` and `faces` with their lines in the file; chains by the name of their element; `data`: points without numbers, as places of a Chain; `hidden`: how
    many faces are not shown; `left`: how many elements, and attributes of elements, are not read."""

    def __init__(self, name):
        self.name, self.properties, self.left, self.hidden = name, {}, {}, 0
        self.ids, self.words, self.lines = [], [], []
        self.faces, self.of_faces = [], []
        self.data = []
        self.chains = {kind: [] for kind in CHAINS}
        self.open = None  # the chain that is being read
        self.face_is_hidden = self.ours = False

    def start(self, name, attributes, line):
        for attribute in attributes.keys() - ATTRIBUTES.get(name, attributes.keys()):
            self.leave(f"{local(attribute)} of {name}")
        if name == "P":
            if "id" not in attributes:
                raise Failed(f"line {line}: a point has no number (id)")
            self.ids.append(attributes["id"])
            self.lines.append(line)
        elif name == "F":
            self.face_is_hidden = attributes.get("i") in ("1", "true")
        elif name in CHAINS:
            self.open = Chain(line, attributes)
            self.chains[name].append(self.open)
        elif name == "Definition" and attributes.get("surfType", "TIN").upper() != "TIN":
            raise Failed(f"line {line}: the surface is a {attributes['surfType']}; triangles (TIN) are read")
        elif name == "Feature":
            self.ours = attributes.get("code") == "abacus"
        elif name == "Property" and self.ours:
            (self.open or self).properties[attributes.get("label", "")] = attributes.get("value", "")
        elif name not in SILENT:
            self.leave(name)

    def leave(self, what):
        self.left[what] = self.left.get(what, 0) + 1

    def end(self, name, text, line):
        if name == "P":
            words = text.split()
            if len(words) not in (2, 3):
                raise Failed(f"line {line}: a point has {counted(len(words), 'number')}; northing, easting and elevation are read")
            self.words += words if len(words) == 3 else [*words, "nan"]
        elif name == "F" and self.face_is_hidden:
            self.hidden += 1
        elif name == "F":
            words = text.split()
            if len(words) != 3:
                raise Failed(f"line {line}: a face has {counted(len(words), 'corner')}; triangles are read")
            self.faces += words
            self.of_faces.append(line)
        elif name in LISTS:
            self.take_list(LISTS[name], text, line)
        elif name in CHAINS:
            if not self.open.places and not self.open.properties:
                raise Failed(f"line {line}: a {name} without points (PntList2D or PntList3D)")
            self.open = None
        elif name == "Feature":
            self.ours = False

    def take_list(self, width, text, line):
        words = text.split()
        if len(words) % width:
            raise Failed(f"line {line}: a list of points has {counted(len(words), 'number')}, which is not a multiple of {width}")
        values = Words(text, comments=False, line=line).floats(len(words), "numbers").reshape(-1, width).tolist()
        elevation = self.open.attributes.get("elev", "nan") if self.open else "nan"
        height, = numbers([elevation], float, lambda _: self.open.line).tolist()
        (self.open.places if self.open else self.data).extend((*(*place, height)[:3], at) for place, at in zip(values, lines_of(text, line, width)))
