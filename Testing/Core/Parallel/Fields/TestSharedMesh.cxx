// SPDX-License-Identifier: BSD-3-Clause
// Octrees and fields that one rank of a machine makes for all of it: those that each rank makes
// alone.
#include "Mesh/Sampling/WarpedMeshes.h"
#include "Parallel/FilesInMemory.h"
#include "Parallel/MeshMadeAlone.h"

#include <gtest/gtest.h>

#include <atomic>

namespace
{

using namespace banyan;
using files_in_memory::FilesInMemory;
using files_in_memory::LongestFile;
using mesh_pieces::PieceOf;
using mesh_pieces::Whole;
using namespace made_alone;

Whole Octree()
{
  return meshes::Make(meshes::Wild({ 2, 1, 1 }, 3, 5), glm::dvec3(0.0), glm::dvec3(1.0), 3);
}

Whole Curved()
{
  return warped::Grid({ 5, 3, 4 }, warped::Bent);
}

std::string MachineOf(const Communicator& communicator, int perMachine)
{
  return std::to_string(communicator.Rank() / perMachine);
}

constexpr double Tolerance = ElementOctree::DefaultTolerance;

const std::vector<std::pair<int, int>> Layouts{ { 1, 1 }, { 2, 1 }, { 2, 2 }, { 3, 2 }, { 4, 4 },
  { 5, 2 } };

TEST(SharedMesh, OneRankOfAMachineFindsWhatEachFindsAlone)
{
  for (const auto& [ranks, perMachine] : Layouts)
  {
    const int onEach = perMachine;
    const int machines = (ranks + perMachine - 1) / perMachine;
    const Whole whole = Octree();
    const std::int64_t before = ElementOctree::FoundSoFar();
    std::atomic<std::int64_t> found{ 0 };
    std::atomic<int> checked{ 0 };
    RunOnSimulatedRanks(ranks,
      [&](Communicator& communicator)
      {
        const Piece piece = PieceOf(whole, communicator);
        SharedMesh shared(
          communicator, piece.Mesh.Mesh(), BrickCells, Tolerance, MachineOf(communicator, onEach));
        communicator.Barrier();
        found = ElementOctree::FoundSoFar() - before;
        communicator.Barrier();
        EXPECT_EQ(shared.WhyNotShared(), "");
        for (const ValuesOn where : { ValuesOn::Points, ValuesOn::Cells, ValuesOn::CellCorners })
        {
          const int component = communicator.Size() % 2 == 0 ? NodeArray::Magnitude : 1;
          const auto field = shared.Field(
            communicator, ArrayOf(piece, where, component), CountOf(piece, where), where);
          const Alone alone(communicator, piece, where, component);
          ExpectSameTree(shared.Tree(), alone.Bricks->Tree());
          ExpectSameField(*field, *alone.Source);
        }
        ++checked;
      });
    EXPECT_EQ(checked.load(), ranks);
    EXPECT_EQ(found.load(), machines) << "one octree is found on each machine";
    EXPECT_TRUE(FilesInMemory().empty()) << "memory is given back";
  }
}

TEST(SharedMesh, MostOfItIsThereOncePerMachine)
{
  const Whole whole = Octree();
  std::vector<MeshBytes> alone(4), together(4);
  for (const int perMachine : { 1, 4 })
  {
    RunOnSimulatedRanks(4,
      [&](Communicator& communicator)
      {
        const Piece piece = PieceOf(whole, communicator);
        SharedMesh shared(communicator, piece.Mesh.Mesh(), BrickCells, Tolerance,
          MachineOf(communicator, perMachine));
        const auto field = shared.Field(communicator, ArrayOf(piece, ValuesOn::Points, 1),
          CountOf(piece, ValuesOn::Points), ValuesOn::Points);
        (perMachine == 1 ? alone : together)[static_cast<std::size_t>(communicator.Rank())] =
          shared.Bytes();
        // Ids, the octree, values and what bricks have of them.
        EXPECT_EQ(FilesInMemory().size(), perMachine == 1 ? 0u : 4u);
        communicator.Barrier();
      });
  }
  for (std::size_t rank = 0; rank < 4; ++rank)
  {
    EXPECT_EQ(alone[rank].Together, 0u);
    EXPECT_TRUE(alone[rank].Leads);
    EXPECT_EQ(together[rank].Leads, rank == 0);
    EXPECT_EQ(together[rank].Together, together[0].Together);
    // But for what aligns arrays.
    EXPECT_NEAR(static_cast<double>(together[rank].Own + together[rank].Together),
      static_cast<double>(alone[rank].Own), 1200.0);
    EXPECT_LT(together[rank].Own, alone[rank].Own / 4);
  }
}

TEST(SharedMesh, CoarserMeshesAreMadeOncePerMachine)
{
  const Whole whole = Octree();
  for (const auto& [ranks, perMachine] : Layouts)
  {
    const int onEach = perMachine;
    RunOnSimulatedRanks(ranks,
      [&](Communicator& communicator)
      {
        const Piece piece = PieceOf(whole, communicator);
        SharedMesh shared(
          communicator, piece.Mesh.Mesh(), BrickCells, Tolerance, MachineOf(communicator, onEach));
        const auto field = shared.Field(communicator, ArrayOf(piece, ValuesOn::Points, 1),
          CountOf(piece, ValuesOn::Points), ValuesOn::Points);
        const Alone alone(communicator, piece, ValuesOn::Points, 1);
        const MeshBytes before = shared.Bytes();
        shared.BringLevels(communicator, 2);
        shared.BringLevels(communicator, 1);
        shared.BringLevels(communicator, 3);
        const MeshBytes after = shared.Bytes();
        // The last rank may be alone on its machine.
        const int here =
          std::min(onEach, communicator.Size() - communicator.Rank() / onEach * onEach);
        EXPECT_EQ(shared.Bricks().LevelCount(), onEach > 1 ? 3 : 0);
        EXPECT_EQ(after.Together > before.Together, here > 1);
        EXPECT_EQ(after.Own > before.Own, onEach > 1);
        for (int level = 1; level <= 3; ++level)
        {
          const Box& domain = shared.Tree().Domain();
          const auto& a = dynamic_cast<const HexBrickSource&>(*field->AtLevel(level, domain));
          const auto& b =
            dynamic_cast<const HexBrickSource&>(*alone.Source->AtLevel(level, domain));
          ExpectSameTree(a.Field().Tree(), b.Field().Tree());
          ExpectSameField(a, b);
        }
        communicator.Barrier();
      });
    EXPECT_TRUE(FilesInMemory().empty());
  }
}

TEST(SharedMesh, ValuesOfANewStepTakeThePlaceOfOldOnes)
{
  const Whole whole = Octree();
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      Piece piece = PieceOf(whole, communicator);
      SharedMesh shared(communicator, piece.Mesh.Mesh(), BrickCells, Tolerance, "one");
      std::unique_ptr<HexBrickSource> field;
      for (int step = 0; step < 4; ++step)
      {
        field.reset();
        field = shared.Field(communicator, ArrayOf(piece, ValuesOn::Points, 1),
          CountOf(piece, ValuesOn::Points), ValuesOn::Points);
        communicator.Barrier();
        EXPECT_EQ(FilesInMemory().size(), 4u);
        const Alone alone(communicator, piece, ValuesOn::Points, 1);
        ExpectSameField(*field, *alone.Source);
        for (float& value : piece.Values)
        {
          value = 0.5f * value + 1.0f;
        }
      }
    });
}

