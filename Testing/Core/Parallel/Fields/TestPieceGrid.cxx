// SPDX-License-Identifier: BSD-3-Clause
// Who holds what, and the zones in which everything is drawn where it lies.
#include "Base/Error.h"
#include "Parallel/Fields/PieceZones.h"
#include "Parallel/Fields/Pieces.h"

#include <gtest/gtest.h>

namespace
{

using namespace pieces;

const glm::ivec3 Samples{ 25, 18, 31 };
constexpr int BrickCells = 7;

class EveryDealOfAGrid : public ::testing::TestWithParam<std::tuple<Deal, int>>
{
protected:
  Deal Dealing() const { return std::get<0>(GetParam()); }
  int Ranks() const { return std::get<1>(GetParam()); }
  PieceGrid MakeGrid() const
  {
    return PieceGrid(Dealt(this->Dealing(), Samples, this->Ranks()), BrickCells);
  }
  /// The lowest rank whose piece has all corners of a cell; -1 for none.
  static int HolderOf(const PieceGrid& grid, const glm::ivec3& cell)
  {
    for (int rank = 0; rank < grid.Ranks(); ++rank)
    {
      if (grid.SamplesOf(rank).Contains(Box{ cell, cell + 2 }))
      {
        return rank;
      }
    }
    return -1;
  }
};

TEST_P(EveryDealOfAGrid, EachCellIsInOneBrickOfTheLowestRankThatHasIt)
{
  const PieceGrid grid = this->MakeGrid();
  const Box cells{ glm::ivec3(0), Samples - 1 };
  std::vector<int> found(static_cast<std::size_t>(cells.Count()), -2);
  for (std::int64_t brick = 0; brick < grid.Count(); ++brick)
  {
    const Box own = grid.CellsOf(brick);
    const glm::ivec3 size = own.Size();
    EXPECT_LE(std::max({ size.x, size.y, size.z }), BrickCells);
    for (int i = 0; i < own.Count(); ++i)
    {
      const glm::ivec3 cell =
        own.Lo + glm::ivec3(i % size.x, i / size.x % size.y, i / size.x / size.y);
      int& holder = found[cell.x + cells.Hi.x * (cell.y + std::size_t(cells.Hi.y) * cell.z)];
      EXPECT_EQ(holder, -2) << "in two bricks";
      holder = grid.HolderOf(brick);
      ASSERT_EQ(holder, HolderOf(grid, cell));
    }
  }
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    const auto n = static_cast<int>(i);
    const glm::ivec3 cell(n % cells.Hi.x, n / cells.Hi.x % cells.Hi.y, n / cells.Hi.x / cells.Hi.y);
    EXPECT_TRUE(found[i] != -2 || HolderOf(grid, cell) == -1) << "in no brick";
  }
}

TEST_P(EveryDealOfAGrid, ShellsHaveOnceWhatBricksTakeAndSomebodyHas)
{
  const PieceGrid grid = this->MakeGrid();
  for (int rank = 0; rank < grid.Ranks(); ++rank)
  {
    const std::vector<PieceGrid::ShellPart> shell = grid.ShellOf(rank);
    for (std::size_t i = 0; i < shell.size(); ++i)
    {
      EXPECT_NE(shell[i].From, rank);
      EXPECT_TRUE(grid.SamplesOf(shell[i].From).Contains(shell[i].Samples));
      EXPECT_TRUE(Intersection(shell[i].Samples, grid.SamplesOf(rank)).Empty());
      for (std::size_t j = 0; j < i; ++j)
      {
        EXPECT_TRUE(Intersection(shell[i].Samples, shell[j].Samples).Empty());
      }
    }
    for (std::int64_t brick = 0; brick < grid.Count(); ++brick)
    {
      if (grid.HolderOf(brick) != rank)
      {
        continue;
      }
      const Box samples = grid.BrickSamples(brick, true);
      std::int64_t there = Intersection(samples, grid.SamplesOf(rank)).Count();
      for (const PieceGrid::ShellPart& part : shell)
      {
        const Box common = Intersection(part.Samples, samples);
        there += common.Empty() ? 0 : common.Count();
      }
      EXPECT_EQ(there == samples.Count(), grid.IsKnown(samples)) << "brick " << brick;
    }
  }
}

