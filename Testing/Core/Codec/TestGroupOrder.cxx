// SPDX-License-Identifier: BSD-3-Clause
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

TEST(GroupOrder, ReferencesAreInsideOrTheStepBeforeAndEarlier)
{
  for (const bool open : { false, true })
  {
    for (int steps = 1; steps <= 70; ++steps)
    {
      const std::vector<int> order = DyadicOrder(steps);
      std::vector<int> sorted = order;
      std::sort(sorted.begin(), sorted.end());
      ASSERT_EQ(static_cast<int>(sorted.size()), steps);
      ASSERT_EQ(order[0], steps - 1) << "the key frame comes first";
      std::vector<bool> done(static_cast<std::size_t>(steps) + 1, false);
      done[0] = open; // the step before
      int before = 0;
      for (int i = 0; i < steps; ++i)
      {
        ASSERT_EQ(sorted[static_cast<std::size_t>(i)], i);
        const int step = order[static_cast<std::size_t>(i)];
        const StepReferences references = ReferencesOfStep(step, steps, open);
        EXPECT_EQ(references.Any(), step != steps - 1);
        if (references.Any())
        {
          ASSERT_TRUE(references.A >= StepBefore && references.A < steps);
          ASSERT_TRUE(references.B > step && references.B < steps);
          EXPECT_TRUE(references.A < step || references.A == references.B);
          EXPECT_TRUE(open ? references.A < step : references.A >= 0) << step << " of " << steps;
          EXPECT_TRUE(done[static_cast<std::size_t>(references.A + 1)]) << step << " of " << steps;
          EXPECT_TRUE(done[static_cast<std::size_t>(references.B + 1)]) << step << " of " << steps;
          before += references.A == StepBefore ? 1 : 0;
        }
        done[static_cast<std::size_t>(step) + 1] = true;
      }
      EXPECT_EQ(before > 0, open && steps > 1);
    }
  }
}

/// As format.md lists them.
TEST(GroupOrder, OfEightStepsIsTheOneOfTheFormat)
{
  EXPECT_EQ(DyadicOrder(8), (std::vector<int>{ 7, 3, 1, 5, 0, 2, 4, 6 }));
  const int a[] = { -1, -1, 1, -1, 3, 3, 5 };
  const int b[] = { 1, 3, 3, 7, 5, 7, 7 };
  for (int step = 0; step < 7; ++step)
  {
    EXPECT_EQ(ReferencesOfStep(step, 8, true).A, a[step]) << step;
    EXPECT_EQ(ReferencesOfStep(step, 8, true).B, b[step]) << step;
    EXPECT_EQ(ReferencesOfStep(step, 8, false).A, a[step] < 0 ? b[step] : a[step]) << step;
    EXPECT_EQ(ReferencesOfStep(step, 8, false).B, b[step]) << step;
  }
}

TEST(GroupOrder, OfSixStepsHasReferencesOnBothSides)
{
  EXPECT_EQ(DyadicOrder(6), (std::vector<int>{ 5, 1, 3, 0, 2, 4 }));
  const int a[] = { -1, -1, 1, 1, 3 };
  const int b[] = { 1, 5, 3, 5, 5 };
  for (int step = 0; step < 5; ++step)
  {
    EXPECT_EQ(ReferencesOfStep(step, 6, true).A, a[step]) << step;
    EXPECT_EQ(ReferencesOfStep(step, 6, true).B, b[step]) << step;
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
    for (const bool open : { false, true })
    {
      // The longest way from a step back to a key frame.
      const std::function<int(int)> length = [&](int step)
      {
        const StepReferences references =
          step == StepBefore ? StepReferences() : ReferencesOfStep(step, steps, open);
        return references.Any() ? 1 + std::max(length(references.A), length(references.B)) : 1;
      };
      for (int step = 0; step < steps; ++step)
      {
        EXPECT_LE(length(step), log + 1) << step << " of " << steps;
      }
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
