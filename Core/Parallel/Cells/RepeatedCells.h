// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Cells_RepeatedCells_h
#define banyan_Parallel_Cells_RepeatedCells_h

#include "Cells/CellLattice.h"
#include "Cells/CheckMesh.h"

namespace banyan
{

class Communicator;

/// Collective: leaves cells out that a higher rank has, too, with all corners in the same places:
/// OrderOfCells of the whole mesh, for pieces in the order of ranks. Their keys go to a rank for
/// each hash, 16 bytes each, if a corner lies in the box around another rank's piece.
/// @param mine what this rank's cells extend over, and ofAll what all do
/// @param facts of this rank's cells: LeftOut is added to
/// Throws CollectiveError.
void LeaveOutRepeated(Communicator& communicator, const CellMesh& mesh, const CellExtent& mine,
  const CellExtent& ofAll, CellFacts& facts);

} // namespace banyan

#endif
