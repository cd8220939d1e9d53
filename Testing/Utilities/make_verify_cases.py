# SPDX-License-Identifier: BSD-3-Clause
"""pvpython make_verify_cases.py FOLDER: a small series of .vti files, the same encoded, and copies
of its second file with one value changed, one NaN changed, and an array left out."""

import os
import sys

from paraview import simple
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkIdList, vtkPoints, vtkShortArray
from vtkmodules.vtkCommonDataModel import (VTK_POLYHEDRON, vtkDataSetAttributes, vtkImageData, vtkRectilinearGrid,
                                           vtkStructuredGrid, vtkUnstructuredGrid)
from vtkmodules.vtkIOXML import (vtkXMLImageDataWriter, vtkXMLRectilinearGridWriter, vtkXMLStructuredGridWriter,
                                 vtkXMLUnstructuredGridWriter)

STEPS = 3
NAN, HIDDEN, CHANGED = 17, 40, 55  # numbers of points
CELL = 150


def image_at(step):
    """Two arrays on an extent that does not begin at 0, with a NaN and a hidden point."""
    image = vtkImageData()
    image.SetExtent(-2, 9, 0, 10, 3, 8)
    image.SetSpacing(0.5, 1.0, 2.0)
    image.SetOrigin(1.0, 0.0, -4.0)
    heat, wind = vtkFloatArray(), vtkShortArray()
    heat.SetName("heat")
    wind.SetName("wind")
    wind.SetNumberOfComponents(3)
    for i in range(image.GetNumberOfPoints()):
        heat.InsertNextValue(float("nan") if i == NAN else (i * 37 % 101 + 10 * step) / 7.0)
        wind.InsertNextTuple3(i % 300 - 150, step, 1000 * step)
    image.GetPointData().AddArray(heat)
    image.GetPointData().AddArray(wind)
    return image


def hiding_at(step):
    """One array, with a hidden point, whose value is far from all others, and a hidden cell."""
    image = image_at(step)
    image.GetPointData().RemoveArray("wind")
    image.GetPointData().GetArray("heat").SetValue(HIDDEN, -1e20)
    image.AllocatePointGhostArray()
    image.GetPointGhostArray().SetValue(HIDDEN, vtkDataSetAttributes.HIDDENPOINT)
    image.AllocateCellGhostArray()
    image.GetCellGhostArray().SetValue(CELL, vtkDataSetAttributes.HIDDENCELL)
    return image


def grid_at(step, curvilinear, place=0.0):
    """The values of an image on a grid with points of its own, which move after the first step."""
    grid = vtkStructuredGrid() if curvilinear else vtkRectilinearGrid()
    image = image_at(step)
    grid.SetExtent(image.GetExtent())
    grid.GetPointData().AddArray(image.GetPointData().GetArray("heat"))
    if curvilinear:
        points = vtkPoints()
        points.SetDataTypeToDouble()
        for i in range(image.GetNumberOfPoints()):
            x, y, z = image.GetPoint(i)
            points.InsertNextPoint(x + 0.01 * y * y + (step > 0), y, z - 0.1 * x)
        x, y, z = points.GetPoint(CHANGED)
        points.SetPoint(CHANGED, x, y + place, z)
        grid.SetPoints(points)
        return grid
    for axis, take in enumerate((grid.SetXCoordinates, grid.SetYCoordinates, grid.SetZCoordinates)):
        along = vtkFloatArray()
        for i in range(image.GetDimensions()[axis]):
            along.InsertNextValue(i * i + axis * (step > 0) + (place if i == 3 else 0.0))
        take(along)
    return grid


