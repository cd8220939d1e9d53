// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Octree/TinyMeshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace
{

using namespace banyan;
using meshes::Cube;

/// Compares an octree with the cubes that its mesh was made of, in any order.
template <class Real, class Id>
void ExpectLeaves(const ElementOctree& tree, const meshes::OwnMesh<Real, Id>& mesh,
  std::vector<Cube> cubes, const glm::ivec3& shift = glm::ivec3(0))
{
  std::sort(cubes.begin(), cubes.end(),
    [&](const Cube& a, const Cube& b)
    { return KeyOf(a.Corner + shift) < KeyOf(b.Corner + shift); });
  ASSERT_EQ(tree.LeafCount(), static_cast<std::int64_t>(cubes.size()));
  std::set<std::int64_t> cells;
  for (std::size_t i = 0; i < cubes.size(); ++i)
  {
    const auto leaf = static_cast<std::int64_t>(i);
    ASSERT_EQ(tree.CornerOfLeaf(leaf), cubes[i].Corner + shift);
    ASSERT_EQ(tree.LevelOfLeaf(leaf), cubes[i].Level);
    cells.insert(tree.CellOfLeaf(leaf));
    std::int64_t nodes[8];
    tree.NodesOfLeaf(leaf, nodes);
    for (int corner = 0; corner < 8; ++corner)
    {
      const glm::ivec3 p = cubes[i].Corner + (1 << cubes[i].Level) *
                                               glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
      ASSERT_EQ(mesh.Places[static_cast<std::size_t>(nodes[corner])], p);
    }
  }
  EXPECT_EQ(cells.size(), cubes.size());
}

TEST(ElementOctree, FindsTheLeavesOfAnyOctreeInAnyOrder)
{
  for (const unsigned shuffle : { 0u, 7u })
  {
    for (const auto& cubes : { meshes::Ball({ 2, 3, 1 }, 4), meshes::Wild({ 1, 1, 2 }, 4, 3) })
    {
      const auto mesh = meshes::Make(cubes, glm::dvec3(0.0), glm::dvec3(1.0), shuffle);
      for (const int threads : { 1, 2, 3 })
      {
        const auto tree = meshes::Find(mesh.Mesh(), threads);
        ExpectLeaves(*tree, mesh, cubes);
        EXPECT_EQ(tree->HoleCells(), 0);
        EXPECT_TRUE(tree->Twins().empty());
      }
    }
  }
}

TEST(ElementOctree, CellsMayBeBoxesAnywhereInFloatsAndDoubles)
{
  const auto cubes = meshes::Ball({ 2, 2, 2 }, 3);
  const glm::dvec3 origin(-7.25, 12.0, 1e-3);
  const glm::dvec3 edge(0.1, 33.3, 2e-5);
  const auto doubles = meshes::Make<double, std::int32_t>(cubes, origin, edge, 5);
  const auto tree = meshes::Find(doubles.Mesh());
  ExpectLeaves(*tree, doubles, cubes);
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_NEAR(tree->Edge()[axis], edge[axis], 1e-12 * edge[axis]);
    EXPECT_NEAR(tree->Origin()[axis], origin[axis], 1e-12);
  }
  const auto floats = meshes::Make<float>(cubes, origin, edge, 5);
  ExpectLeaves(*meshes::Find(floats.Mesh()), floats, cubes);
}

