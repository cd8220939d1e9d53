// SPDX-License-Identifier: BSD-3-Clause
// Octree meshes against definitions: tiling, balance, the nodes that hang and on what.
#include "OctreeMesh.h"
#include "OctreeMeshKeys.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

using banyan::MeshOctant;
using banyan::OctreeMesh;
using banyan::OctreeMeshShape;
using banyan::ThreadPool;

namespace
{

using Place = std::array<std::uint32_t, 3>;

OctreeMeshShape Shape(const std::array<int, 3>& roots, int maxLevel)
{
  OctreeMeshShape shape;
  shape.Roots = roots;
  shape.RootEdge = 10.0;
  shape.Origin = { 5.0, -20.0, 0.0 };
  shape.MaxLevel = maxLevel;
  return shape;
}

/// Divides cubes around a few points to the deepest level.
OctreeMesh::TooLarge NearPoints(const OctreeMeshShape& shape, int points, unsigned seed)
{
  std::mt19937 random(seed);
  std::vector<Place> places(points);
  for (auto& place : places)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = random() % (static_cast<unsigned>(shape.Roots[axis]) << shape.MaxLevel);
    }
  }
  return [places, shape](const MeshOctant& octant)
  {
    const std::uint32_t size = 1u << (shape.MaxLevel - octant.Level);
    return std::any_of(places.begin(), places.end(),
      [&](const Place& p)
      {
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis)
        {
          inside = inside && p[axis] >= octant.Corner[axis] && p[axis] < octant.Corner[axis] + size;
        }
        return inside;
      });
  };
}

struct Box
{
  std::array<long, 3> Low, High;
  int Level;
};

std::vector<Box> Boxes(const OctreeMesh& mesh)
{
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < mesh.CellCount(); ++i)
  {
    const MeshOctant cell = mesh.Cell(i);
    Box box;
    box.Level = cell.Level;
    for (int axis = 0; axis < 3; ++axis)
    {
      box.Low[axis] = cell.Corner[axis];
      box.High[axis] = box.Low[axis] + (1L << (mesh.Shape().MaxLevel - cell.Level));
    }
    boxes.push_back(box);
  }
  return boxes;
}

/// Along how many axes two boxes touch only (their other axes overlap); 4 when they are apart.
int Contact(const Box& a, const Box& b)
{
  int touching = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    if (a.High[axis] < b.Low[axis] || b.High[axis] < a.Low[axis])
    {
      return 4;
    }
    touching += a.High[axis] == b.Low[axis] || b.High[axis] == a.Low[axis];
  }
  return touching;
}