TEST_P(EveryDealOfAGrid, ZonesAreDisjointAndMostlyThePieces)
{
  const PieceGrid grid = this->MakeGrid();
  const ZonesOfRanks zones = ZonesOfPieces(grid, Samples - 1);
  const std::vector<Box> boxes = zones.Zones();
  ASSERT_EQ(static_cast<int>(boxes.size()), this->Ranks());
  std::int64_t cells = 0;
  std::int64_t elsewhere = 0;
  for (int rank = 0; rank < this->Ranks(); ++rank)
  {
    const Box& zone = boxes[static_cast<std::size_t>(rank)];
    cells += zone.Empty() ? 0 : zone.Count();
    for (const PieceGrid::Holding& holding : grid.Holdings())
    {
      const Box part = Intersection(holding.Cells, zone);
      elsewhere += holding.Rank != rank && !part.Empty() ? part.Count() : 0;
    }
  }
  EXPECT_EQ(cells, (Box{ glm::ivec3(0), Samples - 1 }).Count());
  if (this->Dealing() == Deal::Pinwheel && this->Ranks() >= 5)
  {
    EXPECT_GT(elsewhere, 0);
    EXPECT_LT(elsewhere, cells / 4);
  }
  else
  {
    EXPECT_EQ(elsewhere, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Deals, EveryDealOfAGrid,
  ::testing::Combine(::testing::Values(Deal::Slabs, Deal::Blocks, Deal::Ghosts, Deal::OneHasAll,
                       Deal::Everybody, Deal::SomeIdle, Deal::Hole, Deal::Pinwheel),
    ::testing::Values(1, 2, 3, 5, 8, 13)));

TEST(PieceZones, RanksNeedNotLieInTheOrderOfTheTree)
{
  // The first rank has the middle.
  const PieceGrid grid(
    { { { 0, 0, 8 }, { 9, 9, 17 } }, { { 0, 0, 0 }, { 9, 9, 9 } }, { { 0, 0, 16 }, { 9, 9, 25 } } },
    4);
  const std::vector<Box> zones = ZonesOfPieces(grid, { 8, 8, 24 }).Zones();
  EXPECT_EQ(zones[0], (Box{ { 0, 0, 8 }, { 8, 8, 16 } }));
  EXPECT_EQ(zones[1], (Box{ { 0, 0, 0 }, { 8, 8, 8 } }));
  EXPECT_EQ(zones[2], (Box{ { 0, 0, 16 }, { 8, 8, 24 } }));
}

TEST(PieceZones, IdleRanksCanTakePartOfAnothersZone)
{
  const PieceGrid grid({ Box{}, { glm::ivec3(0), glm::ivec3(65) }, Box{}, Box{} }, 16);
  const ZonesOfRanks zones = ZonesOfPieces(grid, glm::ivec3(64));
  BrickCosts costs(glm::ivec3(64), 8);
  std::fill(costs.Values.begin(), costs.Values.end(), 1.0);
  const std::vector<double> speeds(4, 1.0);
  const CostSums sums(costs);
  EXPECT_NEAR(ExpectedImbalance(zones.Tree, sums, speeds), 4.0, 1e-9);
  const ZoneTree balanced = RebalanceMeasuredCost(zones.Tree, costs, speeds);
  EXPECT_NEAR(ExpectedImbalance(balanced, sums, speeds), 1.0, 1e-9);
}

TEST(PieceGrid, RefusesWhatIsNoGrid)
{
  EXPECT_THROW(PieceGrid({ Box{ glm::ivec3(0), glm::ivec3(4) } }, 0), Error);
  EXPECT_THROW(PieceGrid({ Box{ { -1, 0, 0 }, glm::ivec3(4) } }, 4), Error);
  EXPECT_THROW(ZonesOfPieces(PieceGrid({}, 4), glm::ivec3(4)), Error);
  const PieceGrid nothing({ Box{}, Box{ glm::ivec3(0), { 5, 5, 1 } } }, 4);
  EXPECT_EQ(nothing.Count(), 0);
}

} // namespace
