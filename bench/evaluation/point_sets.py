"""The dissertation's data sets: random points of a square, and earthquake models."""
import server
from points import PointSet

# Bytes of disk for each point while a mesh is made from it: its row in the table of points, the vertex table, the simplex table
# (the spools of staging are gone by then); and the rest, mostly WAL.
BYTES_A_POINT = {2: 115, 3: 200}
BYTES_BESIDES = 4 << 30

# How many points abacus_quake returns at the measured frequencies (docs/lab.md).
QUAKE_POINTS = {0.05: 31916, 0.1: 131692, 0.25: 1016926, 0.5: 6027713, 0.75: 20214375, 1: 40131510,
                1.5: 143764696, 1.85: 221962206}


def uniform(size):
    """So many random points, in no order."""
    return PointSet(2, "uniform", size)


class Quake(PointSet):
    """The earthquake model for waves of a frequency, in the octree's Z-order."""

    def __init__(self, frequency):
        super().__init__(3, "quake", QUAKE_POINTS[frequency])
        self.frequency = frequency

    def create_table(self):
        """From abacus_quake, which is quicker than the search for a set of so many points."""
        server.drop("points", "mesh", "mesh_vertices")
        server.query(f"CREATE TABLE points AS SELECT id, x, y, z FROM"
                     f" (SELECT (abacus_quake({self.frequency})).*) AS model")
        server.query("VACUUM (FREEZE, ANALYZE) points")
        return int(server.query("SELECT count(*) FROM points"))


def labels(points):
    """What tells the measurements of a set from those of others."""
    found = {"dimension": points.dimension, "set": points.name, "points": points.size}
    if isinstance(points, Quake):
        found["frequency"] = points.frequency
    return found


def require_disk(points):
    """Room for a mesh of the points."""
    server.require_disk(BYTES_A_POINT[points.dimension] * points.size + BYTES_BESIDES)
