// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_MeshGathering_h
#define banyan_Parallel_Fields_MeshGathering_h

#include "Mesh/Octree/CellNodes.h"
#include "Mesh/Octree/HexMesh.h"
#include "Mesh/Octree/NodalField.h"
#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Communicate/NodeCommunicator.h"

#include <memory>

namespace banyan
{

/// The pieces of all ranks as one mesh, for every rank: cells and points in the order of the ranks.
/// Points at the borders of pieces come once from each. Ranks of a machine have it together, if
/// they can: nobody may write to it. Collective.
///
/// Ids are int32 where there are not too many points for that. Points have an owner of their own,
/// so that ElementOctree::Find can let them go.
///
/// A mesh that one process draws alone is handed back as it is.
/// @param piece of this rank; may have no cells
/// Throws CollectiveError when a cell of a piece refers to a point that the piece has not, and
/// when there is not enough memory.
HexMesh GatherMesh(Communicator& communicator, NodeCommunicator& machines, const HexMesh& piece);

/// Collective: what the ranks that have cells say values belong to.
/// @param cells whether this rank has some
/// Throws CollectiveError when they do not say the same.
ValuesOn AgreedPlace(Communicator& communicator, ValuesOn where, bool cells);

/// Values at the points or cells of a gathered mesh, one component of them, for every rank;
/// those of a machine have them together, if they can.
struct GatheredValues
{
  NodeArray Array;
  /// Keeps the values; empty for those of one process alone, which are not copied. The leader of a
  /// machine may change what is there, as long as no other rank reads it.
  std::shared_ptr<char> Memory;
};

/// Collective.
/// @param piece values at the points (or cells) of this rank's piece; the same component on all
/// ranks
/// @param points (or cells) of the piece
GatheredValues GatherNodes(Communicator& communicator, NodeCommunicator& machines,
  const NodeArray& piece, std::int64_t points);

} // namespace banyan

#endif
