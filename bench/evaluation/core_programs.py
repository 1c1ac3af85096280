"""What programs of bench/ find out about the core alone, over a store in memory: which pages it
asks for, and when (io_trace); how misses are served when links are not stored
(probing_statistics)."""
import dataclasses
import subprocess

import paths
import point_sets

# A trace is kept as the cells of a grid that hold a request.
COLUMNS, ROWS = 250, 200


def output(program, points, cache):
    with points.in_file():
        return subprocess.run([paths.PROGRAMS / program, str(points.dimension), points.file, str(cache)],
                              stdout=subprocess.PIPE, text=True, check=True).stdout


@dataclasses.dataclass
class Probing:
    """Misses, each with nothing known of the neighbour but the shared facet."""
    points: object
    cache: int

    def measure(self, suite):
        sample = {name: int(value) for name, value in
                  (line.split() for line in output("probing_statistics", self.points, self.cache)
                   .splitlines())}
        suite.say(f"{self.points.size:,} points: {sample['misses']:,} misses")
        suite.measurements.append({"what": "probing", **point_sets.labels(self.points),
                                   "cache": self.cache, "samples": [sample]})


@dataclasses.dataclass
class Trace:
    """The requests of pages while points are triangulated."""
    points: object
    cache: int

    def measure(self, suite):
        requests = [Request(*line.split()) for line in
                    output("io_trace", self.points, self.cache).splitlines()]
        seconds = max(request.seconds for request in requests)
        traces = {}
        for request in requests:
            traces.setdefault((request.table, request.kind), []).append(request)
        for (table, kind), found in sorted(traces.items()):
            suite.say(f"{table}: {len(found):,} requests to {kind}")
            blocks = 1 + max(request.block for request in requests if request.table == table)
            suite.measurements.append({
                "what": "trace", **point_sets.labels(self.points), "cache": self.cache,
                "table": table, "kind": kind, "requests": len(found), "seconds": seconds,
                "blocks": blocks, "within": within(found),
                "by_block": cells(found, seconds, lambda request: request.block / blocks),
                "by_place": cells(found, seconds, lambda request: request.place)})


class Request:
    __slots__ = ("seconds", "table", "kind", "block", "place")

    def __init__(self, seconds, table, kind, block, place):
        self.seconds, self.table, self.kind = float(seconds), table, kind
        self.block, self.place = int(block), float(place)


def within(requests):
    """The share of requests whose block is at most so many from that of the request before."""
    steps = [abs(b.block - a.block) for a, b in zip(requests, requests[1:])]
    return {str(far): round(sum(step <= far for step in steps) / len(steps), 4) if steps else None
            for far in (1, 100)}


def cells(requests, seconds, height):
    """The cells of the grid with a request, row after row: `x x x;x;…`."""
    rows = [set() for _ in range(ROWS)]
    for request in requests:
        row = min(ROWS - 1, int(height(request) * ROWS))
        rows[row].add(min(COLUMNS - 1, int(request.seconds / seconds * COLUMNS)))
    return ";".join(" ".join(map(str, sorted(row))) for row in rows)


def places(text):
    """The middles of those cells, from 0 to 1."""
    return [((int(column) + 0.5) / COLUMNS, (row + 0.5) / ROWS)
            for row, columns in enumerate(text.split(";")) for column in columns.split()]
