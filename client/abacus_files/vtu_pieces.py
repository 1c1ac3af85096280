"""The pieces of a VTU as one grid."""
import numpy

from . import cell_arrays
from .english import counted
from .grid import Grid


def keys(points, ids):
    """A number for each point, the same for those of one id (if there are any) and place."""
    table = points + 0.0  # -0 is 0
    if ids is not None:
        table = numpy.column_stack([table, ids >> 32, ids & 0xffffffff])  # doubles do not hold all of an id
    _, first, place = numpy.unique(table, axis=0, return_index=True, return_inverse=True)
    return first[place.reshape(-1)]


def merged(points, ids, data, cells, piece):
    """A point that several pieces have becomes that of the first; what one piece has twice is left to abacus_load. `piece`: whose they are."""
    first = keys(points, ids)
    shared = piece[first] != piece
    if not shared.any():
        return points, ids, data, cells, []
    notes = [f"{shared.sum()} points that several pieces have were taken once"]
    differ = [name for name, values in data.items() if not numpy.array_equal(values[shared].astype(float), values[first[shared]].astype(float), equal_nan=True)]
    if differ:
        notes.append(f"these points differ from piece to piece in {', '.join(differ)}; those of the first piece were taken")
    target = numpy.where(shared, first, numpy.arange(len(points)))
    kept = numpy.flatnonzero(~shared)
    return points[kept], None if ids is None else ids[kept], {name: values[kept] for name, values in data.items()}, {
        kind: numpy.searchsorted(kept, target[corners]) for kind, corners in cells.items()}, notes


def in_all(pieces, arrays):
    """The names of arrays that all pieces have which have any, in order."""
    having = [arrays(piece) for piece in pieces if arrays(piece)]
    return [name for name in (having[0] if having else ()) if all(name in found for found in having)]


def of_cells(pieces, name):
    """{kind: an array's values}"""
    found = {}
    for piece in pieces:
        for kind, values in piece.cell_data.get(name, {}).items():
            found.setdefault(kind, []).append(values)
    return {kind: numpy.concatenate(parts) for kind, parts in found.items()}


def known(pieces, points):
    """The ids of points, if all pieces have them and no id is at two places."""
    pieces = [piece for piece in pieces if len(piece.points)]
    if not pieces or any(piece.ids is None for piece in pieces):
        return None
    ids = numpy.concatenate([piece.ids for piece in pieces])
    apart = len(ids) if len(pieces) == 1 else len(numpy.unique(keys(points, ids)))
    return ids if apart == len(numpy.unique(ids)) else None


def joined(pieces, keep_apart):
    """One grid of them. Points of one id and place are one; without ids, those at one place, unless vertices at one place are to be kept apart."""
    names = in_all(pieces, lambda piece: piece.data)
    points = numpy.concatenate([piece.points for piece in pieces])
    data = {name: numpy.concatenate([piece.data[name] for piece in pieces if name in piece.data]) for name in names}
    begins = numpy.cumsum([0] + [len(piece.points) for piece in pieces])
    cells = {kind: numpy.concatenate([piece.cells[kind] + begin for piece, begin in zip(pieces, begins) if kind in piece.cells])
             for kind in dict.fromkeys(kind for piece in pieces for kind in piece.cells)}
    notes = []
    ids = known(pieces, points)
    if ids is None and any(piece.ids is not None for piece in pieces):
        notes.append("the ids are not whole numbers, or one of them is at several places: points are numbered from 0")
    if len(pieces) > 1 and not (keep_apart and ids is None):
        points, ids, data, cells, more = merged(points, ids, data, cells, numpy.repeat(numpy.arange(len(pieces)), numpy.diff(begins)))
        notes += more
    ghosts = sum(piece.ghosts for piece in pieces)
    if ghosts:
        notes.append(f"left out: {counted(ghosts, 'ghost cell')} of other pieces")
    of_all = in_all([piece for piece in pieces if piece.cells], lambda piece: piece.cell_data)
    left = dict.fromkeys([name for piece in pieces for name in (*piece.texts, *piece.data) if name not in names]
                         + [name for piece in pieces for name in piece.cell_data if name not in of_all])
    if left:
        notes.append(f"texts and data that not all pieces have are left out: {', '.join(left)}")
    grid = Grid(points, cells, ids=ids, data=data, notes=notes)
    cell_arrays.take(grid, {name: of_cells(pieces, name) for name in of_all})
    return grid