std::vector<std::pair<Place, int>> Sorted(const std::vector<Box>& boxes)
{
  std::vector<std::pair<Place, int>> cells;
  for (const Box& box : boxes)
  {
    cells.push_back(
      { { static_cast<std::uint32_t>(box.Low[0]), static_cast<std::uint32_t>(box.Low[1]),
          static_cast<std::uint32_t>(box.Low[2]) },
        box.Level });
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

/// The slow and obvious way: while two cells break the rule, divide the larger.
std::vector<Box> BalanceSlowly(std::vector<Box> boxes)
{
  for (bool changed = true; changed;)
  {
    changed = false;
    for (std::size_t i = 0; i < boxes.size() && !changed; ++i)
    {
      for (std::size_t j = 0; j < boxes.size() && !changed; ++j)
      {
        if (boxes[i].Level < boxes[j].Level - 1 && Contact(boxes[i], boxes[j]) <= 2)
        {
          const Box large = boxes[i];
          boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(i));
          for (int child = 0; child < 8; ++child)
          {
            Box box = large;
            ++box.Level;
            for (int axis = 0; axis < 3; ++axis)
            {
              const long half = (large.High[axis] - large.Low[axis]) / 2;
              box.Low[axis] += (child >> axis & 1) * half;
              box.High[axis] = box.Low[axis] + half;
            }
            boxes.push_back(box);
          }
          changed = true;
        }
      }
    }
  }
  return boxes;
}

std::vector<Box> UnbalancedBoxes(const OctreeMeshShape& shape, const OctreeMesh::TooLarge& tooLarge)
{
  std::vector<Box> boxes;
  const std::function<void(const MeshOctant&)> visit = [&](const MeshOctant& octant)
  {
    const std::uint32_t size = 1u << (shape.MaxLevel - octant.Level);
    const bool divide = octant.Level < shape.MaxLevel && tooLarge(octant);
    for (unsigned child = 0; divide && child < 8; ++child)
    {
      MeshOctant part = { octant.Corner, octant.Level + 1 };
      for (int axis = 0; axis < 3; ++axis)
      {
        part.Corner[axis] += (child >> axis & 1) * size / 2;
      }
      visit(part);
    }
    if (!divide)
    {
      Box box;
      box.Level = octant.Level;
      for (int axis = 0; axis < 3; ++axis)
      {
        box.Low[axis] = octant.Corner[axis];
        box.High[axis] = octant.Corner[axis] + size;
      }
      boxes.push_back(box);
    }
  };
  const auto size = [&](int root) { return static_cast<std::uint32_t>(root) << shape.MaxLevel; };
  for (int z = 0; z < shape.Roots[2]; ++z)
    for (int y = 0; y < shape.Roots[1]; ++y)
      for (int x = 0; x < shape.Roots[0]; ++x)
        visit({ { size(x), size(y), size(z) }, 0 });
  return boxes;
}

Place PlaceOf(const OctreeMesh& mesh, std::uint32_t node)
{
  Place place;
  const auto point = mesh.Point(node);
  for (int axis = 0; axis < 3; ++axis)
  {
    place[axis] = static_cast<std::uint32_t>(
      (point[axis] - mesh.Shape().Origin[axis]) / mesh.EdgeOfLevel(mesh.Shape().MaxLevel));
  }
  return place;
}

/// Nodes in the closed box of a cell of which they are no corner, and what they hang on.
std::map<Place, std::multiset<Place>> HangingSlowly(const OctreeMesh& mesh)
{
  std::map<Place, std::multiset<Place>> hanging;
  const auto boxes = Boxes(mesh);
  for (std::uint32_t node = 0; node < mesh.NodeCount(); ++node)
  {
    const Place p = PlaceOf(mesh, node);
    for (const Box& box : boxes)
    {
      std::vector<int> between;
      bool inside = true;
      for (int axis = 0; axis < 3; ++axis)
      {
        inside = inside && p[axis] >= box.Low[axis] && p[axis] <= box.High[axis];
        if (p[axis] > box.Low[axis] && p[axis] < box.High[axis])
        {
          between.push_back(axis);
        }
      }
      if (!inside || between.empty())
      {
        continue;
      }
      EXPECT_LT(between.size(), 3u) << "a node inside a cell";
      std::multiset<Place> masters;
      for (int i = 0; i < 4; ++i)
      {
        Place master = p;
        for (std::size_t k = 0; k < between.size(); ++k)
        {
          master[between[k]] =
            static_cast<std::uint32_t>(i >> k & 1 ? box.High[between[k]] : box.Low[between[k]]);
        }
        masters.insert(master);
      }
      const auto known = hanging.insert({ p, masters }).first;
      EXPECT_TRUE(known->second == masters) << "a node that hangs in two ways";
    }
  }
  return hanging;
}

} // namespace

TEST(OctreeMesh, KeysAreBitsOfThreeCoordinatesInTurn)
{
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i)
  {
    Place p;
    for (auto& coordinate : p)
    {
      coordinate = static_cast<std::uint32_t>(random() & 0xfffff);
    }
    std::uint64_t slow = 0;
    for (int bit = 0; bit < 20; ++bit)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        slow |= static_cast<std::uint64_t>(p[axis] >> bit & 1) << (3 * bit + axis);
      }
    }
    ASSERT_EQ(banyan::OctreeMeshKeys::Morton(p), slow);
    ASSERT_EQ(banyan::OctreeMeshKeys::Place(slow), p);
  }
}

TEST(OctreeMesh, IsTheSmallestBalancedDivision)
{
  ThreadPool pool(2);
  for (unsigned seed = 0; seed < 8; ++seed)
  {
    const auto shape = Shape({ 1 + static_cast<int>(seed % 3), 2, 1 }, 3 + seed % 3);
    const auto tooLarge = NearPoints(shape, 1 + seed % 2, seed);
    const OctreeMesh mesh(shape, tooLarge, pool);
    const auto expected = BalanceSlowly(UnbalancedBoxes(shape, tooLarge));
    EXPECT_TRUE(Sorted(Boxes(mesh)) == Sorted(expected)) << seed;
  }
}

TEST(OctreeMesh, CellsTileTheBlockAndShareTheirNodes)
{
  ThreadPool pool(2);
  const auto shape = Shape({ 2, 3, 1 }, 5);
  const OctreeMesh mesh(shape, NearPoints(shape, 5, 7), pool);
  const auto boxes = Boxes(mesh);
  double volume = 0.0;
  std::set<Place> corners;
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    const double edge = mesh.EdgeOfLevel(boxes[i].Level);
    volume += edge * edge * edge;
    for (unsigned which = 0; which < 8; ++which)
    {
      Place expected;
      for (int axis = 0; axis < 3; ++axis)
      {
        expected[axis] =
          static_cast<std::uint32_t>(which >> axis & 1 ? boxes[i].High[axis] : boxes[i].Low[axis]);
      }
      ASSERT_EQ(PlaceOf(mesh, mesh.Corners(i)[which]), expected);
      corners.insert(expected);
    }
    for (std::size_t j = 0; j < i; ++j)
    {
      ASSERT_GT(Contact(boxes[i], boxes[j]), 0) << "cells overlap";
    }
  }
  EXPECT_DOUBLE_EQ(volume, 6.0 * 1000.0);
  EXPECT_EQ(corners.size(), mesh.NodeCount());
}

