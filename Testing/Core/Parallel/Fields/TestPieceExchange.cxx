// SPDX-License-Identifier: BSD-3-Clause
// Bricks that go from rank to rank, and what is left of them when a rank cannot give its own.
#include "Base/Error.h"
#include "Parallel/Fields/PieceExchange.h"
#include "Parallel/Fields/Pieces.h"

#include <gtest/gtest.h>

#include <array>
#include <mutex>

namespace
{

using namespace pieces;

constexpr int Ranks = 3;
constexpr int BrickCells = 8;
const glm::ivec3 Samples{ 33, 25, 25 };

/// What ranks say and have after the first exchange and a second one.
struct Outcome
{
  std::array<std::vector<std::string>, 2> Said; ///< an error per rank
  std::array<std::size_t, 2> Kept{};            ///< bricks, of all ranks
  bool AllRight = true;                         ///< values of all bricks that were kept
};

/// Every rank wants all bricks of all others, half of them first.
/// @param loses what it has between the two exchanges, though others count on it; -1 for nobody
Outcome ExchangeTwice(int loses)
{
  const std::vector<float> values = scenes::Sampled<float>(scenes::Standard, Samples);
  const std::vector<Box> dealt = Dealt(Deal::Slabs, Samples, Ranks);
  Outcome outcome;
  std::mutex mutex;
  RunOnSimulatedRanks(Ranks,
    [&](Communicator& communicator)
    {
      const int self = communicator.Rank();
      const Piece<float> piece(values, Samples, dealt[static_cast<std::size_t>(self)]);
      const PieceGrid grid(dealt, BrickCells);
      const std::vector<ScalarType> types(Ranks, ScalarType::Float32);
      PieceSamples mine(piece.Array);
      FetchedBricks fetched;
      for (std::int64_t turn = 0; turn < 2; ++turn)
      {
        if (turn == 1 && self == loses)
        {
          mine = PieceSamples();
        }
        std::vector<std::int64_t> wanted;
        std::vector<std::int32_t> counts(Ranks * Ranks, 0);
        for (std::int64_t brick = turn; brick < grid.Count(); brick += 2)
        {
          const int holder = grid.HolderOf(brick);
          for (int rank = 0; rank < Ranks && holder >= 0; ++rank)
          {
            counts[static_cast<std::size_t>(rank * Ranks + holder)] += rank == holder ? 0 : 1;
          }
          if (holder >= 0 && holder != self)
          {
            wanted.push_back(brick);
          }
        }
        std::string said;
        try
        {
          BrickFetch(grid, types, mine, false).Exchange(communicator, wanted, counts, fetched);
        }
        catch (const Error& error)
        {
          said = error.what();
        }
        const std::lock_guard<std::mutex> lock(mutex);
        outcome.Said[static_cast<std::size_t>(turn)].push_back(said);
        outcome.Kept[static_cast<std::size_t>(turn)] += fetched.Count();
        for (const std::int64_t brick : wanted)
        {
          const SampledBox* const box = fetched.Find(brick);
          const glm::ivec3 at = grid.BrickSamples(brick, false).Lo;
          const float expected =
            values[static_cast<std::size_t>(at.x + Samples.x * (at.y + Samples.y * at.z))];
          outcome.AllRight =
            outcome.AllRight && (!box || *static_cast<const float*>(box->View.Values) == expected);
        }
      }
    });
  return outcome;
}

TEST(PieceExchange, BringsAllBricksThatAreWanted)
{
  const Outcome outcome = ExchangeTwice(-1);
  const PieceGrid grid(Dealt(Deal::Slabs, Samples, Ranks), BrickCells);
  std::size_t held = 0;
  for (std::int64_t brick = 0; brick < grid.Count(); ++brick)
  {
    held += grid.HolderOf(brick) >= 0 ? 1 : 0;
  }
  EXPECT_EQ(outcome.Kept[1], (Ranks - 1) * held);
  EXPECT_TRUE(outcome.AllRight);
  EXPECT_EQ(outcome.Said[0], std::vector<std::string>(Ranks));
  EXPECT_EQ(outcome.Said[1], std::vector<std::string>(Ranks));
}

TEST(PieceExchange, NothingIsKeptAnywhereWhenARankCannotGiveItsBricks)
{
  for (int loses = 0; loses < Ranks; ++loses)
  {
    const Outcome outcome = ExchangeTwice(loses);
    EXPECT_GT(outcome.Kept[0], 0u);
    EXPECT_EQ(outcome.Kept[1], 0u) << "of rank " << loses;
    EXPECT_TRUE(outcome.AllRight) << "of rank " << loses;
    ASSERT_FALSE(outcome.Said[1][0].empty());
    EXPECT_EQ(outcome.Said[1], std::vector<std::string>(Ranks, outcome.Said[1][0]));
  }
}

} // namespace
