// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/ZoneTree.h"
#include "Parallel/Balance/Zones.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace banyan
{
namespace
{

/// A tree whose planes stand anywhere in their zones, on their faces too.
ZoneTree RandomTree(std::mt19937& random, const glm::ivec3& positions, int ranks)
{
  ZoneTree tree = EqualZoneTree(positions, ranks);
  std::vector<Box> zones(tree.Nodes.size());
  zones.front() = tree.Whole();
  for (std::size_t number = 0; number < zones.size(); ++number)
  {
    ZoneTree::Node& node = tree.Nodes[number];
    if (!node.IsLeaf())
    {
      node.Axis = static_cast<int>(random() % 3);
      const int low = zones[number].Lo[node.Axis];
      node.Plane = low + static_cast<int>(random() % (zones[number].Hi[node.Axis] - low + 1u));
      Box below = zones[number];
      Box above = below;
      below.Hi[node.Axis] = above.Lo[node.Axis] = node.Plane;
      zones[node.Below] = below;
      zones[node.Above] = above;
    }
  }
  return tree;
}

Viewpoint RandomView(std::mt19937& random, const glm::ivec3& positions)
{
  std::uniform_real_distribution<double> part(-0.6, 1.6);
  Viewpoint view;
  for (int axis = 0; axis < 3; ++axis)
  {
    view.Eye[axis] = part(random) * positions[axis];
    view.Direction[axis] = random() % 5 == 0 ? 0.0 : part(random) - 0.5;
    // On planes too.
    view.Eye[axis] = random() % 4 == 0 ? std::floor(view.Eye[axis]) : view.Eye[axis];
  }
  view.Parallel = random() % 2 == 0 && view.Direction != glm::dvec3(0.0);
  return view;
}

/// Whether `a` hides `b`, told by the order of the two alone.
bool Hides(const Viewpoint& view, const Box& a, const Box& b)
{
  // Given last, so that it comes first only when it has to.
  return FrontToBack(view, { b, a }).front() == 1;
}

TEST(ZoneTree, IsThatOfTheStaticZones)
{
  for (int ranks = 1; ranks <= 33; ++ranks)
  {
    for (const glm::ivec3& size : { glm::ivec3(7, 5, 3), glm::ivec3(64), glm::ivec3(0, 4, 4) })
    {
      const ZoneTree tree = EqualZoneTree(size, ranks);
      EXPECT_EQ(tree.Ranks(), ranks);
      EXPECT_EQ(tree.Nodes.size(), 2u * static_cast<unsigned>(ranks) - 1);
      EXPECT_EQ(ZonesOf(tree), StaticZones(size, ranks));
    }
  }
}

TEST(ZoneTree, ZonesAreDisjointAndCoverTheGrid)
{
  std::mt19937 random(1);
  for (int trial = 0; trial < 300; ++trial)
  {
    const glm::ivec3 size(random() % 20 + 1, random() % 20 + 1, random() % 20 + 1);
    const ZoneTree tree = RandomTree(random, size, static_cast<int>(random() % 24 + 1));
    const std::vector<Box> zones = ZonesOf(tree);
    std::int64_t count = 0;
    for (std::size_t a = 0; a < zones.size(); ++a)
    {
      count += zones[a].Count();
      for (std::size_t b = 0; b < a; ++b)
      {
        EXPECT_TRUE(Intersection(zones[a], zones[b]).Empty());
      }
    }
    EXPECT_EQ(count, tree.Whole().Count());
  }
}

TEST(ZoneTree, ItsOrderIsOneThatComparingZonesAllows)
{
  std::mt19937 random(2);
  for (int trial = 0; trial < 600; ++trial)
  {
    const glm::ivec3 size(random() % 20 + 1, random() % 20 + 1, random() % 20 + 1);
    const ZoneTree tree = RandomTree(random, size, static_cast<int>(random() % 20 + 1));
    const Viewpoint view = RandomView(random, size);
    const std::vector<Box> zones = ZonesOf(tree);
    const std::vector<int> order = FrontToBack(view, tree);
    std::vector<int> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t rank = 0; rank < zones.size(); ++rank)
    {
      ASSERT_EQ(sorted[rank], static_cast<int>(rank));
    }
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      for (std::size_t j = i + 1; j < order.size(); ++j)
      {
        const Box& first = zones[order[i]];
        const Box& second = zones[order[j]];
        EXPECT_FALSE(first.Empty() && !second.Empty());
        if (!first.Empty() && !second.Empty())
        {
          EXPECT_FALSE(Hides(view, second, first)) << trial << ": " << order[j] << ", " << order[i];
        }
      }
    }
  }
}

TEST(ZoneTree, OrderTellsTheSidesApart)
{
  const ZoneTree tree = EqualZoneTree({ 8, 2, 2 }, 2);
  Viewpoint view;
  view.Eye = { 3.9, 1.0, 1.0 };
  EXPECT_EQ(FrontToBack(view, tree), (std::vector<int>{ 0, 1 }));
  view.Eye = { 4.1, 1.0, 1.0 };
  EXPECT_EQ(FrontToBack(view, tree), (std::vector<int>{ 1, 0 }));
  view.Parallel = true;
  view.Direction = { 0.1, -5.0, 0.0 };
  EXPECT_EQ(FrontToBack(view, tree), (std::vector<int>{ 0, 1 }));
  view.Direction = glm::dvec3(0.0);
  EXPECT_THROW(FrontToBack(view, tree), Error);
  EXPECT_THROW(EqualZoneTree({ 1, 1, 1 }, 0), Error);
}

TEST(ZoneTree, RefinedZonesAreThoseOfTheCells)
{
  std::mt19937 random(3);
  for (int trial = 0; trial < 100; ++trial)
  {
    const glm::ivec3 cells(random() % 60 + 1, random() % 60 + 1, random() % 60 + 1);
    const int edge = static_cast<int>(random() % 9 + 1);
    const ZoneTree tree = RandomTree(random, (cells + edge - 1) / edge, 7);
    const std::vector<Box> fine = ZonesOf(Refined(tree, edge, cells));
    const std::vector<Box> coarse = ZonesOf(tree);
    for (std::size_t rank = 0; rank < fine.size(); ++rank)
    {
      EXPECT_EQ(fine[rank], CellsOfBricks(coarse[rank], edge, cells));
    }
  }
}

} // namespace
} // namespace banyan
