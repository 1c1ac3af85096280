"""Meshes of a database as files, and files as meshes: the rooms of abacus-export and abacus-import.

psql.py        psql as a child, which ends when it should
session.py     psql as a stream of rows, in one snapshot
arrays.py      a mesh as chunks of arrays
formats.py     which writer a file's name asks for
write_*.py     one format each
grid.py        what a reader makes of a file, and the checks of it
read_*.py      one format each, read_other.py by meshio; words.py, vtk_array.py and msh_section.py are parts of them
apart.py       a process for a reader, with limits
read.py        which reader a file's name asks for, and what abacus_load is given
load.py        that into tables, and a mesh
"""
