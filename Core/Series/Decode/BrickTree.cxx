// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/BrickTree.h"

#include "Base/Bytes.h"
#include "Base/Error.h"

namespace banyan
{
namespace
{

std::size_t IndexOf(const glm::ivec3& size, const glm::ivec3& p)
{
  return (static_cast<std::size_t>(p.z) * size.y + p.y) * size.x + p.x;
}

/// Calls `body(parent index, child index)` for each node of a level and its parent, each parent's
/// children in a row.
template <class Body>
void ForChildren(const glm::ivec3& parents, const glm::ivec3& children, Body&& body)
{
  glm::ivec3 p;
  for (p.z = 0; p.z < parents.z; ++p.z)
  {
    for (p.y = 0; p.y < parents.y; ++p.y)
    {
      for (p.x = 0; p.x < parents.x; ++p.x)
      {
        const glm::ivec3 end = glm::min(2 * p + 2, children);
        glm::ivec3 c;
        for (c.z = 2 * p.z; c.z < end.z; ++c.z)
        {
          for (c.y = 2 * p.y; c.y < end.y; ++c.y)
          {
            for (c.x = 2 * p.x; c.x < end.x; ++c.x)
            {
              body(IndexOf(parents, p), IndexOf(children, c), c == 2 * p);
            }
          }
        }
      }
    }
  }
}

void Join(BrickTree::Node& parent, const BrickTree::Node& child, bool first)
{
  // Bits, not values: -0 and 0 are equal but not the same.
  parent.Fused =
    child.Fused && (first || (parent.Fused && BitCast<std::uint64_t>(parent.Range.Low) ==
                                                BitCast<std::uint64_t>(child.Range.Low)));
  if (first)
  {
    parent.Range = child.Range;
  }
  parent.Range.Include(child.Range);
  parent.Mask |= child.Mask;
  parent.HasNonFinite = parent.HasNonFinite || child.HasNonFinite;
}

/// Counts, per level, the nodes that `marked` and whose parents are not.
template <class Marked>
CountsBySize CountGreatest(const BrickTree& tree, Marked&& marked)
{
  CountsBySize counts(tree.Levels.size(), 0);
  for (std::size_t l = 0; l + 1 < tree.Levels.size(); ++l)
  {
    ForChildren(tree.Levels[l + 1].Size, tree.Levels[l].Size,
      [&](std::size_t parent, std::size_t child, bool)
      { counts[l] += marked(l, child) && !marked(l + 1, parent) ? 1 : 0; });
  }
  counts.back() += marked(tree.Levels.size() - 1, 0) ? 1 : 0;
  return counts;
}

} // namespace

BrickTree FuseMacroVoxels(const std::vector<BrickNode>& nodes, const BrickLayout& layout)
{
  if (static_cast<std::int64_t>(nodes.size()) != layout.BrickCount())
  {
    throw Error("A tree needs one node per brick of its layout",
      { {}, {}, nodes.size(), static_cast<std::uint64_t>(layout.BrickCount()) });
  }
  BrickTree tree;
  tree.Levels.emplace_back();
  tree.Levels[0].Size = layout.Bricks();
  for (const BrickNode& node : nodes)
  {
    tree.Levels[0].Nodes.push_back(
      { node.Range, node.Mask, node.HasNonFinite, node.Uniform, node.Identity });
  }
  while (tree.Levels.back().Nodes.size() > 1)
  {
    const BrickTree::Level& below = tree.Levels.back();
    BrickTree::Level level;
    level.Size = (below.Size + 1) / 2;
    level.Nodes.resize(IndexOf(level.Size, { 0, 0, level.Size.z }));
    ForChildren(level.Size, below.Size,
      [&](std::size_t parent, std::size_t child, bool first)
      { Join(level.Nodes[parent], below.Nodes[child], first); });
    tree.Levels.push_back(std::move(level));
  }
  return tree;
}

CountsBySize CountMacroVoxels(const BrickTree& tree)
{
  return CountGreatest(tree,
    [&tree](std::size_t level, std::size_t node) { return tree.Levels[level].Nodes[node].Fused; });
}

MergedTree MergeWithPrevious(const BrickTree& tree, const BrickTree& previous)
{
  if (tree.Levels.empty() || tree.Levels.size() != previous.Levels.size() ||
      tree.Levels[0].Size != previous.Levels[0].Size)
  {
    throw Error("Only trees over the same bricks can be merged");
  }
  MergedTree merged;
  merged.Unchanged.resize(tree.Levels.size());
  const std::vector<BrickTree::Node>& bricks = tree.Levels[0].Nodes;
  for (std::size_t i = 0; i < bricks.size(); ++i)
  {
    const bool same = bricks[i].Identity == previous.Levels[0].Nodes[i].Identity;
    merged.Unchanged[0].push_back(same ? 1 : 0);
    merged.ChangedBricks += same ? 0 : 1;
  }
  for (std::size_t l = 1; l < tree.Levels.size(); ++l)
  {
    const std::vector<std::uint8_t>& below = merged.Unchanged[l - 1];
    std::vector<std::uint8_t>& level = merged.Unchanged[l];
    level.assign(tree.Levels[l].Nodes.size(), 1);
    ForChildren(tree.Levels[l].Size, tree.Levels[l - 1].Size,
      [&](std::size_t parent, std::size_t child, bool) { level[parent] &= below[child]; });
  }
  merged.Subtrees = CountGreatest(tree,
    [&merged](std::size_t level, std::size_t node) { return merged.Unchanged[level][node] != 0; });
  return merged;
}

} // namespace banyan
