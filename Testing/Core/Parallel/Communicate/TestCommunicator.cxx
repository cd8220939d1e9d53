// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/CommunicatorCases.h"

#include "Base/Error.h"
#include "Parallel/Communicate/Collective.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <stdexcept>
#include <string>
#include <thread>

namespace banyan::testing
{
namespace
{

class SimulatedRanks : public ::testing::TestWithParam<int>
{
};

TEST_P(SimulatedRanks, KeepTheContract)
{
  const int size = GetParam();
  std::atomic<int> ranks{ 0 };
  RunOnSimulatedRanks(size,
    [&](Communicator& communicator)
    {
      EXPECT_EQ(communicator.Size(), size);
      ranks += 1 << communicator.Rank();
      EXPECT_EQ(CheckCommunicator(communicator), "");
    });
  EXPECT_EQ(ranks, (1 << size) - 1);
}

INSTANTIATE_TEST_SUITE_P(Ranks, SimulatedRanks, ::testing::Range(1, 18));

TEST(SelfCommunicator, KeepsTheContract)
{
  const auto communicator = MakeSelfCommunicator();
  EXPECT_EQ(communicator->Size(), 1);
  EXPECT_EQ(communicator->Rank(), 0);
  EXPECT_EQ(CheckCommunicator(*communicator), "");
  EXPECT_EQ(AgreeOnError(*communicator, "The disk is full."), "The disk is full.");
}

TEST(SelfCommunicator, KeepsWhatThreadsGatherApart)
{
  const auto communicator = MakeSelfCommunicator();
  std::atomic<int> begun{ 0 };
  const auto gather = [&](std::size_t bytes, char value)
  {
    const std::string mine(bytes, value);
    std::string all(bytes, ' ');
    ++begun;
    while (begun < 2)
    {
      std::this_thread::yield();
    }
    for (int i = 0; i < 200000; ++i)
    {
      communicator->AllGather(mine.data(), bytes, all.data());
      if (all != mine)
      {
        return false;
      }
    }
    return true;
  };
  auto other = std::async(std::launch::async, gather, 40, 'b');
  EXPECT_TRUE(gather(8, 'a'));
  EXPECT_TRUE(other.get());
}

TEST(Collective, ThrowsTheSameOnAllRanksWhereNested)
{
  RunOnSimulatedRanks(3,
    [](Communicator& communicator)
    {
      const auto fail = [&]
      {
        if (communicator.Rank() == 1)
        {
          throw Error("The disk is full.");
        }
      };
      try
      {
        Collective(communicator, [&] { Collective(communicator, fail); });
        ADD_FAILURE() << "rank " << communicator.Rank() << " threw nothing";
      }
      catch (const CollectiveError& error)
      {
        EXPECT_STREQ(error.what(), "Rank 1: The disk is full.");
      }
      EXPECT_NO_THROW(Collective(communicator, [] {}));
    });
}

TEST(Collective, HasASentenceForMissingMemory)
{
  RunOnSimulatedRanks(2,
    [](Communicator& communicator)
    {
      const auto allocate = [] { throw std::bad_alloc(); };
      try
      {
        CollectiveOn(1, communicator, allocate, "Use more ranks.");
        ADD_FAILURE() << "rank " << communicator.Rank() << " threw nothing";
      }
      catch (const CollectiveError& error)
      {
        EXPECT_STREQ(error.what(), "Rank 1: Use more ranks.");
      }
      EXPECT_THROW(Collective(communicator, allocate), CollectiveError);
    });
}

TEST(Collective, KeepsTheFirstFailure)
{
  std::string failure;
  Attempt(failure, [] { throw Error("first"); });
  Attempt(failure, [] { throw Error("second"); });
  Attempt(failure, [] {});
  EXPECT_EQ(failure, "first");
}

TEST(Meet, WaitsForAllRanksAndTicksMeanwhile)
{
  std::atomic<int> here{ 0 };
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      int ticks = 0;
      for (int time = 1; time < 3; ++time)
      {
        const bool late = communicator.Rank() == time;
        if (late)
        {
          std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        ++here;
        Meet(communicator, [&ticks] { ++ticks; });
        EXPECT_GE(here, 3 * time) << communicator.Rank();
        EXPECT_TRUE(late || ticks > 0);
      }
      EXPECT_EQ(AllSum(communicator, 1.0), 3.0);
    });
}

TEST(SimulatedRanks, ThrowTheFirstExceptionAndReleaseTheOthers)
{
  const auto body = [](Communicator& communicator)
  {
    if (communicator.Rank() == 2)
    {
      throw std::runtime_error("rank 2 gave up");
    }
    communicator.Barrier();
  };
  try
  {
    RunOnSimulatedRanks(5, body);
    FAIL();
  }
  catch (const std::runtime_error& error)
  {
    EXPECT_STREQ(error.what(), "rank 2 gave up");
  }
}

// The mistakes below would hang under MPI; here they end with a sentence.
TEST(SimulatedRanks, NoticeThatNobodyWillEverSend)
{
  const auto bothReceive = [](Communicator& communicator)
  {
    int value = 0;
    communicator.Receive(1 - communicator.Rank(), 5, &value, sizeof(value));
    communicator.WaitAll();
  };
  EXPECT_THROW(RunOnSimulatedRanks(2, bothReceive), Error);

  const auto oneLeaves = [](Communicator& communicator)
  {
    if (communicator.Rank() != 0)
    {
      communicator.Barrier();
    }
  };
  EXPECT_THROW(RunOnSimulatedRanks(3, oneLeaves), Error);
}

TEST(SimulatedRanks, RefuseMessagesOfAnotherSize)
{
  const auto body = [](Communicator& communicator)
  {
    std::int64_t value = 0;
    if (communicator.Rank() == 0)
    {
      communicator.Send(1, 5, &value, 4);
    }
    else
    {
      communicator.Receive(0, 5, &value, 8);
    }
    communicator.WaitAll();
  };
  EXPECT_THROW(RunOnSimulatedRanks(2, body), Error);
}

TEST(SimulatedRanks, RefuseRanksAndTagsThatDoNotExist)
{
  const auto communicator = MakeSelfCommunicator();
  char byte = 0;
  EXPECT_THROW(communicator->Send(1, 0, &byte, 1), Error);
  EXPECT_THROW(communicator->Receive(-1, 0, &byte, 1), Error);
  EXPECT_THROW(communicator->Send(0, -1, &byte, 1), Error);
  EXPECT_THROW(RunOnSimulatedRanks(0, [](Communicator&) {}), Error);
}

} // namespace
} // namespace banyan::testing
