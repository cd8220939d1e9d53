#include "Codec/GroupOrder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace banyan::testing
{
namespace
{

TEST(GroupOrder, ReferencesAreInsideAndEarlier)
{
  for (int steps = 1; steps <= 70; ++steps)
  {
    const std::vector<int> order = DyadicOrder(steps);
    std::vector<int> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    ASSERT_EQ(static_cast<int>(sorted.size()), steps);
    std::vector<bool> done(static_cast<std::size_t>(steps), false);
    for (int i = 0; i < steps; ++i)
    {
      ASSERT_EQ(sorted[static_cast<std::size_t>(i)], i);
      const int step = order[static_cast<std::size_t>(i)];
      const StepReferences references = ReferencesOfStep(step, steps);
      if (step == 0)
      {
        EXPECT_TRUE(references.A < 0 && references.B < 0);
      }
      else
      {
        ASSERT_TRUE(references.A >= 0 && references.A < step);
        ASSERT_TRUE(references.B >= 0 && references.B < steps && references.B != step);
        EXPECT_TRUE(done[static_cast<std::size_t>(references.A)]) << step << " of " << steps;
        EXPECT_TRUE(done[static_cast<std::size_t>(references.B)]) << step << " of " << steps;
      }
      done[static_cast<std::size_t>(step)] = true;
    }
  }
}

TEST(GroupOrder, ChainsGrowWithTheLogarithm)
{
  for (int steps = 1; steps <= 1024; steps = steps * 3 / 2 + 1)
  {
    int log = 0;
    while (1 << log < steps)
    {
      ++log;
    }
    // The longest way from a step back to the first.
    const std::function<int(int)> length = [&](int step)
    {
      const StepReferences references = ReferencesOfStep(step, steps);
      return step == 0 ? 1 : 1 + std::max(length(references.A), length(references.B));
    };
    for (int step = 0; step < steps; ++step)
    {
      EXPECT_LE(length(step), log + 1) << step << " of " << steps;
    }
  }
}

TEST(GroupOrder, CoarserOctavesHaveFinerOddBins)
{
  for (const int bin : { 1, 3, 5, 31, 33, 2097151 })
  {
    EXPECT_EQ(BinOfOctave(bin, 0), bin);
    for (int octave = 1; octave < 30; ++octave)
    {
      const int here = BinOfOctave(bin, octave);
      EXPECT_EQ(here % 2, 1);
      EXPECT_GE(here, 1);
      EXPECT_LE(here, BinOfOctave(bin, octave - 1));
      EXPECT_NEAR(here, bin / std::pow(1.3, octave), 1.01);
    }
  }
}

} // namespace
} // namespace banyan::testing