def cells_at(step, place=0.0, corner=None):
    """A mesh of tetrahedra, a polyhedron and a wedge, whose points move after the first step."""
    grid, points, heat, age = vtkUnstructuredGrid(), vtkPoints(), vtkFloatArray(), vtkFloatArray()
    for i in range(27):
        x, y, z = i % 3, i // 3 % 3, i // 9
        points.InsertNextPoint(x + 0.1 * y * (step > 0) + (place if i == 13 else 0.0), y + 0.2 * z, z - 0.1 * x)
        heat.InsertNextValue((i * 37 % 101 + 10 * step) / 7.0)
    grid.SetPoints(points)
    cells = [(10, [0, 1, 3, 9]), (10, [1, 4, 3, 13]), (13, [4, 5, 7, 13, 14, corner or 16]), (10, [18, 19, 21, 9])]
    for kind, ids in cells:
        grid.InsertNextCell(kind, len(ids), ids)
    faces = vtkIdList()
    for number in (4, 3, 10, 11, 13, 3, 10, 14, 11, 3, 11, 14, 13, 3, 10, 13, 14):
        faces.InsertNextId(number)
    grid.InsertNextCell(VTK_POLYHEDRON, faces)
    for cell in range(grid.GetNumberOfCells()):
        age.InsertNextValue(cell * cell - step)
    heat.SetName("heat")
    age.SetName("age")
    grid.GetPointData().AddArray(heat)
    grid.GetCellData().AddArray(age)
    return grid


def write(image, path):
    writer = {".vtu": vtkXMLUnstructuredGridWriter, ".vti": vtkXMLImageDataWriter, ".vts": vtkXMLStructuredGridWriter,
              ".vtr": vtkXMLRectilinearGridWriter}[os.path.splitext(path)[1]]()
    writer.SetFileName(path)
    writer.SetInputData(image)
    writer.SetDataModeToBinary()  # ParaView of Debian 12 cannot read appended data
    if not writer.Write():
        raise RuntimeError(f"{path} was not written")


def encode(files, path, **options):
    reader = simple.OpenDataFile(files)
    simple.SaveData(path, proxy=reader, WriteTimeSteps=1, ErrorBound=1 / 512, **options)
    if not os.path.isfile(path):
        raise RuntimeError(f"{path} was not written")


def main():
    folder = sys.argv[1]
    simple.LoadPlugin(os.environ["BANYAN_PLUGIN"], ns=vars(simple))
    files = [os.path.join(folder, f"step_{step}.vti") for step in range(STEPS)]
    for step, path in enumerate(files):
        write(image_at(step), path)
    encode(files, os.path.join(folder, "series.banyan"))

    changed = image_at(1)
    changed.GetPointData().GetArray("heat").SetValue(CHANGED, 400.0)
    write(changed, os.path.join(folder, "changed.vti"))
    filled = image_at(1)
    filled.GetPointData().GetArray("heat").SetValue(NAN, 0.0)
    write(filled, os.path.join(folder, "filled.vti"))
    fewer = image_at(1)
    fewer.GetPointData().RemoveArray("wind")
    write(fewer, os.path.join(folder, "fewer.vti"))

    hiding = [os.path.join(folder, f"hiding_{step}.vti") for step in range(2)]
    for step, path in enumerate(hiding):
        write(hiding_at(step), path)
    encode(hiding, os.path.join(folder, "hiding.banyan"), PointArrays=["heat"])
    for name, change in (("bits", lambda image: image.GetPointData().GetArray("heat").SetValue(HIDDEN, 1e20)),
                         ("cells", lambda image: image.GetCellGhostArray().SetValue(CELL, 0)),
                         ("bare", lambda image: image.GetPointData().RemoveArray("vtkGhostType"))):
        image = hiding_at(1)
        change(image)
        write(image, os.path.join(folder, f"hiding_{name}.vti"))

    for curvilinear, name in ((True, ".vts"), (False, ".vtr")):
        grids = [os.path.join(folder, f"grid_{step}{name}") for step in range(STEPS)]
        for step, path in enumerate(grids):
            write(grid_at(step, curvilinear), path)
        encode(grids, os.path.join(folder, f"grid{name}.banyan"))
        write(grid_at(1, curvilinear, 1e-5), os.path.join(folder, "moved" + name))

    meshes = [os.path.join(folder, f"mesh_{step}.vtu") for step in range(STEPS)]
    for step, path in enumerate(meshes):
        write(cells_at(step), path)
    encode(meshes, os.path.join(folder, "mesh.vtu.banyan"))
    write(cells_at(1, 1e-5), os.path.join(folder, "moved.vtu"))
    write(cells_at(1, corner=17), os.path.join(folder, "turned.vtu"))


main()
