// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Series/Decode/BrickTree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>

namespace banyan
{
namespace
{

/// Bricks of a volume of nx x ny x nz bricks with few distinct values, so that much can fuse.
struct Sampled
{
  BrickLayout Layout;
  std::vector<BrickNode> Nodes;
};

Sampled MakeBricks(const glm::ivec3& bricks, unsigned seed, int values)
{
  Sampled result;
  result.Layout = BrickLayout(bricks * 4, 4, 0);
  std::mt19937 random(seed);
  for (std::int64_t i = 0; i < result.Layout.BrickCount(); ++i)
  {
    BrickNode node;
    const glm::ivec3 p = result.Layout.PositionOf(i);
    // Mostly one value per octant, so that large macro voxels occur.
    const bool noise = random() % 8 == 0;
    const int octant = (p.x / 4 + p.y / 4 + p.z / 4) % values;
    const double value = noise ? static_cast<double>(random() % values) : octant;
    node.Uniform = random() % 16 != 0;
    node.Range = { value, node.Uniform ? value : value + 1 };
    node.Mask = ValueMask{ 1 } << (random() % 64);
    node.HasNonFinite = random() % 32 == 0;
    node.Identity = { static_cast<std::uint64_t>(value * 2) + (node.Uniform ? 0u : 1u), 7 };
    result.Nodes.push_back(node);
  }
  return result;
}

const std::vector<glm::ivec3> Sizes = { { 1, 1, 1 }, { 2, 1, 1 }, { 3, 2, 1 }, { 8, 8, 8 },
  { 7, 5, 3 }, { 1, 13, 6 }, { 9, 9, 1 } };

/// Visits the bricks below a node, by position and nothing else.
void ForBricksBelow(const Sampled& bricks, std::size_t level, const glm::ivec3& node,
  const std::function<void(std::size_t)>& visit)
{
  for (std::int64_t i = 0; i < bricks.Layout.BrickCount(); ++i)
  {
    const glm::ivec3 p = bricks.Layout.PositionOf(i);
    if (glm::ivec3(p.x >> level, p.y >> level, p.z >> level) == node)
    {
      visit(static_cast<std::size_t>(i));
    }
  }
}

glm::ivec3 PositionIn(const BrickTree::Level& level, std::size_t i)
{
  const int n = static_cast<int>(i);
  return { n % level.Size.x, n / level.Size.x % level.Size.y, n / level.Size.x / level.Size.y };
}

bool ParentIs(const BrickTree& tree, std::size_t level, const glm::ivec3& p,
  const std::function<bool(std::size_t, std::size_t)>& marked)
{
  if (level + 1 == tree.Levels.size())
  {
    return false;
  }
  const BrickTree::Level& above = tree.Levels[level + 1];
  const glm::ivec3 q = p / 2;
  return marked(
    level + 1, static_cast<std::size_t>((q.z * above.Size.y + q.y) * above.Size.x + q.x));
}

TEST(BrickTree, NodesSayWhatTheBricksBelowSay)
{
  for (const glm::ivec3& size : Sizes)
  {
    for (unsigned seed = 0; seed < 6; ++seed)
    {
      const Sampled bricks = MakeBricks(size, seed, 1 + static_cast<int>(seed) % 3);
      const BrickTree tree = FuseMacroVoxels(bricks.Nodes, bricks.Layout);
      EXPECT_EQ(tree.Levels.back().Nodes.size(), 1u);
      for (std::size_t l = 0; l < tree.Levels.size(); ++l)
      {
        EXPECT_EQ(tree.Levels[l].Size, (size + ((1 << l) - 1)) / (1 << l));
        for (std::size_t i = 0; i < tree.Levels[l].Nodes.size(); ++i)
        {
          BrickTree::Node expected;
          expected.Fused = true;
          double first = 0;
          bool any = false;
          ForBricksBelow(bricks, l, PositionIn(tree.Levels[l], i),
            [&](std::size_t b)
            {
              const BrickNode& brick = bricks.Nodes[b];
              first = any ? first : brick.Range.Low;
              any = true;
              expected.Fused = expected.Fused && brick.Uniform && brick.Range.Low == first;
              expected.Range.Include(brick.Range);
              expected.Mask |= brick.Mask;
              expected.HasNonFinite = expected.HasNonFinite || brick.HasNonFinite;
            });
          const BrickTree::Node& node = tree.Levels[l].Nodes[i];
          ASSERT_TRUE(any);
          EXPECT_EQ(node.Fused, expected.Fused);
          EXPECT_EQ(node.Mask, expected.Mask);
          EXPECT_EQ(node.HasNonFinite, expected.HasNonFinite);
          EXPECT_EQ(node.Range.Low, expected.Range.Low);
          EXPECT_EQ(node.Range.High, expected.Range.High);
        }
      }
    }
  }
}

TEST(BrickTree, MergingMarksSubtreesWithoutAChange)
{
  for (const glm::ivec3& size : Sizes)
  {
    for (unsigned seed = 0; seed < 6; ++seed)
    {
      const Sampled before = MakeBricks(size, seed, 2);
      Sampled after = before;
      std::mt19937 random(seed);
      std::int64_t changed = 0;
      for (BrickNode& node : after.Nodes)
      {
        const bool change = random() % 30 < seed;
        node.Identity.High += change ? 1 : 0;
        changed += change ? 1 : 0;
      }
      const BrickTree tree = FuseMacroVoxels(after.Nodes, after.Layout);
      const MergedTree merged =
        MergeWithPrevious(tree, FuseMacroVoxels(before.Nodes, before.Layout));
      EXPECT_EQ(merged.ChangedBricks, changed);
      CountsBySize expected(tree.Levels.size(), 0);
      const auto unchanged = [&](std::size_t l, std::size_t i)
      {
        bool same = true;
        ForBricksBelow(after, l, PositionIn(tree.Levels[l], i),
          [&](std::size_t b)
          { same = same && after.Nodes[b].Identity == before.Nodes[b].Identity; });
        return same;
      };
      for (std::size_t l = 0; l < tree.Levels.size(); ++l)
      {
        for (std::size_t i = 0; i < tree.Levels[l].Nodes.size(); ++i)
        {
          const bool same = unchanged(l, i);
          EXPECT_EQ(merged.Unchanged[l][i] != 0, same);
          const bool greatest =
            same && !ParentIs(tree, l, PositionIn(tree.Levels[l], i), unchanged);
          expected[l] += greatest ? 1 : 0;
        }
      }
      EXPECT_EQ(merged.Subtrees, expected);
    }
  }
}

TEST(BrickTree, CountsMacroVoxelsBySize)
{
  Sampled bricks = MakeBricks({ 4, 4, 4 }, 1, 1);
  for (BrickNode& node : bricks.Nodes)
  {
    node.Uniform = true;
    node.Range = { 1, 1 };
  }
  EXPECT_EQ(
    CountMacroVoxels(FuseMacroVoxels(bricks.Nodes, bricks.Layout)), (CountsBySize{ 0, 0, 1 }));
  bricks.Nodes[0].Range = { 2, 2 };
  EXPECT_EQ(
    CountMacroVoxels(FuseMacroVoxels(bricks.Nodes, bricks.Layout)), (CountsBySize{ 8, 7, 0 }));
  bricks.Nodes[0].Uniform = false;
  EXPECT_EQ(
    CountMacroVoxels(FuseMacroVoxels(bricks.Nodes, bricks.Layout)), (CountsBySize{ 7, 7, 0 }));
}

TEST(BrickTree, ZeroAndMinusZeroDoNotFuse)
{
  Sampled bricks = MakeBricks({ 2, 1, 1 }, 1, 1);
  for (BrickNode& node : bricks.Nodes)
  {
    node.Uniform = true;
    node.Range = { 0.0, 0.0 };
  }
  EXPECT_TRUE(FuseMacroVoxels(bricks.Nodes, bricks.Layout).Levels[1].Nodes[0].Fused);
  bricks.Nodes[1].Range = { -0.0, -0.0 };
  EXPECT_FALSE(FuseMacroVoxels(bricks.Nodes, bricks.Layout).Levels[1].Nodes[0].Fused);
}

TEST(BrickTree, RejectsTreesThatDoNotFit)
{
  const Sampled a = MakeBricks({ 2, 2, 1 }, 1, 1);
  const Sampled b = MakeBricks({ 2, 1, 2 }, 1, 1);
  EXPECT_THROW(FuseMacroVoxels(a.Nodes, BrickLayout({ 4, 4, 4 }, 4, 0)), Error);
  EXPECT_THROW(
    MergeWithPrevious(FuseMacroVoxels(a.Nodes, a.Layout), FuseMacroVoxels(b.Nodes, b.Layout)),
    Error);
}

} // namespace
} // namespace banyan
