// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace
{

using banyan::ThreadPool;

TEST(ThreadPool, EachItemOnce)
{
  for (const int width : { 1, 2, 3, 8 })
  {
    ThreadPool pool(width);
    EXPECT_EQ(pool.Width(), width);
    for (const int count : { 0, 1, 2, 7, 1000 })
    {
      std::vector<std::atomic<int>> calls(count);
      pool.ParallelFor(count, [&](std::int64_t i) { ++calls[i]; });
      for (const auto& c : calls)
      {
        EXPECT_EQ(c, 1);
      }
    }
  }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(ThreadPool, ThreadsThatCannotBeStartedAreToldOf)
{
  // Stacks of 8 MiB each: a process of 600 MiB has room for some of them.
  const auto tooMany = []
  {
    const rlimit limit{ 600u << 20, 600u << 20 };
    setrlimit(RLIMIT_AS, &limit);
    try
    {
      const ThreadPool pool(900);
    }
    catch (const banyan::Error& error)
    {
      std::cerr << error.what() << std::endl;
      std::_Exit(3);
    }
    std::_Exit(0);
  };
  EXPECT_EXIT(tooMany(), testing::ExitedWithCode(3), "Only [0-9]+ of 900 threads could be started");
}
#endif

TEST(ThreadPool, NegativeCountIsNothing)
{
  ThreadPool pool(2);
  bool called = false;
  pool.ParallelFor(-5, [&](std::int64_t) { called = true; });
  EXPECT_FALSE(called);
}

TEST(ThreadPool, RefusesNoThreads)
{
  EXPECT_THROW(ThreadPool(0), banyan::Error);
}

TEST(ThreadPool, WorkersHaveNumbersBelowTheWidthAndScratchOfTheirOwn)
{
  constexpr int width = 4;
  ThreadPool pool(width);
  std::vector<std::atomic<int>> inUse(width);
  std::atomic<bool> shared{ false };
  const std::function<void(std::int64_t, int)> body = [&](std::int64_t, int worker)
  {
    ASSERT_GE(worker, 0);
    ASSERT_LT(worker, width);
    if (++inUse[worker] != 1)
    {
      shared = true;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(50));
    --inUse[worker];
  };
  pool.ParallelFor(200, body);
  EXPECT_FALSE(shared);
}

TEST(ThreadPool, WorksOnSeveralThreads)
{
  ThreadPool pool(2);
  std::atomic<int> arrived{ 0 };
  // Each of the two items waits until the other has started: one thread alone could not.
  pool.ParallelFor(2,
    [&](std::int64_t)
    {
      ++arrived;
      const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(30);
      while (arrived < 2 && std::chrono::steady_clock::now() < patience)
      {
        std::this_thread::yield();
      }
    });
  EXPECT_EQ(arrived, 2);
}

TEST(ThreadPool, ThrowsTheFirstExceptionAndWorksOn)
{
  for (const int width : { 1, 3 })
  {
    ThreadPool pool(width);
    const auto fail = [](std::int64_t i)
    {
      if (i == 5)
      {
        throw std::runtime_error("five");
      }
    };
    EXPECT_THROW(pool.ParallelFor(100, fail), std::runtime_error);
    std::atomic<int> sum{ 0 };
    pool.ParallelFor(100, [&](std::int64_t) { ++sum; });
    EXPECT_EQ(sum, 100);
  }
}

TEST(ThreadPool, ItemsAfterAFailureAreSkipped)
{
  ThreadPool pool(1);
  std::int64_t last = -1;
  const auto body = [&](std::int64_t i)
  {
    last = i;
    if (i == 3)
    {
      throw std::runtime_error("three");
    }
  };
  EXPECT_THROW(pool.ParallelFor(10, body), std::runtime_error);
  EXPECT_EQ(last, 3);
}

TEST(ThreadPool, LoopsInsideLoops)
{
  ThreadPool pool(3);
  std::atomic<int> calls{ 0 };
  pool.ParallelFor(10, [&](std::int64_t) { pool.ParallelFor(10, [&](std::int64_t) { ++calls; }); });
  EXPECT_EQ(calls, 100);
}

TEST(ThreadPool, LoopsFromSeveralThreadsAtOnce)
{
  ThreadPool pool(3);
  std::atomic<int> calls{ 0 };
  std::vector<std::thread> callers;
  for (int t = 0; t < 4; ++t)
  {
    callers.emplace_back(
      [&]
      {
        for (int repeat = 0; repeat < 50; ++repeat)
        {
          pool.ParallelFor(20, [&](std::int64_t) { ++calls; });
        }
      });
  }
  for (std::thread& caller : callers)
  {
    caller.join();
  }
  EXPECT_EQ(calls, 4 * 50 * 20);
}

TEST(ThreadPool, WidthOfTheProcessPool)
{
  setenv("BANYAN_THREADS", "3", 1);
  EXPECT_EQ(ThreadPool::DefaultWidth(), 3);
  setenv("BANYAN_THREADS", "none", 1);
  ThreadPool::SetRanksOnThisNode(1 << 20);
  EXPECT_EQ(ThreadPool::DefaultWidth(), 1); // never less than one
  ThreadPool::SetRanksOnThisNode(0);        // counts as one
  EXPECT_GE(ThreadPool::DefaultWidth(), 1);
  unsetenv("BANYAN_THREADS");
  ThreadPool::SetProcessWidth(2);
  EXPECT_EQ(ThreadPool::Process().Width(), 2);
  ThreadPool::SetProcessWidth(0);
  EXPECT_EQ(ThreadPool::Process().Width(), ThreadPool::DefaultWidth());
}

} // namespace
