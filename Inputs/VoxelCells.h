// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_VoxelCells_h
#define banyan_Inputs_VoxelCells_h

#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

namespace banyan
{

/// Voxels that become the cells of a grid: corners in the order of VTK's, x fastest.
class VoxelCells
{
public:
  void Add(const vtkIdType (&points)[8])
  {
    for (const vtkIdType point : points)
    {
      this->Corners->InsertNextValue(point);
    }
  }

  void Finish(vtkUnstructuredGrid* grid, vtkPoints* points) const
  {
    vtkNew<vtkCellArray> cells;
    cells->SetData(8, this->Corners);
    grid->SetPoints(points);
    grid->SetCells(VTK_VOXEL, cells);
  }

private:
  vtkNew<vtkIdTypeArray> Corners;
};

/// Some of the tuples of an array, one after the other.
inline vtkSmartPointer<vtkDataArray> Chosen(vtkDataArray* all, vtkIdList* tuples)
{
  const auto chosen = vtkSmartPointer<vtkDataArray>::Take(all->NewInstance());
  chosen->SetName(all->GetName());
  chosen->SetNumberOfComponents(all->GetNumberOfComponents());
  chosen->CopyComponentNames(all);
  chosen->SetNumberOfTuples(tuples->GetNumberOfIds());
  if (tuples->GetNumberOfIds() > 0)
  {
    all->GetTuples(tuples, chosen);
  }
  return chosen;
}

} // namespace banyan

#endif
