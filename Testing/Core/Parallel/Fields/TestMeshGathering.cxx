// SPDX-License-Identifier: BSD-3-Clause
// Meshes in pieces on ranks.
#include "Mesh/Octree/HexBrickSource.h"
#include "Mesh/Octree/TinyMeshes.h"
#include "Parallel/Fields/MeshGathering.h"
#include "Parallel/MeshPieces.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <mutex>

namespace
{

using namespace banyan;

using mesh_pieces::Piece;

TEST(MeshGathering, PiecesAreTheMeshThatTheyWereCutFrom)
{
  const auto whole = meshes::Make(meshes::Ball({ 2, 1, 1 }, 4));
  const std::size_t cells = whole.Ids.size() / 8;
  for (const auto& [ranks, perMachine] : std::vector<std::pair<int, int>>{
         { 1, 1 }, { 2, 2 }, { 3, 1 }, { 3, 2 }, { 5, 5 }, { 5, 2 }, { 6, 3 } })
  {
    std::atomic<int> checked{ 0 };
    const int onEach = perMachine;
    RunOnSimulatedRanks(ranks,
      [&](Communicator& communicator)
      {
        const Piece piece = mesh_pieces::PieceOf(whole, communicator);
        const HexMesh mine = piece.Mesh.Mesh();
        NodeCommunicator machines(communicator, std::to_string(communicator.Rank() / onEach));
        const HexMesh mesh = GatherMesh(communicator, machines, mine);
        EXPECT_EQ(machines.Shares(), onEach > 1);
        EXPECT_EQ(machines.WhyNot(), "");
        ASSERT_EQ(mesh.CellCount, static_cast<std::int64_t>(cells));
        const auto tree = meshes::Find(mesh, 1);
        EXPECT_EQ(tree->HoleCells(), 0);
        EXPECT_EQ(tree->Mesh().Points == nullptr, communicator.Size() > 1);
        NodeArray array;
        array.Values = piece.Values.data();
        array.Components = 2;
        array.Component = communicator.Size() % 2 == 0 ? NodeArray::Magnitude : 1;
        const GatheredValues all = GatherNodes(communicator, machines, array, mine.PointCount);
        ThreadPool pool(1);
        const NodalField field(tree, all.Array, pool);
        for (std::size_t i = 0; i < whole.Places.size(); ++i)
        {
          const glm::ivec3 place = whole.Places[i];
          const double expected = place.x + 100.0 * place.y + 10000.0 * place.z;
          ASSERT_NEAR(field.AtPoint(place), expected, 1e-2);
        }
        ++checked;
      });
    EXPECT_EQ(checked.load(), ranks);
  }
}

TEST(MeshGathering, AStrayPointIsSaidOnAllRanks)
{
  const auto whole = meshes::Make(meshes::Ball({ 1, 1, 1 }, 3));
  std::atomic<int> refused{ 0 };
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      Piece piece(whole, 0, 4);
      if (communicator.Rank() == 1)
      {
        piece.Mesh.IdAt(2, 3) = 4711;
      }
      try
      {
        NodeCommunicator machines(communicator);
        GatherMesh(communicator, machines, piece.Mesh.Mesh());
      }
      catch (const Error& error)
      {
        refused += std::string(error.what()).find("point 4711") != std::string::npos ? 1 : 0;
      }
    });
  EXPECT_EQ(refused, 3);
}

} // namespace