TEST(OctreeMesh, HangingNodesAreThoseInsideEdgesAndFaces)
{
  ThreadPool pool(2);
  std::size_t edges = 0, faces = 0;
  for (unsigned seed = 0; seed < 4; ++seed)
  {
    const auto shape = Shape({ 2, 1, 2 }, 4);
    const OctreeMesh mesh(shape, NearPoints(shape, 2, seed), pool);
    std::map<Place, std::multiset<Place>> found;
    std::set<std::uint32_t> nodes;
    std::uint32_t last = 0;
    for (const auto& hanging : mesh.Hanging())
    {
      EXPECT_TRUE(nodes.empty() || hanging.Node > last);
      last = hanging.Node;
      nodes.insert(hanging.Node);
      std::multiset<Place> masters;
      for (const std::uint32_t master : hanging.Masters)
      {
        masters.insert(PlaceOf(mesh, master));
      }
      found[PlaceOf(mesh, hanging.Node)] = masters;
      (hanging.Masters[0] == hanging.Masters[2] ? edges : faces)++;
    }
    for (const auto& hanging : mesh.Hanging())
    {
      for (const std::uint32_t master : hanging.Masters)
      {
        EXPECT_EQ(nodes.count(master), 0u) << "a master hangs itself";
      }
    }
    EXPECT_TRUE(found == HangingSlowly(mesh)) << seed;
  }
  EXPECT_GT(edges, 0u);
  EXPECT_GT(faces, 0u);
}

TEST(OctreeMesh, DoesNotDependOnThreads)
{
  const auto shape = Shape({ 2, 2, 2 }, 7);
  ThreadPool one(1), three(3);
  const OctreeMesh a(shape, NearPoints(shape, 40, 3), one),
    b(shape, NearPoints(shape, 40, 3), three);
  ASSERT_EQ(a.CellCount(), b.CellCount());
  ASSERT_EQ(a.NodeCount(), b.NodeCount());
  ASSERT_EQ(a.Hanging().size(), b.Hanging().size());
  for (std::size_t i = 0; i < a.CellCount(); ++i)
  {
    ASSERT_EQ(a.Corners(i), b.Corners(i));
  }
  for (std::size_t i = 0; i < a.Hanging().size(); ++i)
  {
    ASSERT_EQ(a.Hanging()[i].Node, b.Hanging()[i].Node);
    ASSERT_EQ(a.Hanging()[i].Masters, b.Hanging()[i].Masters);
  }
}

TEST(OctreeMesh, PointsAreFoundInTheirCells)
{
  ThreadPool pool(1);
  const auto shape = Shape({ 2, 1, 1 }, 5);
  const OctreeMesh mesh(shape, NearPoints(shape, 3, 11), pool);
  for (std::size_t i = 0; i < mesh.CellCount(); ++i)
  {
    auto point = mesh.CornerPoint(mesh.Cell(i));
    EXPECT_EQ(mesh.CellAt(point), i);
    for (double& p : point)
    {
      p += 0.9 * mesh.EdgeOfLevel(mesh.Cell(i).Level);
    }
    EXPECT_EQ(mesh.CellAt(point), i);
  }
  EXPECT_EQ(mesh.CellAt({ 25.0, -10.0, 10.0 }), mesh.CellCount() - 1);
  EXPECT_THROW(mesh.CellAt({ 4.9, -15.0, 5.0 }), banyan::Error);
  EXPECT_THROW(mesh.CellAt({ 6.0, -15.0, 10.1 }), banyan::Error);
}

TEST(OctreeMesh, ImpossibleShapesAreErrors)
{
  ThreadPool pool(1);
  const auto never = [](const MeshOctant&) { return false; };
  EXPECT_EQ(OctreeMesh(Shape({ 1, 1, 1 }, 0), never, pool).NodeCount(), 8u);
  EXPECT_THROW(OctreeMesh(Shape({ 0, 1, 1 }, 2), never, pool), banyan::Error);
  EXPECT_THROW(OctreeMesh(Shape({ 1, 1, 1 }, 16), never, pool), banyan::Error);
  EXPECT_THROW(OctreeMesh(Shape({ 1, 32, 1 }, 15), never, pool), banyan::Error);
  auto flat = Shape({ 1, 1, 1 }, 2);
  flat.RootEdge = 0.0;
  EXPECT_THROW(OctreeMesh(flat, never, pool), banyan::Error);
}
