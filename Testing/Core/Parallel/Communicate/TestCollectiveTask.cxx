// SPDX-License-Identifier: BSD-3-Clause
// Threads of all ranks whose messages the main threads send: they have the same answers, and end
// together wherever they are stopped.
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/CollectiveTask.h"
#include "Parallel/CommunicatorCases.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace banyan::testing
{
namespace
{

bool Stay()
{
  return false;
}

/// Leaves when it is asked for the so manieth time.
std::function<bool()> LeaveAfter(int times)
{
  return [times]() mutable { return --times < 0; };
}

/// What Serve throws, on this rank; empty for nothing.
std::string FailureOf(CollectiveTask& task)
{
  try
  {
    task.Serve(Stay);
  }
  catch (const CollectiveError& error)
  {
    EXPECT_FALSE(task.IsStarted());
    return error.what();
  }
  return {};
}

/// @param body of each simulated rank
void OnRanks(const std::vector<int>& counts, const std::function<void(Communicator&)>& body)
{
  for (const int ranks : counts)
  {
    RunOnSimulatedRanks(ranks, body);
  }
}

TEST(CollectiveTask, ThreadsHaveTheAnswersOfMainThreads)
{
  OnRanks({ 1, 2, 3, 4, 5 },
    [](Communicator& communicator)
    {
      std::string wrong = "nothing was done";
      CollectiveTask task(communicator);
      task.Start(
        [&](Communicator& ranks, const StopFlag&)
        {
          EXPECT_EQ(ranks.Rank(), communicator.Rank());
          EXPECT_EQ(ranks.Size(), communicator.Size());
          EXPECT_EQ(ranks.RanksOnThisNode(), ranks.Size());
          EXPECT_FALSE(ranks.SendsAtOnce());
          ranks.LeaveTogether("nobody");
          wrong = CheckCollectives(ranks, 777) + CheckHelpers(ranks);
          ranks.Together([&](Communicator& together) { wrong += CheckCommunicator(together); });
        });
      EXPECT_TRUE(task.IsStarted());
      int calls = 0;
      while (!task.Serve(LeaveAfter(3)))
      {
        ++calls;
        EXPECT_EQ(AllSum(communicator, 1.0), communicator.Size()) << "messages of others between";
      }
      EXPECT_EQ(wrong, "");
      EXPECT_GT(calls, 5);
      EXPECT_FALSE(task.IsStarted());
      EXPECT_TRUE(task.Serve(Stay)) << "nothing is left to do";
    });
}

TEST(CollectiveTask, MessagesToSingleRanksNeedAPart)
{
  OnRanks({ 2 },
    [](Communicator& communicator)
    {
      CollectiveTask task(communicator);
      const auto refuses = [&](const std::function<void(Communicator&)>& send)
      {
        task.Start([&](Communicator& ranks, const StopFlag&) { send(ranks); });
        EXPECT_NE(FailureOf(task).find("Communicator::Together"), std::string::npos);
      };
      int value = 0;
      Communicator::Arrival arrival;
      refuses([&](Communicator& ranks) { ranks.Send(0, 1, &value, sizeof(value)); });
      refuses([&](Communicator& ranks) { ranks.Receive(0, 1, &value, sizeof(value)); });
      refuses([&](Communicator& ranks) { ranks.WaitAll(); });
      refuses([&](Communicator& ranks) { ranks.SendWhole(0, 1, &value, sizeof(value)); });
      refuses([&](Communicator& ranks) { ranks.ReceiveWhole(0, 1, &value, sizeof(value)); });
      refuses([&](Communicator& ranks) { ranks.WaitAnyWhole(); });
      refuses([&](Communicator& ranks) { ranks.TakeAnyWhole(arrival); });
    });
}

TEST(CollectiveTask, MainThreadsLeaveWhileThreadsWork)
{
  OnRanks({ 1, 3 },
    [](Communicator& communicator)
    {
      std::atomic<bool> works{ true };
      CollectiveTask task(communicator);
      task.Start(
        [&](Communicator& ranks, const StopFlag&)
        {
          while (ranks.Rank() == 0 && works)
          {
            std::this_thread::yield();
          }
          ranks.Barrier();
        });
      for (int i = 0; i < 3; ++i)
      {
        EXPECT_FALSE(task.Serve(LeaveAfter(i)));
        EXPECT_TRUE(task.IsStarted());
      }
      works = false;
      EXPECT_TRUE(task.Serve(Stay));
    });
}

/// Leaves at some moment, stops, and counts operations. @return whether it was in the middle
bool StopSomewhere(Communicator& communicator, CollectiveTask& task, int times, int operations)
{
  int done = 0;
  task.Start(
    [&](Communicator& ranks, const StopFlag&)
    {
      std::minstd_rand dice(static_cast<unsigned>(times * ranks.Size() + ranks.Rank()) + 1);
      for (; done < operations; ++done)
      {
        std::this_thread::sleep_for(std::chrono::microseconds(dice() % 3 == 0 ? dice() % 300 : 0));
        EXPECT_EQ(AllSum(ranks, done), done * ranks.Size());
      }
    });
  const bool ended = task.Serve(LeaveAfter(times));
  task.Stop();
  EXPECT_FALSE(task.IsStarted());
  for (const double theirs : AllGatherValues(communicator, done))
  {
    EXPECT_EQ(theirs, done) << "one thread knows more than another";
  }
  EXPECT_TRUE(!ended || done == operations);
  return done > 0 && done < operations;
}

TEST(CollectiveTask, WhereverItIsStoppedAllThreadsHaveDoneTheSame)
{
  OnRanks({ 1, 2, 3, 5 },
    [](Communicator& communicator)
    {
      CollectiveTask task(communicator);
      int inTheMiddle = 0;
      for (int times = 0; times < 60; ++times)
      {
        inTheMiddle += StopSomewhere(communicator, task, times, 20) ? 1 : 0;
      }
      EXPECT_GT(inTheMiddle, 10);
    });
}

TEST(CollectiveTask, IsStoppedWhileItWaits)
{
  OnRanks({ 1, 2, 4 },
    [](Communicator& communicator)
    {
      std::atomic<bool> interrupted{ false };
      const auto wait = [&](Communicator& ranks, const StopFlag&)
      {
        try
        {
          ranks.Barrier();
        }
        catch (const Interruption&)
        {
          interrupted = true;
          EXPECT_THROW(ranks.Barrier(), Interruption) << "nothing is done any more";
          throw;
        }
      };
      {
        CollectiveTask task(communicator);
        task.Start(wait);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        task.Start(wait);
        EXPECT_TRUE(interrupted) << "by the next one";
        interrupted = false;
      }
      EXPECT_TRUE(interrupted) << "by the end of its owner";
    });
}

TEST(CollectiveTask, AFailureOfOneThreadIsThatOfAllRanks)
{
  OnRanks({ 1, 2, 4 },
    [](Communicator& communicator)
    {
      const int last = communicator.Size() - 1;
      const std::string expected =
        (last > 0 ? "Rank " + std::to_string(last) + ": " : std::string()) + "The disk is full.";
      const auto fail = [&]
      {
        if (communicator.Rank() == last)
        {
          throw Error("The disk is full.");
        }
      };
      CollectiveTask task(communicator);
      task.Start([&](Communicator& ranks, const StopFlag&) { Collective(ranks, fail); });
      EXPECT_EQ(FailureOf(task), expected);
      task.Start([&](Communicator&, const StopFlag&) { fail(); });
      EXPECT_EQ(FailureOf(task), expected) << "at the end";
      task.Start(
        [&](Communicator& ranks, const StopFlag&)
        {
          fail();
          ranks.Barrier();
        });
      EXPECT_EQ(FailureOf(task), expected) << "the others wait";
      task.Start(
        [&](Communicator& ranks, const StopFlag&)
        {
          ranks.Together([&](Communicator&) { fail(); });
          ranks.Barrier();
        });
      EXPECT_EQ(FailureOf(task), expected) << "in the main thread";
      task.Start([&](Communicator& ranks, const StopFlag&) { ranks.Barrier(); });
      EXPECT_EQ(FailureOf(task), "") << "the next one is all right";
    });
}

TEST(CollectiveTask, AThreadThatEndsAloneIsAnError)
{
  OnRanks({ 2, 3 },
    [](Communicator& communicator)
    {
      CollectiveTask task(communicator);
      for (int alone = 0; alone < communicator.Size(); ++alone)
      {
        task.Start(
          [&](Communicator& ranks, const StopFlag&)
          {
            ranks.Barrier();
            if (ranks.Rank() != alone)
            {
              ranks.Barrier();
            }
          });
        EXPECT_NE(FailureOf(task).find("others wait"), std::string::npos);
      }
    });
}

} // namespace
} // namespace banyan::testing
