"""LandXML 1.2: a surface with points and faces, lines as breaklines, borders of regions as boundaries. Northing comes before easting."""
import datetime
from fractions import Fraction
from xml.sax.saxutils import quoteattr

import numpy

from .held import loss
from .landxml_words import NAMESPACE, UNITS, feature
from .mesh_lines import Corners, regions
from .psql import Failed, literal

suffixes = (".landxml", ".xml")
holds = ("lines", "regions", "srid")


def unit_of(mesh):
    """The unit of the coordinates, as PROJ calls it, where PostGIS knows it; else metres."""
    schema = mesh.session.texts("SELECT quote_ident(nspname) FROM pg_extension JOIN pg_namespace n ON n.oid = extnamespace WHERE extname = 'postgis'")
    found = mesh.session.texts(f"SELECT substring(proj4text FROM '\\+units=(\\S+)') FROM {schema[0]}.spatial_ref_sys "
                               f"WHERE srid = {mesh.srid} AND proj4text ~ '\\+units='") if schema and mesh.srid > 0 else []
    return found[0] if found and found[0] in UNITS else "m"


def head(mesh):
    system, linear, area, volume, others = UNITS[unit_of(mesh)]
    now = datetime.datetime.now(datetime.timezone.utc)
    return (f'<?xml version="1.0" encoding="UTF-8"?>\n<LandXML xmlns="{NAMESPACE}" version="1.2" date="{now:%Y-%m-%d}" time="{now:%H:%M:%S}">\n'
            f'<Units><{system} linearUnit="{linear}" areaUnit="{area}" volumeUnit="{volume}" {others}/></Units>\n'
            + (f'<CoordinateSystem epsgCode="{mesh.srid}"/>\n' if mesh.srid > 0 else ""))


def breaklines(mesh, z):
    """A Breakline for each line, or for each of its parts."""
    corners = Corners(mesh, z)
    begins = corners.begins().tolist()
    for begin, end in zip(begins, [*begins[1:], len(corners.line)]):
        heights = [] if z is None else [corners.values[begin:end]]
        places = numpy.column_stack([corners.places[begin:end, ::-1], *heights])
        width = places.shape[1]
        part = corners.part[begin]
        yield (f'<Breakline brkType="standard" name="{corners.line[begin]}"><PntList{width}D>{" ".join(map(repr, places.reshape(-1).tolist()))}</PntList{width}D>'
               f"{feature(kind='soft' if corners.soft[begin] else None, part=None if part < 0 else part)}</Breakline>\n")


def rings(mesh, region):
    """The rings of a region's border, as places; those around holes turn clockwise."""
    found = {}
    for ring, x, y in mesh.session.all(f"SELECT ring, x, y FROM abacus_hull({mesh.sql}, within => {literal(region)}) ORDER BY ring, position", ["int8", "float8", "float8"]):
        found.setdefault(ring, []).append((x, y))
    return [numpy.array([*places, places[0]]) for places in found.values()]


def is_void(ring):
    """Whether it turns clockwise, exactly."""
    places = [tuple(map(Fraction, place)) for place in ring.tolist()]
    return sum(ax * by - bx * ay for (ax, ay), (bx, by) in zip(places, places[1:])) < 0


def plain(name):
    """A name that XML can hold."""
    if any(c < " " and c not in "\t\n\r" for c in name):
        raise Failed(f"the name {name!r} has characters that XML cannot hold")
    return name


def boundaries(mesh):
    kept = set(mesh.session.texts(f"SELECT DISTINCT line::text FROM {mesh.lines()} AS l"))
    for name, _, lines, seeds in regions(mesh):
        of = {} if not kept.issuperset(map(str, lines)) or seeds and mesh.within else {"lines": " ".join(map(str, lines))} if lines else {"seeds": " ".join(repr(value) for seed in seeds for value in seed)}
        for ring in rings(mesh, name):
            yield (f'<Boundary bndType="{"void" if is_void(ring) else "outer"}" edgeTrim="true" name={quoteattr(plain(name))}>'
                   f'<PntList2D>{" ".join(map(repr, ring[:, ::-1].reshape(-1).tolist()))}</PntList2D>{feature(**of)}</Boundary>\n')
            of = {"lines": ""} if of else of  # those of the first ring are those of the region


def element(name, parts):
    """An element around others, or nothing."""
    text = "".join(parts)
    return f"<{name}>\n{text}</{name}>\n" if text else ""


def ids_held(mesh):
    least, _ = mesh.id_range()
    return least > 0 and mesh.ids_differ()


def write_points(mesh, file, z, by_ids):
    """Returns the ids of the points, if the file has them."""
    number, kept = 0, []
    for ids, coordinates, values in mesh.points():
        places = mesh.solid(coordinates, values, z)[:, [1, 0, 2]].tolist()
        names = ids.tolist() if by_ids else range(number + 1, number + 1 + len(places))
        file.write("".join(f'<P id="{name}">{n!r} {e!r} {h!r}</P>\n' for name, (n, e, h) in zip(names, places)).encode())
        number += len(places)
        kept += [ids] if by_ids else []
    return numpy.concatenate(kept or [[]]) if by_ids else None


def refusal(mesh, z):
    """Why the format cannot have the mesh, or None."""
    if mesh.dimension != 2 or mesh.corners != 3:
        return "LandXML has surfaces of triangles only: use .vtu or .npz"
    if mesh.within and not mesh.is_region():
        return "LandXML has the border of a region, so --within is the name of a region here; other formats take a polygon"
    return None


def write(mesh, file, z):
    file.write(head(mesh).encode())
    file.write(f"<Surfaces><Surface name={quoteattr(plain(mesh.name))}>\n".encode())
    file.write(element("SourceData", [element("Boundaries", boundaries(mesh)), element("Breaklines", breaklines(mesh, z))]).encode())
    file.write(b'<Definition surfType="TIN">\n<Pnts>\n')
    ids = write_points(mesh, file, z, ids_held(mesh))
    file.write(b"</Pnts>\n<Faces>\n")
    for _, corners, _ in mesh.cells():
        file.write("".join("<F>%d %d %d</F>\n" % tuple(row) for row in (corners + 1 if ids is None else ids[corners]).tolist()).encode())
    file.write(f"</Faces>\n</Definition>\n{feature(z=None if z is None else mesh.attributes[z])}</Surface></Surfaces>\n</LandXML>\n".encode())


def lost(mesh, z):
    attributes = [name for n, name in enumerate(mesh.attributes) if n != z]
    return loss(mesh, ids=ids_held(mesh) or "ids of points (some are equal, or less than 1)", labels=False, markers=False,
                attributes=f"attributes of points ({', '.join(attributes)})" if attributes else True)
