"""PLY, in text or binary: vertices, and faces as one of several lists that a face may have."""
import numpy

from .grid import Grid
from .psql import Failed
from .words import Words, numbers

suffixes = (".ply",)
TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2", "int": "i4",
         "int32": "i4", "uint": "u4", "uint32": "u4", "int64": "i8", "uint64": "u8", "float": "f4", "float32": "f4", "double": "f8", "float64": "f8"}
FORMATS = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}
KINDS = {1: "vertex", 2: "line", 3: "triangle", 4: "quad"}
MARKER = "marker"
FACES = ("vertex_indices", "vertex_index")


class Property:
    def __init__(self, line, words):
        self.name, self.list = words[-1], words[1] == "list"
        if len(words) != (5 if self.list else 3) or not all(word in TYPES for word in words[2 if self.list else 1: -1]):
            raise Failed(f"line {line}: has a property of an unknown type: {' '.join(words)}")
        self.type = TYPES[words[-2]]
        self.count = TYPES[words[2]] if self.list else None


def head(file):
    """The byte order, the elements: (name, how many, properties), and the lines of the header."""
    if file.readline(16).strip() != b"ply":
        raise Failed("line 1: does not begin with ply")
    order, elements, lines = "", [], 1
    while True:
        line = file.readline(65536)
        lines += 1
        if not line.endswith(b"\n"):
            raise Failed(f"line {lines}: ends within its header")
        words = line.decode(errors="replace").split()
        if not words or words[0] in ("comment", "obj_info"):
            continue
        if words[0] == "end_header":
            break
        if words[0] == "format" and len(words) > 1 and words[1] in FORMATS:
            order = FORMATS[words[1]]
        elif words[0] == "element" and len(words) == 3 and words[2].isdigit():
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property" and elements and len(words) > 2:
            elements[-1][2].append(Property(lines, words))
        else:
            raise Failed(f"line {lines}: has an unknown line in its header: {' '.join(words)}")
    if order == "":
        raise Failed(f"line {lines}: does not say its format")
    return order, elements, lines


