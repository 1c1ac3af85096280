"""Surfaces of a mesh in memory: a mesh in the plane as terrain; of a mesh in space its border, the borders of what has a label, or isosurfaces."""
import numpy

from .arrays import Mesh, table_of
from .psql import Failed, literal

# Outwards, of a tetrahedron whose corners are in positive orientation.
FACETS = "(VALUES (n1, n2, n3), (n0, n3, n2), (n0, n1, n3), (n0, n2, n1)) AS f (a, b, c)"


class Surface:
    """`points`: n x 3; `triangles`: the numbers of their corners, counterclockwise seen from above, from outside, or from where values are less;
    `values`: n x attributes, NaN where there is none; `of`: what it shows, for programs."""

    def __init__(self, name, points, triangles, values, of):
        self.name, self.points, self.triangles, self.values, self.of = name, points, triangles, values, of


class Surfaces:
    """What is written in place of the mesh. `isosurfaces`: texts ATTRIBUTE=VALUE; `label`: NAME or NAME=VALUE; both may be missing."""

    def __init__(self, mesh, z, isosurfaces=None, label=None):
        if mesh.corners != mesh.dimension + 1:
            raise Failed("surfaces are those of meshes, not of octrees: use .vtu, or .obj for a quadtree")
        if mesh.dimension == 2 and (isosurfaces or label):
            raise Failed("--isosurface and --label are for meshes in space")
        self.mesh, self.attributes = mesh, mesh.attributes
        if mesh.dimension == 2:
            self.parts = [terrain(mesh, z)]
        elif isosurfaces:
            self.parts = [isosurface(mesh, *parsed) for parsed in [assigned(text, mesh.attributes, "attribute") for text in isosurfaces]]
        else:
            self.parts = borders(mesh, *(assigned(label, mesh.labels, "label", may_lack=True) if label else (None, None)))
        self.parts = [part for part in self.parts if len(part.triangles)]
        if not self.parts:
            raise Failed("there is no triangle of this surface in the mesh")

    @property
    def vertices(self):
        return sum(len(part.points) for part in self.parts)

    @property
    def simplices(self):
        return sum(len(part.triangles) for part in self.parts)

    def unheld(self, holds):
        return self.mesh.unheld(holds)


def assigned(text, names, what, may_lack=False):
    """NAME=VALUE; the value may be missing if `may_lack`, and is None then."""
    if may_lack and text in names:
        return text, None
    name, equals, value = text.rpartition("=")
    if equals and name not in names or not equals and may_lack:
        raise Failed(f"the mesh has no {what} {name if equals else text}; it has: {', '.join(names) or 'none'}")
    try:
        if equals and numpy.isfinite(float(value)):
            return name, float(value)
    except ValueError:
        pass
    raise Failed(f"{text} is not the name of an {what}, = and a number" if what[0] in "aeiou" else f"{text} is not the name of a {what}, = and a number")


def terrain(mesh, z):
    points, values = [numpy.empty((0, 3))], [numpy.empty((0, len(mesh.attributes)))]
    for _, coordinates, attributes in mesh.points():
        points.append(mesh.solid(coordinates, attributes, z))
        values.append(attributes)
    triangles = [numpy.empty((0, 3), numpy.int64), *(corners for _, corners, _ in mesh.cells())]
    return Surface(mesh.name, numpy.concatenate(points), numpy.concatenate(triangles), numpy.concatenate(values), {})


def table(session, query, whole, real):
    """All rows of a query of so many whole numbers, and then real ones: two arrays."""
    found = [(table_of(chunk, 0, whole, "<i8"), table_of(chunk, whole, real, "<f8")) for chunk in session.chunks(query, ["int8"] * whole + ["float8"] * real)]
    empty = numpy.empty((0, whole), numpy.int64), numpy.empty((0, real))
    return tuple(numpy.concatenate(arrays) for arrays in zip(empty, *found))


# ---- Isosurfaces -----------------------------------------------------------------------------------------------------------


