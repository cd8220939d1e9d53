// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/EqualRuns.h"

#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <random>
#include <vector>

namespace
{

using namespace banyan;

TEST(EqualRuns, EachRunComesOnce)
{
  std::mt19937 random(2);
  for (const unsigned longest : { 1u, 2u, 100u, 40000u })
  {
    // Parts of keys below the bit do not matter.
    constexpr int bit = 7;
    std::vector<std::uint64_t> keys;
    std::map<std::size_t, std::size_t> expected;
    for (std::uint64_t run = 0; keys.size() < 100000; run += 1 + random() % 3)
    {
      const std::size_t begin = keys.size();
      for (unsigned i = 1 + random() % longest; i > 0; --i)
      {
        keys.push_back(run << bit | random() % 128);
      }
      expected[begin] = keys.size();
    }
    KeyedNumbers numbers(keys.size());
    std::copy(keys.begin(), keys.end(), numbers.Keys.get());
    for (const int threads : { 1, 4 })
    {
      ThreadPool pool(threads);
      std::mutex mutex;
      std::map<std::size_t, std::size_t> runs;
      std::size_t calls = 0;
      ForEqualRuns(numbers, bit, pool,
        [&](std::size_t begin, std::size_t end, int)
        {
          const std::lock_guard<std::mutex> lock(mutex);
          runs[begin] = end;
          ++calls;
        });
      EXPECT_EQ(runs, expected);
      EXPECT_EQ(calls, expected.size());
    }
  }
}

} // namespace
