# SPDX-License-Identifier: BSD-3-Clause
"""Grids and meshes of all kinds are drawn by "Banyan Volume" as they are: one field in many forms is one picture.

    test_any_mesh.py --plugin Banyan.so --out FOLDER [--reference FOLDER]

With a reference (the folder of a run on one rank) the pictures must be the same: at most 1 of 255.
"""
import os

from paraview import simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

import pictures
import session

EXTENT = [0, 10, 0, 8, 0, 6]
INFORMATION = f"""
executive = self.GetExecutive()
information = executive.GetOutputInformation(0)
information.Set(executive.WHOLE_EXTENT(), {EXTENT}, 6)
information.Set(self.CAN_PRODUCE_SUB_EXTENT(), 1)
"""
# A field on a grid of a kind; its points are bent where BENT is not 0. Each rank has its part of the extent.
GRID = """
import math
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkPoints
executive = self.GetExecutive()
information = executive.GetOutputInformation(0)
extent = [0] * 6
information.Get(executive.UPDATE_EXTENT(), extent)
grid = self.GetOutput()
grid.SetExtent(extent)
across = [range(extent[2 * i], extent[2 * i + 1] + 1) for i in range(3)]
places = [(x, y, z) for z in across[2] for y in across[1] for x in across[0]]
if grid.IsA("vtkRectilinearGrid"):
    for axis, put in zip(across, (grid.SetXCoordinates, grid.SetYCoordinates, grid.SetZCoordinates)):
        array = vtkDoubleArray()
        for at in axis:
            array.InsertNextValue(at)
        put(array)
else:
    points = vtkPoints()
    points.SetDataTypeToDouble()
    for x, y, z in places:
        points.InsertNextPoint(x, y, z + BENT * math.sin(0.4 * x + 0.3 * y))
    grid.SetPoints(points)
values = vtkDoubleArray()
values.SetName("value")
for x, y, z in places:
    values.InsertNextValue(math.sin(0.5 * x) + math.cos(0.6 * y) * math.sin(0.7 * z))
grid.GetPointData().SetScalars(values)
"""


def grid(kind, bent=0.0):
    return simple.ProgrammableSource(Script=GRID.replace("BENT", str(bent)), ScriptRequestInformation=INFORMATION,
                                     OutputDataSetType=kind)


def as_cells(source):
    """The same cells in an unstructured grid."""
    return simple.AppendDatasets(Input=source)


def quadratic(source):
    """Cells with points at the middles of edges, faces and the cell, where the linear ones have them."""
    return simple.ProgrammableFilter(Input=as_cells(source), OutputDataSetType="vtkUnstructuredGrid", Script="""
import math
from vtkmodules.vtkCommonCore import reference, vtkDoubleArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkTriQuadraticHexahedron
data, out = self.GetUnstructuredGridInput(), self.GetUnstructuredGridOutput()
shape = vtkTriQuadraticHexahedron()
places = [shape.GetParametricCoords()[i] for i in range(81)]
points, values = vtkPoints(), vtkDoubleArray()
points.SetDataTypeToDouble()
values.SetName("value")
old = data.GetPointData().GetArray("value")
out.Allocate(data.GetNumberOfCells())
for number in range(data.GetNumberOfCells()):
    cell, ids = data.GetCell(number), []
    for i in range(27):
        place, weights = [0.0] * 3, [0.0] * 8
        cell.EvaluateLocation(reference(0), places[3 * i:3 * i + 3], place, weights)
        value = math.fsum(w * old.GetValue(cell.GetPointId(k)) for k, w in enumerate(weights))
        ids.append(points.InsertNextPoint(place))
        values.InsertNextValue(value)
    out.InsertNextCell(29, 27, ids)
out.SetPoints(points)
out.GetPointData().SetScalars(values)
""")


