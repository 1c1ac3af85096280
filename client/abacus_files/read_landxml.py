"""A surface of LandXML: points, faces, breaklines, contours and boundaries. In it, northing comes before easting."""
import re

import numpy

from . import epsg
from .english import counted
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
EPSG = re.compile(r"(?:EPSG:+|urn:ogc:def:crs:EPSG:[^:]*:)?(\d+)", re.IGNORECASE)


class File:
    """The surfaces of a file, of which one is kept, and what it says about coordinates."""

    def __init__(self, path, wanted):
        self.wanted, self.names, self.surface = wanted, [], None
        self.unit, self.epsg, self.open = None, None, None
        Stream("LandXML", self.start, self.end).parse(path)
        if self.surface is None:
            raise Failed(f"has no surface {wanted}; it has: {', '.join(self.names) or 'none'}" if wanted is not None else "has no surfaces")
        if wanted is None and len(self.names) > 1:
            raise Failed(f"has several surfaces; name one by --surface: {', '.join(self.names)}")

    def start(self, name, attributes, line):
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
        if self.open:
            self.open.end(name, text, line)
            if name == "Surface":
                self.open = None


def shortest(value):
    return repr(value).removesuffix(".0")


class Points:
    """The points of a surface, and those of its lines: one of a place is one, with the height that any of them has."""

    def __init__(self, surface):
        self.ids = numbers(surface.ids, int, surface.lines.__getitem__)
        table = numbers(surface.words, float, lambda n: surface.lines[n // 3]).reshape(-1, 3)
        self.places = Places(self.ids, surface.lines.__getitem__)
        self.points = [[*place, line] for place, line in zip(table.tolist(), surface.lines)]  # [northing, easting, elevation, line of the file]
        self.at = {}
        for n, point in enumerate(self.points):
            self.agree(self.points[self.at.setdefault((point[0], point[1]), n)], point)

    def agree(self, known, point):
        """One of two points at a place may have no height; otherwise both have the same."""
        if known[2] != known[2]:
            known[2:] = point[2:]
        elif point[2] == point[2] and point[2] != known[2]:
            north, east, height, line = point
            raise Failed(f"line {line}: the point at northing {shortest(north)}, easting {shortest(east)} has the height {shortest(height)}, "
                         f"but in line {known[3]} it has the height {shortest(known[2])}")

    def place(self, *point):
        found = self.at.setdefault(point[:2], len(self.points))
        if found == len(self.points):
            self.points.append(list(point))
        else:
            self.agree(self.points[found], point)
        return found

    def known(self, *point):
        """Whether the point is one of those that are there."""
        found = self.at.get(point[:2])
        if found is not None:
            self.agree(self.points[found], point)
        return found is not None

    def all(self):
        """Ids, places (easting, northing, elevation), and a function that says the line of one. Points that only lines have get ids above all others."""
        first, more = int(self.ids.max(initial=0)) + 1, len(self.points) - len(self.ids)
        table = numpy.array([point[:3] for point in self.points]).reshape(-1, 3)
        return numpy.concatenate([self.ids, numpy.arange(first, first + more)]), table[:, [1, 0, 2]], lambda n: self.points[n][3]


class Lines:
    """Rows of a plan, of chains; each that has no number of its own gets the next free one."""

    def __init__(self, points, chains):
        self.points, self.rows, self.count = points, [], {}
        names = [chain.attributes.get("name", "") for chain in chains]
        self.named = {name: int(name) for name in names if name.lstrip("-").isdecimal() and abs(int(name)) < 1 << 62}
        self.free = max([0, *self.named.values()]) + 1
        self.unnamed = 0  # whose names are left out

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


def regions_of(surface, lines, notes):
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
    region = HOLE if is_hole else surface.name or "surface"
    for chain in plain:
        found.append([region, lines.add(chain, True), None, None])
    lost = sum(chain.attributes.get("name", "") not in ("", region) for chain in plain)
    if lost:
        notes.append(f"left out: {counted(lost, 'name of a boundary', 'names of boundaries')} (together they are the region {region})")
    return found


def notes_of(file, surface, lines):
    notes = []
    if file.unit is not None and file.unit.lower() not in METRES:
        notes.append(f"coordinates are in the unit {file.unit}, and stay so")
    if surface.hidden:
        notes.append(f"left out: {counted(surface.hidden, 'face')} that the file does not show (i=1)")
    types = {chain.attributes.get("brkType", "standard") for chain in surface.chains["Breakline"]} - {"standard"}
    if types:
        notes.append(f"types of breaklines are left out: {', '.join(sorted(types))}; all become fixed edges")
    if lines.unnamed:
        notes.append(f"left out: {counted(lines.unnamed, 'name of a breakline or contour', 'names of breaklines and contours')} "
                     "(only whole numbers that differ are kept)")
    if surface.left:
        notes.append(f"left out: {', '.join(f'{count} {name}' for name, count in surface.left.items())}")
    return notes


def srid_of(file, notes):
    if file.epsg is None:
        return 0
    found = EPSG.fullmatch(file.epsg.strip())
    if found and int(found[1]) <= epsg.GREATEST:
        return int(found[1])
    notes.append(f"the coordinate system {file.epsg} is left out: it is not a code of EPSG, so the mesh has no SRID")
    return 0


def read(path, surface=None):
    file = File(path, surface)
    surface = file.surface
    points = Points(surface)
    lines = Lines(points, surface.chains["Breakline"] + surface.chains["Contour"])
    for chain in surface.chains["Breakline"] + surface.chains["Contour"]:
        lines.add(chain, False)
    notes = notes_of(file, surface, lines)
    plan = Plan(regions_of(surface, lines, notes))
    plan.take(lines.rows)
    others = [point for point in surface.data if not points.known(*point)]
    if len(surface.ids) and others:
        notes.append(f"left out: {counted(len(others), 'point')} of the source data (the surface has points of its own)")
    else:
        for point in others:
            points.place(*point)
    ids, places, line_of = points.all()
    corners = numbers(surface.faces, int, lambda n: surface.of_faces[n // 3]).reshape(-1, 3)
    cells = {"triangle": points.places.of(corners, lambda n: surface.of_faces[n // 3], "face")} if len(corners) else {}
    height = places[:, 2]
    data = {surface.properties.get("z", Z): height} if (height != 0).any() and not numpy.isnan(height).all() else {}
    grid = Grid(places[:, :2], cells, ids=ids, data=data, notes=notes, lines={"points": line_of, "triangle": surface.of_faces.__getitem__})
    grid.plan, grid.srid = plan, srid_of(file, grid.notes)
    return grid
