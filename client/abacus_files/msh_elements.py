"""The elements of Gmsh's .msh: corners, numbers and physical groups by kind."""
import numpy

# {number of Gmsh: (name of meshio, corners)}
KINDS = {1: ("line", 2), 2: ("triangle", 3), 3: ("quad", 4), 4: ("tetra", 4), 5: ("hexahedron", 8), 6: ("wedge", 6), 7: ("pyramid", 5), 8: ("line3", 3),
         9: ("triangle6", 6), 10: ("quad9", 9), 11: ("tetra10", 10), 12: ("hexahedron27", 27), 13: ("wedge18", 18), 14: ("pyramid14", 14),
         15: ("vertex", 1), 16: ("quad8", 8), 17: ("hexahedron20", 20), 18: ("wedge15", 15), 19: ("pyramid13", 13), 20: ("triangle9", 9),
         21: ("triangle10", 10), 22: ("triangle12", 12), 23: ("triangle15", 15), 24: ("triangle15", 15), 25: ("triangle21", 21), 26: ("line4", 4),
         27: ("line5", 5), 28: ("line6", 6), 29: ("tetra20", 20), 30: ("tetra35", 35), 31: ("tetra56", 56), 92: ("hexahedron64", 64),
         93: ("hexahedron125", 125)}
MATERIAL = "material"


def kind_of(section, number):
    if number not in KINDS:
        section.fail(f"elements of Gmsh's type {number}, which is not known")
    return KINDS[number]


def padded(groups):
    """Tables of groups as one; 0 where an element has fewer."""
    width = max(part.shape[1] for part in groups)
    return numpy.concatenate([numpy.pad(part, ((0, 0), (0, width - part.shape[1]))) for part in groups])


class Elements:
    def __init__(self):
        self.parts, self.count = {}, 0

    def add(self, kind, numbers, corners, groups, lines_of):
        """Elements of a kind; `groups`: a table with a row for each, whose signs are directions, 0: none. lines_of(n): the line of the nth corner."""
        self.parts.setdefault(kind, []).append((numbers, corners, numpy.abs(groups), lines_of))
        self.count += len(corners)

    def check(self, section, wanted):
        if self.count != wanted:
            section.fail(f"${section.name} says that it has {wanted} elements, but has {self.count}")

    def cells(self, places):
        """{kind: (numbers, corners, groups)}"""
        found = {}
        for kind, parts in self.parts.items():
            corners = numpy.concatenate([places.of(corners, lines_of) for _, corners, _, lines_of in parts])
            found[kind] = once(numpy.concatenate([numbers for numbers, *_ in parts]), corners, padded([groups for _, _, groups, _ in parts]))
        return found


def once(numbers, corners, groups):
    """Format 2 has an element once for each of its groups; so those with the same corners and other groups are one with several."""
    _, first, place = numpy.unique(numpy.sort(corners, axis=1), axis=0, return_index=True, return_inverse=True)
    if len(first) == len(corners):
        return numbers, corners, groups
    owner = first[place.reshape(-1)]
    sets = {}
    kept = []
    for n, at in enumerate(owner.tolist()):
        group = int(groups[n, 0])
        if at == n or group in sets[at]:  # given twice, which abacus_load refuses
            kept.append(n)
            sets.setdefault(at, []).append(group)
        else:
            sets[at].append(group)
    table = numpy.zeros((len(kept), max(map(len, sets.values()))), numpy.int64)
    for row, n in enumerate(kept):
        of = sets[n] if n in sets else [int(groups[n, 0])]
        table[row, : len(of)] = of
    return numbers[kept], corners[kept], table


def labels_and_markers(cells):
    """The groups of simplices as labels `material`, `material_2` ..., those of facets as markers; and what is left out."""
    labels, markers, left = {}, {}, 0
    facet = "triangle" if any(kind.startswith("tetra") for kind in cells) else "line"
    for kind, (_, _, groups) in cells.items():
        for k in range(groups.shape[1]):
            if groups[:, k].any():
                labels[kind, MATERIAL if k == 0 else f"{MATERIAL}_{k + 1}"] = groups[:, k].astype(float)
        markers[kind] = groups[:, 0]
        left += int((groups[:, 1:] != 0).any(axis=1).sum()) if kind.startswith(facet) else 0
    return labels, markers, left
