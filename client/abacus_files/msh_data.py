"""Data of nodes and elements in Gmsh's .msh, and the names of physical groups."""
import numpy


def view(section):
    """The name of a view, the numbers of its nodes or elements, and their values: a column for each component."""
    texts = [section.line().strip('"') for _ in range(section.whole_line())]
    for _ in range(section.whole_line()):
        section.line()  # the time
    numbers = [section.whole_line() for _ in range(section.whole_line())]
    if len(numbers) < 3 or min(numbers[1:3]) < 0:
        section.fail(f"${section.name} does not say how much data it has")
    _, width, count = numbers[:3]
    table = section.rows(count, "i4", *["f8"] * width)
    return texts[0] if texts else "data", table[0], numpy.column_stack(table[1:]) if width else numpy.empty((count, 0))


def of_nodes(views, places, count):
    """{name: values of each node}; those that a view does not have are NaN. Views of one name are steps, of which the last counts."""
    data, notes = {}, []
    for name, nodes, values in views:
        if name in data:
            notes.append(f"{name} has several steps; the last one is taken")
        data[name] = numpy.full((count, values.shape[1]), numpy.nan)
        data[name][places.of(nodes)] = values
    return data, list(dict.fromkeys(notes))


def of_elements(views, cells):
    """{name: {kind: values of each element}}"""
    arrays = {}
    for name, elements, values in views:
        order = numpy.argsort(elements, kind="stable")
        arrays[name] = {}
        for kind, (numbers, *_) in cells.items():
            at = numpy.minimum(numpy.searchsorted(elements[order], numbers), max(len(elements) - 1, 0))
            has = elements[order][at] == numbers if len(elements) else numpy.zeros(len(numbers), bool)
            arrays[name][kind] = numpy.full((len(numbers), values.shape[1]), numpy.nan)
            arrays[name][kind][has] = values[order[at[has]]] if len(elements) else 0
    return arrays


def names(section):
    """Physical groups as (dimension, number, name)."""
    found = []
    for _ in range(section.whole_line()):
        words = section.line().split(None, 2)
        if len(words) < 3 or not (words[0].isdigit() and words[1].lstrip("-").isdigit()):
            section.fail(f"{' '.join(words)!r} is not a dimension, a number and a name")
        found.append((int(words[0]), abs(int(words[1])), words[2].removeprefix('"').removesuffix('"')))
    return found