def isosurface(mesh, attribute, value):
    """Each other attribute is carried along by a query of its own; corners have the same numbers in all of them."""
    surface = f"abacus_isosurface({mesh.sql}, {literal(repr(value))}::float8, {literal(attribute)}"
    places = ", ".join(f"corners[{i}][{axis}]" for i in (1, 2, 3) for axis in (1, 2, 3))
    triangles, corners = table(mesh.session, f"SELECT v0, v1, v2, {places} FROM {surface}) ORDER BY v0, v1, v2", 3, 9)
    points = at_corners(triangles, corners.reshape(-1, 3))
    values = numpy.full((len(points), len(mesh.attributes)), value)
    for n, carried in enumerate(mesh.attributes):
        if carried == attribute:
            continue
        query = (f"SELECT v0, v1, v2, {', '.join(f'''coalesce(values[{i}], 'NaN')''' for i in (1, 2, 3))} FROM {surface}, {literal(carried)}) "
                 "ORDER BY v0, v1, v2")
        numbers, found = table(mesh.session, query, 3, 3)
        values[:, n] = at_corners(numbers, found.reshape(-1, 1))[:, 0]
    return Surface(f"{attribute} = {value:g}", *welded(points, triangles, values), {"attribute": attribute, "value": value})


def at_corners(triangles, rows):
    """A row for each number, from the rows of all corners."""
    table = numpy.empty((triangles.max(initial=-1) + 1, rows.shape[1]))
    table[triangles.ravel()] = rows
    return table


def welded(points, triangles, values):
    """Where the value is exactly that of a vertex, corners on several edges have its place: they become one, and triangles without an area go."""
    rows = numpy.column_stack([points, values]) + 0.0
    keys = numpy.ascontiguousarray(rows).view([("", numpy.void, rows.shape[1] * rows.itemsize)]).ravel()
    _, first, place = numpy.unique(keys, return_index=True, return_inverse=True)
    triangles = first[place][triangles]
    triangles = triangles[(triangles != triangles[:, [1, 2, 0]]).all(axis=1)]
    used, numbers = numpy.unique(triangles, return_inverse=True)
    return points[used], numbers.reshape(-1, 3), values[used]


# ---- Borders -------------------------------------------------------------------------------------------------------------


def borders(mesh, label, value):
    """The facets that are on one side only of the tetrahedra with a value of a label, of each value, or of all tetrahedra."""
    column = "0::float8" if label is None else f"labels[{mesh.labels.index(label) + 1}]"
    wanted = "true" if label is None else f"{column} IS NOT NULL" if value is None else f"{column} = {literal(repr(value))}::float8"
    query = (f"SELECT min(a), min(b), min(c), label FROM (SELECT a, b, c, {column} AS label FROM abacus_numbered_simplices({mesh.sql}), LATERAL {FACETS} "
             f"WHERE {wanted}) AS facets GROUP BY label, least(a, b, c), greatest(a, b, c), a + b + c HAVING count(*) = 1 ORDER BY 4, 1, 2, 3")
    facets, labels = table(mesh.session, query, 3, 1)
    numbers = numpy.unique(facets)
    points, values = vertices(mesh, numbers)
    parts = []
    for found in numpy.unique(labels):
        triangles = facets[labels[:, 0] == found]
        used, corners = numpy.unique(triangles, return_inverse=True)
        at = numpy.searchsorted(numbers, used)
        name, of = (mesh.name, {}) if label is None else (f"{label} {found:g}", {"label": label, "value": float(found)})
        parts.append(Surface(name, points[at], least_first(corners.reshape(-1, 3)), values[at], of))
    return parts


def vertices(mesh, numbers):
    """Places and attributes of vertices with these numbers, which ascend."""
    points, values, begin = [numpy.empty((0, 3))], [numpy.empty((0, len(mesh.attributes)))], 0
    for _, coordinates, attributes in mesh.points():
        end = begin + len(coordinates)
        here = numbers[slice(*numpy.searchsorted(numbers, [begin, end]))] - begin
        points.append(coordinates[here])
        values.append(attributes[here])
        begin = end
    return numpy.concatenate(points), numpy.concatenate(values)


def least_first(triangles):
    """The same triangles, each from its least corner on, in the order of their corners."""
    turned = numpy.take_along_axis(triangles, (triangles.argmin(axis=1)[:, None] + numpy.arange(3)) % 3, axis=1)
    return turned[numpy.lexsort(turned.T[::-1])]