TEST(ElementOctree, RoundedCoordinatesOfAMapAreRecognised)
{
  // Universal Transverse Mercator: float32 keeps half a metre of 5 million, cells are 10 m.
  const auto cubes = meshes::Ball({ 5, 3, 2 }, 5);
  const glm::dvec3 origin(554238.3, 5105370.7, -10000.0);
  const glm::dvec3 edge(10.0 / 3.0, 10.0, 7.7);
  const auto floats = meshes::Make<float>(cubes, origin, edge, 9);
  ExpectLeaves(*meshes::Find(floats.Mesh()), floats, cubes);
  // The same numbers in doubles: they are known for floats by their bits.
  auto doubles = meshes::Make<double>(cubes, origin, edge, 9);
  std::copy(floats.Points.begin(), floats.Points.end(), doubles.Points.begin());
  ExpectLeaves(*meshes::Find(doubles.Mesh()), doubles, cubes);
  // A flat mesh of many more cells than one edge can be measured for.
  const auto row = meshes::Leaves({ 3000, 1, 1 }, 0, [](const Cube&) { return false; });
  const auto flat = meshes::Make<float>(row, origin, glm::dvec3(7.7, 10.0, 1.0));
  ExpectLeaves(*meshes::Find(flat.Mesh()), flat, row);
}

TEST(ElementOctree, AnOctreeMayBeginBesideItsLargestCells)
{
  // Small cells below x = 8 stand before one large cell: the octree's origin is not the mesh's.
  std::vector<Cube> cubes{ { { 8, 0, 0 }, 3 } };
  for (int i = 0; i < 8; ++i)
  {
    cubes.push_back({ { 4 + (i & 1) * 2, (i >> 1 & 1) * 2, (i >> 2) * 2 }, 1 });
  }
  const auto mesh = meshes::Make(cubes);
  const auto tree = meshes::Find(mesh.Mesh());
  // Finest edges are 2 long, and the origin of the tree lies at 0, not at 4.
  EXPECT_EQ(tree->Edge(), glm::dvec3(2.0));
  EXPECT_EQ(tree->Domain().Lo, glm::ivec3(2, 0, 0));
  EXPECT_EQ(tree->Domain().Hi, glm::ivec3(8, 4, 4));
  EXPECT_EQ(tree->CoarsestLevel(), 2);
  EXPECT_EQ(tree->HoleCells(), 6 * 4 * 4 - 64 - 8);
}