def draw(source, path, where="POINTS", said="", **options):
    """Draws a mesh with default options but for a low tolerance. Nothing may be said but `said`."""
    window, before = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(window)
    try:
        source.UpdatePipeline()
        view = session.new_view((220, 180))
        display = simple.Show(source, view)
        simple.ColorBy(display, (where, "value"))
        display.SetRepresentationType(session.REPRESENTATION)
        for table in (simple.GetColorTransferFunction("value"), simple.GetOpacityTransferFunction("value")):
            table.RescaleTransferFunction(-2.0, 2.0)
        display.ScalarOpacityUnitDistance = 1.5
        display.ImageErrorTolerance = 0.5
        for name, value in options.items():
            setattr(display, name, value)
        view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [24, -14, 17], [5, 4, 3], [0, 0, 1]
        view.CameraParallelScale = 7.0
        view.StillRender()
        simple.SaveScreenshot(path, view)
        display.UpdatePropertyInformation()
        size = display.GetProperty("MeshBytes").GetElement(0)
    finally:
        vtkOutputWindow.SetInstance(before)
    session.clear()
    picture = pictures.load(path)
    output = window.GetOutput()
    session.require(said in output if said else not output, f"{path}: {output}")
    session.require(picture is None or int(abs(picture.astype(int) - picture[0, 0]).max()) > 60, f"{path} is empty")
    session.require(size > 1000, f"{path} is drawn as a mesh: {size}")


def draw_cell_values(out, reference):
    """Values of cells as means, as VTK makes them of cells of one size, or as they are."""
    def on_cells(kind):
        return simple.PointDatatoCellData(Input=grid(kind, 0.6 if kind == "vtkStructuredGrid" else 0.0))

    def path_of(name):
        return os.path.join(out, name + ".png")

    even = lambda: simple.PointDatatoCellData(Input=as_cells(grid("vtkRectilinearGrid")))
    cases = {
        "means": (lambda: on_cells("vtkStructuredGrid"), {}),
        "kept": (lambda: on_cells("vtkStructuredGrid"), {"CellValues": "As they are"}),
        "even_means": (even, {}),
        "even_kept": (even, {"CellValues": "As they are"}),
    }
    for name, (make, options) in cases.items():
        draw(make(), path_of(name), "CELLS", **options)
        if reference:
            pictures.require_near(path_of(name), os.path.join(reference, name + ".png"))
    for prefix in ("", "even_"):
        error = pictures.difference(pictures.load(path_of(prefix + "kept")).astype(int),
                                    pictures.load(path_of(prefix + "means")).astype(int))
        session.require(error.max() > 20, f"{prefix}kept looks like means: {error.max()}")
    if not reference: # VTK's means know the cells of one rank alone
        draw(simple.CellDatatoPointData(Input=even()), path_of("nodal"))
        pictures.require_near(path_of("even_means"), path_of("nodal"))


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--reference")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    session.begin(arguments)
    # What is drawn, which picture it must be, and by how much it may differ.
    cases = {
        "structured": (lambda: grid("vtkStructuredGrid"), None, 0),
        "rectilinear": (lambda: grid("vtkRectilinearGrid"), "structured", 1),
        "curved": (lambda: grid("vtkStructuredGrid", 0.6), None, 0),
        "curved_cells": (lambda: as_cells(grid("vtkStructuredGrid", 0.6)), "curved", 1),
        "quadratic": (lambda: quadratic(grid("vtkStructuredGrid", 0.6)), "curved", 2),
        "groups": (lambda: simple.GroupDatasets(Input=[grid("vtkStructuredGrid", 0.6)]), "curved", 1),
        # Another field inside of cells, and pieces of ranks are cut otherwise.
        "tetrahedra": (lambda: simple.Tetrahedralize(Input=grid("vtkStructuredGrid", 0.6)), "curved", 10),
    }
    for name, (make, like, allowed) in cases.items():
        path = os.path.join(arguments.out, name + ".png")
        draw(make(), path)
        if like:
            pictures.require_near(path, os.path.join(arguments.out, like + ".png"), allowed)
        if arguments.reference and name != "tetrahedra":
            pictures.require_near(path, os.path.join(arguments.reference, name + ".png"))
    path = os.path.join(arguments.out, "shaded.png")
    draw(as_cells(grid("vtkStructuredGrid", 0.6)), path, Shade=1)
    draw_cell_values(arguments.out, arguments.reference)
    if arguments.reference:
        pictures.require_near(path, os.path.join(arguments.reference, "shaded.png"))
        divided = os.path.join(arguments.out, "by_picture.png")
        draw(as_cells(grid("vtkStructuredGrid", 0.6)), divided, Shade=1, Division="By picture",
             said="'Division' By picture has no effect: cells of a mesh stay on their ranks")
        pictures.require_near(divided, path, 0)


main()
