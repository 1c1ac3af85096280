"""Gmsh's .msh, versions 2, 4.0 and 4.1, in text or binary: ids, materials and markers as Gmsh has them. Other files of that suffix are meshio's."""
import numpy

from . import read_other
from .grid import Grid
from .msh_section import File, is_of_gmsh
from .psql import Failed
from .words import places

suffixes = (".msh",)
# {number of Gmsh: (name of meshio, corners)}
KINDS = {1: ("line", 2), 2: ("triangle", 3), 3: ("quad", 4), 4: ("tetra", 4), 5: ("hexahedron", 8), 6: ("wedge", 6), 7: ("pyramid", 5), 8: ("line3", 3),
         9: ("triangle6", 6), 10: ("quad9", 9), 11: ("tetra10", 10), 12: ("hexahedron27", 27), 13: ("wedge18", 18), 14: ("pyramid14", 14),
         15: ("vertex", 1), 16: ("quad8", 8), 17: ("hexahedron20", 20), 18: ("wedge15", 15), 19: ("pyramid13", 13), 20: ("triangle9", 9),
         21: ("triangle10", 10), 22: ("triangle12", 12), 23: ("triangle15", 15), 26: ("line4", 4), 27: ("line5", 5), 28: ("line6", 6),
         29: ("tetra20", 20), 30: ("tetra35", 35), 31: ("tetra56", 56), 92: ("hexahedron64", 64), 93: ("hexahedron125", 125)}
SECTIONS = ("Entities", "Nodes", "Elements", "NodeData")


def kind_of(number):
    if number not in KINDS:
        raise Failed(f"has elements of Gmsh's type {number}, which is not known")
    return KINDS[number]


class Elements:
    """Numbers of corners and physical groups by kind."""

    def __init__(self):
        self.corners, self.groups, self.count = {}, {}, 0

    def add(self, kind, corners, groups):
        self.corners.setdefault(kind, []).append(corners)
        self.groups.setdefault(kind, []).append(groups)
        self.count += len(corners)

    def check(self, wanted):
        if self.count != wanted:
            raise Failed(f"says that it has {wanted} elements, but has {self.count}")

    def cells(self, ids):
        return {kind: places(numpy.concatenate(parts), ids) for kind, parts in self.corners.items()}

    def tags(self):
        return {kind: numpy.concatenate(parts) for kind, parts in self.groups.items()}


def nodes_2(section):
    ids, *axes = section.rows(section.first(), "i4", "f8", "f8", "f8")
    return ids, numpy.column_stack(axes)


def elements_2(file, section, elements):
    count = section.first()
    if file.binary:
        while elements.count < count:
            number, rows, tags = section.numbers("i4", 3).tolist()
            kind, corners = kind_of(number)
            if min(rows, tags + 1) < 1:
                raise Failed("has a block without elements")
            table = section.numbers("i4", rows * (1 + tags + corners)).reshape(rows, -1)
            elements.add(kind, table[:, 1 + tags:], table[:, 1] if tags else numpy.zeros(rows, int))
    else:
        rows = {}
        for _ in range(count):
            _, number, tags = section.numbers("i8", 3).tolist()
            kind, corners = kind_of(number)
            words = section.numbers("i8", tags + corners).tolist()
            rows.setdefault(kind, []).append([words[0] if tags else 0] + words[tags:])
        for kind, found in rows.items():
            table = numpy.array(found, dtype=numpy.int64)
            elements.add(kind, table[:, 1:], table[:, 0])
    elements.check(count)


def entities_4(file, section):
    """{(dimension, entity): its first physical group}, and how many entities have others, too."""
    groups, more = {}, 0
    for dimension, count in enumerate(section.numbers(file.size, 4).tolist()):
        for _ in range(count):
            entity, = section.numbers("i4", 1).tolist()
            section.numbers("f8", 3 if dimension == 0 and file.version == "4.1" else 6)
            several, = section.numbers(file.size, 1).tolist()
            groups[dimension, entity] = ([abs(group) for group in section.numbers("i4", several).tolist()] + [0])[0]
            more += several > 1
            if dimension:
                bounds, = section.numbers(file.size, 1).tolist()
                section.numbers("i4", bounds)
    return groups, more


