"""Entities, nodes and elements of Gmsh's formats 4.0 and 4.1."""
import numpy

from .msh_elements import kind_of


class Groups:
    """{(dimension, entity): its physical groups}"""

    def __init__(self, file):
        self.of, self.size, self.is_4_1 = {}, file.size, file.version == "4.1"

    def entity(self, section, dimension, partitioned):
        entity, = section.numbers("i4", 1).tolist()
        of = dimension
        if partitioned:
            of, _ = section.numbers("i4", 2).tolist()  # the entity that it is a part of
            several, = section.numbers(self.size, 1).tolist()
            section.numbers("i4", several)  # partitions
        section.numbers("f8", 3 if dimension == 0 and self.is_4_1 else 6)
        several, = section.numbers(self.size, 1).tolist()
        groups = [abs(group) for group in section.numbers("i4", several).tolist()]
        self.of[dimension, entity] = groups if of == dimension else []  # where partitions meet, Gmsh names the groups of what was cut
        if dimension:
            bounds, = section.numbers(self.size, 1).tolist()
            section.numbers("i4", bounds)

    def read(self, section, partitioned=False):
        if partitioned:
            section.numbers(self.size, 1)  # how many partitions
            ghosts, = section.numbers(self.size, 1).tolist()
            section.numbers("i4", 2 * ghosts)
        for dimension, count in enumerate(section.numbers(self.size, 4).tolist()):
            for _ in range(count):
                self.entity(section, dimension, partitioned)

    def table(self, dimension, entity, rows):
        """The groups of an entity for each of its elements; 0 if it has none."""
        return numpy.tile(numpy.array(self.of.get((dimension, entity)) or [0], dtype=numpy.int64), (rows, 1))


def blocks(file, section):
    """How many there are in all, and a generator of blocks: (dimension, entity, a number, how many)."""
    count_of_blocks, count = section.numbers(file.size, 4 if file.version == "4.1" else 2).tolist()[:2]

    def each():
        for _ in range(count_of_blocks):
            head = section.numbers("i4", 3).tolist()
            if file.version != "4.1":
                head[:2] = head[1::-1]
            if not 0 <= head[0] <= 3:
                section.fail(f"a block of dimension {head[0]}")
            yield (*head, *section.numbers(file.size, 1).tolist())

    return count, each()


def nodes(file, section):
    wanted, found = blocks(file, section)
    ids, points = [numpy.empty(0, numpy.int64)], [numpy.empty((0, 3))]
    for dimension, _, parametric, count in found:
        more = dimension if parametric else 0  # places on the curve or surface
        if file.version == "4.1":
            ids.append(section.numbers(file.size, count))
            points.append(section.numbers("f8", count * (3 + more)).reshape(count, 3 + more)[:, :3])
        else:
            number, *axes = section.rows(count, "i4", *["f8"] * (3 + more))
            ids.append(number)
            points.append(numpy.column_stack(axes)[:, :3])
    ids = numpy.concatenate(ids)
    if len(ids) != wanted:
        section.fail(f"$Nodes says that it has {wanted} nodes, but has {len(ids)}")
    return ids, numpy.concatenate(points)


def read_elements(file, section, elements, groups):
    wanted, found = blocks(file, section)
    for dimension, entity, number, count in found:
        kind, corners = kind_of(section, number)
        width = 1 + corners
        table = section.numbers(file.size if file.version == "4.1" else "i4", count * width).reshape(count, width)
        elements.add(kind, table[:, 0], table[:, 1:], groups.table(dimension, entity, count), section.lines_of(count, width, corners))
    elements.check(section, wanted)
