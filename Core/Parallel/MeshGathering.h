#ifndef banyan_Parallel_MeshGathering_h
#define banyan_Parallel_MeshGathering_h

#include "HexOctree/HexMesh.h"
#include "HexOctree/NodalField.h"
#include "Parallel/Communicator.h"

#include <memory>

namespace banyan
{

/// The pieces of all ranks as one mesh, on every rank: cells and points in the order of the ranks.
/// Points at the borders of pieces come once from each. Collective.
///
/// A mesh that one process draws alone is handed back as it is.
/// @param piece of this rank; may have no cells
/// Throws Error, on all ranks, when a cell of a piece refers to a point that the piece has not.
HexMesh GatherMesh(Communicator& communicator, const HexMesh& piece);

/// Values at the points or cells of a gathered mesh, one component of them, on every rank.
struct GatheredValues
{
  NodeArray Array;
  std::shared_ptr<const void> Owner; ///< keeps the values; empty for those of one process alone
};

/// Collective.
/// @param piece values at the points (or cells) of this rank's piece; the same component on all ranks
/// @param points (or cells) of the piece
GatheredValues GatherNodes(Communicator& communicator, const NodeArray& piece, std::int64_t points);

} // namespace banyan

#endif
