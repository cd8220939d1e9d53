// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Parallel/Watchdog/Heartbeat.h"

#include <gtest/gtest.h>

#include <chrono>
#include <mutex>
#include <thread>

#include <unistd.h>

namespace
{

using namespace banyan;

std::vector<RankState> Three(std::uint32_t beats)
{
  return { { 0, 100, beats, 1, 0, Phase::Compositing }, { 1, 101, beats, 0, 0, Phase::Casting },
    { 2, 102, beats, 2, 0, Phase::Outside } };
}

TEST(LostRankDetector, WhoWorksOrIsElsewhereIsNotLost)
{
  LostRankDetector lost(5.0, true);
  for (std::uint32_t tick = 1; tick < 1000; ++tick)
  {
    ASSERT_EQ("", lost.Tick(0.1, 0, Three(tick)));
  }
}

TEST(LostRankDetector, WhoGivesNoSignIsLostAfterTheLimit)
{
  LostRankDetector lost(5.0, true);
  lost.Tick(0.1, 0, Three(1));
  int ticks = 0;
  std::string sentence;
  for (std::uint32_t beat = 2; sentence.empty() && ticks < 1000; ++beat, ++ticks)
  {
    std::vector<RankState> states = Three(beat);
    states[1].Beats = 1;
    sentence = lost.Tick(0.1, 0, states);
  }
  EXPECT_NEAR(50, ticks, 1);
  EXPECT_EQ("Rank 1 (process 101) has given no sign of life for 5 s; the last thing known is that "
            "it was casting rays.",
    sentence);
}

TEST(LostRankDetector, WhoHasEndedIsMissedByThoseWhoWait)
{
  LostRankDetector waits(5.0, true);
  LostRankDetector works(5.0, true);
  std::vector<RankState> states = Three(1);
  states[1].Ended = true;
  std::string missed;
  for (std::uint32_t beat = 2; beat < 100; ++beat)
  {
    states[2].Beats = beat;
    missed += waits.Tick(0.1, 0, states, true);
    ASSERT_EQ("", works.Tick(0.1, 0, states, false));
  }
  EXPECT_NE("", missed);
}

TEST(LostRankDetector, OneSignIsEnough)
{
  LostRankDetector lost(5.0, true);
  for (std::uint32_t tick = 1; tick < 1000; ++tick)
  {
    std::vector<RankState> states = Three(tick);
    states[1].Beats = tick / 40;
    ASSERT_EQ("", lost.Tick(0.1, 0, states));
  }
}

TEST(LostRankDetector, ARankDoesNotMissItselfNorThoseThatHaveNotBegun)
{
  LostRankDetector lost(5.0, false);
  for (std::uint32_t tick = 1; tick < 1000; ++tick)
  {
    std::vector<RankState> states = Three(tick);
    states[0].Beats = 7;
    states[2] = RankState{};
    ASSERT_EQ("", lost.Tick(0.1, 0, states));
  }
}

/// All ranks were stopped together, for an hour, in one tick.
TEST(LostRankDetector, AJobThatIsStoppedAndGoesOnLosesNobody)
{
  LostRankDetector lost(5.0, true);
  lost.Tick(0.1, 0, Three(1));
  EXPECT_EQ("", lost.Tick(3600.0, 0, Three(1)));
  EXPECT_EQ("", lost.Tick(0.1, 0, Three(2)));
}

TEST(LostRankDetector, WhoDoesNotGetOnIsLost)
{
  LostRankDetector lost(5.0, true);
  std::vector<RankState> states = Three(1);
  states[1].StallMilliseconds = 4999;
  EXPECT_EQ("", lost.Tick(0.1, 0, states));
  states[1].StallMilliseconds = 5000;
  EXPECT_EQ("Rank 1 (process 101) runs, but has not got on for 5 s; the last thing known is that "
            "it was casting rays.",
    lost.Tick(0.1, 0, states));
}

TEST(LostRankDetector, WhenAllWaitForEachOtherTheJobIsLost)
{
  const auto ticksOf = [](bool all, bool again)
  {
    LostRankDetector lost(5.0, all);
    for (std::uint32_t tick = 1; tick < 200; ++tick)
    {
      std::vector<RankState> states = Three(tick);
      states[1].Waits = 3;
      states[2].Waits = again ? 5 + 2 * (tick / 10) : 5;
      if (!lost.Tick(0.1, 0, states).empty())
      {
        return static_cast<int>(tick);
      }
    }
    return 200;
  };
  EXPECT_NEAR(51, ticksOf(true, false), 1);
  EXPECT_EQ(200, ticksOf(true, true));   // one of them got something now and then
  EXPECT_EQ(200, ticksOf(false, false)); // others of another machine may send
}

TEST(LostRankDetector, TimeWithoutProgressCountsFullyWhereAProcessorIsUsed)
{
  StallTimer clock;
  clock.Tick(0.1, 0.1, true, 5);
  double stuck = 0;
  for (int i = 0; i < 100; ++i)
  {
    stuck = clock.Tick(0.1, 0.1, true, 5);
  }
  EXPECT_NEAR(10.0, stuck, 1e-9);
  for (int i = 0; i < 100; ++i)
  {
    stuck = clock.Tick(0.1, 0.001, true, 5);
  }
  EXPECT_NEAR(11.0, stuck, 1e-9);
  EXPECT_EQ(0.0, clock.Tick(0.1, 0.1, true, 6));
  EXPECT_NEAR(0.1, clock.Tick(0.1, 0.1, true, 6), 1e-9);
  EXPECT_EQ(0.0, clock.Tick(0.1, 0.1, false, 6));
  EXPECT_NEAR(LostRankDetector::LongestTick, clock.Tick(3600.0, 3600.0, true, 6), 1e-9);
}

TEST(LostRankDetector, OnlyOneThreadHasPhases)
{
  const PhaseScope phase(Phase::Casting);
  std::thread(
    []
    {
      const PhaseScope other(Phase::Balancing);
      EXPECT_EQ(Phase::Casting, Progress::Now());
    })
    .join();
  {
    const PhaseScope inner(Phase::Compositing);
    EXPECT_EQ(Phase::Compositing, Progress::Now());
  }
  EXPECT_EQ(Phase::Casting, Progress::Now());
}

/// Calls `wanted` until it is true, for ten seconds.
template <typename Wanted>
bool SoonTrue(const Wanted& wanted)
{
  const Timer timer;
  while (!wanted() && timer.Seconds() < 10.0)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return wanted();
}

TEST(Heartbeat, RanksSeeEachOtherUntilTheyEnd)
{
  const std::string name = Heartbeat::MakeMemory(3);
  const Heartbeat first(name, 3, 0, 40, 1e9, {});
  auto second =
    std::make_unique<Heartbeat>(name, 3, 2, 42, 1e9, std::function<void(const std::string&)>{});
  Heartbeat::ForgetName(name);
  EXPECT_THROW(Heartbeat(name, 3, 1, 41, 1e9, {}), Error);
  EXPECT_EQ(40, first.States()[0].Rank);
  EXPECT_EQ(-1, first.States()[1].Rank);
  EXPECT_EQ(42, first.States()[2].Rank);
  EXPECT_EQ(static_cast<int>(getpid()), second->States()[0].Process);
  const std::uint32_t before = first.States()[2].Beats;
  EXPECT_TRUE(SoonTrue([&] { return first.States()[2].Beats > before + 3; }));
  {
    const PhaseScope phase(Phase::Fetching);
    EXPECT_TRUE(SoonTrue([&] { return first.States()[2].Doing == Phase::Fetching; }));
    const WaitScope wait;
    EXPECT_TRUE(SoonTrue([&] { return first.States()[2].Waits % 2 == 1; }));
  }
  EXPECT_TRUE(SoonTrue([&] { return first.States()[2].Doing == Phase::Outside; }));
  EXPECT_FALSE(first.States()[2].Ended);
  second.reset();
  EXPECT_TRUE(first.States()[2].Ended);
  const std::uint32_t last = first.States()[2].Beats;
  const std::uint32_t mine = first.States()[0].Beats;
  EXPECT_TRUE(SoonTrue([&] { return first.States()[0].Beats > mine + 3; }));
  EXPECT_EQ(last, first.States()[2].Beats);
}

TEST(Heartbeat, ARankThatDoesNotGetOnIsToldOnce)
{
  const std::string name = Heartbeat::MakeMemory(1);
  std::mutex mutex;
  std::vector<std::string> told;
  const Heartbeat beat(name, 1, 0, 3, 1.0,
    [&](const std::string& sentence)
    {
      const std::lock_guard<std::mutex> lock(mutex);
      told.push_back(sentence);
    });
  Heartbeat::ForgetName(name);
  const PhaseScope phase(Phase::Casting);
  ThreadPool pool(1);
  pool.ParallelFor(20,
    [](std::int64_t)
    {
      const Timer item;
      while (item.Seconds() < 0.1)
      {
      }
    });
  {
    const std::lock_guard<std::mutex> lock(mutex);
    EXPECT_TRUE(told.empty()) << told.front();
  }
  const Timer stuck;
  for (std::size_t count = 0; count == 0 && stuck.Seconds() < 30.0;)
  {
    const std::lock_guard<std::mutex> lock(mutex);
    count = told.size();
  }
  const Timer again;
  while (again.Seconds() < 1.5)
  {
  }
  const std::lock_guard<std::mutex> lock(mutex);
  ASSERT_EQ(1u, told.size());
  EXPECT_NE(std::string::npos, told.front().find("Rank 3 has not got on for ")) << told.front();
  EXPECT_NE(std::string::npos, told.front().find("while it was casting rays.")) << told.front();
}

TEST(Heartbeat, WhatCannotBeOpenedIsAnError)
{
  EXPECT_THROW(Heartbeat("/banyan-no-such-memory", 2, 0, 0, 1.0, {}), Error);
}

} // namespace