def blocks_4(file, section):
    """How many there are in all, and a generator of blocks: (dimension, entity, a number, how many)."""
    blocks, count = section.numbers(file.size, 4 if file.version == "4.1" else 2).tolist()[:2]

    def each():
        for _ in range(blocks):
            head = section.numbers("i4", 3).tolist()
            if file.version != "4.1":
                head[:2] = head[1::-1]
            yield (*head, *section.numbers(file.size, 1).tolist())

    return count, each()


def nodes_4(file, section):
    wanted, blocks = blocks_4(file, section)
    ids, points = [numpy.empty(0, numpy.int64)], [numpy.empty((0, 3))]
    for dimension, _, parametric, count in blocks:
        more = dimension if parametric else 0  # places on the curve or surface
        if file.version == "4.1":
            ids.append(section.numbers(file.size, count))
            points.append(section.numbers("f8", count * (3 + more)).reshape(count, -1)[:, :3])
        else:
            number, *axes = section.rows(count, "i4", *["f8"] * (3 + more))
            ids.append(number)
            points.append(numpy.column_stack(axes)[:, :3])
    ids = numpy.concatenate(ids)
    if len(ids) != wanted:
        raise Failed(f"says that it has {wanted} nodes, but has {len(ids)}")
    return ids, numpy.concatenate(points)


def elements_4(file, section, elements, groups):
    wanted, blocks = blocks_4(file, section)
    for dimension, entity, number, count in blocks:
        kind, corners = kind_of(number)
        table = section.numbers(file.size if file.version == "4.1" else "i4", count * (1 + corners)).reshape(count, 1 + corners)
        elements.add(kind, table[:, 1:], numpy.full(count, groups.get((dimension, entity), 0)))
    elements.check(wanted)


def node_data(section):
    """The name of a view, and its numbers of nodes and values; of vectors no values."""
    texts = [section.line().strip('"') for _ in range(int(section.line()))]
    for _ in range(int(section.line())):
        section.line()  # the time
    numbers = [int(section.line()) for _ in range(int(section.line()))]
    if len(numbers) < 3:
        raise Failed("has data of nodes that does not say how much there is")
    _, width, count = numbers[:3]
    table = section.rows(count, "i4", *["f8"] * width)
    return texts[0] if texts else "data", table[0], table[1] if width == 1 else None


def values_of(views, ids):
    """{name: a value for each node}; those that a view does not have are NaN."""
    data, notes = {}, []
    for name, nodes, values in views:
        if values is None:
            notes.append(f"vectors of points are left out: {name}")
            continue
        data[name] = numpy.full(len(ids), numpy.nan) if name not in data else data[name]
        data[name][places(nodes, ids)] = values
    return data, notes


def read(path):
    if not is_of_gmsh(path):
        return read_other.read(path)
    file = File(path)
    ids, points, groups, more, views, elements = None, None, {}, 0, [], Elements()
    for name, section in file.sections(SECTIONS):
        if name == "Entities":
            groups, more = entities_4(file, section)
        elif name == "NodeData":
            views.append(node_data(section))
        elif file.version[0] == "2":
            if name == "Nodes":
                ids, points = nodes_2(section)
            else:
                elements_2(file, section, elements)
        elif name == "Nodes":
            ids, points = nodes_4(file, section)
        else:
            elements_4(file, section, elements, groups)
    if ids is None or not len(ids):
        raise Failed("has no nodes")
    data, notes = values_of(views, ids)
    if more:
        notes.append(f"physical groups but the first of {more} entities are left out")
    return Grid(points, elements.cells(ids), ids=ids, data=data, tags=elements.tags(), notes=notes)
