// SPDX-License-Identifier: BSD-3-Clause
// Frames that threads of all ranks draw while main threads serve them: they have the bits of frames
// that are drawn directly, whatever was broken off before.
#include "Parallel/Frame/MeshSteps.h"
#include "Parallel/Frame/PlainSteps.h"
#include "Parallel/Frame/ServedFrames.h"

namespace
{

using namespace banyan;
using namespace banyan::played;

template <class Player>
void ExpectFramesOfThreads(int mostRanks)
{
  for (int ranks = 1; ranks <= mostRanks; ++ranks)
  {
    RunOnSimulatedRanks(ranks,
      [](Communicator& communicator)
      {
        ServedPlayer<Player> player(communicator);
        Situation now;
        for (const bool shaded : { false, true })
        {
          for (const bool interacting : { true, false })
          {
            now.Shaded = shaded;
            now.Interacting = interacting;
            player.Begin(now);
            player.Finish();
            player.ExpectDirect(now);
          }
        }
        now.Projected = true;
        player.Begin(now);
        player.Finish();
        player.ExpectDirect(now);
      });
  }
}

TEST(ServedFrames, HaveTheBitsOfDirectOnes)
{
  ExpectFramesOfThreads<PlainPlayer>(4);
  ExpectFramesOfThreads<Player>(4);
  ExpectFramesOfThreads<MeshPlayer>(4);
}

/// @param operations of each number of ranks
template <class Player>
void ExpectFramesWhateverWasBrokenOff(int operations)
{
  for (unsigned ranks = 1; ranks <= 4; ++ranks)
  {
    RunOnSimulatedRanks(static_cast<int>(ranks),
      [&](Communicator& communicator)
      {
        ServedPlayer<Player> player(communicator);
        EXPECT_GT(DrawAndBreakOff(player, operations, ranks), operations / 8);
      });
  }
}

TEST(ServedFrames, WhateverWasBrokenOffTheNextOneIsRight)
{
  ExpectFramesWhateverWasBrokenOff<PlainPlayer>(50);
}

TEST(ServedFrames, WhateverWasBrokenOffTheNextOneOfASeriesIsRight)
{
  ExpectFramesWhateverWasBrokenOff<Player>(50);
}

TEST(ServedFrames, WhateverWasBrokenOffTheNextOneOfAMeshIsRight)
{
  ExpectFramesWhateverWasBrokenOff<MeshPlayer>(50);
}

template <class Player>
void ExpectEqualDecisions()
{
  RunOnSimulatedRanks(3,
    [](Communicator& communicator)
    {
      // Rays that end early end elsewhere in other zones.
      const double allowed = 4.0 * Situation().Tolerance / 8.0 / 255.0 + 1e-5;
      ServedPlayer<Player> player(communicator, LoadBalancing::MeasuredCost);
      DrawAndBreakOff(player, 40, 3, allowed);
    });
}

TEST(ServedFrames, ZonesThatMoveAreThoseOfAllRanksWhateverWasBrokenOff)
{
  ExpectEqualDecisions<PlainPlayer>();
  ExpectEqualDecisions<Player>();
  ExpectEqualDecisions<MeshPlayer>();
}

TEST(ServedFrames, AFailureOfOneRankIsThatOfAll)
{
  RunOnSimulatedRanks(3,
    [](Communicator& communicator)
    {
      ServedPlayer<PlainPlayer> player(communicator);
      StopFlag stop;
      if (communicator.Rank() == 1)
      {
        stop.Ask(); // casting throws
      }
      Situation now;
      for (int i = 0; i < 3; ++i)
      {
        now.Function = i;
        player.Begin(now, &stop);
        try
        {
          player.ServeSome(1000000);
          ADD_FAILURE() << "nothing was thrown on rank " << communicator.Rank();
        }
        catch (const CollectiveError& error)
        {
          EXPECT_STREQ(error.what(), "Rank 1: The work was stopped.");
        }
        player.Begin(now);
        player.Finish();
        player.ExpectDirect(now);
      }
    });
}

} // namespace
