// SPDX-License-Identifier: BSD-3-Clause
// What is measured of pictures that come late: on simulated ranks, with a tiny volume.
#include "StandardScenes.h"
#include "TicketMeasure.h"
#include "TicketScene.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace banyan::bench
{
namespace
{

TicketOptions Few()
{
  TicketOptions options;
  options.Views = 3;
  options.DragTickets = 4;
  options.DragSeconds = 0.005;
  options.OneProcess = true;
  options.Balancing = LoadBalancing::Off;
  return options;
}

/// On rank 0.
TicketsTook Measured(int ranks, const std::string& scene, const TicketOptions& options)
{
  ThreadPool::SetProcessWidth(1);
  const auto volume = StandardVolume(33, ThreadPool::Process());
  TicketsTook first;
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      const TicketsTook took =
        MeasureTickets(communicator, TicketScene(volume, scene, 64), options);
      if (communicator.Rank() == 0)
      {
        first = took;
      }
    });
  return first;
}

TEST(Tickets, CountsWhatRanksAskFor)
{
  RunOnSimulatedRanks(3,
    [](Communicator& communicator)
    {
      CountingCommunicator ranks(communicator);
      TicketMeter meter(ranks, true);
      meter.Begin();
      AllSum(ranks, 1.0);
      AllSum(ranks, 1.0); // to learn something, say
      ranks.Together(
        [](Communicator& all)
        {
          char received = 0;
          all.Send((all.Rank() + 1) % 3, 1, "x", 1);
          all.Receive((all.Rank() + 2) % 3, 1, &received, 1);
          all.WaitAll();
        });
      const PictureTook took = meter.End(1.0);
      EXPECT_EQ(took.Collectives, 1.0);
      EXPECT_EQ(took.Asks, 1.0);
      EXPECT_EQ(took.Messages, 3.0);
      EXPECT_EQ(took.Bytes, 3.0);
    });
}

TEST(Tickets, EachViewIsDrawnBothWays)
{
  for (const int ranks : { 1, 3 })
  {
    const TicketsTook took = Measured(ranks, "S1", Few());
    ASSERT_EQ(took.Synchronous.size(), 3U);
    ASSERT_EQ(took.Late.size(), 3U);
    for (std::size_t view = 0; view < 3; ++view)
    {
      const PictureTook& direct = took.Synchronous[view];
      const PictureTook& late = took.Late[view];
      EXPECT_EQ(direct.CoarseMilliseconds, 0.0);
      EXPECT_EQ(direct.Asks, 0.0);
      EXPECT_GT(late.CoarseMilliseconds, 0.0);
      EXPECT_GT(late.Milliseconds, late.CoarseMilliseconds);
      EXPECT_GT(late.Asks, 0.0);
      EXPECT_GT(late.Collectives, direct.Collectives) << "a coarse picture, too";
      EXPECT_GT(direct.ProcessorMilliseconds, 0.0);
      EXPECT_EQ(direct.Messages > 0.0, ranks > 1);
      EXPECT_EQ(late.Messages > direct.Messages, ranks > 1);
    }
  }
}

TEST(Tickets, WhereNothingIsVisibleNoPixelsAreSent)
{
  TicketOptions options = Few();
  options.DragTickets = 0;
  options.Plans = false;
  const double empty = Measured(3, "nothing", options).Late.front().Bytes;
  EXPECT_GT(Measured(3, "opaque", options).Late.front().Bytes, 10.0 * empty);
}

TEST(Tickets, ADragEndsWithAnExactPicture)
{
  const DragTook drag = Measured(2, "S1", Few()).Drag;
  EXPECT_EQ(drag.Tickets, 4);
  ASSERT_GE(drag.CoarseMilliseconds.size(), 1U);
  EXPECT_LE(drag.CoarseMilliseconds.size(), 4U);
  ASSERT_EQ(drag.StopMilliseconds.size(), drag.CoarseMilliseconds.size());
  for (std::size_t i = 0; i < drag.StopMilliseconds.size(); ++i)
  {
    EXPECT_LE(drag.StopMilliseconds[i], drag.CoarseMilliseconds[i]);
  }
  EXPECT_GE(drag.ExactMilliseconds, drag.CoarseMilliseconds.back());
}

TEST(Tickets, APictureThatWasKeptIsNoMeasurement)
{
  TicketOptions options = Few();
  options.ViewDegrees = 0.0;
  EXPECT_THROW(Measured(2, "S1", options), Error);
  EXPECT_THROW(Measured(1, "no such scene", Few()), Error);
}

TEST(Tickets, QuantilesAreValues)
{
  EXPECT_EQ(QuantileOf({}, 0.5), 0.0);
  EXPECT_EQ(QuantileOf({ 3, 1, 2 }, 0.5), 2.0);
  EXPECT_EQ(QuantileOf({ 4, 3, 1, 2 }, 0.95), 4.0);
}

} // namespace
} // namespace banyan::bench
