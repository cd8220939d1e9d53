// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_GhostCells_h
#define banyan_Inputs_GhostCells_h

#include "vtkDataSetAttributes.h"
#include "vtkUnsignedCharArray.h"

namespace banyan
{

/// Cells with any of these flags are those of other pieces, or hidden.
constexpr int GhostBits = vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;

/// @param flags of cells, or of points, or null
inline bool HasGhosts(vtkUnsignedCharArray* flags, int bits = GhostBits)
{
  for (vtkIdType cell = 0; flags && cell < flags->GetNumberOfTuples(); ++cell)
  {
    if ((flags->GetValue(cell) & bits) != 0)
    {
      return true;
    }
  }
  return false;
}

} // namespace banyan

#endif
