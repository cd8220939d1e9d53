// SPDX-License-Identifier: BSD-3-Clause
// The samplings that are chosen for a tolerance: is the picture as good as they say?
#include "ConvergedImage.h"
#include "Picture.h"
#include "PlanTesting.h"
#include "StandardScenes.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Render/Sampling/SamplingPlan.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

using namespace banyan;
using namespace banyan::bench;
using namespace banyan::plan_testing;

namespace
{

constexpr int Samples = 64;
constexpr int Pixels = 192;

class StandardScenesPlan : public testing::TestWithParam<std::pair<StandardFunction, bool>>
{
};

TEST_P(StandardScenesPlan, TheErrorStaysBelowTheEstimate)
{
  ThreadPool pool(2);
  const BenchScene scene =
    StandardScene(StandardVolume(Samples, pool), GetParam().first, GetParam().second, Pixels);
  const FloatImage converged = ConvergedImage(scene, 1.0 / 16.0, pool);
  std::int64_t samplesBefore = std::numeric_limits<std::int64_t>::max();
  for (const double tolerance : { 0.25, 2.0, 8.0, 32.0 })
  {
    SCOPED_TRACE(tolerance);
    for (const int coarsest : { 2, 0 })
    {
      Drawer drawer(scene);
      const SamplingPlan plan = drawer.Plan(tolerance, coarsest);
      ASSERT_TRUE(plan.Samplings);
      drawer.Statistics = {};
      const double error = ErrorOf(drawer.Draw(plan), converged).Largest;
      EXPECT_LE(error, plan.EstimatedError);
      EXPECT_GT(plan.EstimatedError, 0.0);
      EXPECT_EQ(plan.Limit,
        plan.EstimatedError > tolerance ? SamplingLimit::Distance : SamplingLimit::None);
      if (plan.EstimatedError > tolerance)
      {
        // Then it is only because samples get no closer.
        double closest = drawer.Scene.SampleDistance;
        for (const RaySampling& sampling : plan.Samplings->Samplings())
        {
          closest = std::min(closest, sampling.Distance);
        }
        EXPECT_EQ(closest, drawer.Scene.SampleDistance / 8.0);
      }
      if (coarsest > 0)
      {
        EXPECT_LT(drawer.Statistics.SamplesTaken, samplesBefore);
        samplesBefore = drawer.Statistics.SamplesTaken;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(SamplingPlan, StandardScenesPlan,
  testing::Values(std::pair{ StandardFunction::S1, false }, std::pair{ StandardFunction::S1, true },
    std::pair{ StandardFunction::S2, false }, std::pair{ StandardFunction::S2, true }));

TEST(SamplingPlan, SmoothScenesTakeFewerSamplesThanOnePerVoxel)
{
  ThreadPool pool(2);
  Drawer drawer(StandardScene(StandardVolume(97, pool), StandardFunction::S1, false, Pixels));
  drawer.Cast(drawer.Scene);
  const std::int64_t onePerVoxel = drawer.Statistics.SamplesTaken;
  const SamplingPlan plan = drawer.Plan(8.0, 2);
  drawer.Statistics = {};
  drawer.Draw(plan);
  EXPECT_LT(drawer.Statistics.SamplesTaken, onePerVoxel / 2);
}

TEST(SamplingPlan, LevelsWithoutProbesAreExtrapolated)
{
  ThreadPool pool(2);
  const BenchScene scene =
    StandardScene(StandardVolume(Samples, pool), StandardFunction::S2, false, Pixels);
  const FloatImage converged = ConvergedImage(scene, 1.0 / 16.0, pool);
  int extrapolated = 0;
  for (const int finestProbe : { 1, 2 })
  {
    for (const double tolerance : { 2.0, 16.0 })
    {
      Drawer drawer(scene);
      int finest = 3;
      const SamplingPlan plan = PlanSamplings(drawer.Scene,
        { tolerance, drawer.Scene.SampleDistance, 3, finestProbe, LeastCells },
        [&](const RayScene& probe)
        {
          finest = std::min(finest, probe.Samplings->Samplings().front().Level);
          return drawer.Cast(probe);
        });
      EXPECT_GE(finest, finestProbe);
      EXPECT_EQ(plan.Extrapolated, *plan.Samplings->UsedLevels().begin() < finestProbe);
      EXPECT_LE(ErrorOf(drawer.Draw(plan), converged).Largest, plan.EstimatedError);
      extrapolated += plan.Extrapolated;
    }
  }
  EXPECT_GT(extrapolated, 0);
}

TEST(SamplingPlan, LevelsOfFewCellsAreNotTrusted)
{
  ThreadPool pool(2);
  Drawer drawer(StandardScene(StandardVolume(129, pool), StandardFunction::S1, false, Pixels));
  int coarsest = 0;
  PlanSamplings(drawer.Scene, { 8.0, drawer.Scene.SampleDistance, 3 },
    [&](const RayScene& probe)
    {
      coarsest = std::max(coarsest, probe.Samplings->Samplings().front().Level);
      return drawer.Cast(probe);
    });
  EXPECT_EQ(coarsest, 1);
}

TEST(SamplingPlan, TheFinestLevelThatFitsInMemoryIsFoundWithoutLoading)
{
  ThreadPool pool(2);
  Drawer drawer(StandardScene(StandardVolume(65, pool), StandardFunction::S1, false, Pixels));
  const auto finest = [&](std::uint64_t bytes)
  { return FinestLevelWithin(drawer.Scene, drawer.Source, drawer.Scene.DomainCells, 3, bytes); };
  // 64^3 cells, of which everything can be seen, packed as pairs of floats.
  const std::uint64_t all = std::uint64_t{ 65 * 65 * 65 } * 8;
  EXPECT_EQ(finest(2 * all), 0);
  EXPECT_EQ(finest(all / 2), 1);
  EXPECT_EQ(finest(all / 20), 2);
  EXPECT_EQ(finest(0), 3);
}

TEST(SamplingPlan, WhatCannotBeSeenIsNotPlanned)
{
  ThreadPool pool(2);
  BenchScene scene = StandardScene(StandardVolume(16, pool), StandardFunction::S1, false, Pixels);
  for (glm::dvec4& node : scene.Nodes)
  {
    node.a = 0.0;
  }
  const SamplingPlan plan = Drawer(scene).Plan(1.0, 2);
  EXPECT_FALSE(plan.Samplings);
  EXPECT_EQ(plan.EstimatedError, 0.0);
  EXPECT_GT(plan.Probes, 0);
}

TEST(SamplingPlan, PicturesOfAnySize)
{
  ThreadPool pool(2);
  const BenchScene scene =
    StandardScene(StandardVolume(16, pool), StandardFunction::S2, false, Pixels);
  Drawer drawer(scene);
  const RayCamera camera = drawer.Scene.Camera;
  for (const glm::ivec2 size : { glm::ivec2(1, 1), glm::ivec2(31, 200), glm::ivec2(333, 7) })
  {
    drawer.Scene.Camera = camera.WithSize(size);
    drawer.Scene.Viewport = { glm::ivec2(0), size };
    drawer.Scene.Depth.assign(static_cast<std::size_t>(size.x) * size.y, 0.7f);
    const SamplingPlan plan = drawer.Plan(1.0, 1);
    if (plan.Samplings)
    {
      EXPECT_EQ(plan.Samplings->Tiles(), (size + 31) / 32);
    }
    drawer.Draw(plan);
  }
}

TEST(SamplingPlan, WishesAreChecked)
{
  ThreadPool pool(1);
  Drawer drawer(StandardScene(StandardVolume(8, pool), StandardFunction::S1, false, 16));
  for (const double tolerance : { 0.0, -1.0, std::nan(""), HUGE_VAL })
  {
    EXPECT_THROW(drawer.Plan(tolerance, 0), Error);
  }
  EXPECT_THROW(drawer.Plan(1.0, -1), Error);
  drawer.Scene.SampleDistance = 0.0;
  EXPECT_THROW(drawer.Plan(1.0, 0), Error);
}

} // namespace
