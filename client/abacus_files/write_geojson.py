"""GeoJSON text sequence (RFC 8142, newline-delimited): a polygon for each triangle, with its ids and the values of its corners.

GDAL and tippecanoe read it line by line. RFC 7946 wants longitudes and latitudes: PostGIS makes them of a mesh that has an SRID.
"""
import json
import math
import sys

from .arrays import no_coordinate, unlike, values_of
from .held import loss
from .psql import Failed

suffixes = (".geojsonl", ".geojsons", ".geojsonseq")
holds = ("labels",)
LONGITUDE_LATITUDE = 4326


class Places:
    """Where the corners of triangles are asked for: SQL of their coordinates, and whether a reader would misplace them."""

    def __init__(self, mesh):
        self.srid = mesh.srid
        self.postgis = mesh.session.texts("SELECT quote_ident(nspname) FROM pg_extension JOIN pg_namespace n ON n.oid = extnamespace WHERE extname = 'postgis'")
        self.projected = bool(self.postgis) and self.srid not in (0, LONGITUDE_LATITUDE)
        self.outside = False

    def columns(self):
        plain = [f"corners[{i + 1}][{k + 1}]" for i in range(3) for k in range(2)]
        return [f"{self.postgis[0]}.ST_{axis}(g{i})" for i in range(3) for axis in "XY"] if self.projected else plain

    def source(self, cells):
        if not self.projected:
            return cells
        of = self.postgis[0]
        corners = ", ".join(f"{of}.ST_Transform({of}.ST_SetSRID({of}.ST_MakePoint(corners[{i + 1}][1], corners[{i + 1}][2]), {self.srid}), "
                            f"{LONGITUDE_LATITUDE}) AS g{i}" for i in range(3))
        return f"(SELECT code, v0, v1, v2, \"values\", labels, {corners} FROM {cells} OFFSET 0) AS projected"

    def seen(self, places):
        self.outside = self.outside or any(abs(x) > 180 or abs(y) > 90 for x, y, *_ in places)

    def say(self):
        """What a user should know of the coordinates that were written."""
        if self.projected:
            said = f"the coordinates were projected from SRID {self.srid} to longitude and latitude"
        elif self.srid not in (0, LONGITUDE_LATITUDE):
            said = (f"the coordinates are those of SRID {self.srid}, but readers of GeoJSON take them as longitude and latitude; "
                    "with the extension postgis in the database they are projected")
        elif self.outside:
            said = ("the coordinates are not longitudes and latitudes, but readers of GeoJSON take them as such; with the extension postgis and "
                    "an SRID of the mesh (abacus_set_srid) they are projected")
        else:
            return
        print(f"abacus-export: {said}", file=sys.stderr)


def number(value):
    """JSON has no infinite numbers."""
    return value if math.isfinite(value) else None


def feature(mesh, names, row, z, projected):
    count = len(mesh.attributes)
    code, ids, rest = row[0], row[1:4], row[4:]
    places = [list(rest[2 * i: 2 * i + 2]) for i in range(3)]
    if not all(map(math.isfinite, rest[:6])):
        raise Failed(f"triangle {ids} cannot be projected to longitude and latitude")
    projected.seen(places)
    values = [[number(v) for v in rest[6 + i * count: 6 + (i + 1) * count]] for i in range(3)]
    if z is not None:
        for place, value in zip(places, values):
            if value[z] is None:
                raise Failed(no_coordinate(mesh.attributes[z]))
            place.append(value[z])
    properties = {"code": code, **{f"v{i}": v for i, v in enumerate(ids)}}
    for k, name in enumerate(names[:count]):
        corners = [value[k] for value in values]
        properties[name] = None if None in corners else number(sum(corners) / 3)
    properties.update(zip(names[count:], map(number, rest[6 + 3 * count:])))
    return {"type": "Feature", "properties": properties, "geometry": {"type": "Polygon", "coordinates": [[*places, places[0]]]}}


def refusal(mesh, z):
    """Why the format cannot have the mesh, or None."""
    if mesh.dimension != 2:
        return "GeoJSON has polygons only, no tetrahedra: use .vtu or .npz"
    if mesh.corners != 3:
        return "GeoJSON of a quadtree is not written: use .vtu, .ply or .obj"
    return None


def write(mesh, file, z):
    places = Places(mesh)
    count = len(mesh.attributes)
    columns = places.columns() + [f"coalesce(\"values\"[{i + 1}][{k + 1}], 'NaN')" for i in range(3) for k in range(count)]
    columns += values_of("labels", len(mesh.labels))
    query = f"SELECT code, v0, v1, v2, {', '.join(columns)} FROM {places.source(mesh.cells_sql)}"
    types = ["int8"] * 4 + ["float8"] * len(columns)
    fields = [f"f{n}" for n in range(len(types))]
    names = unlike(mesh.attributes + mesh.labels, ("code", "v0", "v1", "v2"))
    for chunk in mesh.chunks(query, types):
        rows = zip(*(chunk[name].tolist() for name in fields))
        file.write("".join(json.dumps(feature(mesh, names, row, z, places), allow_nan=False) + "\n" for row in rows).encode())
    places.say()


def lost(mesh, z):
    attributes = f"attributes of points ({', '.join(mesh.attributes)}), of which a triangle has the means" if mesh.attributes else True
    return loss(mesh, attributes=attributes, markers=False)
