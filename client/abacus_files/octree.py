"""An octree or a quadtree as chunks of arrays, as writers take a mesh: its nodes, and its leaves as hexahedra or quadrangles."""
from .arrays import Mesh, figures, find, table_of, unlike, values_of
from .part import Labelled, Part
from .psql import Failed, literal

# abacus_octree_elements has corners with x fastest; files go around a face.
AROUND = {2: [0, 1, 3, 2], 3: [0, 1, 3, 2, 4, 5, 7, 6]}

FINEST = {2: 31, 3: 21}  # levels


class Octree(Mesh):
    """Its labels are the attributes of leaves and their levels. Attributes of a point are how many anchors it hangs between, and their numbers."""

    facets = 0

    def __init__(self, session, name, progress=None):
        self.session, self.progress = session, progress
        self.sql = f"{literal(name)}::regclass"
        self.dimension, self.simplices, self.finest = figures(session, self.sql, ("dimension", "leaves", "levels"))
        (self.vertices,), = session.all(f"SELECT count(*) FROM abacus_octree_nodes({self.sql})", ["int8"])
        (self.srid,), = session.all(f"SELECT abacus_srid({self.sql})::int8", ["int8"])
        self.corners, self.axes = 1 << self.dimension, "xyz"[: self.dimension]
        self.anchors = 1 << (self.dimension - 1)
        self.attributes = ["hanging", *(f"anchor_{n + 1}" for n in range(self.anchors))]
        self.labels = unlike(session.texts(f"SELECT name FROM abacus_attributes({self.sql}) ORDER BY position"), ("level",)) + ["level"]

    def id_range(self):
        return 0, self.vertices - 1

    def ids_differ(self):
        return True

    def unheld(self, _):
        return ([f"the SRID {self.srid}"] if self.srid > 0 else []) + (
            [f"that its leaves may have the level {self.finest} at most"] if self.finest < FINEST[self.dimension] else [])

    def of_label(self, n, greatest):
        return False, 0

    def points(self):
        """As those of a mesh; ids are the numbers of nodes."""
        anchors = ["coalesce(cardinality(anchors), 0)::float8", *(f"coalesce(anchors[{n + 1}]::float8, 'NaN')" for n in range(self.anchors))]
        query = f"SELECT {', '.join(['node', *(f'point[{n + 1}]' for n in range(self.dimension)), *anchors])} FROM abacus_octree_nodes({self.sql})"
        for chunk in self.chunks(query, ["int8"] + ["float8"] * (self.dimension + len(anchors))):
            yield (chunk["f0"].astype("<i8"), table_of(chunk, 1, self.dimension, "<f8"), table_of(chunk, 1 + self.dimension, len(anchors), "<f8"))

    def cells(self):
        labels = values_of("attributes", len(self.labels) - 1) + ["level::float8"]
        query = (f"SELECT {', '.join(['code', *(f'nodes[{n + 1}]' for n in AROUND[self.dimension]), *labels])} FROM abacus_octree_elements({self.sql})")
        for chunk in self.chunks(query, ["int8"] * (1 + self.corners) + ["float8"] * len(labels)):
            yield (chunk["f0"].astype("<i8"), table_of(chunk, 1, self.corners, "<i8"), table_of(chunk, 1 + self.corners, len(labels), "<f8"))


def opened(session, name, region=None, labels=False):
    """A mesh, a region of one, or an octree. `labels`: whether a file can say of triangles in which region they are."""
    find(session, name)
    leaves, = figures(session, f"{literal(name)}::regclass", ("leaves",))
    if region is not None:
        if leaves >= 0:
            raise Failed("--within is for meshes in the plane")
        return Part(session, name, region)
    if leaves >= 0:
        return Octree(session, name)
    mesh = Mesh(session, name)
    return Labelled(session, name) if labels and mesh.region_names() else mesh
