"""LAS files of every version and point format, made here of whole numbers that a formula gives, so that a test knows what is in them.

The LAZ files in las/ have the same records; las/README.md says how they were made.
"""
import struct

import numpy

EXTRA = 3  # bytes behind each record
COUNT = 137
COLOURS = {2: 3, 3: 3, 5: 3, 7: 3, 8: 4, 10: 4}  # how many
WAVES = (4, 5, 9, 10)  # formats with wave packets, 29 bytes
NEVER_TIMED = (0, 2)
HEADS = {0: 227, 1: 227, 2: 227, 3: 235, 4: 375}


def noise(n, column, below):
    """A whole number from 0 on that looks random, always the same one."""
    return ((n + 1) * 6364136223846793005 + (column + 1) * 1442695040888963407) % 2**64 * 2862933555777941757 % 2**64 * below >> 64


def point(n, format):
    """The nth one, as numbers."""
    long = format >= 6
    returns = 1 + noise(n, 3, 5)
    return {"X": 1000 * (n % 12) + noise(n, 0, 1000) - 6000, "Y": 1000 * (n // 12) + noise(n, 1, 1000), "Z": 20000 + noise(n, 2, 500),
            "intensity": noise(n, 4, 65536), "number_of_returns": returns, "return_number": 1 + noise(n, 5, returns),
            "classification": noise(n, 6, 23 if long else 13), "withheld": noise(n, 7, 9) == 0, "synthetic": noise(n, 8, 2), "user_data": noise(n, 9, 256),
            "angle": noise(n, 10, 5000) - 2500 if long else noise(n, 10, 180) - 90, "point_source_id": noise(n, 11, 65536),
            "gps_time": noise(n, 12, 10**9) / 1024, "colours": [noise(n, 13 + k, 65536) for k in range(COLOURS.get(format, 0))]}


def record(of, format, extra):
    head = struct.pack("<3iH", of["X"], of["Y"], of["Z"], of["intensity"])
    if format < 6:
        flags = of["synthetic"] << 5 | of["withheld"] << 7 | of["classification"]
        data = head + struct.pack("<BBbBH", of["number_of_returns"] << 3 | of["return_number"], flags, of["angle"], of["user_data"], of["point_source_id"])
    else:
        flags = of["synthetic"] | of["withheld"] << 2
        data = head + struct.pack("<BBBBhH", of["number_of_returns"] << 4 | of["return_number"], flags, of["classification"], of["user_data"], of["angle"],
                                  of["point_source_id"])
    if format not in NEVER_TIMED:
        data += struct.pack("<d", of["gps_time"])
    data += struct.pack(f"<{len(of['colours'])}H", *of["colours"])
    return data + (bytes(range(29)) if format in WAVES else b"") + bytes(range(extra))


def variable_record(user, number, data, long=False):
    return struct.pack("<H16sHQ32s" if long else "<H16sHH32s", 0, user.encode(), number, len(data), b"") + data


def las(format, minor=None, count=COUNT, extra=0, scale=(.01, .01, .01), offset=(0, 0, 0), records=(), wkt=False, points=None, compressed=False, body=None,
        long_records=(0, 0), bounds=(0,) * 6):
    """The bytes of a file. `points`: other ones than those of the formula; `body`: in place of their records. `bounds`: greatest and least x, y, z."""
    minor = (4 if format >= 6 else 3 if format >= 4 else 2) if minor is None else minor
    points = [point(n, format) for n in range(count)] if points is None else points
    body = b"".join(record(of, format, extra) for of in points) if body is None else body
    head = bytearray(HEADS[minor])
    head[:4], head[6], head[24:26] = b"LASF", 16 if wkt else 0, bytes([1, minor])
    behind = b"".join(variable_record(*of) for of in records)
    legacy = len(points) if minor < 4 or format < 6 else 0
    struct.pack_into("<HIIBHI", head, 94, len(head), len(head) + len(behind), len(records), format | 0x80 * compressed, len(record(point(0, format), format, extra)), legacy)
    struct.pack_into("<12d", head, 131, *scale, *offset, *bounds)
    if minor == 4:
        struct.pack_into("<QIQ", head, 235, *long_records, len(points))
    return bytes(head) + behind + body


def columns(points, names, format):
    """What attributes of points should be, as arrays."""
    def value(of, name):
        if name in ("red", "green", "blue", "nir"):
            return of["colours"][("red", "green", "blue", "nir").index(name)]
        if name == "scan_angle":
            return of["angle"] * (.006 if format >= 6 else 1)
        return of[name]
    return [numpy.array([value(of, name) for of in points]) for name in names]


HALF, EACH, LEVELS = 6400, 12, 3  # of an octree of nodes: half of its side in whole numbers, points in each node, levels


def nodes():
    """{(level, x, y, z): points of format 7} of an octree, the lowest layer of cells, and of the last level only those that an even number of x and y gives."""
    found, n = {}, 0
    for level in range(LEVELS):
        side = 2 * HALF >> level
        for x in range(1 << level):
            for y in range(1 << level):
                if level == LEVELS - 1 and (x + y) % 2:
                    continue
                found[level, x, y, 0] = []
                for _ in range(EACH):
                    found[level, x, y, 0].append(dict(point(n, 7), X=x * side - HALF + noise(n, 20, side), Y=y * side - HALF + noise(n, 21, side), Z=noise(n, 2, side) - HALF,
                                                      withheld=False))
                    n += 1
    return found
