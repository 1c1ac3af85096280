"""What was read from a file, into a mesh: temporary tables, and abacus_load."""
from . import psql
from .progress import Progress
from .psql import Failed, literal, statement

ROWS = 1 << 14  # are made at once


def wholes(values):
    return map(str, values.tolist())


def reals(values):
    """Numbers as COPY takes them; NaN is NULL."""
    return ["" if value != value else repr(value) for value in values.tolist()]


def table(name, columns, arrays):
    """A temporary table; `arrays`: of each column, how it is written, and its values."""
    yield 0, statement(f"CREATE TEMP TABLE abacus_import_{name} ({', '.join(columns)}) ON COMMIT DROP")
    yield 0, f"COPY abacus_import_{name} FROM STDIN (FORMAT csv);\n"
    count = len(arrays[0][1])
    for begin in range(0, count, ROWS):
        rows = zip(*(write(values[begin: begin + ROWS]) for write, values in arrays))
        yield min(ROWS, count - begin), "\n".join(map(",".join, rows)) + "\n"
    yield 0, "\\.\n"


def texts(names):
    return "ARRAY[" + ", ".join(map(literal, names)) + "]::text[]"


class OctreeScript:
    """The same for an octree."""

    def __init__(self, name, found):
        self.name, self.found = name, found
        self.rows = len(found.codes)

    def pieces(self):
        found = self.found
        corners = ", ".join(f"ARRAY[{', '.join(map(repr, corner.tolist()))}]::float8[]" for corner in (found.lower, found.upper))
        yield 0, "BEGIN;\n"
        yield from table("leaves", ["code bigint", "level integer", *(f"a{n} float8" for n in range(len(found.values)))],
                         [(wholes, found.codes), (wholes, found.levels), *((reals, values) for values in found.values)])
        # one statement, whose answer is the number of leaves
        yield 0, statement(f"SELECT abacus_octree_from_rows(abacus_octree_create({literal(self.name)}, {found.dimension}, {corners}, "
                           f"attributes => {texts(found.names)}), 'TABLE abacus_import_leaves')")
        yield 0, "COMMIT;\n"


class Script:
    """What psql is sent, in pieces of (rows, text). Names and texts come by way of statement(), where psql does not look into them."""

    def __init__(self, mesh, found, groups, retriangulate, split_nodes, inherit=False):
        self.mesh, self.found, self.groups = mesh, found, groups
        self.options = {"retriangulate": retriangulate, "split_nodes": split_nodes, "inherit": inherit}
        self.axes = "xyz"[: found.dimension]
        self.attributes = [f"a{n}" for n in range(len(found.names))]
        self.corners = [f"v{n}" for n in range(found.dimension + 1)]
        self.labels = [f"l{n}" for n in range(len(found.labels))]
        self.rows = len(found.points) + len(found.simplices) + len(found.facets)

    def pieces(self):
        found = self.found
        yield 0, "BEGIN;\n"
        yield from table("points", ["id bigint", *(f"{name} float8" for name in (*self.axes, *self.attributes))],
                              [(wholes, found.ids), *((reals, axis) for axis in found.points.T), *((reals, values) for values in found.values)])
        yield from table("simplices", [*(f"{name} bigint" for name in self.corners), *(f"{name} float8" for name in self.labels)],
                              [*((wholes, found.ids[corner]) for corner in found.simplices.T), *((reals, values) for values in found.labels)])
        yield from table("facets", [*(f"{name} bigint" for name in self.corners[:-1]), "marker integer"],
                              [*((wholes, found.ids[corner]) for corner in found.facets.T), (wholes, found.markers)])
        yield 0, statement(self.load_sql())
        if self.groups is not None:
            yield 0, self.named_groups()
        yield 0, "COMMIT;\n"

    def load_sql(self):
        points = f"SELECT {', '.join(['id', *self.axes, *self.attributes])} FROM abacus_import_points"
        return (f"SELECT abacus_load({literal(self.mesh)}, {literal(points)}, 'TABLE abacus_import_simplices', "
                f"attributes => {texts(self.found.names)}, labels => {texts(self.found.label_names) if self.labels else 'NULL'}, "
                f"facets => {literal('TABLE abacus_import_facets') if len(self.found.facets) else 'NULL'}, "
                f"{', '.join(f'{name} => {str(wanted).lower()}' for name, wanted in self.options.items())})")

    def named_groups(self):
        """A table of the names that the file gives its labels and markers."""
        rows = ", ".join(f"({dimension}, {number}, {literal(name)})" for dimension, number, name in self.found.groups)
        columns = "(dimension integer, number integer, name text, PRIMARY KEY (dimension, number))"
        make = (f"DECLARE made text := (SELECT string_agg(quote_ident(part), '.') FROM unnest(parse_ident({literal(self.groups)})) AS part); "
                f"BEGIN EXECUTE format('CREATE TABLE %s {columns}', made); EXECUTE format('INSERT INTO %s TABLE abacus_import_groups', made); END")
        return (statement(f"CREATE TEMP TABLE abacus_import_groups {columns} ON COMMIT DROP")
                + (statement(f"INSERT INTO abacus_import_groups VALUES {rows}") if rows else "") + statement(f"DO {literal(make)}"))


def load(path, script, database):
    """Makes the mesh; returns the number of its simplices."""
    process = psql.start(database)
    try:
        try:
            with Progress(path, script.rows) as progress:
                for rows, text in script.pieces():
                    data = text.encode(errors="surrogateescape")
                    process.stdin.write(data)
                    progress.add(rows, len(data))
                process.stdin.close()
                progress.say(f"{path}: the server checks the mesh and stores it")
                said = process.stdout.read()
                status = process.wait()
        except BrokenPipeError:
            said, status = b"", process.wait()
    finally:
        psql.end(process)
    if status != 0 or not said.split():
        raise Failed(f"{path}: not loaded")
    return int(said.split()[-1])
