// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_BrickTree_h
#define banyan_Series_Decode_BrickTree_h

#include "Series/Decode/SeriesFile.h"

#include <cstdint>
#include <vector>

namespace banyan
{

/// The octree over the bricks of one field at one step, branch on need: a parent stands over up to
/// 2 x 2 x 2 children, and where the volume ends there are fewer; nothing is padded to a power of
/// two, and a flat volume gets a quadtree.
struct BrickTree
{
  struct Node
  {
    ValueRange Range;          ///< of everything below; empty when nothing is finite
    ValueMask Mask = 0;        ///< all masks below together
    bool HasNonFinite = false; ///< somewhere below
    bool Fused = false;        ///< a macro voxel: one value (Range.Low, bit-exact) everywhere below
    PayloadIdentity Identity;  ///< of bricks only
  };

  struct Level
  {
    glm::ivec3 Size{ 1 };    ///< nodes per axis
    std::vector<Node> Nodes; ///< x fastest
  };

  /// Levels[0] are the bricks, the last level is the root alone. The node at position p of level l
  /// stands over the bricks p * 2^l to (p + 1) * 2^l, cut where the volume ends.
  std::vector<Level> Levels;
};

/// How many macro voxels or subtrees there are of each size: element l counts the greatest ones
/// that are nodes of level l of the tree (a node counts only when its parent does not).
using CountsBySize = std::vector<std::int64_t>;

/// Builds the tree bottom-up, visiting each brick once, and fuses nodes whose children are macro
/// voxels of the same bits.
/// @par Source: "A study of time-varying octree and difference encoding", section 3.2.
/// @param nodes bricks of the finest level
/// @param layout of that level
BrickTree FuseMacroVoxels(const std::vector<BrickNode>& nodes, const BrickLayout& layout);

/// The greatest macro voxels by size.
CountsBySize CountMacroVoxels(const BrickTree& tree);

/// Says what a step has in common with the one before.
struct MergedTree
{
  /// Per level and node: 1 when nothing below has changed, so that what was made of the subtree at
  /// the step before (its picture, say) may be used again.
  std::vector<std::vector<std::uint8_t>> Unchanged;
  CountsBySize Subtrees;          ///< the greatest unchanged subtrees by size
  std::int64_t ChangedBricks = 0; ///< bricks that are not unchanged
};

/// Marks the subtrees that are equal in both trees: those whose bricks have equal identities.
/// @par Source: the same study, section 3.3 and figure 9.
/// Throws Error when the trees do not have the same shape.
MergedTree MergeWithPrevious(const BrickTree& tree, const BrickTree& previous);

} // namespace banyan

#endif
