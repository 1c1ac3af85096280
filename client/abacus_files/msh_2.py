"""Nodes and elements of Gmsh's format 2."""
import numpy

from .msh_elements import kind_of


def nodes(section):
    ids, *axes = section.rows(section.first(), "i4", "f8", "f8", "f8")
    return ids, numpy.column_stack(axes)


def binary_elements(section, count, elements):
    while elements.count < count:
        number, rows, tags = section.numbers("i4", 3).tolist()
        kind, corners = kind_of(section, number)
        if min(rows, tags + 1) < 1:
            section.fail("a block without elements")
        table = section.numbers("i4", rows * (1 + tags + corners)).reshape(rows, -1)
        elements.add(kind, table[:, 0], table[:, 1 + tags:], table[:, 1:2] if tags else numpy.zeros((rows, 1), int), None)


def text_elements(section, count, elements):
    rows = {}
    words = section.words
    for _ in range(count):
        element, number, tags = section.numbers("i8", 3).tolist()
        kind, corners = kind_of(section, number)
        if tags < 0:
            section.fail(f"an element with {tags} tags")
        found = section.numbers("i8", tags + corners).tolist()
        rows.setdefault(kind, ([], []))
        rows[kind][0].append([element, found[0] if tags else 0, *found[tags:]])
        rows[kind][1].append(words.at - corners)
    for kind, (found, begins) in rows.items():
        table = numpy.array(found, dtype=numpy.int64)
        corners = table.shape[1] - 2
        elements.add(kind, table[:, 0], table[:, 2:], table[:, 1:2], lambda n, begins=begins, corners=corners: words.line(begins[n // corners] + n % corners))


def read_elements(file, section, elements):
    count = section.first()
    (binary_elements if file.binary else text_elements)(section, count, elements)
    elements.check(section, count)
