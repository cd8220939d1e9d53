// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Parallel_MeshMadeAlone_h
#define banyan_Testing_Core_Parallel_MeshMadeAlone_h

#include "Parallel/Fields/SharedMesh.h"
#include "Parallel/MeshPieces.h"

#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

/// The octree, the bricks and the field of a mesh as one rank makes them alone, to compare with
/// those that ranks make together.
namespace made_alone
{

using namespace banyan;
using mesh_pieces::Piece;

constexpr int BrickCells = 4;

inline NodeArray ArrayOf(const Piece& piece, ValuesOn where, int component)
{
  NodeArray array;
  if (where == ValuesOn::Cells)
  {
    array.Values = piece.CellValues.data();
    array.Type = ScalarType::Float64;
    return array;
  }
  array.Values = piece.Values.data();
  array.Components = 2;
  array.Component = component;
  return array;
}

inline std::int64_t CountOf(const Piece& piece, ValuesOn where)
{
  const HexMesh mesh = piece.Mesh.Mesh();
  return where == ValuesOn::Cells ? mesh.CellCount : mesh.PointCount;
}

/// What a rank makes alone, slowly and step by step, of what was gathered.
struct Alone
{
  std::shared_ptr<const HexBricks> Bricks;
  std::unique_ptr<HexBrickSource> Source;

  Alone(Communicator& communicator, const Piece& piece, ValuesOn where, int component)
  {
    ThreadPool pool(1);
    NodeCommunicator machines(communicator, "");
    const HexMesh mesh = GatherMesh(communicator, machines, piece.Mesh.Mesh());
    const GatheredValues all =
      GatherNodes(communicator, machines, ArrayOf(piece, where, component), CountOf(piece, where));
    const std::shared_ptr<const ElementOctree> tree = ElementOctree::Find(mesh, pool);
    this->Bricks = std::make_shared<const HexBricks>(tree, BrickCells);
    const auto made = where == ValuesOn::Points
                        ? nullptr
                        : std::make_unique<CellNodes>(*tree, all.Array, where, pool);
    this->Source =
      std::make_unique<HexBrickSource>(this->Bricks, made ? made->Nodes() : all.Array, pool);
  }
};

inline void ExpectSameTree(const ElementOctree& a, const ElementOctree& b)
{
  ASSERT_EQ(a.LeafCount(), b.LeafCount());
  ASSERT_EQ(a.Mesh().PointCount, b.Mesh().PointCount);
  EXPECT_EQ(a.Origin(), b.Origin());
  EXPECT_EQ(a.Edge(), b.Edge());
  EXPECT_EQ(a.Tolerance(), b.Tolerance());
  EXPECT_TRUE(a.Domain() == b.Domain());
  EXPECT_EQ(a.CoarsestLevel(), b.CoarsestLevel());
  EXPECT_EQ(a.HoleCells(), b.HoleCells());
  EXPECT_EQ(a.UnbalancedNodes(), b.UnbalancedNodes());
  for (std::int64_t leaf = 0; leaf < a.LeafCount(); ++leaf)
  {
    ASSERT_EQ(a.KeyOfLeaf(leaf), b.KeyOfLeaf(leaf));
    ASSERT_EQ(a.LevelOfLeaf(leaf), b.LevelOfLeaf(leaf));
    ASSERT_EQ(a.CellOfLeaf(leaf), b.CellOfLeaf(leaf));
    ASSERT_EQ(a.LeafAt(a.CornerOfLeaf(leaf)), b.LeafAt(a.CornerOfLeaf(leaf)));
    std::int64_t nodes[2][8];
    a.NodesOfLeaf(leaf, nodes[0]);
    b.NodesOfLeaf(leaf, nodes[1]);
    ASSERT_EQ(std::memcmp(nodes[0], nodes[1], sizeof(nodes[0])), 0);
  }
  ASSERT_EQ(a.Hanging().size(), b.Hanging().size());
  for (std::size_t i = 0; i < a.Hanging().size(); ++i)
  {
    ASSERT_EQ(a.Hanging()[i].Node, b.Hanging()[i].Node);
    ASSERT_EQ(a.Hanging()[i].Leaf, b.Hanging()[i].Leaf);
    ASSERT_EQ(a.Hanging()[i].Part, b.Hanging()[i].Part);
  }
  ASSERT_EQ(a.Twins().size(), b.Twins().size());
  for (std::size_t i = 0; i < a.Twins().size(); ++i)
  {
    ASSERT_EQ(a.Twins()[i].Node, b.Twins()[i].Node);
    ASSERT_EQ(a.Twins()[i].First, b.Twins()[i].First);
  }
}

inline void ExpectSameField(const HexBrickSource& a, const HexBrickSource& b)
{
  ASSERT_EQ(a.Field().Type(), b.Field().Type());
  for (std::int64_t node = 0; node < a.Field().Tree().Mesh().PointCount; ++node)
  {
    ASSERT_EQ(a.Field().AtNode(node), b.Field().AtNode(node)) << node;
  }
  ASSERT_EQ(a.Bricks(), b.Bricks());
  EXPECT_EQ(a.MasksAreOver().Low, b.MasksAreOver().Low);
  EXPECT_EQ(a.MasksAreOver().High, b.MasksAreOver().High);
  for (std::int64_t brick = 0; brick < a.Bricks().x; ++brick)
  {
    ASSERT_TRUE(a.CellsOf(brick) == b.CellsOf(brick));
    ASSERT_EQ(a.RangeOf(brick).Low, b.RangeOf(brick).Low);
    ASSERT_EQ(a.RangeOf(brick).High, b.RangeOf(brick).High);
    ASSERT_EQ(a.MaskOf(brick), b.MaskOf(brick));
    ASSERT_EQ(a.UniformValueOf(brick).has_value(), b.UniformValueOf(brick).has_value());
  }
}

} // namespace made_alone

#endif
