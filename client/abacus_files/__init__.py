"""Meshes of a database as files, and files as meshes: the rooms of abacus-export and abacus-import.

psql.py        psql as a child, which ends when it should
session.py     psql as a stream of rows, in one snapshot
progress.py    a line on the terminal
arrays.py      a mesh as chunks of arrays; octree.py: an octree likewise; series.py: a mesh at the steps of a series
mesh_lines.py  its lines, their markers and its regions; seeds.py: places inside of regions
surfaces.py    surfaces of a mesh in memory; normals.py: their normals
held.py        what a format cannot hold; english.py: numbers of things in messages
formats.py     which writer a file's name asks for
write_*.py     one format each
grid.py        what a reader makes of a file, and the checks of it
plan.py        lines and regions in a file
cell_arrays.py what arrays of cells become: labels and markers
words.py       numbers in text, with their lines; xml_lines.py: XML, likewise; xml_stream.py: XML piece by piece
read_*.py      one format each, read_other.py by meshio; msh_*.py, medit_words.py, vtk_array.py, vtu_pieces.py, xdmf_*.py, poly_words.py and landxml_*.py are parts of them
apart.py       a process for a reader, with limits; apart_points.py: points that it streams
read.py        which reader a file's name asks for
input.py       what abacus_load is given; octree_input.py: what abacus_octree_from_rows is given; plan_input.py: points, lines and regions
point_formats.py  which reader of points a file's name asks for: read_las.py, read_asc.py, read_tiff.py
las_header.py  LAS: its header; las_records.py: its records; classes.py: names of classes; decimals.py: coordinates; epsg.py: codes of coordinate systems
laz.py         LAZ by laz-perf; laz_chunks.py: where its chunks are; laz_coder.py: how the table of them is compressed; copc.py: nodes of an octree
cells.py       cells of a raster as points
copy_rows.py   rows in the binary form of COPY; load_points.py: those into a table, and a mesh
load.py        that into tables, and a mesh; load_plan.py: likewise of points, lines and regions; load_faces.py: with triangles
"""
import os
import sys

try:
    import numpy  # noqa: F401
except ModuleNotFoundError:
    sys.exit(f"{os.path.basename(sys.argv[0])}: numpy is missing (python3-numpy in Debian)")
