"""What a mesh has that a format cannot hold."""

from .english import counted


def loss(mesh, ids=True, attributes=True, labels=True, markers=True):
    """Names it. The arguments say what the format holds: all of a thing, or a text about what of it is lost."""
    lost = []
    for what, held, there in (("ids of points", ids, True), (f"attributes of points ({', '.join(mesh.attributes)})", attributes, mesh.attributes),
                              (f"labels of cells ({', '.join(mesh.labels)})", labels, mesh.labels),
                              (f"markers of {counted(mesh.facets, 'facet')}", markers, mesh.facets)):
        if there and held is not True:
            lost.append(held if held else what)
    return lost


def doubles_hold_ids(mesh):
    """Doubles hold whole numbers up to 2^53."""
    least, greatest = mesh.id_range()
    return max(greatest, -least - 1) <= 1 << 53
