// SPDX-License-Identifier: BSD-3-Clause
#include "Fields/GridOfLeaves.h"

#include "GridOfAmr.h"
#include "GridOfHyperTrees.h"

#include "Base/Error.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkHyperTreeGrid.h"
#include "vtkOverlappingAMR.h"
#include "vtkPointData.h"
#include "vtkUnstructuredGrid.h"

namespace banyan
{

void TakeLeaves(
  Communicator& communicator, FieldPiece& piece, vtkSmartPointer<vtkUnstructuredGrid>& grid)
{
  vtkOverlappingAMR* const blocks = vtkOverlappingAMR::SafeDownCast(piece.Leaves);
  vtkHyperTreeGrid* const trees = vtkHyperTreeGrid::SafeDownCast(piece.Leaves);
  std::vector<AmrBox> boxes;
  Collective(communicator,
    [&]
    {
      if (piece.Leaves && !blocks && !trees)
      {
        throw Error(std::string("Data of the type ") + piece.Leaves->GetClassName() +
                    " cannot be drawn: use 'Resample To Image'.");
      }
      boxes = BoxesOf(blocks);
    });
  boxes = BoxesOfAll(communicator, boxes);
  Collective(communicator,
    [&]
    {
      if (!piece.Leaves)
      {
        return;
      }
      grid = trees ? GridOfHyperTrees(trees, piece.ArrayName)
                   : GridOfAmr(blocks, boxes, piece.ArrayName);
      piece.Grid = grid;
      vtkDataSetAttributes* const values = grid->GetAttributes(
        piece.Where == ValuesOn::Cells ? vtkDataObject::CELL : vtkDataObject::POINT);
      piece.Array = values->GetArray(piece.ArrayName.c_str());
      if (!piece.Array && grid->GetNumberOfCells() > 0)
      {
        throw Error("Not all blocks have the array '" + piece.ArrayName +
                    "' with the same type and components: choose another one in 'Coloring'.");
      }
    });
}

} // namespace banyan
