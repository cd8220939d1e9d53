// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_GridOfHyperTrees_h
#define banyan_Inputs_GridOfHyperTrees_h

#include "BanyanInputsModule.h" // for export macro

#include "vtkSmartPointer.h"

#include <string>

class vtkHyperTreeGrid;
class vtkUnstructuredGrid;

namespace banyan
{

/// The leaves of a hyper tree grid as voxels with their cell data, in the order of trees and then
/// of children. Masked leaves and ghosts are left out; leaves at the depth limit are taken as they
/// are. Corners at one place are one point. Interfaces within cells are not regarded.
/// @param array name of the only cell array that is wanted; all where empty
/// Throws Error with a sentence for grids of fewer than three dimensions, of other branch factors
/// than 2, and with more than 2^21 cells of the deepest level along an axis.
BANYANINPUTS_EXPORT vtkSmartPointer<vtkUnstructuredGrid> GridOfHyperTrees(
  vtkHyperTreeGrid* trees, const std::string& array = {});

} // namespace banyan

#endif
