// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_CellArrays_h
#define banyan_Inputs_CellArrays_h

#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVersionMacros.h"

namespace banyan
{

/// Types of the cells, one for each. Since VTK 9.6 the array may compute them; null without cells.
inline vtkDataArray* CellTypesOf(vtkUnstructuredGrid* grid)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
  return grid->GetCellTypes();
#else // until VTK 9.5
  return grid->GetCellTypesArray();
#endif
}

/// The same values in memory.
inline vtkSmartPointer<vtkUnsignedCharArray> PlainCellTypesOf(vtkUnstructuredGrid* grid)
{
  vtkDataArray* const types = CellTypesOf(grid);
  vtkSmartPointer<vtkUnsignedCharArray> plain = vtkUnsignedCharArray::SafeDownCast(types);
  if (!plain)
  {
    plain = vtkSmartPointer<vtkUnsignedCharArray>::New();
    plain->DeepCopy(types);
  }
  return plain;
}

} // namespace banyan

#endif
