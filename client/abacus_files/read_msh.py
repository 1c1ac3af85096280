"""Gmsh's .msh, versions 2, 4.0 and 4.1, in text or binary: ids, materials and markers as Gmsh has them. Those of Fluent are meshio's."""
from . import cell_arrays, msh_2, msh_4, msh_data, read_other
from .english import counted
from .grid import Grid
from .msh_elements import Elements, labels_and_markers
from .msh_section import File, is_of_fluent
from .psql import Failed
from .words import Places

suffixes = (".msh",)
SECTIONS = ("Entities", "PartitionedEntities", "Nodes", "Elements", "NodeData", "ElementData", "PhysicalNames")
SILENT = ("GhostElements", "Comments", "InterpolationScheme", "Parametrizations")


def read(path):
    if is_of_fluent(path):
        return read_other.read(path)
    file = File(path)
    ids, points, named, left, elements = None, None, [], [], Elements()
    views, groups = {"NodeData": [], "ElementData": []}, msh_4.Groups(file)
    for name, section in file.sections(SECTIONS):
        if section is None:
            left += [name] if name not in SILENT else []
        elif name.endswith("Entities"):
            groups.read(section, partitioned=name == "PartitionedEntities")
        elif name in views:
            views[name].append(msh_data.view(section))
        elif name == "PhysicalNames":
            named = msh_data.names(section)
        elif name == "Nodes":
            if ids is not None:
                section.fail("$Nodes for the second time")
            ids, points = msh_2.nodes(section) if file.version[0] == "2" else msh_4.nodes(file, section)
        elif file.version[0] == "2":
            msh_2.read_elements(file, section, elements)
        else:
            msh_4.read_elements(file, section, elements, groups)
    if ids is None or not len(ids):
        raise Failed("has no nodes")
    places = Places(ids)
    cells = elements.cells(places)
    data, notes = msh_data.of_nodes(views["NodeData"], places, len(ids))
    labels, markers, several = labels_and_markers(cells)
    if left:
        notes.append(f"left out: {', '.join(dict.fromkeys(left))}")
    if several:
        notes.append(f"left out: all but the first physical group of {counted(several, 'element')} of one dimension less (the first is the marker)")
    grid = Grid(points, {kind: corners for kind, (_, corners, _) in cells.items()}, ids=ids, data=data, labels=labels, markers=markers, groups=named,
                notes=notes)
    cell_arrays.take_labels(grid, msh_data.of_elements(views["ElementData"], cells))
    return grid
