"""Parts that time Goose, the dissertation's chapter 2, beside Abacus: the same points, in turns."""
import json

import engines
import server
from points import PointSet


class Goose:
    """Uniform points, as many as the mode says, more each time."""

    def __init__(self, dimension, sizes, runs):
        self.dimension, self.sizes, self.runs = dimension, sizes, runs

    def measure(self, suite):
        if self.dimension == 3:
            server.create_extension("cube")
        for size in self.sizes[suite.mode]:
            points = PointSet(self.dimension, "uniform", size)
            labels = {"dimension": self.dimension, "set": points.name, "points": points.create_table()}
            abacus = {"what": "goose", "engine": "abacus", **labels, "samples": []}
            goose = {"what": "goose", "engine": "goose", **labels, "samples": []}
            for _ in range(self.runs[suite.mode]):
                abacus["samples"].append(engines.Abacus("default").sample(points))
                goose["samples"].append(take_goose(points))
            compare_simplices(self.dimension)
            suite.measurements += [abacus, goose]
            for measurement in abacus, goose:
                sample = measurement["samples"][-1]
                suite.say(f"  {size:9,} points  {measurement['engine']:6} {sample['wall']:9.3f} s"
                          f"   CPU {sample['cpu']:9.3f} s")
            server.drop("mesh", "mesh_vertices", "rows", "points")


def take_goose(points):
    """With what abacus_goose says of it."""
    server.drop("rows")
    server.settle()
    with server.Session() as session:
        sample = session.timed(
            "SELECT json_object_agg(name, value) FROM abacus_goose('rows', 'SELECT id,"
            f" {points.columns} FROM points', dimension => {points.dimension})")
    sample |= json.loads(sample.pop("printed"))
    return sample


def compare_simplices(dimension):
    """Both have made the same."""
    columns = ", ".join(f"v{i}" for i in range(dimension + 1))
    rows, mesh = f"SELECT {columns} FROM rows", f"SELECT {columns} FROM abacus_simplices('mesh')"
    differing = server.query(f"SELECT count(*) FROM (({rows} EXCEPT {mesh}) UNION ALL ({mesh} EXCEPT {rows})) AS d")
    if differing != "0":
        raise server.Failure(f"{differing} simplices differ between Goose and Abacus")
