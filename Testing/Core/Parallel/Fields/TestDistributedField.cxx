// SPDX-License-Identifier: BSD-3-Clause
// Which kind of field ranks draw, from what each of them has, and what all of them hear when one
// cannot.
#include "Mesh/Sampling/WarpedMeshes.h"
#include "Parallel/Fields/ArrayInput.h"
#include "Parallel/Fields/DistributedField.h"
#include "Parallel/Fields/PiecesField.h"
#include "Parallel/Fields/WholeField.h"
#include "Render/Cells/CellSource.h"

#include <gtest/gtest.h>

namespace
{

using namespace array_input;

TEST(DistributedField, OneRankDrawsTheWhole)
{
  const auto alone = MakeSelfCommunicator();
  Dealt data(*alone);
  DistributedField field;
  EXPECT_TRUE(field.Empty());
  field.Update(*alone, data.In);
  EXPECT_EQ(field.Problem(), "");
  EXPECT_NE(dynamic_cast<WholeField*>(&field.Drawn()), nullptr);
  EXPECT_EQ(field.Place().Cells.Hi, GridSamples - 1);
  EXPECT_EQ(field.Place().Bounds[0], First.x);
  ThreadPool pool(1);
  const ValueRange range = FiniteRange(data.In.Values, pool);
  EXPECT_EQ(field.Range().Low, range.Low);
  EXPECT_EQ(field.Range().High, range.High);
  ASSERT_NE(field.Drawn().Source(), nullptr);
}

TEST(DistributedField, RanksAgreeOnPiecesAndOnWhatIsNew)
{
  RunOnSimulatedRanks(4,
    [](Communicator& communicator)
    {
      Dealt data(communicator, pieces::Deal::SomeIdle);
      DistributedField field;
      field.Update(communicator, data.In);
      EXPECT_EQ(field.Problem(), "");
      const DrawnField* const drawn = &field.Drawn();
      EXPECT_NE(dynamic_cast<const PiecesField*>(drawn), nullptr);
      EXPECT_EQ(field.Place().Cells.Hi, GridSamples - 1);
      EXPECT_EQ(drawn->Zones().size(), 4u);
      const std::uint64_t version = field.Version();
      field.Update(communicator, data.In);
      EXPECT_EQ(field.Version(), version);
      data.In.Changes += communicator.Rank() == 3 ? 1 : 0;
      field.Update(communicator, data.In);
      EXPECT_NE(field.Version(), version);
      EXPECT_EQ(&field.Drawn(), drawn) << "the next step is in the same field";
      data.In.Piece = {};
      ++data.In.Changes;
      field.Update(communicator, data.In);
      EXPECT_TRUE(field.Empty());
      EXPECT_EQ(field.Problem(), "");
      EXPECT_EQ(field.Drawn().Source(), nullptr);
    });
}

/// Ranks whose input is changed by one of them, and what all hear then. Afterwards all is well.
void ExpectProblem(const std::string& problem, const std::function<void(Input&, int rank)>& spoil)
{
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      Dealt data(communicator);
      DistributedField field;
      field.Update(communicator, data.In);
      const std::uint64_t version = field.Version();
      spoil(data.In, communicator.Rank());
      ++data.In.Changes;
      field.Update(communicator, data.In);
      EXPECT_EQ(field.Problem().substr(0, problem.size()), problem);
      EXPECT_TRUE(field.Empty());
      EXPECT_EQ(field.Drawn().Source(), nullptr);
      EXPECT_NE(field.Version(), version);
      field.Update(communicator, data.In);
      EXPECT_FALSE(field.Problem().empty()) << "is said as long as it stays";
      Dealt again(communicator);
      again.In.Changes = 9;
      field.Update(communicator, again.In);
      EXPECT_EQ(field.Problem(), "");
      EXPECT_FALSE(field.Empty());
    });
}

TEST(DistributedField, AllRanksHearWhatOneCannot)
{
  ExpectProblem("Rank 1: It has no array.",
    [](Input& input, int rank) { input.Problem = rank == 1 ? "It has no array." : ""; });
  ExpectProblem("Rank 2: It cannot be read.",
    [](Input& input, int rank) { input.Unreadable = rank == 2 ? "It cannot be read." : ""; });
  ExpectProblem("Rank 2: The pieces of the data do not belong to one grid: the spacing differs "
                "from that on rank 0.",
    [](Input& input, int rank) { input.Piece.Spacing[1] = rank == 2 ? 2.0 : 1.0; });
  ExpectProblem(
    "Rank 1: The pieces of the data do not belong to one grid: the number of components",
    [](Input& input, int rank) { input.Piece.Components = rank == 0 ? 3 : 1; });
  ExpectProblem("Rank 0: One rank has image data and another one a mesh of cells.",
    [](Input& input, int rank)
    { input.Piece.Has = rank == 1 ? PieceFacts::Kind::Mesh : input.Piece.Has; });
}

