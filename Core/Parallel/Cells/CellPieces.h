// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Cells_CellPieces_h
#define banyan_Parallel_Cells_CellPieces_h

#include "Render/Cells/CellField.h"

#include <memory>

namespace banyan
{

class Communicator;
class ThreadPool;

/// Collective: makes the piece of a mesh that a rank has ready to be drawn. Cells are dealt in any
/// way; a rank may have none. Index space and order are those of the whole mesh, and its border is
/// known to those ranks that have cells there: two pieces have all other faces. A cell that several
/// ranks have is left out but on the highest of them.
///
/// Faces that one cell of a piece has alone go to a rank for each hash and back, 24 bytes each.
/// @param facts of this rank's cells, those that are left out among Repeated
/// Throws CollectiveError: see DrawnCells::Of.
std::shared_ptr<const DrawnCells> DrawnPiece(
  Communicator& communicator, const CellMesh& mesh, CellFacts& facts, ThreadPool& pool);

} // namespace banyan

#endif
