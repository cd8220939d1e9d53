// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_LeafParts_h
#define banyan_Inputs_LeafParts_h

#include "BanyanInputsModule.h" // For export macro

#include "vtkSmartPointer.h"

#include <vector>

class vtkDataObject;
class vtkDataSetAttributes;

namespace banyan
{

/// A copy of data (blocks are those of AMR) by reference, which can be given arrays without
/// touching the original.
BANYANINPUTS_EXPORT vtkSmartPointer<vtkDataObject> CopyOfLeaves(vtkDataObject* leaves);

/// Returns the attributes of the cells of hyper trees, or of the cells or points of each block of
/// AMR, in the order of the blocks. Other data, and points of hyper trees, have none.
/// @param where vtkDataObject::POINT or CELL
BANYANINPUTS_EXPORT std::vector<vtkDataSetAttributes*> PartsOfLeaves(
  vtkDataObject* leaves, int where);

/// Whether values of two hyper tree grids, or of two AMR data sets, stand for the same places: the
/// same trees and cells, numbered in the same way, or the same blocks.
BANYANINPUTS_EXPORT bool HaveSameLeaves(vtkDataObject* one, vtkDataObject* other);

/// Whether values of two data objects stand for the same cells and points, counted in the same way:
/// hyper trees and AMR as above, unstructured grids whose cells have the same points (which may
/// have moved), other data sets with as many of both, blocks if all of them do.
BANYANINPUTS_EXPORT bool HaveSameCells(vtkDataObject* one, vtkDataObject* other);

} // namespace banyan

#endif
