"""2DM of SMS, the mesh format of hydraulic models, which QGIS reads as a mesh layer."""
import numpy

from .english import counted
from .held import loss

suffixes = (".2dm",)
holds = ("labels",)
MATERIAL = "material"
GREATEST = (1 << 31) - 1


class Material:
    """The label that is written as material: that of this name, or the only one, if its numbers are whole. `at`: its place, or None.
    `missing`: how many triangles have none; they get 0."""

    def __init__(self, mesh):
        self.at = mesh.labels.index(MATERIAL) if MATERIAL in mesh.labels else 0 if len(mesh.labels) == 1 else None
        self.missing = 0
        if self.at is not None:
            whole, self.missing = mesh.of_label(self.at, GREATEST)
            self.at = self.at if whole else None

    def column(self, labels):
        if self.at is None:
            return numpy.ones(len(labels), int)
        return numpy.nan_to_num(labels[:, self.at]).astype(numpy.int64)


def holds_ids(mesh):
    least, greatest = mesh.id_range()
    return least > 0 and greatest <= GREATEST and mesh.ids_differ()


def refusal(mesh, z):
    """Why the format cannot have the mesh, or None."""
    if mesh.dimension != 2:
        return "2DM has triangles and quadrangles only, no tetrahedra: use .vtu or .npz"
    return None


def write(mesh, file, z):
    material = Material(mesh)
    ids = None
    if holds_ids(mesh):
        mesh.will_read(2)
        ids = numpy.concatenate([ids for ids, *_ in mesh.points()] or [[]])
    card = "E3T" if mesh.corners == 3 else "E4Q"
    file.write(b"MESH2D\n" + (b"NUM_MATERIALS_PER_ELEM 1\n" if material.at is not None else b""))
    number = 0
    for _, corners, labels in mesh.cells():
        lines = []
        for row, of in zip((corners + 1 if ids is None else ids[corners]).tolist(), material.column(labels).tolist()):
            number += 1
            lines.append(f"{card} {number} {' '.join(map(str, row))} {of}\n")
        file.write("".join(lines).encode())
    number = 0
    for of, coordinates, values in mesh.points():
        lines = []
        places = mesh.solid(coordinates, values, z).tolist()
        for id_, (x, y, h) in zip(range(number + 1, number + 1 + len(places)) if ids is None else of.tolist(), places):
            lines.append(f"ND {id_} {x!r} {y!r} {h!r}\n")
        number += len(places)
        file.write("".join(lines).encode())


def lost(mesh, z):
    attributes = [name for n, name in enumerate(mesh.attributes) if n != z]
    material = Material(mesh)
    labels = [name for n, name in enumerate(mesh.labels) if n != material.at]
    lost_labels = ([f"labels of cells ({', '.join(labels)})"] if labels else []) + (
        [f"missing values of {mesh.labels[material.at]}: {counted(material.missing, 'triangle gets', 'triangles get')} 0"] if material.at is not None and material.missing else [])
    return loss(mesh, ids=True if holds_ids(mesh) else "ids of points (some are equal, less than 1 or greater than 2147483647)",
                attributes=f"attributes of points ({', '.join(attributes)})" if attributes else True,
                labels="; ".join(lost_labels) or True, markers=False)
