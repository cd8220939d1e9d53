// SPDX-License-Identifier: BSD-3-Clause
// The order of InteractiveLevels, which is chosen by what pictures of the standard scenes are like.
#include "Picture.h"
#include "StandardScenes.h"

#include "Base/ThreadPool.h"
#include "Render/Raycast/InterpolateSkippedPixels.h"
#include "Render/Sampling/InteractiveLevels.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;
using namespace banyan::bench;

constexpr int CoarsestLevel = 3;

struct Drawn
{
  double Decibels = 0.0;
  double Samples = 0.0;
};

Drawn Draw(
  const BenchScene& scene, const RaySampling& sampling, const FloatImage* reference, FloatImage& to)
{
  ThreadPool pool(2);
  const SampleArray array = scene.Data->Array();
  const ValueRange range = FiniteRange(array, pool);
  ArrayBrickSource source(array, BrickCells, MaskRange{ range.Low, range.High }, pool);
  RayScene drawn = ToRayScene(scene, 1.0, 1.0f - 1.0f / 255.0f);
  drawn.Samplings = std::make_shared<const TileSamplings>(
    drawn.Camera.ImageSize(), std::vector<RaySampling>{ sampling });
  RayStatistics statistics;
  to = CastRays(drawn, source, drawn.DomainCells, ~std::uint64_t{ 0 }, pool, statistics);
  InterpolateSkippedPixels(drawn, to, pool);
  return { reference ? ErrorOf(to, *reference).PsnrDecibels : 0.0,
    static_cast<double>(statistics.SamplesTaken) };
}

/// Each step is as good as other samplings that take as many samples, or more, at most a little
/// worse; and takes fewer samples than the step before.
TEST(CoarseSteps, NoOtherSamplingIsMuchBetterForAsManySamples)
{
  ThreadPool pool(2);
  for (const StandardFunction function : { StandardFunction::S1, StandardFunction::S2 })
  {
    const BenchScene scene = StandardScene(StandardVolume(96, pool), function, true, 384);
    FloatImage reference;
    FloatImage picture;
    Draw(scene, { 0, 0.25, 1 }, nullptr, reference);
    std::vector<Drawn> others;
    for (int level = 0; level <= CoarsestLevel; ++level)
    {
      for (int stride = 1; stride <= RaySampling::LargestStride; stride *= 2)
      {
        others.push_back(
          Draw(scene, { level, static_cast<double>(1 << level), stride }, &reference, picture));
      }
    }
    double before = std::numeric_limits<double>::infinity();
    for (int step = 0; step <= InteractiveLevels::Last(CoarsestLevel); ++step)
    {
      const Drawn drawn =
        Draw(scene, InteractiveLevels::SamplingOf(step, 1.0, CoarsestLevel), &reference, picture);
      EXPECT_LT(drawn.Samples, before) << scene.Name << ", step " << step;
      before = drawn.Samples;
      for (const Drawn& other : others)
      {
        if (other.Samples <= drawn.Samples)
        {
          EXPECT_GE(drawn.Decibels, other.Decibels - 3.0) << scene.Name << ", step " << step;
        }
      }
    }
  }
}

} // namespace
