// SPDX-License-Identifier: BSD-3-Clause
// Coarser levels of octree meshes: which elements they have, and their values.
#include "Mesh/Octree/LevelMeshes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace levels;

/// Which cells have an element, x fastest.
std::vector<bool> CoveredCells(const ElementOctree& tree)
{
  std::vector<bool> covered;
  ForPoints(Size, [&](const glm::ivec3& cell) { covered.push_back(tree.LeafAt(cell) >= 0); });
  return covered;
}

/// The corner and the level of the element of a coarser mesh at a cell: the largest cube up to the
/// level that smaller leaves fill, cell by cell.
Cube SlowElementAt(
  const ElementOctree& tree, const std::vector<bool>& covered, const glm::ivec3& cell, int level)
{
  const std::int64_t own = tree.LeafAt(cell);
  Cube found{ tree.CornerOfLeaf(own), tree.LevelOfLeaf(own) };
  for (int larger = found.Level + 1; larger <= level; ++larger)
  {
    const glm::ivec3 corner = cell >> larger << larger;
    for (int i = 0; i < 1 << 3 * larger; ++i)
    {
      const int mask = (1 << larger) - 1;
      const glm::ivec3 p = corner + glm::ivec3(i & mask, i >> larger & mask, i >> 2 * larger);
      if (!covered[static_cast<std::size_t>(p.x + Size.x * (p.y + Size.y * p.z))])
      {
        return found;
      }
    }
    found = { corner, larger };
  }
  return found;
}

TEST(HexLevels, ElementsAreTheLargestCubesThatAreFilled)
{
  ThreadPool pool(2);
  for (const auto& cubes : { Graded(), Rough(), Holed() })
  {
    const Made made(cubes, scenes::Standard);
    const ElementOctree& tree = made.Bricks->Tree();
    const std::vector<bool> covered = CoveredCells(tree);
    for (const int level : { 1, 3 })
    {
      const ElementOctree& coarser = made.Bricks->AtLevel(level, pool).Bricks->Tree();
      EXPECT_LT(coarser.LeafCount(), tree.LeafCount());
      EXPECT_EQ(coarser.Domain(), tree.Domain());
      EXPECT_EQ(coarser.HoleCells(), tree.HoleCells());
      ForPoints(tree.Domain().Hi,
        [&](const glm::ivec3& cell)
        {
          const std::int64_t leaf = coarser.LeafAt(cell);
          ASSERT_EQ(leaf < 0, tree.LeafAt(cell) < 0);
          if (leaf >= 0)
          {
            const Cube expected = SlowElementAt(tree, covered, cell, level);
            ASSERT_EQ(coarser.LevelOfLeaf(leaf), expected.Level);
            ASSERT_EQ(coarser.CornerOfLeaf(leaf), expected.Corner);
          }
        });
      // From the mesh itself, without the levels between.
      const CoarserOctree direct = CoarserOctreeOf(tree, level, pool);
      EXPECT_EQ(direct.Tree->LeafCount(), coarser.LeafCount());
      EXPECT_EQ(direct.Tree->Hanging().size(), coarser.Hanging().size());
    }
  }
}

TEST(HexLevels, CornersKeepTheirValuesAndNoFaceHasACrack)
{
  ThreadPool pool(1);
  for (const auto& cubes : { Graded(), Rough(), Holed() })
  {
    const Made made(cubes, scenes::Standard);
    HexBrickSource source = made.Source(pool);
    const Box domain = made.Bricks->Tree().Domain();
    for (const int level : { 1, 3 })
    {
      const NodalField& field = At(source, level, domain).Field();
      const ElementOctree& tree = field.Tree();
      std::vector<bool> hangs(static_cast<std::size_t>(tree.Mesh().PointCount), false);
      for (const HangingNode& node : tree.Hanging())
      {
        hangs[static_cast<std::size_t>(node.Node)] = true;
      }
      for (std::int64_t leaf = 0; leaf < tree.LeafCount(); ++leaf)
      {
        std::int64_t nodes[8];
        tree.NodesOfLeaf(leaf, nodes);
        for (int corner = 0; corner < 8; ++corner)
        {
          const glm::ivec3 at =
            tree.CornerOfLeaf(leaf) +
            glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2) * (1 << tree.LevelOfLeaf(leaf));
          if (!hangs[static_cast<std::size_t>(nodes[corner])])
          {
            ASSERT_EQ(field.AtNode(nodes[corner]), source.Field().AtPoint(at));
          }
        }
      }
      ForPoints(domain.Hi + 1,
        [&](const glm::ivec3& point)
        {
          // All elements that touch a point of the lattice say the same of it.
          double low = std::numeric_limits<double>::infinity();
          double high = -low;
          for (int octant = 0; octant < 8; ++octant)
          {
            const std::int64_t leaf =
              tree.LeafAt(point - glm::ivec3(octant & 1, octant >> 1 & 1, octant >> 2));
            if (leaf >= 0)
            {
              double corners[8];
              field.CornersOf(leaf, corners);
              const double value = NodalField::Interpolate(corners,
                glm::dvec3(point - tree.CornerOfLeaf(leaf)) / double(1 << tree.LevelOfLeaf(leaf)));
              low = std::min(low, value);
              high = std::max(high, value);
            }
          }
          ASSERT_TRUE(high < low || high - low < 1e-6);
        });
    }
  }
}

/// Each cell with points of its own.
TEST(HexLevels, PointsAtOnePlaceBecomeOne)
{
  ThreadPool pool(1);
  const auto cubes = Rough();
  const Made shared(cubes, scenes::Standard);
  meshes::OwnMesh<double, std::int64_t> apart;
  for (const Cube& cube : cubes)
  {
    const auto one = meshes::Make({ cube });
    const auto before = static_cast<std::int64_t>(apart.Places.size());
    apart.Points.insert(apart.Points.end(), one.Points.begin(), one.Points.end());
    apart.Places.insert(apart.Places.end(), one.Places.begin(), one.Places.end());
    for (const std::int64_t id : one.Ids)
    {
      apart.Ids.push_back(id + before);
    }
  }
  const Made twins(apart, scenes::Standard);
  HexBrickSource a = shared.Source(pool);
  HexBrickSource b = twins.Source(pool);
  const Box domain = shared.Bricks->Tree().Domain();
  const NodalField& expected = At(a, 2, domain).Field();
  const NodalField& field = At(b, 2, domain).Field();
  ASSERT_EQ(field.Tree().LeafCount(), expected.Tree().LeafCount());
  ForPoints(domain.Hi + 1, [&](const glm::ivec3& point)
    { ASSERT_NEAR(field.AtPoint(point), expected.AtPoint(point), 1e-6); });
}

} // namespace
