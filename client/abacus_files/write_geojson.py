"""GeoJSON text sequence (RFC 8142, newline-delimited): a polygon for each triangle, with its ids and the values of its corners.

GDAL and tippecanoe read it line by line. Coordinates are as they are in the mesh; RFC 7946 wants longitudes and latitudes.
"""
import json
import math

from .arrays import MESH, unlike
from .session import Failed

suffixes = (".geojsonl", ".geojsons", ".geojsonseq")


def feature(mesh, names, row, z):
    count = len(mesh.attributes)
    code, ids, rest = row[0], row[1:4], row[4:]
    places = [list(rest[2 * i: 2 * i + 2]) for i in range(3)]
    values = [[None if math.isnan(v) else v for v in rest[6 + i * count: 6 + (i + 1) * count]] for i in range(3)]
    if z is not None:
        for place, value in zip(places, values):
            if value[z] is None:
                raise Failed(f"{mesh.attributes[z]} is missing at some vertices, so it is no third coordinate")
            place.append(value[z])
    properties = {"code": code, **{f"v{i}": v for i, v in enumerate(ids)}}
    for k, name in enumerate(names):
        corners = [value[k] for value in values]
        properties[name] = None if None in corners else sum(corners) / 3
    return {"type": "Feature", "properties": properties, "geometry": {"type": "Polygon", "coordinates": [[*places, places[0]]]}}


def write(mesh, file, z):
    if mesh.dimension != 2:
        raise Failed("GeoJSON has polygons only, no tetrahedra: take .vtu or .npz")
    count = len(mesh.attributes)
    columns = [f"corners[{i + 1}][{k + 1}]" for i in range(3) for k in range(2)]
    columns += [f"coalesce(\"values\"[{i + 1}][{k + 1}], 'NaN')" for i in range(3) for k in range(count)]
    query = f"SELECT code, v0, v1, v2, {', '.join(columns)} FROM abacus_cells({MESH})"
    types = ["int8"] * 4 + ["float8"] * len(columns)
    fields = [f"f{n}" for n in range(len(types))]
    names = unlike(mesh.attributes, ("code", "v0", "v1", "v2"))
    for chunk in mesh.session.chunks(query, types):
        rows = zip(*(chunk[name].tolist() for name in fields))
        file.write("".join(json.dumps(feature(mesh, names, row, z)) + "\n" for row in rows).encode())