class TextRows:
    """The values of an element's rows, from words."""

    def __init__(self, file, lines):
        self.words = Words(file.read().decode(errors="replace"), comments=False, line=lines + 1)

    def fail(self, said):
        self.words.fail(said)

    def values(self, type, count):
        return (self.words.floats if type[0] == "f" else self.words.integers)(count, "its elements")

    def uniform(self, count, row):
        """A table of `count` rows of (type, how many); None where the rows are not all alike."""
        width, begin = sum(many for _, many in row), self.words.at
        table = numpy.array(self.words.take(count * width, "its elements"), dtype=object).reshape(count, width)
        columns, at = [], 0
        for type, many in row:
            part = table[:, at: at + many].reshape(-1).tolist()
            columns.append(numbers(part, float if type[0] == "f" else int, lambda n, at=at, many=many: self.words.line(begin + n // many * width + at + n % many))
                           .reshape(count, many))
            at += many
        return columns

    def place(self):
        return self.words.at

    def back(self, place):
        self.words.at = place


class BinaryRows:
    """The same from bytes."""

    def __init__(self, file, order):
        self.begin, self.bytes, self.order, self.at = file.tell(), file.read(), order, 0

    def fail(self, said):
        raise Failed(f"byte {self.begin + self.at}: {said}")

    def values(self, type, count):
        dtype = numpy.dtype(self.order + type)
        if count * dtype.itemsize > len(self.bytes) - self.at:
            self.fail("the file ends before all of its elements are there")
        found = numpy.frombuffer(self.bytes, dtype, count, self.at)
        self.at += count * dtype.itemsize
        return found

    def uniform(self, count, row):
        dtype = numpy.dtype([(f"f{n}", self.order + type, (many,)) for n, (type, many) in enumerate(row)])
        if count * dtype.itemsize > len(self.bytes) - self.at:
            self.fail("the file ends before all of its elements are there")
        table = numpy.frombuffer(self.bytes, dtype, count, self.at)
        self.at += count * dtype.itemsize
        return [table[f"f{n}"] for n in range(len(row))]

    def place(self):
        return self.at

    def back(self, place):
        self.at = place


def row_of(rows, properties):
    """The values of one row: an array for each property."""
    found = []
    for part in properties:
        count = 1
        if part.list:
            count = int(rows.values(part.count, 1)[0])
            if count < 0:
                rows.fail(f"a list ({part.name}) of {count} numbers")
        found.append(rows.values(part.type, count))
    return found


def element(rows, count, properties):
    """{property: a table of `count` rows}; of a list of several lengths, a list of arrays."""
    if count == 0 or not properties:
        return {part.name: numpy.empty((0, 1)) for part in properties}
    begin = rows.place()
    first = row_of(rows, properties)
    rows.back(begin)
    shape = []
    for part, values in zip(properties, first):
        shape += [(part.count, 1)] if part.list else []
        shape.append((part.type, len(values)))
    try:
        columns = iter(rows.uniform(count, shape))
        found, same = {}, True
        for part, values in zip(properties, first):
            same = same and (not part.list or bool((next(columns) == len(values)).all()))
            found[part.name] = next(columns)
        if same:
            return found
    except (Failed, ValueError):  # shorter rows follow, so it only seems to end early; or words are taken for those of another column
        pass
    rows.back(begin)
    several = [row_of(rows, properties) for _ in range(count)]
    return {part.name: [row[n] for row in several] if part.list else numpy.array([row[n] for row in several]) for n, part in enumerate(properties)}


def faces(grid, face):
    """Gives a grid its cells, and the numbers of faces as their labels."""
    lists = next((face[name] for name in FACES if name in face), None)
    if lists is None:
        raise Failed(f"has no faces with {' or '.join(FACES)}")
    counts = numpy.full(len(lists), lists.shape[1]) if isinstance(lists, numpy.ndarray) else numpy.array([len(corners) for corners in lists])
    if (counts == 0).any():
        raise Failed(f"face {numpy.flatnonzero(counts == 0)[0]}, counted from 0, has no corners")
    for count in numpy.unique(counts).tolist():
        kind, of = KINDS.get(count, f"polygon of {count}"), numpy.flatnonzero(counts == count)
        grid.cells[kind] = lists[of] if isinstance(lists, numpy.ndarray) else numpy.array([lists[n] for n in of.tolist()])
        for name, values in face.items():
            if name not in FACES and isinstance(values, numpy.ndarray) and values.ndim == 2 and values.shape[1] == 1:
                grid.labels[kind, name] = values[of, 0].astype(float)


def edges(grid, edge):
    """Gives a grid its edges, as MeshLab and abacus-export write them."""
    if {"vertex1", "vertex2"} <= set(edge) and len(edge["vertex1"]):
        grid.cells["line"] = numpy.column_stack([edge["vertex1"].reshape(-1), edge["vertex2"].reshape(-1)]).astype(numpy.int64)
        if MARKER in edge and edge[MARKER].dtype.kind in "iu":
            grid.markers["line"] = edge[MARKER].reshape(-1).astype(numpy.int64)


def read(path):
    with open(path, "rb") as file:
        order, elements, lines = head(file)
        rows = TextRows(file, lines) if order is None else BinaryRows(file, order)
    found = {name: element(rows, count, properties) for name, count, properties in elements}
    vertices = found.get("vertex", {})
    if not all(axis in vertices for axis in "xy"):
        raise Failed("has no vertices with x and y")
    axes = [axis for axis in "xyz" if axis in vertices]
    lists = {(name, part.name) for name, _, properties in elements for part in properties if part.list}
    data = {name: values.reshape(-1) for name, values in vertices.items() if name not in axes and ("vertex", name) not in lists}
    grid = Grid(numpy.column_stack([vertices[axis] for axis in axes]), {}, data=data)
    faces(grid, {name: values for name, values in found.get("face", {}).items() if name in FACES or ("face", name) not in lists})
    edges(grid, found.get("edge", {}))
    taken = ("vertex1", "vertex2", MARKER) if grid.markers else ("vertex1", "vertex2") if "line" in grid.cells else ()
    left = [*sorted(f"{name} {part}" for name, part in lists if name in ("vertex", "face") and part not in FACES),
            *(f"edge {name}" for name in found.get("edge", {}) if name not in taken),
            *(name for name in found if name not in ("vertex", "face", "edge"))]
    grid.notes += [f"left out: {', '.join(left)}"] if left else []
    return grid
