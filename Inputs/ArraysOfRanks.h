// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_ArraysOfRanks_h
#define banyan_Inputs_ArraysOfRanks_h

#include "BanyanInputsModule.h"

#include "vtkSmartPointer.h"

class vtkUnstructuredGrid;

namespace banyan
{

class Communicator;

/// Collective: the grid with those arrays only that the grids of all ranks have, with the same type
/// and components; others are named in its field data (see LeftOutName). The same arrays on any
/// number of ranks: blocks that lack one may lie on any of them. Ranks without cells do not count.
/// @param grid is left as it is; null counts as empty
/// @return a copy by reference where an array is left out, otherwise `grid`
BANYANINPUTS_EXPORT vtkSmartPointer<vtkUnstructuredGrid> WithArraysOfAllRanks(
  Communicator& ranks, vtkUnstructuredGrid* grid);

} // namespace banyan

#endif
