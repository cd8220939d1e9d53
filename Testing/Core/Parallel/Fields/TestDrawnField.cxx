// SPDX-License-Identifier: BSD-3-Clause
// Kinds of fields behind one interface: where they lie, what they draw, and what all ranks hear
// when one fails.
#include "Parallel/Fields/MeshField.h"
#include "Parallel/Fields/Pieces.h"
#include "Parallel/Fields/PiecesField.h"
#include "Parallel/Fields/WholeField.h"
#include "Parallel/Frame/DistributedFrame.h"

#include <gtest/gtest.h>

namespace
{

using namespace pieces;

constexpr std::uint64_t Budget = 4u << 20;
const glm::ivec3 Samples{ 25, 21, 23 };

/// One frame, with its calls in their order.
FloatImage Draw(Communicator& communicator, DrawnField& field, ThreadPool& pool)
{
  RayScene scene = scenes::Scene(Samples, glm::ivec2(61, 47), glm::dmat4(1.0), 0.8, false);
  scene.Transfer = scenes::Tabulate(scenes::Sparse);
  field.BeginFrame(communicator, scene);
  FrameStatistics statistics;
  FloatImage picture = DrawDistributed(
    communicator, scene, { field.Source(), field.Zones(), Budget, pool }, statistics);
  field.ReadAhead(scene, field.Zones()[static_cast<std::size_t>(communicator.Rank())]);
  field.EndFrame(communicator);
  return picture;
}

TEST(DrawnField, LiesWhereItsSamplesDo)
{
  Grid grid;
  grid.Origin = { 10.0, 20.0, 30.0 };
  grid.Spacing = { 2.0, 1.0, 0.5 };
  const FieldPlace place = PlaceOfSamples(grid, { { 1, 2, 3 }, { 6, 5, 6 } });
  EXPECT_EQ(place.Cells.Lo, glm::ivec3(0));
  EXPECT_EQ(place.Cells.Hi, glm::ivec3(4, 2, 2));
  EXPECT_EQ(place.CellSize, 0.5);
  const std::array<double, 6> bounds{ { 12.0, 20.0, 22.0, 24.0, 31.5, 32.5 } };
  EXPECT_EQ(place.Bounds, bounds);
  EXPECT_EQ(glm::dvec3(place.IndexToPhysical * glm::dvec4(1, 1, 1, 1)), glm::dvec3(14, 23, 32));
}

TEST(DrawnField, AlwaysHasLevelsThatMemoryHolds)
{
  EXPECT_EQ(DrawnField::CoarsestLevelOf({ 0, 0, 0 }), 3);
  EXPECT_EQ(DrawnField::CoarsestLevelOf({ 1023, 1023, 1023 }), 3);
  EXPECT_EQ(DrawnField::CoarsestLevelOf({ 1024, 5, 5 }), 3);
  EXPECT_EQ(DrawnField::CoarsestLevelOf({ 5, 1025, 5 }), 4);
  EXPECT_EQ(DrawnField::CoarsestLevelOf({ 4095, 4095, 4095 }), 5);
  EXPECT_EQ(DrawnField::CoarsestLevelOf({ 16384, 16384, 128 }), 7);
}

TEST(DrawnField, PiecesAreDrawnLikeTheWhole)
{
  const std::vector<double> values = scenes::Sampled<double>(scenes::Standard, Samples);
  ThreadPool pool(1);
  const SampleArray array = scenes::ArrayOf(values, Samples);
  const ValueRange range = FiniteRange(array, pool);
  WholeField whole;
  whole.Take(
    std::make_unique<ArrayBrickSource>(array, 16, MaskRange{ range.Low, range.High }, pool),
    { glm::ivec3(0), Samples - 1 });
  const auto alone = MakeSelfCommunicator();
  const FloatImage expected = Draw(*alone, whole, pool);

  const std::vector<Box> dealt = Dealt(Deal::Slabs, Samples, 3);
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      const Piece<double> mine(
        values, Samples, dealt[static_cast<std::size_t>(communicator.Rank())]);
      ThreadPool own(1);
      PiecesField field;
      field.Take(communicator, dealt, mine.Array, Samples - 1, 8, LoadBalancing::Off);
      EXPECT_FALSE(field.IsMesh() || field.IsEncoded());
      const FloatImage picture = Draw(communicator, field, own);
      if (communicator.Rank() == 0)
      {
        EXPECT_LT(MaxDifference(expected, picture), 1e-5);
      }
      field.Clear();
      EXPECT_EQ(field.Source(), nullptr);
    });
}

TEST(DrawnField, AMeshWithoutCellsIsNoOctree)
{
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      MeshField field;
      MeshField::Piece piece;
      piece.OtherCells = communicator.Rank() == 2 ? "7 tetrahedra" : "";
      EXPECT_THROW(field.Take(communicator, piece, 0.0, LoadBalancing::Off), Error);
      EXPECT_EQ(field.Source(), nullptr);
    });
}

} // namespace
