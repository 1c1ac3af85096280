"""Meshes of a database as files, and files as meshes: the rooms of abacus-export and abacus-import.

session.py    psql as a stream of rows, in one snapshot
arrays.py     a mesh as chunks of arrays
formats.py    which writer a file's name asks for
write_*.py    one format each
read.py       files by way of meshio, into tables
"""
