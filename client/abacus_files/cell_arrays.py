"""What arrays of cells become: labels of simplices and markers of facets. So it is in VTU, XDMF and whatever meshio reads."""
import re

import numpy

from .grid import CORNERS, OF_HIGHER_ORDER, SIMPLICES, SMALL

MARKER = "marker"
OCTANTS = ("quad", "hexahedron")
CODE = re.compile("code_*")  # as abacus-export writes it beside the ids of points: a place on the curve, which the mesh gets anew


def of_kind(kind):
    """The plain kind of cells whose corners are those of this one."""
    found = OF_HIGHER_ORDER.fullmatch(kind)
    return found[1] if found else kind


def is_code(name, values, has_ids):
    return has_ids and CODE.fullmatch(name) and all(numpy.asarray(part).dtype.kind in "iu" for part in values.values())


def columns(name, values):
    """An array with several components as several arrays of one; texts give none."""
    parts = {kind: numpy.asarray(part) for kind, part in values.items()}
    widths = {part.size // len(part) for part in parts.values() if len(part)}
    if len(widths) != 1 or any(part.dtype.kind not in "iufb" for part in parts.values()):
        return {}
    width, = widths
    tables = {kind: part.reshape(len(part), width) for kind, part in parts.items()}
    names = [name] if width == 1 else [f"{name}_{'xyz'[n] if width <= 3 else n}" for n in range(width)]
    return {names[n]: {kind: table[:, n] for kind, table in tables.items()} for n in range(width)}


def marker_of(arrays, facets):
    """The name of the array whose integers on facets are markers: `marker`, or else the only one; and those that could be it, too."""
    on_facets = [name for name, values in arrays.items() if any(values[kind].dtype.kind in "iu" and values[kind].any() for kind in facets if kind in values)]
    found = MARKER if MARKER in on_facets else on_facets[0] if len(on_facets) == 1 else None
    return found, [name for name in on_facets if name != found]


def take_labels(grid, arrays):
    """Gives a grid the labels of {name: {kind: a number for each cell}}, none of which is a marker."""
    for name, values in arrays.items():
        for part, of_kinds in columns(name, values).items():
            grid.labels.update({(kind, part): numbers.astype(float) for kind, numbers in of_kinds.items() if not numpy.isnan(numbers).all()})


def take(grid, arrays):
    """Gives a grid the labels and markers of {name: {kind: a number for each cell}}; what cannot be taken is noted."""
    numbers, left = {}, []
    for name, values in arrays.items():
        if is_code(name, values, grid.ids is not None or "id" in grid.data):
            grid.codes.update({kind: numpy.asarray(part).reshape(-1).astype(numpy.int64) for kind, part in values.items() if kind in OCTANTS})
            continue
        found = columns(name, values)
        numbers.update(found)
        left += [] if found else [name]
    kinds = {of_kind(kind) for kind, corners in grid.cells.items() if len(corners)}
    simplex = "tetra" if "tetra" in kinds else "triangle"
    facet = SMALL[SIMPLICES[simplex] - 1]
    of = {plain: [kind for kind in grid.cells if of_kind(kind) == plain] for plain in CORNERS}
    marker, others = marker_of(numbers, of[facet])
    for name, values in numbers.items():
        if name == marker:
            grid.markers.update({kind: values[kind].astype(numpy.int64) for kind in of[facet] if kind in values})
        has = [kind for kind in (*of[simplex], *OCTANTS) if kind in values]
        if name == marker and not any(values[kind].any() for kind in has):
            continue  # 0 on simplices says nothing
        grid.labels.update({(kind, name): values[kind].astype(float) for kind in has})
    if left:
        grid.notes.append(f"texts of cells are left out: {', '.join(left)}")
    if others:
        grid.notes.append(f"numbers of cells of one dimension less are left out: {', '.join(others)}"
                          + ("" if marker else "; an array named marker would give markers, or the only one of whole numbers"))
