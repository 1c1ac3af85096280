"""Triangle's .poly: points, segments, holes and regions. Points may be in the .node beside it."""
import pathlib

from .english import counted
from .grid import Grid
from .plan import HOLE, Plan
from .poly_words import Said, above
from .psql import Failed
from .read_tetgen import Part, nodes
from .words import Places, Rows, number, read_text

suffixes = (".poly",)


def beside(path):
    """The files that belong to one, this one among them."""
    return [pathlib.Path(path), Part(pathlib.Path(path), ".node").path]


def has_points(rows):
    """Whether the points are here; else they are in .node."""
    count = rows.whole(2, "its first line")[0]
    rows.at -= 1
    return count != 0


def points_of(path, rows):
    """The points, and whether their lines are those of this file."""
    if has_points(rows):
        return nodes(rows), True
    rows.row("the points")
    node = Part(path, ".node")
    if not node.exists():
        raise Failed(f"line {rows.rows[rows.at - 1][0]}: says that its points are in {node.path.name}, which is not there")
    return node.read(nodes), False


def segments(rows, places):
    """(line of the file, number, place, place, marker) of each."""
    count, markers = (rows.whole(1, "the number of segments") + [0])[:2]
    words, begin = rows.table(count, 3 + (markers > 0), "segments")
    width = 3 + (markers > 0)
    table = rows.numbers(words, int, begin, width).reshape(-1, width)
    line_of = lambda n: rows.rows[begin + n][0]
    ends = places.of(table[:, 1:3], lambda n: line_of(n // 2), "segment")
    found = [(line_of(n), *row) for n, row in enumerate(zip(table[:, 0].tolist(), *ends.T.tolist(), table[:, 3].tolist() if markers else [0] * count))]
    for line, _, a, b, _ in found:
        if a == b:
            raise Failed(f"line {line}: a segment has the same point at both ends")
    return found


def seeds(rows, width, what):
    """(line of the file, numbers) of each place."""
    count, = rows.whole(1, f"the number of {what}")[:1]
    if count < 0:
        rows.fail(rows.at - 1, f"the file says that it has {count} {what}")
    found = []
    for n in range(count):
        words = rows.row(f"all {what} are there ({n} of {count})")
        line = rows.rows[rows.at - 1][0]
        if len(words) < width:
            raise Failed(f"line {line}: {counted(len(words), 'number')}, where {what} have {width}")
        try:
            found.append((line, [number(word, float) for word in words[1:]]))
        except ValueError:
            raise Failed(f"line {line}: not all of these are numbers: {' '.join(words)}") from None
    return found


def name_of(attribute):
    return str(int(attribute)) if attribute == attribute and abs(attribute) < 1 << 53 and attribute == int(attribute) else repr(attribute)


def lines_of(found, said):
    """Rows of a plan. A segment is a line of its own, unless a comment says to which line it belongs."""
    rows, last, count = [], None, {}  # how many corners a line has
    for where, given, a, b, marker in found:
        entry = above(said.lines, where)
        line, soft, part = entry[1:] if entry else (given, False, -1)
        if entry is None or entry != last:
            if entry is None and line in count:
                raise Failed(f"line {where}: two segments have the number {line}")
            count[line] = count.get(line, 0) + 1
            rows.append((line, count[line], a, part, soft, marker))
        elif rows[-1][2] == a:
            rows[-1] = (*rows[-1][:-1], marker)
        else:
            raise Failed(f"line {where}: the segment of line {line} does not begin where the one above it ends")
        count[line] += 1
        rows.append((line, count[line], b, part, soft, 0))
        last = entry
    return rows


def regions_of(holes, regions, said):
    """[name, line, x, y] of each outline and seed. One with outlines has seeds for other programs only."""
    found, outlines = [], {}
    for where, (x, y, *rest) in holes + regions:
        entry = above(said.regions, where)
        name = entry[1] if entry else name_of(rest[0]) if rest else HOLE
        if entry and entry[2]:
            outlines[name] = entry[2]
        else:
            found.append([name, None, x, y])
    return [[name, line, None, None] for name, lines in outlines.items() for line in lines] + found


def read(path):
    text = read_text(path)
    said, rows = Said(text), Rows(text)
    (line_of, ids, points, data), here = points_of(pathlib.Path(path), rows)
    if points.shape[1] != 2:
        raise Failed("has points in space: facets of TetGen are not read; a mesh has lines in the plane only")
    names = list(data)
    if said.attributes is not None:
        if len(said.attributes) != len(names):
            raise Failed(f"has {counted(len(names), 'attribute')}, but a comment names {len(said.attributes)}")
        data = dict(zip(said.attributes, data.values()))
    plan = Plan()
    plan.take(lines_of(segments(rows, Places(ids, line_of)), said))
    holes = seeds(rows, 3, "holes")
    regions = seeds(rows, 4, "regions") if rows.more() else []
    if rows.more():
        rows.fail(rows.at, f"there is more than {counted(len(regions), 'region')}")
    plan.regions = regions_of(holes, regions, said)
    grid = Grid(points, {}, ids=None if "id" in data else ids, data=data, lines={"points": line_of} if here else {})
    grid.plan, grid.srid = plan, said.srid
    areas = sum(len(numbers) > 3 and numbers[3] > 0 for _, numbers in regions)
    if areas:
        grid.notes.append(f"left out: {counted(areas, 'greatest area', 'greatest areas')} of triangles (a mesh gets no other points than those of the file)")
    if not here:
        grid.notes.append(f"the points were read from {Part(pathlib.Path(path), '.node').path.name}")
    triangles = Part(pathlib.Path(path), ".ele")
    if triangles.exists():
        grid.notes.append(f"the triangles of {triangles.path.name} were not read; name that file to load them")
    return grid