TEST(ElementOctree, LeavesAreFoundByPlace)
{
  const auto cubes = meshes::Wild({ 2, 1, 1 }, 4, 11);
  std::vector<Cube> some;
  for (std::size_t i = 0; i < cubes.size(); ++i)
  {
    if (i % 5 != 0)
    {
      some.push_back(cubes[i]);
    }
  }
  const auto mesh = meshes::Make(some, glm::dvec3(0.0), glm::dvec3(1.0), 3);
  const auto tree = meshes::Find(mesh.Mesh());
  std::int64_t holes = 0;
  for (int z = -1; z <= 16; ++z)
  {
    for (int y = -1; y <= 16; ++y)
    {
      for (int x = -1; x <= 32; ++x)
      {
        const glm::ivec3 p(x, y, z);
        std::int64_t expected = -1;
        for (std::int64_t leaf = 0; leaf < tree->LeafCount(); ++leaf)
        {
          const glm::ivec3 low = tree->CornerOfLeaf(leaf);
          expected = Box{ low, low + (1 << tree->LevelOfLeaf(leaf)) }.Contains(p) ? leaf : expected;
        }
        ASSERT_EQ(tree->LeafAt(p), expected);
        holes += expected < 0 && tree->Domain().Contains(p) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(holes, 0);
  EXPECT_EQ(tree->HoleCells(), holes);
}

/// The slow way: every point against every leaf.
std::map<std::int64_t, std::int64_t> HangingOf(
  const ElementOctree& tree, const std::vector<glm::ivec3>& places)
{
  std::map<std::int64_t, std::int64_t> hanging;
  for (std::size_t node = 0; node < places.size(); ++node)
  {
    int level = -1;
    for (std::int64_t leaf = 0; leaf < tree.LeafCount(); ++leaf)
    {
      const int edge = 1 << tree.LevelOfLeaf(leaf);
      const glm::ivec3 in = places[node] - tree.CornerOfLeaf(leaf);
      const bool touches = Box{ glm::ivec3(0), glm::ivec3(edge + 1) }.Contains(in);
      const bool corner = in.x % edge == 0 && in.y % edge == 0 && in.z % edge == 0;
      if (touches && !corner && tree.LevelOfLeaf(leaf) > level)
      {
        level = tree.LevelOfLeaf(leaf);
        hanging[static_cast<std::int64_t>(node)] = level;
      }
    }
  }
  return hanging;
}

TEST(ElementOctree, PointsThatHangAreFound)
{
  for (const auto& cubes : { meshes::Ball({ 1, 2, 1 }, 4), meshes::Wild({ 1, 1, 1 }, 4, 2) })
  {
    const auto mesh = meshes::Make(cubes, glm::dvec3(0.0), glm::dvec3(1.0), 4);
    const auto tree = meshes::Find(mesh.Mesh());
    const auto expected = HangingOf(*tree, mesh.Places);
    ASSERT_EQ(tree->Hanging().size(), expected.size());
    EXPECT_GT(expected.size(), 50u);
    int level = 30;
    for (const HangingNode& hanging : tree->Hanging())
    {
      ASSERT_EQ(tree->LevelOfLeaf(hanging.Leaf), expected.at(hanging.Node));
      EXPECT_LE(tree->LevelOfLeaf(hanging.Leaf), level) << "large cells come first";
      level = tree->LevelOfLeaf(hanging.Leaf);
      const glm::vec3 at =
        glm::vec3(tree->CornerOfLeaf(hanging.Leaf)) + hanging.Part * float(1 << level);
      EXPECT_EQ(glm::ivec3(at), mesh.Places[static_cast<std::size_t>(hanging.Node)]);
    }
  }
}

TEST(ElementOctree, BalanceIsCounted)
{
  const auto halved = [](const Cube& cube) { return cube.Corner == glm::ivec3(0); };
  // One corner refined twice: its neighbours are one level apart, then two.
  const auto balanced = meshes::Make(meshes::Leaves({ 2, 1, 1 }, 1, halved));
  EXPECT_EQ(meshes::Find(balanced.Mesh())->UnbalancedNodes(), 0);
  const auto unbalanced = meshes::Make(
    meshes::Leaves({ 2, 1, 1 }, 2, [](const Cube& cube) { return cube.Corner.x < 4; }));
  EXPECT_GT(meshes::Find(unbalanced.Mesh())->UnbalancedNodes(), 0);
}

TEST(ElementOctree, PointsThatCoincideCountAsTheFirst)
{
  // Each cell with points of its own.
  const auto cubes = meshes::Ball({ 1, 1, 1 }, 3);
  const auto shared = meshes::Make(cubes);
  meshes::OwnMesh<double, std::int64_t> apart;
  for (const std::int64_t id : shared.Ids)
  {
    apart.Ids.push_back(static_cast<std::int64_t>(apart.Places.size()));
    apart.Places.push_back(shared.Places[static_cast<std::size_t>(id)]);
    for (int axis = 0; axis < 3; ++axis)
    {
      apart.Points.push_back(apart.Places.back()[axis]);
    }
  }
  const auto one = meshes::Find(shared.Mesh());
  const auto tree = meshes::Find(apart.Mesh());
  ExpectLeaves(*tree, apart, cubes);
  const std::size_t hanging = HangingOf(*tree, apart.Places).size();
  EXPECT_EQ(tree->Hanging().size(), hanging);
  EXPECT_EQ(one->Hanging().size(), HangingOf(*one, shared.Places).size());
  // All points are the first of their place, hang, or are twins of the first.
  EXPECT_EQ(apart.Places.size() - hanging - tree->Twins().size(),
    shared.Places.size() - one->Hanging().size());
  for (const TwinNode& twin : tree->Twins())
  {
    EXPECT_LT(twin.First, twin.Node);
    EXPECT_EQ(apart.Places[static_cast<std::size_t>(twin.First)],
      apart.Places[static_cast<std::size_t>(twin.Node)]);
  }
}

} // namespace
