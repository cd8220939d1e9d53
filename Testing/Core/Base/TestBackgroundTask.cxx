// SPDX-License-Identifier: BSD-3-Clause
// A task in a thread of its own: it ends by itself, or when it is asked to.
#include "Base/BackgroundTask.h"

#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <atomic>
#include <thread>

namespace
{

using namespace banyan;

/// Works until it is asked to stop.
void WorkForEver(const StopFlag& stop)
{
  while (true)
  {
    stop.Check();
    std::this_thread::yield();
  }
}

TEST(BackgroundTask, EndsByItself)
{
  BackgroundTask task;
  EXPECT_FALSE(task.IsStarted());
  EXPECT_FALSE(task.HasEnded());
  int done = 0;
  task.Start([&](const StopFlag&) { done = 1; });
  EXPECT_TRUE(task.IsStarted());
  task.Finish();
  EXPECT_TRUE(task.HasEnded());
  EXPECT_TRUE(task.IsStarted()) << "nobody has taken note of it";
  task.Wait();
  EXPECT_FALSE(task.IsStarted());
  EXPECT_FALSE(task.HasEnded());
  EXPECT_EQ(done, 1);
  task.Wait();
}

#ifdef __linux__
/// The window's thread gets the cores when it wants them.
TEST(BackgroundTask, HasLowPriorityAndSoHaveItsLoops)
{
  const auto niceness = [] { return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); };
  const int usual = niceness();
  std::atomic<int> least{ 100 };
  BackgroundTask task;
  task.Start(
    [&](const StopFlag&)
    {
      ThreadPool::Process().ParallelFor(1000,
        [&](std::int64_t)
        {
          const int mine = niceness();
          for (int seen = least; mine < seen && !least.compare_exchange_weak(seen, mine);)
          {
          }
          std::this_thread::yield();
        });
    });
  task.Wait();
  EXPECT_EQ(least, std::min(usual + 10, 19));
  ThreadPool::Process().ParallelFor(1000, [&](std::int64_t) { EXPECT_EQ(niceness(), usual); });
}
#endif

TEST(BackgroundTask, IsStoppedWhenAsked)
{
  BackgroundTask task;
  task.Start(WorkForEver);
  EXPECT_FALSE(task.HasEnded());
  task.Stop();
  EXPECT_FALSE(task.IsStarted());
  task.Stop();
}

TEST(BackgroundTask, AnotherOneTakesItsPlace)
{
  BackgroundTask task;
  task.Start(WorkForEver);
  bool asked = true;
  task.Start([&](const StopFlag& stop) { asked = stop.IsAsked(); });
  task.Wait();
  EXPECT_FALSE(asked) << "the wish to stop was not meant for it";
}

TEST(BackgroundTask, EndsWithItsOwner)
{
  BackgroundTask task;
  task.Start(WorkForEver);
}

TEST(BackgroundTask, WhatItThrowsIsThrownToWhoeverWaits)
{
  BackgroundTask task;
  task.Start([](const StopFlag&) { throw Error("The disk is full."); });
  task.Finish();
  EXPECT_TRUE(task.HasEnded());
  EXPECT_THROW(task.Wait(), Error);
  EXPECT_FALSE(task.IsStarted());
  task.Wait();
  task.Start([](const StopFlag&) { throw Error("The disk is full."); });
  task.Stop();
}

} // namespace
