"""Results: how they are stored, merged and summed up.

A part of the suite leaves one JSON file:

    {"part": "2d", "mode": "full", "seconds": 240, "machine": {...},
     "measurements": [
        {"what": "build", "engine": "cgal", "dimension": 2, "set": "uniform", "points": 1000000,
         "samples": [{"wall": 0.52, "cpu": 0.52, "memory": 156147712, ...}, ...]},
        ...]}

The labels of a measurement say what was measured; its samples are the runs, with seconds and
bytes. Nothing is summed up before a report is made, so that a report can be made anew in other ways.
Results are the files of all parts in one: {"parts": {"2d": {...}, ...}}.
"""
import json
import statistics

SAME = ("cpu", "cores", "memory_bytes", "kernel", "gpu", "compiler", "flags", "abacus")


class Results:
    """The measurements of several parts."""

    def __init__(self, parts=None):
        self.parts = parts or {}

    @classmethod
    def read(cls, path):
        """Of a file of results; none if there is no such file."""
        if not path.exists():
            return cls()
        return cls(json.loads(path.read_text())["parts"])

    def merge_files(self, folder):
        """Takes in the files of parts in a folder, instead of earlier results of the same parts."""
        for path in sorted(folder.glob("*.json")):
            part = json.loads(path.read_text())
            self.parts[part["part"]] = part
        self.parts = dict(sorted(self.parts.items()))  # in the order in which they are written
        return self

    def write(self, path):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(dump({"parts": self.parts}) + "\n")

    def all(self, **labels):
        """The measurements that have all of these labels."""
        return [measurement for part in self.parts.values() for measurement in part["measurements"]
                if all(measurement.get(key) == value for key, value in labels.items())]

    def groups(self):
        """[(machine, results)] of the parts that were measured on the same machine with the same versions. The
        packages of the machine are those of all these parts."""
        groups = []
        for name, part in self.parts.items():
            about = part["machine"]
            for known, parts in groups:
                if is_same(about, known):
                    known["packages"] |= about["packages"]
                    parts[name] = part
                    break
            else:
                groups.append((about | {"packages": dict(about["packages"])}, {name: part}))
        return [(about, Results(parts)) for about, parts in groups]

    def one(self, **labels):
        """The measurement that has these labels, or None."""
        found = self.all(**labels)
        if len(found) > 1:
            raise LookupError(f"{len(found)} measurements are {labels}")
        return found[0] if found else None

    def median(self, figure, **labels):
        """The median of a figure of that measurement; None if it was not measured."""
        measurement = self.one(**labels)
        return None if measurement is None else median(measurement, figure)


def is_same(machine, other):
    """A package that one of them lacks makes no difference: later parts have more peers."""
    return all(machine.get(key) == other.get(key) for key in SAME) and all(
        other["packages"].get(name, version) == version for name, version in machine["packages"].items())


def write_part(folder, part):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{part['part']}.json").write_text(dump(part) + "\n")


def dump(content, indent=""):
    """JSON in which what holds no list or object takes one line: a sample, for instance."""
    inner = content.values() if isinstance(content, dict) else content
    if not isinstance(content, (dict, list)) or \
            not any(isinstance(value, (dict, list)) for value in inner):
        return json.dumps(content, ensure_ascii=False)
    deeper = indent + " "
    if isinstance(content, dict):
        lines = [f"{deeper}{json.dumps(key)}: {dump(value, deeper)}" for key, value in content.items()]
        return "{\n" + ",\n".join(lines) + f"\n{indent}}}"
    lines = [deeper + dump(value, deeper) for value in content]
    return "[\n" + ",\n".join(lines) + f"\n{indent}]"


def values(measurement, figure):
    return [sample[figure] for sample in measurement["samples"] if sample.get(figure) is not None]


def median(measurement, figure):
    """The median of the runs; None if they don't have the figure."""
    found = values(measurement, figure)
    return statistics.median(found) if found else None


def spread(measurement, figure):
    """(median, least, greatest); None if the runs don't have the figure."""
    found = values(measurement, figure)
    return (statistics.median(found), min(found), max(found)) if found else None


def ratio(dividend, divisor):
    """None if one of them was not measured."""
    return dividend / divisor if dividend is not None and divisor else None