TEST(DistributedField, WhatOneRankHidesIsHiddenOnAll)
{
  RunOnSimulatedRanks(3,
    [](Communicator& communicator)
    {
      Dealt data(communicator);
      if (communicator.Rank() == 2)
      {
        data.In.Piece.HiddenCells = 1;
        data.In.Hidden = { First + glm::ivec3(3, 4, 15), First + glm::ivec3(5, 7, 16) };
      }
      DistributedField field;
      field.Update(communicator, data.In);
      EXPECT_EQ(field.Problem(), "");
      BrickSource* const source = field.Drawn().Source();
      ASSERT_NE(source, nullptr);
      ASSERT_NE(source->Hidden(), nullptr);
      EXPECT_EQ(source->Hidden()->CountIn(field.Place().Cells), 6);
      EXPECT_TRUE(source->Hidden()->All({ { 3, 4, 15 }, { 5, 7, 16 } }));
    });
}

TEST(DistributedField, HexahedraOfAllRanksAreAMesh)
{
  const mesh_pieces::Whole whole =
    meshes::Make(meshes::Wild({ 2, 1, 1 }, 3, 5), glm::dvec3(0.0), glm::dvec3(1.0), 3);
  RunOnSimulatedRanks(2,
    [&](Communicator& communicator)
    {
      const mesh_pieces::Piece piece = mesh_pieces::PieceOf(whole, communicator);
      Input input;
      input.Piece.Has = PieceFacts::Kind::Mesh;
      input.Boxes.Mesh = piece.Mesh.Mesh();
      input.Boxes.Values = made_alone::ArrayOf(piece, ValuesOn::Points, 1);
      DistributedField field;
      field.Update(communicator, input);
      EXPECT_EQ(field.Problem(), "");
      EXPECT_TRUE(field.Drawn().IsMesh());
      EXPECT_FALSE(field.Empty());
      // An image takes its place.
      Dealt data(communicator);
      data.In.Changes = 7;
      field.Update(communicator, data.In);
      EXPECT_FALSE(field.Drawn().IsMesh());
      EXPECT_EQ(field.Place().Cells.Hi, GridSamples - 1);
    });
}

/// Gives an input hexahedra that may be an octree.
/// @param types of cells; must stay
void GiveHexahedra(Input& input, const mesh_pieces::Piece& piece, ValuesOn where,
  const std::vector<std::uint8_t>& types)
{
  const HexMesh boxes = piece.Mesh.Mesh();
  input.Piece.Has = PieceFacts::Kind::Mesh;
  input.Boxes.Mesh = boxes;
  input.Boxes.Values = made_alone::ArrayOf(piece, where, 1);
  input.Boxes.Where = where;
  CellMesh& mesh = input.AnyCells.Mesh;
  mesh.Points = boxes.Points;
  mesh.PointType = boxes.PointType;
  mesh.PointCount = boxes.PointCount;
  mesh.Connectivity = boxes.Connectivity;
  mesh.ConnectivityCount = 8 * boxes.CellCount;
  mesh.IdType = boxes.IdType;
  mesh.PerCell = 8;
  mesh.CellCount = boxes.CellCount;
  mesh.Types = types.data();
  input.AnyCells.Values = input.Boxes.Values;
  input.AnyCells.Where = where;
}

TEST(DistributedField, HexahedraThatAreNoOctreeAreCells)
{
  const mesh_pieces::Whole whole = warped::Grid({ 5, 3, 4 }, warped::Bent);
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      const mesh_pieces::Piece piece = mesh_pieces::PieceOf(whole, communicator);
      const HexMesh boxes = piece.Mesh.Mesh();
      const std::vector<std::uint8_t> types(static_cast<std::size_t>(boxes.CellCount), 12);
      Input input;
      GiveHexahedra(input, piece, ValuesOn::Points, types);
      DistributedField field;
      for (int step = 0; step < 3; ++step)
      {
        field.Update(communicator, input);
        EXPECT_EQ(field.Problem(), "");
        const auto* const source = dynamic_cast<const CellSource*>(field.Drawn().Source());
        ASSERT_NE(source, nullptr);
        EXPECT_EQ(source->Cells().Cells->Order.size(), boxes.CellCount);
        EXPECT_EQ(source->Cells().Cells->Count, whole.Ids.size() / 8);
        EXPECT_EQ(input.Tried, 1) << "a mesh that is known to be no octree is not tried again";
        ++input.Changes;
      }
      communicator.Barrier();
    });
}

TEST(DistributedField, OctreesWhoseCellValuesAreKeptAreCellsMeanwhile)
{
  const mesh_pieces::Whole whole =
    meshes::Make(meshes::Wild({ 2, 1, 1 }, 3, 5), glm::dvec3(0.0), glm::dvec3(1.0), 3);
  RunOnSimulatedRanks(2,
    [&](Communicator& communicator)
    {
      const mesh_pieces::Piece piece = mesh_pieces::PieceOf(whole, communicator);
      const std::vector<std::uint8_t> types(
        static_cast<std::size_t>(piece.Mesh.Mesh().CellCount), 12);
      Input input;
      GiveHexahedra(input, piece, ValuesOn::Cells, types);
      DistributedField field;
      for (const bool keeps : { false, true, false, true })
      {
        // One rank says so: the other one may have no values of its own.
        input.AnyCells.KeepsCellValues = keeps && communicator.Rank() == 1;
        ++input.Changes;
        field.Update(communicator, input);
        EXPECT_EQ(field.Problem(), "");
        const auto* const source = dynamic_cast<const CellSource*>(field.Drawn().Source());
        EXPECT_EQ(source != nullptr, keeps);
        EXPECT_TRUE(!source || source->Cells().OfCells);
      }
      communicator.Barrier();
    });
}

} // namespace
