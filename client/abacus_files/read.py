"""Files by way of meshio, into a mesh; 2DM, which meshio does not know, by a few lines of our own."""
import csv
import io
import os
import subprocess

import meshio
import numpy

from .session import Failed


def simplices_of(file_mesh, path):
    """The dimension, and rows of corner numbers; tetrahedra where there are any, else triangles."""
    for kind, dimension in (("tetra", 3), ("triangle", 2)):
        blocks = [block.data for block in file_mesh.cells if block.type == kind]
        if blocks:
            others = sorted({block.type for block in file_mesh.cells} - {"tetra", "triangle", "vertex", "line"})
            if others:
                raise Failed(f"{path}: has cells of other kinds ({', '.join(others)}); only triangles and tetrahedra make a mesh")
            return dimension, numpy.concatenate(blocks)
    raise Failed(f"{path}: has neither triangles nor tetrahedra")


def columns_of(file_mesh, dimension, path):
    """Coordinates, names of the attributes and their values. A plane mesh keeps z as an attribute unless it is 0 everywhere."""
    points = numpy.asarray(file_mesh.points, dtype=float)
    names, values = [], []
    if dimension == 2 and points.shape[1] == 3 and numpy.any(points[:, 2] != 0):
        names.append("z")
        values.append(points[:, 2])
    if points.shape[1] < dimension:
        raise Failed(f"{path}: points have {points.shape[1]} coordinates, {dimension} are needed")
    for name, data in file_mesh.point_data.items():
        if name != "id" and numpy.size(data) == len(points): # vectors and tensors are left out
            names.append(name)
            values.append(numpy.asarray(data, dtype=float).reshape(-1))
    ids = numpy.asarray(file_mesh.point_data.get("id", numpy.arange(len(points))), dtype=numpy.int64).reshape(-1)
    if len(numpy.unique(ids)) != len(ids):
        ids = numpy.arange(len(points))
    return ids, points[:, :dimension], names, values


def identifier(name):
    return '"' + name.replace('"', '""') + '"'


def literal(text):
    return "'" + text.replace("'", "''") + "'"


def script(mesh, dimension, ids, points, names, values, simplices, retriangulate):
    """What psql is sent, line by line."""
    axes = "xyz"[:dimension]
    kinds = "".join(f", {axis} float8" for axis in axes) + "".join(f", {identifier('a_' + name)} float8" for name in names)
    yield "BEGIN;\nSET LOCAL standard_conforming_strings = on;\n"
    yield f"CREATE TEMP TABLE abacus_import_points (id bigint{kinds}) ON COMMIT DROP;\n"
    yield f"CREATE TEMP TABLE abacus_import_simplices ({', '.join(f'v{i} bigint' for i in range(dimension + 1))}) ON COMMIT DROP;\n"
    yield "COPY abacus_import_points FROM STDIN (FORMAT csv);\n"
    for n in range(len(ids)):
        row = io.StringIO()
        rest = ["" if numpy.isnan(column[n]) else repr(float(column[n])) for column in values]
        csv.writer(row, lineterminator="\n").writerow([int(ids[n]), *(repr(float(x)) for x in points[n]), *rest])
        yield row.getvalue()
    yield "\\.\nCOPY abacus_import_simplices FROM STDIN (FORMAT csv);\n"
    for corners in simplices:
        yield ",".join(str(int(ids[n])) for n in corners) + "\n"
    columns = ", ".join(["id", *axes, *(f"{identifier('a_' + name)} AS {identifier(name)}" for name in names)])
    attributes = "ARRAY[" + ", ".join(literal(name) for name in names) + "]::text[]"
    yield "\\.\n"
    yield (f"SELECT abacus_load(:'mesh', {literal(f'SELECT {columns} FROM abacus_import_points')}, 'TABLE abacus_import_simplices', "
           f"attributes => {attributes}, retriangulate => {'true' if retriangulate else 'false'});\nCOMMIT;\n")


def read_2dm(path):
    """The nodes and triangles of a 2DM file."""
    nodes, corners = {}, []
    with open(path, encoding="utf-8", errors="replace") as file:
        for line in file:
            words = line.split()
            if words and words[0] == "ND":
                nodes[int(words[1])] = [float(word) for word in words[2:5]]
            elif words and words[0] == "E3T":
                corners.append([int(word) for word in words[2:5]])
            elif words and words[0] in ("E4Q", "E6T", "E8Q", "E9Q"):
                raise Failed(f"{path}: has {words[0]} cells; only triangles make a mesh")
    place = {number: n for n, number in enumerate(nodes)}
    triangles = numpy.array([[place[n] for n in corner] for corner in corners], dtype=int).reshape(-1, 3)
    return meshio.Mesh(numpy.array(list(nodes.values())), [("triangle", triangles)], point_data={"id": numpy.array(list(nodes))})


def read_file(path):
    try:
        return read_2dm(path) if path.lower().endswith(".2dm") else meshio.read(path)
    except KeyError as error:
        raise Failed(f"{path}: a cell names node {error}, which is not there") from error
    except (meshio.ReadError, OSError, ValueError, IndexError) as error:
        raise Failed(f"{path}: {error}") from error
    except SystemExit as error:  # meshio's way where it cannot go on
        raise Failed(f"{path}: no file that meshio reads") from error


def load(path, mesh, database, retriangulate):
    """Makes the mesh; returns the number of its simplices."""
    file_mesh = read_file(path)
    dimension, simplices = simplices_of(file_mesh, path)
    ids, points, names, values = columns_of(file_mesh, dimension, path)
    command = ["psql", "-X", "-q", "-A", "-t", "-v", "ON_ERROR_STOP=1", "-v", f"mesh={mesh}", *(["-d", database] if database else [])]
    psql = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=None, text=True, env=dict(os.environ, PGCLIENTENCODING="UTF8"))
    try:
        for line in script(mesh, dimension, ids, points, names, values, simplices, retriangulate):
            psql.stdin.write(line)
        said, _ = psql.communicate()
    except BrokenPipeError:
        said = ""
        psql.wait()
    if psql.returncode != 0:
        raise Failed(f"{path}: not loaded")
    return int(said.split()[-1])
