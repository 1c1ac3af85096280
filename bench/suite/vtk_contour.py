#!/usr/bin/python3
"""What VTK's contour filter takes, of a grid of tetrahedra that is in memory.

A program of its own, for the packages of the system's Python. It reads `points.csv` (x, y, z, value) and
`tetrahedra.csv` (numbers of points, in order) in a folder, and prints the samples as JSON.
"""
import json
import pathlib
import sys
import time

import numpy
import vtkmodules.all as vtk
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray


def grid_of(points, tetrahedra):
    grid, places, cells = vtk.vtkUnstructuredGrid(), vtk.vtkPoints(), vtk.vtkCellArray()
    places.SetDataTypeToDouble()
    places.SetData(numpy_to_vtk(numpy.ascontiguousarray(points[:, :3]), deep=True))
    grid.SetPoints(places)
    fours = numpy.column_stack([numpy.full(len(tetrahedra), 4), tetrahedra - tetrahedra.min()])
    cells.SetCells(len(tetrahedra), numpy_to_vtkIdTypeArray(fours.ravel().astype(numpy.int64), deep=True))
    grid.SetCells(vtk.VTK_TETRA, cells)
    grid.GetPointData().SetScalars(numpy_to_vtk(numpy.ascontiguousarray(points[:, 3]), deep=True))
    return grid


def main(folder, runs, value):
    grid = grid_of(numpy.loadtxt(pathlib.Path(folder, "points.csv"), delimiter=","),
                   numpy.loadtxt(pathlib.Path(folder, "tetrahedra.csv"), delimiter=",", dtype=numpy.int64))
    samples = []
    for run in range(runs + 1):
        contour = vtk.vtkContourFilter()
        contour.SetInputData(grid)
        contour.ComputeNormalsOff()
        contour.SetOutputPointsPrecision(vtk.vtkAlgorithm.DOUBLE_PRECISION)
        contour.SetValue(0, value)
        wall, cpu = time.perf_counter(), time.process_time()
        contour.Update()
        sample = {"wall": time.perf_counter() - wall, "cpu": time.process_time() - cpu,
                  "answers": contour.GetOutput().GetNumberOfCells()}
        if run > 0:  # as for Abacus
            samples.append(sample)
    print(json.dumps(samples))


main(sys.argv[1], int(sys.argv[2]), float(sys.argv[3]))
