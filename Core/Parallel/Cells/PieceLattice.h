// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Cells_PieceLattice_h
#define banyan_Parallel_Cells_PieceLattice_h

#include "Render/Cells/CellSource.h"

namespace banyan
{

class Communicator;
class ThreadPool;

/// Collective: gives a piece of a mesh the finest lattice of the whole mesh, and the cells at its
/// border, unless all ranks have them. Values have the bits that one rank with all cells finds: of
/// a place that several ranks' cells hold, the last cell in the order gives the value.
///
/// Each rank decides a part of the places. It gets a bit for each place where another one has a
/// value, then the values, with the key of the cell where ranks contradict each other.
/// @param shaded with gradients: GivePieceGradients comes first
/// Throws CollectiveError.
void GivePieceLattice(
  Communicator& communicator, CellSource& source, bool shaded, ThreadPool& pool);

} // namespace banyan

#endif
