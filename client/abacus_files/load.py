"""What was read from a file, into a mesh: temporary tables, and abacus_load."""
import csv
import io

import numpy

from . import psql
from .arrays import unlike
from .psql import Failed, literal, statement

MATERIAL = "material"


def table(name, columns):
    return statement(f"CREATE TEMP TABLE {name} ({', '.join(columns)}) ON COMMIT DROP") + f"COPY {name} FROM STDIN (FORMAT csv);\n"


def script(mesh, found, retriangulate, split_nodes):
    """What psql is sent, line by line. Names and texts come by way of statement(), where psql does not look into them."""
    axes = "xyz"[: found.dimension]
    attributes = [f"a{n}" for n in range(len(found.names))]
    corners = [f"v{n}" for n in range(found.dimension + 1)]
    labels = unlike([MATERIAL], found.names) if found.materials is not None else []
    yield "BEGIN;\n"
    yield table("abacus_import_points", ["id bigint", *(f"{name} float8" for name in (*axes, *attributes))])
    for n, id_ in enumerate(found.ids.tolist()):
        row = io.StringIO()
        rest = ["" if numpy.isnan(column[n]) else repr(float(column[n])) for column in found.values]
        csv.writer(row, lineterminator="\n").writerow([id_, *map(repr, found.points[n].tolist()), *rest])
        yield row.getvalue()
    yield "\\.\n" + table("abacus_import_simplices", [*(f"{name} bigint" for name in corners), *(f"{name} float8" for name in labels)])
    for n, row in enumerate(found.ids[found.simplices].tolist()):
        material = [str(found.materials[n] or "")] if labels else []
        yield ",".join([*map(str, row), *material]) + "\n"
    yield "\\.\n" + table("abacus_import_facets", [*(f"{name} bigint" for name in corners[:-1]), "marker integer"])
    for row, marker in zip(found.ids[found.facets].tolist(), found.markers.tolist()):
        yield ",".join(map(str, [*row, marker])) + "\n"
    yield "\\.\n"

    def texts(names):
        return "ARRAY[" + ", ".join(map(literal, names)) + "]::text[]"

    points = f"SELECT {', '.join(['id', *axes, *attributes])} FROM abacus_import_points"
    yield statement(f"SELECT abacus_load({literal(mesh)}, {literal(points)}, "
                    f"'TABLE abacus_import_simplices', attributes => {texts(found.names)}, labels => {texts(labels) if labels else 'NULL'}, "
                    f"facets => {literal('TABLE abacus_import_facets') if len(found.facets) else 'NULL'}, "
                    f"retriangulate => {'true' if retriangulate else 'false'}, split_nodes => {'true' if split_nodes else 'false'})")
    yield "COMMIT;\n"


def load(path, found, mesh, database, retriangulate, split_nodes):
    """Makes the mesh; returns the number of its simplices."""
    process = psql.start(database)
    try:
        try:
            for line in script(mesh, found, retriangulate, split_nodes):
                process.stdin.write(line.encode(errors="surrogateescape"))
            process.stdin.close()
            said = process.stdout.read()
            status = process.wait()
        except BrokenPipeError:
            said, status = b"", process.wait()
    finally:
        psql.end(process)
    if status != 0 or not said.split():
        raise Failed(f"{path}: not loaded")
    return int(said.split()[-1])
