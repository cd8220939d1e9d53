// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Cells_GatheredCells_h
#define banyan_Parallel_Cells_GatheredCells_h

#include "Cells/CellMesh.h"
#include "Parallel/Communicate/Communicator.h"

#include <vector>

namespace banyan
{

/// Collective: the pieces of all ranks as one mesh, for every rank: cells and points in the order
/// of the ranks, without those that are hidden or not drawn. That of a rank alone is handed back as
/// it is, and belongs to whom it did.
///
/// Each rank has a copy of the whole mesh then.
/// Throws CollectiveError when memory runs out on a rank.
CellMesh GatherCells(Communicator& communicator, const CellMesh& piece);

/// Collective: the numbers of all ranks, in the order of the ranks.
std::vector<float> GatherFloats(Communicator& communicator, std::vector<float> mine);

} // namespace banyan

#endif
