// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_Fields_GridOfLeaves_h
#define banyan_Inputs_Fields_GridOfLeaves_h

#include "Fields/FieldPiece.h"

#include "vtkSmartPointer.h"

namespace banyan
{

class Communicator;

/// Collective: the leaves of a piece's hyper trees, or the visible cells of its AMR blocks, as
/// voxels (see GridOfHyperTrees and GridOfAmr). Of AMR all ranks tell which blocks they have: a
/// cell is hidden by finer ones wherever these are.
/// @param piece Grid and Array are set to what is made, which `grid` keeps alive; a piece without
/// Leaves stays as it is
/// Throws CollectiveError when a rank has something else.
void TakeLeaves(
  Communicator& communicator, FieldPiece& piece, vtkSmartPointer<vtkUnstructuredGrid>& grid);

} // namespace banyan

#endif
