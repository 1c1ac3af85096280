"""The EPSG code of a coordinate system: of the horizontal part, if it has a vertical one, too. GDAL, if it is installed, finds the code of a system that does not
say it, as in the files of ESRI."""
import re
import struct

PROJECTED, GEOGRAPHIC = 3072, 2048  # keys of GeoTIFF
USER_DEFINED = 32767
GREATEST = 999999  # that a mesh takes as its SRID
SURE = 90  # of 100: as GDAL has it, all but the name is the same
TOKEN = re.compile(r'"((?:[^"]|"")*)"|([A-Za-z_]\w*)\s*[\[(]|([\])])|([^\s,\[\]()"]+)')
SYSTEM = re.compile("(PROJ|GEOG|GEOD|ENG|LOCAL)[A-Z]*(CS|CRS)|GEOGRAPHICCRS|GEODETICCRS|PROJECTEDCRS", re.IGNORECASE)
WRAPPERS = ("COMPD_CS", "COMPOUNDCRS", "BOUNDCRS", "SOURCECRS")


def of_keys(directory):
    """That of the keys of GeoTIFF, which are groups of four numbers; 0 if they have none."""
    numbers = struct.unpack(f"<{len(directory) // 2}H", directory[: len(directory) // 2 * 2])
    keys = {numbers[at]: numbers[at + 3] for at in range(4, len(numbers) - 3, 4) if numbers[at + 1] == 0}
    for key in PROJECTED, GEOGRAPHIC:
        if key in keys:
            return keys[key] if 0 < keys[key] < USER_DEFINED else 0
    return 0


def tree(wkt):
    """The nodes of a text, each as [keyword, texts and nodes in it]."""
    top = ["", []]
    path = [top]
    for quoted, keyword, closing, plain in TOKEN.findall(wkt):
        if keyword:
            node = [keyword.upper(), []]
            path[-1][1].append(node)
            path.append(node)
        elif closing:
            if len(path) > 1:
                path.pop()
        else:
            path[-1][1].append(quoted or plain)
    return top


def code_of(node):
    """The EPSG code that a node has itself, or 0."""
    for child in node[1]:
        if isinstance(child, list) and child[0] in ("AUTHORITY", "ID"):
            texts = [text for text in child[1] if isinstance(text, str)]
            if len(texts) >= 2 and texts[0].upper() == "EPSG" and texts[1].isdecimal() and int(texts[1]) <= GREATEST:
                return int(texts[1])
    return 0


def of_wkt(wkt):
    """(that of WKT, version 1 or 2, or 0; the name of the system). If only the whole of a horizontal and a vertical system has one, it is that."""
    node, whole = tree(wkt), 0
    while node[0] in ("", *WRAPPERS):
        node = next((child for child in node[1] if isinstance(child, list) and (child[0] in WRAPPERS or SYSTEM.fullmatch(child[0]))), None)
        if node is None:
            return 0, ""
        whole = whole or code_of(node)
    return code_of(node) or whole or matching(wkt), next((text for text in node[1] if isinstance(text, str)), "")


def matching(wkt):
    """That of the one system that GDAL takes for the same; 0 if there is none, or several."""
    try:
        from osgeo import osr
    except ImportError:
        return 0
    osr.UseExceptions()
    try:
        system = osr.SpatialReference()
        system.ImportFromWkt(wkt)
        found = {match.GetAuthorityCode(None) for match, confidence in system.FindMatches() if confidence >= SURE and match.GetAuthorityName(None) == "EPSG"}
    except RuntimeError:  # it is not one that GDAL knows
        return 0
    return int(found.pop()) if len(found) == 1 else 0


def unknown(name):
    """What a user should know of a system without a code."""
    return f"its coordinate system{f' ({name})' if name else ''} has no EPSG code: the mesh has no SRID unless abacus_set_srid gives it one"