/// Ids of all cells are longer than a file may be then: each rank is on its own from there on. Or
/// the mesh is there already: leaders go on making what they alone can make, and send it.
TEST(SharedMesh, WhatCannotBeHadTogetherIsSent)
{
  const Whole whole = Octree();
  for (const bool fromTheFirst : { false, true })
  {
    std::unique_ptr<LongestFile> limit;
    RunOnSimulatedRanks(5,
      [&](Communicator& communicator)
      {
        const auto forbid = [&]
        {
          communicator.Barrier();
          if (communicator.Rank() == 0)
          {
            limit = std::make_unique<LongestFile>(0);
          }
          communicator.Barrier();
        };
        if (fromTheFirst)
        {
          forbid();
        }
        const Piece piece = PieceOf(whole, communicator);
        SharedMesh shared(
          communicator, piece.Mesh.Mesh(), BrickCells, Tolerance, MachineOf(communicator, 3));
        EXPECT_EQ(shared.WhyNotShared().empty(), !fromTheFirst);
        if (!fromTheFirst)
        {
          forbid();
        }
        for (const ValuesOn where : { ValuesOn::Points, ValuesOn::Cells })
        {
          const auto field =
            shared.Field(communicator, ArrayOf(piece, where, 1), CountOf(piece, where), where);
          const Alone alone(communicator, piece, where, 1);
          ExpectSameTree(shared.Tree(), alone.Bricks->Tree());
          ExpectSameField(*field, *alone.Source);
        }
        communicator.Barrier();
      });
  }
}

TEST(SharedMesh, ARefusalFailsOnAllRanksWithOneSentence)
{
  std::atomic<int> said{ 0 };
  RunOnSimulatedRanks(5,
    [&](Communicator& communicator)
    {
      const Piece piece = PieceOf(Curved(), communicator);
      try
      {
        const SharedMesh shared(
          communicator, piece.Mesh.Mesh(), BrickCells, Tolerance, MachineOf(communicator, 3));
        ADD_FAILURE() << "an octree is found of a curved mesh";
      }
      catch (const Error& error)
      {
        const std::string sentence = error.what();
        said += sentence.find("is not an axis-aligned box") != std::string::npos ? 1 : 0;
      }
      communicator.Barrier();
      EXPECT_TRUE(FilesInMemory().empty()) << "nothing is left of a mesh that is not drawn";
      communicator.Barrier();
    });
  EXPECT_EQ(said.load(), 5);
}

} // namespace
