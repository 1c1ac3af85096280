"""A surface of LandXML: points, faces, breaklines, contours and boundaries. In it, northing comes before easting."""
import numpy

from .grid import Grid
from .landxml_surface import Surface
from .plan import HOLE, Plan
from .psql import Failed
from .words import Places, numbers
from .xml_stream import Stream

suffixes = (".xml", ".landxml")
METRES = ("meter", "metre")
HOLES = ("void", "hide", "inner", "hole")
Z = "z"


class File:
    """The surfaces of a file, of which one is kept, and what it says about coordinates."""

    def __init__(self, path, wanted):
        self.wanted, self.names, self.surface = wanted, [], None
        self.unit, self.epsg, self.depth, self.open = None, None, 0, None
        Stream(self.start, self.end).parse(path)
        if self.surface is None:
            raise Failed(f"has no surface {wanted}; it has: {', '.join(self.names) or 'none'}" if wanted is not None else "has no surfaces")
        if wanted is None and len(self.names) > 1:
            raise Failed(f"has several surfaces; name one by --surface: {', '.join(self.names)}")

    def start(self, name, attributes, line):
        self.depth += 1
        if self.depth == 1 and name != "LandXML":
            raise Failed(f"line {line}: is not LandXML, but {name}")
        if name == "Surface":
            self.names.append(attributes.get("name", ""))
            if self.wanted in (None, self.names[-1]) and self.surface is None:
                self.open = self.surface = Surface(self.names[-1])
        elif name == "CoordinateSystem" and self.epsg is None:
            self.epsg = attributes.get("epsgCode")
        elif name in ("Metric", "Imperial"):
            self.unit = attributes.get("linearUnit")
        if self.open:
            self.open.start(name, attributes, line)

    def end(self, name, text, line):
        self.depth -= 1
        if self.open:
            self.open.end(name, text, line)
            if name == "Surface":
                self.open = None


