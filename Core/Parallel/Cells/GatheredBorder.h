// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Cells_GatheredBorder_h
#define banyan_Parallel_Cells_GatheredBorder_h

#include "Render/Cells/CellField.h"

#include <memory>

namespace banyan
{

class Communicator;

/// Collective: the cells of all ranks that have faces at the border of the mesh, on each rank, with
/// their points, values and gradients. Rank after rank, each rank's cells in their order.
/// @param piece of a mesh, as DrawnPiece has made its cells
/// @param withGradients whether all ranks have some; those without points need none
/// Throws CollectiveError.
std::shared_ptr<const CellField> GatherBorder(
  Communicator& communicator, const CellField& piece, bool withGradients);

} // namespace banyan

#endif
