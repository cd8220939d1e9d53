// SPDX-License-Identifier: BSD-3-Clause
// Which levels a plan may use, from probes whose errors are known because they are made up.
#include "Render/Sampling/SamplingPlan.h"

#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace banyan;

namespace
{

/// What each level and each distance adds to every pixel, in 1/255.
struct Offsets
{
  double Level[3];        ///< of level 0, 1 and 2
  double EverySecondStep; ///< of distances that are odd powers of two
};

SamplingPlan PlanOf(
  const Offsets& offsets, double tolerance, bool shaded = false, int finestLevel = 0)
{
  RayScene scene = scenes::Scene(glm::ivec3(65), glm::ivec2(512));
  scene.Shading.On = shaded;
  SamplingWish wish{ tolerance, 1.0, 2, 0, /*LeastCells=*/1, /*LargestPixelStride=*/1 };
  wish.FinestLevel = finestLevel;
  return PlanSamplings(scene, wish,
    [&](const RayScene& probe)
    {
      const RaySampling& sampling = probe.Samplings->Samplings().front();
      const int power = static_cast<int>(std::lround(std::log2(sampling.Distance)));
      const double off =
        offsets.Level[sampling.Level] + (power % 2 != 0 ? offsets.EverySecondStep : 0.0);
      FloatImage image;
      image.Rect = probe.Viewport;
      image.Pixels.assign(static_cast<std::size_t>(image.Rect.Count()),
        glm::vec4(static_cast<float>(0.5 + off / 255.0), 0.5f, 0.5f, 1.0f));
      return image;
    });
}

int FinestLevelOf(const SamplingPlan& plan)
{
  int finest = 99;
  for (const RaySampling& sampling : plan.Samplings->Samplings())
  {
    finest = std::min(finest, sampling.Level);
  }
  return finest;
}

int LevelOfFirstTile(const SamplingPlan& plan)
{
  const auto number = static_cast<std::size_t>(plan.Samplings->NumberAt(glm::ivec2(0)));
  return plan.Samplings->Samplings()[number].Level;
}

double LongestDistanceOf(const SamplingPlan& plan)
{
  const std::vector<bool> used = plan.Samplings->Used();
  double longest = 0.0;
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    longest = std::max(longest, used[i] ? plan.Samplings->Samplings()[i].Distance : 0.0);
  }
  return longest;
}

// With a tolerance of 8 a tile may be off by 7, and levels and distances by half of it each. Four
// times its offset of 0.75, level 2 is off by 3, level 1 by 1 and level 0 not at all; but only when
// level 0 was drawn is this known, because levels 2 and 1 are 1 apart.
constexpr Offsets LevelTwoWillDo{ { 0.0, -0.25, 0.75 }, 0.25 };

TEST(SamplingPlanLevels, FinerLevelsThanAreNeededAreNotUsed)
{
  const SamplingPlan plan = PlanOf(LevelTwoWillDo, 8.0);
  ASSERT_TRUE(plan.Samplings);
  EXPECT_EQ(FinestLevelOf(plan), 2);
  EXPECT_EQ(LevelOfFirstTile(plan), 2);
  EXPECT_LE(plan.EstimatedError, 8.0);
}

TEST(SamplingPlanLevels, FinerLevelsArePutBackWhereDistancesLeaveNoRoom)
{
  // However close samples are, they differ by 1.25 from those twice as far apart: off by 5, four
  // times as much. With the 3 of level 2 that is more than 7, with the 1 of level 1 it is not.
  Offsets offsets = LevelTwoWillDo;
  offsets.EverySecondStep = 1.25;
  const SamplingPlan plan = PlanOf(offsets, 8.0);
  ASSERT_TRUE(plan.Samplings);
  EXPECT_EQ(FinestLevelOf(plan), 0);
  EXPECT_EQ(LevelOfFirstTile(plan), 1);
  EXPECT_NEAR(plan.EstimatedError, 1.0 + 5.0 + 1.0, 1e-3);
}

TEST(SamplingPlanLevels, TheLeastErrorIsTakenWhereNoneIsSmallEnough)
{
  Offsets offsets = LevelTwoWillDo;
  offsets.EverySecondStep = 2.5;
  const SamplingPlan plan = PlanOf(offsets, 8.0);
  ASSERT_TRUE(plan.Samplings);
  EXPECT_EQ(LevelOfFirstTile(plan), 0);
  EXPECT_NEAR(plan.EstimatedError, 10.0 + 1.0, 1e-3);
}

TEST(SamplingPlanLevels, WhatKeepsAPlanFromItsToleranceIsSaid)
{
  EXPECT_EQ(PlanOf(LevelTwoWillDo, 8.0).Limit, SamplingLimit::None);
  Offsets offsets = LevelTwoWillDo;
  offsets.EverySecondStep = 2.5;
  EXPECT_EQ(PlanOf(offsets, 8.0).Limit, SamplingLimit::Distance);
  const SamplingPlan held = PlanOf({ { 0.0, 5.0, 9.0 }, 0.0 }, 8.0, false, /*finestLevel=*/1);
  EXPECT_EQ(held.Limit, SamplingLimit::Level);
  EXPECT_GT(held.EstimatedError, 8.0);
}

// Where a ray meets a place without a gradient, no probe says how far single pixels are off.
/// Of normals that turn over, in 1/255.
double ErrorOfNormals(double distance)
{
  return 1.1 * (distance < 1.0 ? std::pow(distance, 1.7) : distance);
}

TEST(SamplingPlanLevels, ShadedSamplesAreNoFurtherApartThanNormalsAllow)
{
  constexpr Offsets allAlike{ { 0.0, 0.0, 0.0 }, 0.0 };
  for (const double tolerance : { 0.5, 1.0, 2.0, 4.0, 8.0 })
  {
    const SamplingPlan shaded = PlanOf(allAlike, tolerance, /*shaded=*/true);
    const double distance = LongestDistanceOf(shaded);
    EXPECT_LE(ErrorOfNormals(distance), tolerance);
    EXPECT_GE(shaded.EstimatedError, ErrorOfNormals(distance));
    EXPECT_GE(ErrorOfNormals(2.0 * distance), 0.4 * tolerance) << "and not much closer";
    EXPECT_GE(LongestDistanceOf(PlanOf(allAlike, tolerance)), 4.0) << "unshaded";
  }
}

} // namespace
