# SPDX-License-Identifier: BSD-3-Clause
"""A mesh of make_mesh.py as a source of ParaView, which holds it in memory."""

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkStructuredGrid, vtkUnstructuredGrid

ARRAY = "value"
kept = []  # what VTK's arrays refer to


def refer(values, make=numpy_to_vtk):
    """An array of VTK that has no memory of its own."""
    values = numpy.ascontiguousarray(values)
    kept.append(values)
    return make(values)


def grid_of(mesh):
    if "dimensions" in mesh:
        grid = vtkStructuredGrid()
        grid.SetDimensions([int(number) for number in mesh["dimensions"]])
    else:
        cells = vtkCellArray()
        cells.SetData(refer(mesh["offsets"], numpy_to_vtkIdTypeArray), refer(mesh["ids"], numpy_to_vtkIdTypeArray))
        grid = vtkUnstructuredGrid()
        grid.SetCells(refer(mesh["types"]), cells)
    points = vtkPoints()
    points.SetData(refer(mesh["points"]))
    grid.SetPoints(points)
    values = refer(mesh["values"])
    values.SetName(ARRAY)
    grid.GetPointData().SetScalars(values)
    return grid


def make(path):
    """The source, the bounds of the mesh, and range and unit length of the functions."""
    source = simple.TrivialProducer()
    with numpy.load(path) as mesh:
        source.GetClientSideObject().SetOutput(grid_of(mesh))
        functions = mesh["range"].tolist(), float(mesh["unit"])
        bounds = mesh["bounds"].tolist()
    source.UpdatePipeline()
    return source, bounds, *functions
