# SPDX-License-Identifier: BSD-3-Clause
"""A hyper tree grid that is refined at random, and the same on any number of ranks.

ParaView's own HyperTreeGridRandom makes other trees in each piece since ParaView 5.13.
"""
from paraview import simple

SCRIPT = """
import random
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkCommonDataModel import vtkHyperTreeGrid, vtkHyperTreeGridNonOrientedCursor
executive = self.GetExecutive()
info = executive.GetOutputInformation(0)
piece = info.Get(executive.UPDATE_PIECE_NUMBER()) or 0
pieces = info.Get(executive.UPDATE_NUMBER_OF_PIECES()) or 1
cells, edge = {cells!r}, {edge!r}
grid = vtkHyperTreeGrid()
grid.Initialize()
grid.SetDimensions([n + 1 for n in cells])
grid.SetBranchFactor(2)
for axis, n in zip("XYZ", cells):
    places = vtkDoubleArray()
    for i in range(n + 1):
        places.InsertNextValue(edge * i)
    getattr(grid, "Set" + axis + "Coordinates")(places)
depths = vtkDoubleArray()
depths.SetName("Depth")
def refine(cursor, chance, depth):
    depths.InsertValue(cursor.GetGlobalNodeIndex(), depth)
    if depth == {depth!r} or chance.random() > 0.6:
        return
    cursor.SubdivideLeaf()
    for child in range(8):
        cursor.ToChild(child)
        refine(cursor, chance, depth + 1)
        cursor.ToParent()
cursor, trees = vtkHyperTreeGridNonOrientedCursor(), cells[0] * cells[1] * cells[2]
for tree in range(trees):
    if tree * pieces // trees == piece:
        grid.InitializeNonOrientedCursor(cursor, tree, True)
        cursor.SetGlobalIndexStart(depths.GetNumberOfTuples())
        refine(cursor, random.Random(tree), 0)
grid.GetCellData().AddArray(depths)
self.GetOutputDataObject(0).ShallowCopy(grid)
"""
INFORMATION = """
self.GetExecutive().GetOutputInformation(0).Set(self.CAN_HANDLE_PIECE_REQUEST(), 1)
"""


def random_trees(cells, edge=1.0, depth=2):
    """A source of cells[0] x cells[1] x cells[2] trees; the array of the cells is called Depth."""
    # A programmable source cannot make hyper trees.
    return simple.ProgrammableFilter(
        Input=simple.HyperTreeGridRandom(), RequestInformationScript=INFORMATION,
        Script=SCRIPT.format(cells=list(cells), edge=edge, depth=depth))
