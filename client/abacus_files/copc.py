"""COPC: a LAZ file whose chunks are the nodes of an octree. A window, or a spacing, needs only some of them."""
import struct

from .psql import Failed

USER, INFO = "copc", 1
ENTRY = struct.Struct("<4iQii")
PAGE = -1  # in place of a count of points: the entry names another page


class Octree:
    def __init__(self, header):
        record = header.record(USER, INFO)
        if record is None:
            raise Failed("is not a COPC file: --spacing needs the octree that such a file has")
        if len(record) < 56:
            raise Failed(f"byte {header.records[USER, INFO][0]}: the record of COPC has {len(record)} bytes")
        self.header = header
        *self.centre, self.half, self.spacing, self.root, self.length = struct.unpack_from("<5d2Q", record)
        if not (self.half > 0 and self.spacing > 0):
            raise Failed(f"byte {header.records[USER, INFO][0]}: the octree has no size, or no spacing")

    def depth(self, spacing):
        """The deepest level that a spacing needs."""
        level, found = 0, self.spacing
        while found > spacing and level < 64:
            level, found = level + 1, found / 2
        return level

    def meets(self, key, window):
        """Whether a node has a part of the window, to its border."""
        side = 2 * self.half / 2 ** key[0]
        lower = [centre - self.half + at * side for centre, at in zip(self.centre, key[1:3])]
        return all(low <= most and low + side >= least for low, least, most in zip(lower, window[:2], window[2:]))

    def entries(self, at, length):
        if length % ENTRY.size or at + length > self.header.size:
            raise Failed(f"byte {at}: a page of the octree has {length} bytes, but the file ends at byte {self.header.size}")
        self.header.file.seek(at)
        return ENTRY.iter_unpack(self.header.file.read(length))

    def chunks(self, window, spacing):
        """[byte, length, count of points] of each node that is needed, in the order of the file."""
        deepest = self.depth(spacing) if spacing is not None else 64
        pages, seen, found = [(self.root, self.length)], set(), []
        while pages:
            page = pages.pop()
            if page[0] in seen:
                raise Failed(f"byte {page[0]}: two nodes of the octree have one page")
            seen.add(page[0])
            for *key, at, length, count in self.entries(*page):
                if not 0 <= key[0] < 64 or count < PAGE or length < 0:
                    raise Failed(f"byte {page[0]}: a page of the octree has an entry ({'-'.join(map(str, key))}) that cannot be")
                if key[0] > deepest or window is not None and not self.meets(key, window):
                    continue
                if count == PAGE:
                    pages.append((at, length))
                elif count > 0:
                    found.append([at, length, count])
        wrong = next((at for at, length, _ in found if at < self.header.begin or at + length > self.header.size), None)
        if wrong is not None:
            raise Failed(f"byte {wrong}: a node of the octree ends beyond byte {self.header.size}; the file is cut off or damaged")
        return sorted(found)
