"""What XDMF calls cells: names and numbers."""
# {name of meshio: (name in XDMF, number in a mixed topology, corners)}; a polyline says how many corners it has
KINDS = {"vertex": ("Polyvertex", 1, 1), "line": ("Polyline", 2, 2), "triangle": ("Triangle", 4, 3), "quad": ("Quadrilateral", 5, 4), "tetra": ("Tetrahedron", 6, 4),
         "pyramid": ("Pyramid", 7, 5), "wedge": ("Wedge", 8, 6), "hexahedron": ("Hexahedron", 9, 8), "line3": ("Edge_3", 34, 3),
         "triangle6": ("Triangle_6", 36, 6), "quad8": ("Quadrilateral_8", 37, 8), "tetra10": ("Tetrahedron_10", 38, 10), "hexahedron20": ("Hexahedron_20", 48, 20)}
COUNTED = ("vertex", "line")  # in a mixed topology their number is followed by that of their corners
SHORT = {"tri": "triangle", "tet": "tetrahedron", "quad": "quadrilateral", "hex": "hexahedron", "edge": "edge"}
BY_NUMBER = {number: (kind, corners) for kind, (_, number, corners) in KINDS.items()}


def named(name):
    """(kind, corners) of a name, which may be short, such as Tri_6; None if it is not known."""
    head, _, order = name.lower().partition("_")
    long = SHORT.get(head, head) + ("_" + order if order else "")
    return next(((kind, corners) for kind, (known, _, corners) in KINDS.items() if known.lower() == long), None)
