"""Where the chunks of a LAZ file are, and how many points each has."""
import struct

from .laz_coder import Decoder, Differences
from .psql import Failed

USER, NUMBER = "laszip encoded", 22204  # of LASzip's record
WHOLE, CHUNKED, LAYERED = 1, 2, 3  # ways of compression
VARIABLE = 0xFFFFFFFF
BYTES, WAVE = 0, (9, 13)  # types of items: extra bytes, and wave packets in short and long records
LATEST = {WHOLE: 2, CHUNKED: 2, LAYERED: 3}  # version of the items of each way
READS = (0, 1, 2, 3, 6, 7, 8)  # point formats that laz-perf reads


def way_of(header):
    """How the file is compressed, and how many points a chunk has."""
    record = header.record(USER, NUMBER)
    if record is None or len(record) < 34:
        raise Failed("is compressed, but has no record of LASzip that says how")
    at = header.records[USER, NUMBER][0]
    way, = struct.unpack_from("<H", record)
    size, = struct.unpack_from("<I", record, 12)
    items, = struct.unpack_from("<H", record, 32)
    if way not in LATEST or len(record) < 34 + 6 * items:
        raise Failed(f"byte {at}: is compressed in a way ({way}) that is not known")
    if header.format not in READS:
        raise Failed(f"byte 104: is compressed and has points of format {header.format} (with wave packets), which laz-perf cannot read; "
                     "decompressed, as LAS, it can be read")
    versions = {struct.unpack_from("<H", record, 34 + 6 * n + 4)[0] for n in range(items)}
    if versions != {LATEST[way]}:
        raise Failed(f"byte {at}: is compressed with items of version {', '.join(map(str, sorted(versions)))}, where laz-perf reads version {LATEST[way]}")
    if way == CHUNKED and size == 0 or header.format >= 6 and way != LAYERED:
        raise Failed(f"byte {at}: is compressed in a way ({way}) that its points of format {header.format} cannot have")
    return way, size


def table(header):
    """The byte at which the table begins, how many chunks it has, and the rest of it."""
    at = header.begin
    for place in header.begin, header.size - 8:  # at the end if the writer could not go back
        header.file.seek(place)
        at, = struct.unpack("<q", header.file.read(8).ljust(8, b"\0"))
        if at != -1:
            break
    if not header.begin + 8 <= at <= header.size - 8:
        raise Failed(f"byte {header.begin}: the table of chunks should be at byte {at}, but the file ends at byte {header.size}: it is cut off or damaged")
    header.file.seek(at)
    version, count = struct.unpack("<II", header.file.read(8))
    if version != 0 or count > header.count:
        raise Failed(f"byte {at}: no table of chunks begins there")
    return at, count, header.file.read()


def chunks(header):
    """[byte, length, count of points] of each."""
    way, size = way_of(header)
    if way == WHOLE:
        return [[header.begin, header.size - header.begin, header.count]]
    end, count, data = table(header)
    numbers = Differences(Decoder(data), 2)
    found, at, left, points, length = [], header.begin + 8, header.count, 0, 0
    try:
        for _ in range(count):
            points = numbers.next(points, 0) if size == VARIABLE else min(size, left)
            length = numbers.next(length, 1)
            found.append([at, length, points])
            at, left = at + length, left - points
    except Failed as error:
        raise Failed(f"byte {end}: {error}") from error
    if at != end or left != 0:
        raise Failed(f"byte {end}: the table of chunks has {header.count - left} points up to byte {at}, but the file has {header.count} up to byte {end}")
    return [chunk for chunk in found if chunk[2]]