class Points:
    """The points of a surface, and those of its lines: one of a place is one."""

    def __init__(self, surface):
        self.ids = numbers(surface.ids, int, surface.lines.__getitem__)
        table = numbers(surface.words, float, lambda n: surface.lines[n // 3]).reshape(-1, 3)
        self.places = Places(self.ids, surface.lines.__getitem__)
        self.table, self.at, self.more = table, {}, []
        for n, (north, east, _) in enumerate(table.tolist()):
            self.at.setdefault((north, east), n)

    def place(self, north, east, elevation):
        found = self.at.setdefault((north, east), len(self.table) + len(self.more))
        if found == len(self.table) + len(self.more):
            self.more.append((north, east, elevation))
        elif found >= len(self.table) and numpy.isnan(self.more[found - len(self.table)][2]):
            self.more[found - len(self.table)] = (north, east, elevation)
        return found

    def all(self):
        """Ids and places (easting, northing, elevation). Points that only lines have get ids above all others."""
        table = numpy.concatenate([self.table, numpy.array(self.more).reshape(-1, 3)])
        first = int(self.ids.max(initial=0)) + 1
        return numpy.concatenate([self.ids, numpy.arange(first, first + len(self.more))]), table[:, [1, 0, 2]]


class Lines:
    """Rows of a plan, of chains; each that has no number of its own gets the next free one."""

    def __init__(self, points, chains):
        self.points, self.rows, self.count = points, [], {}
        names = [chain.attributes.get("name", "") for chain in chains]
        self.named = {name: int(name) for name in names if name.lstrip("-").isdecimal() and abs(int(name)) < 1 << 62}
        self.free = max([0, *self.named.values()]) + 1
        self.unnamed = 0

    def add(self, chain, closed):
        """The number of a chain's line."""
        places = []
        for place in chain.places:
            at = self.points.place(*place)
            if not places or places[-1] != at:
                places.append(at)
        if closed and places[0] != places[-1]:
            places.append(places[0])
        if len(places) < 2:
            raise Failed(f"line {chain.line}: a line has fewer than two points")
        name = chain.attributes.get("name", "")
        part = self.part(chain)
        line = self.named.get(name) if not closed else None
        if line is None or (line in self.count and part < 0):
            self.unnamed += bool(name) and not closed
            line, self.free = self.free, self.free + 1
        for at in places:
            self.count[line] = self.count.get(line, 0) + 1
            self.rows.append((line, self.count[line], at, part, chain.properties.get("kind") == "soft", 0))
        return line

    def part(self, chain):
        part = chain.properties.get("part", "-1")
        if not part.lstrip("-").isdecimal():
            raise Failed(f"line {chain.line}: the part {part} is not a whole number")
        return int(part)


def ours(chain, label, kind):
    """The numbers of a property that abacus-export writes."""
    return numbers(chain.properties.get(label, "").split(), kind, lambda _: chain.line).tolist()


def regions_of(surface, lines):
    """[name, line, x, y] of outlines and seeds. All boundaries of a surface are outlines of one region; those of ours say of which."""
    found, plain = [], []
    for chain in surface.chains["Boundary"]:
        name = chain.attributes.get("name", "")
        for line in ours(chain, "lines", int):
            found.append([name, line, None, None])
        seeds = ours(chain, "seeds", float)
        found += [[name, None, x, y] for x, y in zip(seeds[::2], seeds[1::2])]
        if not chain.properties:
            plain.append(chain)
    is_hole = plain and all(chain.attributes.get("bndType") in HOLES for chain in plain)
    for chain in plain:
        found.append([HOLE if is_hole else surface.name or "surface", lines.add(chain, True), None, None])
    return found


def notes_of(file, surface, lines):
    notes = []
    if file.unit is not None and file.unit.lower() not in METRES:
        notes.append(f"coordinates are in the unit {file.unit}, and stay so")
    if surface.hidden:
        notes.append(f"{surface.hidden} faces that are not shown (i=1) are left out")
    types = {chain.attributes.get("brkType", "standard") for chain in surface.chains["Breakline"]} - {"standard"}
    if types:
        notes.append(f"types of breaklines are left out: {', '.join(sorted(types))}; all become fixed edges")
    if lines.unnamed:
        notes.append(f"names of {lines.unnamed} breaklines and contours are left out, as they are not numbers that differ")
    if surface.left:
        notes.append(f"left out: {', '.join(f'{count} {name}' for name, count in surface.left.items())}")
    return notes


def srid_of(file, notes):
    if file.epsg is not None and file.epsg.isdecimal():
        return int(file.epsg)
    if file.epsg is not None:
        notes.append(f"the coordinate system {file.epsg} is left out: it has no number of EPSG")
    return 0


def read(path, surface=None):
    file = File(path, surface)
    surface = file.surface
    points = Points(surface)
    lines = Lines(points, surface.chains["Breakline"] + surface.chains["Contour"])
    for chain in surface.chains["Breakline"] + surface.chains["Contour"]:
        lines.add(chain, False)
    plan = Plan(regions_of(surface, lines))
    plan.take(lines.rows)
    notes = notes_of(file, surface, lines)
    if len(surface.ids) and surface.data:
        notes.append(f"{len(surface.data)} points of the source data are left out: the surface has points of its own")
    else:
        for place in surface.data:
            points.place(*place)
    ids, places = points.all()
    corners = numbers(surface.faces, int, lambda n: surface.of_faces[n // 3]).reshape(-1, 3)
    cells = {"triangle": points.places.of(corners, lambda n: surface.of_faces[n // 3], "face")} if len(corners) else {}
    height = places[:, 2]
    data = {surface.properties.get("z", Z): height} if (height != 0).any() and not numpy.isnan(height).all() else {}
    grid = Grid(places[:, :2], cells, ids=ids, data=data, notes=notes, lines={"points": surface.lines.__getitem__, "triangle": surface.of_faces.__getitem__}
                if not points.more else {})
    grid.plan, grid.srid = plan, srid_of(file, grid.notes)
    return grid
