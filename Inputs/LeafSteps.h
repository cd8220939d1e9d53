// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_LeafSteps_h
#define banyan_Inputs_LeafSteps_h

#include "BanyanInputsModule.h"

#include "vtkSmartPointer.h"

#include <functional>
#include <string>

class vtkDataObject;
class vtkUnstructuredGrid;

namespace banyan
{

class Communicator;
class ElementOctree;

/// Collective: hyper trees and AMR as grids of their leaves; `data` then is that grid. Other data
/// stay as they are, and all data do where a rank has a problem. Throws CollectiveError.
/// @param problem of this rank so far, or nothing; its data do not count then
/// @param found whether any rank has such data
BANYANINPUTS_EXPORT void LeavesAsGrid(Communicator& ranks, const std::string& problem,
  vtkSmartPointer<vtkDataObject>& data, bool& found);

/// Replaces the arrays of a grid of leaves by the point arrays that "Banyan Volume" draws of them
/// (see CellNodes): those of cells, and those of points, which agree at one place then. Where both
/// have a name, that of points counts. Float32 where that holds all values of the type, otherwise
/// float64.
/// @param wanted which arrays, by name
BANYANINPUTS_EXPORT void MakeNodal(const ElementOctree& tree, vtkUnstructuredGrid* grid,
  const std::function<bool(const std::string&)>& wanted);

} // namespace banyan

#endif
