// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Balance_ZoneTree_h
#define banyan_Parallel_Balance_ZoneTree_h

#include "Base/Box.h"
#include "Render/Scene/Viewpoint.h"

#include <vector>

namespace banyan
{

/// A kd-tree that cuts a grid into one zone per rank (section 3.2 of "Dynamic load balancing for
/// parallel volume rendering"), for any rank count.
///
/// Positions of the grid are bricks, or whatever else zones may be cut at: cells, say. Planes move
/// from frame to frame, but axes and ranks stay where they are, so that a zone keeps most of what
/// it had.
///
/// @par Source: "Dynamic load balancing for parallel volume rendering", section 3.2
struct ZoneTree
{
  struct Node
  {
    int Axis = 0;   ///< of the splitting plane's normal
    int Plane = 0;  ///< first position above it
    int Below = -1; ///< number of the child with lower positions; -1 for a leaf
    int Above = -1;
    int FirstRank = 0; ///< ranks of the leaves under this node
    int Ranks = 1;

    bool IsLeaf() const { return this->Below < 0; }
  };

  glm::ivec3 Positions{ 0 };
  std::vector<Node> Nodes; ///< the root is the first, parents stand before their children

  int Ranks() const { return this->Nodes.empty() ? 0 : this->Nodes.front().Ranks; }
  Box Whole() const { return { glm::ivec3(0), this->Positions }; }

  friend bool operator==(const ZoneTree& a, const ZoneTree& b);
  friend bool operator!=(const ZoneTree& a, const ZoneTree& b) { return !(a == b); }
};

/// A tree of zones of equal size, as far as positions allow: the longest axis is split in the ratio
/// of the ranks on each side. With more ranks than positions some zones are empty.
/// @param positions along each axis; negative ones count as 0
/// @param ranks at least 1; throws Error otherwise
ZoneTree EqualZoneTree(const glm::ivec3& positions, int ranks);

/// The zone of each node: of the whole for the root, of ranks for leaves.
std::vector<Box> NodeZones(const ZoneTree& tree);

/// The zone of each rank: half-open boxes of positions, disjoint; together they are the whole.
std::vector<Box> ZonesOf(const ZoneTree& tree);

/// The same tree over a grid whose positions are `edge` times as close: planes stay in their place.
/// @param positions of the finer grid: its last coarse position may be cut off
ZoneTree Refined(const ZoneTree& tree, int edge, const glm::ivec3& positions);

/// Ranks from front to back: rank a stands before rank b when a can hide b. Exact for perspective
/// (the eye anywhere, inside a zone too) and parallel projections, without comparing zones: the
/// side of each plane that the eye is on comes first. Ranks of empty zones come last.
/// @param view in the space of the positions
/// Throws Error when the camera has no position or direction.
std::vector<int> FrontToBack(const Viewpoint& view, const ZoneTree& tree);

} // namespace banyan

#endif
