// SPDX-License-Identifier: BSD-3-Clause
#include "MeshPieces.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSet.h"
#include "vtkUnstructuredGrid.h"

namespace banyan
{

bool CollectGrids(vtkDataObject* data, std::vector<vtkUnstructuredGrid*>& grids)
{
  if (vtkUnstructuredGrid* grid = vtkUnstructuredGrid::SafeDownCast(data))
  {
    if (grid->GetNumberOfCells() > 0)
    {
      grids.push_back(grid);
    }
    return true;
  }
  vtkCompositeDataSet* const composite = vtkCompositeDataSet::SafeDownCast(data);
  if (!composite)
  {
    return false;
  }
  vtkSmartPointer<vtkCompositeDataIterator> blocks;
  blocks.TakeReference(composite->NewIterator());
  blocks->SkipEmptyNodesOn();
  bool any = false;
  for (blocks->InitTraversal(); !blocks->IsDoneWithTraversal(); blocks->GoToNextItem())
  {
    vtkDataSet* const block = vtkDataSet::SafeDownCast(blocks->GetCurrentDataObject());
    vtkUnstructuredGrid* const grid = vtkUnstructuredGrid::SafeDownCast(block);
    if (block && !grid && block->GetNumberOfCells() > 0)
    {
      return false;
    }
    any = any || grid;
    if (grid && grid->GetNumberOfCells() > 0)
    {
      grids.push_back(grid);
    }
  }
  return any;
}

} // namespace banyan
