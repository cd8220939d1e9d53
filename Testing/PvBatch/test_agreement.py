# SPDX-License-Identifier: BSD-3-Clause
"""Ranks agree on what they can do with a mesh, also where it is what it was before on some of them only.

    test_agreement.py --plugin Banyan.so --out FOLDER [--reference FOLDER]

With a reference (the folder of a run on one rank) the pictures must be the same: at most 1 of 255.
"""
import os

from paraview import simple

import pictures
import session

STEPS = """
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
piece = info.Get(executive.UPDATE_PIECE_NUMBER()) or 0
pieces = info.Get(executive.UPDATE_NUMBER_OF_PIECES()) or 1
step = int(info.Get(executive.UPDATE_TIME_STEP()) or 0)
def value(place):
    return (0.4 + 0.4 * (place * 7 % 11 / 11)) * (1.0, 1.03, 1.2)[step]
def fill(data, name, values):
    from vtkmodules.vtkCommonCore import vtkDoubleArray
    array = vtkDoubleArray()
    array.SetName(name)
    for one in values:
        array.InsertNextValue(one)
    data.GetCellData().AddArray(array)
"""
INFORMATION = """
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
info.Set(self.CAN_HANDLE_PIECE_REQUEST(), 1)
info.Set(executive.TIME_STEPS(), [0.0, 1.0, 2.0], 3)
info.Set(executive.TIME_RANGE(), [0.0, 2.0], 2)
"""
# In step 2 a cell on the right is cut into eight: on two ranks the first one has the cells that it had.
CUBES = STEPS + """
from vtkmodules.vtkCommonCore import vtkPoints
grid = self.GetUnstructuredGridOutput()
points, values = vtkPoints(), []
grid.Allocate(100)
cubes = [(x, y, z, 2) for x in (0, 2, 4, 6) for y in (0, 2) for z in (0, 2)]
if step == 2:
    cubes = cubes[:-1] + [(x, y, z, 1) for x in (6, 7) for y in (2, 3) for z in (2, 3)]
for number, (x, y, z, edge) in enumerate(cubes):
    if pieces > 1 and (x >= 4) != (piece == 1):
        continue
    ids = [points.InsertNextPoint(x + edge * (i & 1), y + edge * (i >> 1 & 1), z + edge * (i >> 2))
           for i in range(8)]
    grid.InsertNextCell(11, 8, ids)
    values.append(value(number))
grid.SetPoints(points)
fill(grid, "value", values)
"""
# In step 2 another cell of the second tree is the one that is refined: there are as many as before.
TREES = STEPS + """
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkCommonDataModel import vtkHyperTreeGrid, vtkHyperTreeGridNonOrientedCursor
def make():
    grid = vtkHyperTreeGrid()
    grid.Initialize()
    grid.SetDimensions([3, 2, 2])
    grid.SetBranchFactor(2)
    for axis, last in zip("XYZ", (3, 2, 2)):
        places = vtkDoubleArray()
        for i in range(last):
            places.InsertNextValue(4.0 * i)
        getattr(grid, f"Set{axis}Coordinates")(places)
    cursor, values = vtkHyperTreeGridNonOrientedCursor(), []
    for tree in (0, 1):
        if pieces > 1 and tree != piece:
            continue
        grid.InitializeNonOrientedCursor(cursor, tree, True)
        cursor.SetGlobalIndexStart(len(values))
        cursor.SubdivideLeaf()
        cursor.ToChild(5 if tree == 1 and step == 2 else 3)
        cursor.SubdivideLeaf()
        values += [value(100 * tree + i) for i in range(17)]
    fill(grid, "value", values)
    return grid
"""
ONE = TREES + """
self.GetOutputDataObject(0).ShallowCopy(make())
"""
BLOCKS = TREES + """
self.GetOutputDataObject(0).SetBlock(0, make())
"""
# The first block has an array more than the second one.
PARTS = STEPS + """
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
output = self.GetOutputDataObject(0)
output.SetNumberOfBlocks(4)
for block in range(4):
    if pieces > 1 and block % pieces != piece:
        continue
    grid = vtkUnstructuredGrid()
    points = vtkPoints()
    ids = [points.InsertNextPoint(block + (i & 1), i >> 1 & 1, i >> 2) for i in range(8)]
    grid.Allocate(1)
    grid.InsertNextCell(11, 8, ids)
    grid.SetPoints(points)
    fill(grid, "all", [block])
    if block % 2 == 0:
        fill(grid, "some", [block])
    output.SetBlock(block, grid)
"""


def source_of(script, kind):
    if kind == "vtkHyperTreeGrid":
        return simple.ProgrammableFilter(Input=simple.HyperTreeGridRandom(), Script=script,
                                         RequestInformationScript=INFORMATION)
    return simple.ProgrammableSource(Script=script, ScriptRequestInformation=INFORMATION,
                                     OutputDataSetType=kind)


def draw(source, path, strength):
    source.UpdatePipeline(1.0)
    view = session.new_view((200, 200))
    view.ViewTime = 1.0
    display = simple.Show(source, view)
    simple.ColorBy(display, ("CELLS", "value"))
    display.SetRepresentationType(session.REPRESENTATION)
    for table in (simple.GetColorTransferFunction("value"), simple.GetOpacityTransferFunction("value")):
        table.RescaleTransferFunction(0.0, 1.0)
    display.ScalarOpacityUnitDistance = 2.0
    display.SampleDistanceVoxels = 0.5
    display.TemporalEnhancement = strength
    simple.Render(view)  # the first one of all places the camera
    view.CameraPosition = [20.0, -14.0, 12.0]
    view.CameraFocalPoint = [4.0, 2.0, 2.0]
    view.CameraViewUp = [0.0, 0.0, 1.0]
    simple.Render(view)
    simple.SaveScreenshot(path, view)
    simple.Delete(view)
    return pictures.load(path)


def check_motion(arguments):
    """Of the steps 0 and 2 around step 1 only the first has the cells of step 1."""
    drawn = {}
    for name, script, kind in (("cubes", CUBES, "vtkUnstructuredGrid"), ("trees", ONE, "vtkHyperTreeGrid"),
                               ("blocks", BLOCKS, "vtkMultiblockDataSet")):
        source = source_of(script, kind)
        for strength in (0.0, 0.7):
            file = f"{name}_{strength}.png"
            path = os.path.join(arguments.out, file)
            drawn[name, strength] = draw(source, path, strength)
            if arguments.reference:
                pictures.require_near(path, os.path.join(arguments.reference, file))
        session.clear()
    if drawn["cubes", 0.0] is None:
        return  # not on this rank
    for name in ("cubes", "trees", "blocks"):
        most = pictures.difference(drawn[name, 0.0], drawn[name, 0.7]).max()
        session.require(most > 20, f"{name}: motion is not brought out: {most}")
    most = pictures.difference(drawn["trees", 0.7], drawn["blocks", 0.7]).max()
    session.require(most <= 1, f"trees in a block are compared with others: {most} of 255")


def check_arrays():
    octree = simple.BanyanHexOctree(Input=source_of(PARTS, "vtkMultiblockDataSet"))
    octree.UpdatePipeline()
    names = octree.CellData.keys()
    session.require("all" in names and "octree_level" in names and "some" not in names,
                    f"arrays {names}")
    session.clear()


def main():
    parser = session.parser(__doc__)
    parser.add_argument("--out", required=True)
    parser.add_argument("--reference")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    session.begin(arguments)
    check_motion(arguments)
    check_arrays()
    print("Ranks agree.")


main()
