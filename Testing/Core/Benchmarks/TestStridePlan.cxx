// SPDX-License-Identifier: BSD-3-Clause
// Which pixels of a picture have rays: is it as good as the plan says, and where does it keep all
// rays?
#include "ConvergedImage.h"
#include "Picture.h"
#include "PlanTesting.h"
#include "StandardScenes.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

using namespace banyan;
using namespace banyan::bench;
using namespace banyan::plan_testing;

namespace
{

constexpr int Samples = 97;
constexpr int Pixels = 416;

int StrideAt(const SamplingPlan& plan, const glm::ivec2& tile)
{
  const auto number = static_cast<std::size_t>(plan.Samplings->NumberAt(tile));
  return plan.Samplings->Samplings()[number].PixelStride;
}

/// How many tiles have rays in no more than every `least`-th pixel.
int TilesWith(const SamplingPlan& plan, int least)
{
  int count = 0;
  for (int y = 0; y < plan.Samplings->Tiles().y; ++y)
  {
    for (int x = 0; x < plan.Samplings->Tiles().x; ++x)
    {
      count += StrideAt(plan, { x, y }) >= least ? 1 : 0;
    }
  }
  return count;
}

/// The largest error inside of some pixels, in 1/255.
double ErrorIn(const FloatImage& a, const FloatImage& b, const PixelRect& where)
{
  double largest = 0.0;
  for (int y = where.Lo.y; y < where.Hi.y; ++y)
  {
    for (int x = where.Lo.x; x < where.Hi.x; ++x)
    {
      const auto pixel = [&](const FloatImage& image)
      {
        const PixelRect& rect = image.Rect;
        const bool inside = x >= rect.Lo.x && x < rect.Hi.x && y >= rect.Lo.y && y < rect.Hi.y;
        return inside ? image.At(x, y) : glm::vec4(0.0f);
      };
      const glm::vec4 difference = glm::abs(pixel(a) - pixel(b));
      largest = std::max<double>(largest,
        std::max(std::max(difference.r, difference.g), std::max(difference.b, difference.a)));
    }
  }
  return 255.0 * largest;
}

class StridePlan : public testing::Test
{
protected:
  BenchScene SceneWith(StandardFunction function)
  {
    return StandardScene(StandardVolume(Samples, this->Pool), function, false, Pixels);
  }
  ThreadPool Pool{ 2 };
};

TEST_F(StridePlan, ErrorsStayBelowEstimatesWherePixelsAreLeftOut)
{
  for (const StandardFunction function : { StandardFunction::S1, StandardFunction::S2 })
  {
    const BenchScene scene = this->SceneWith(function);
    Drawer drawer(scene);
    const FloatImage converged = drawer.Converged();
    int leftOut = 0;
    for (const double tolerance : { 2.0, 8.0, 32.0, 128.0 })
    {
      SCOPED_TRACE(tolerance);
      const SamplingPlan plan = drawer.Plan(tolerance, 2);
      leftOut += TilesWith(plan, 2);
      EXPECT_LE(ErrorIn(drawer.Draw(plan), converged, drawer.Scene.Viewport), plan.EstimatedError);
    }
    EXPECT_GT(leftOut, 40);
  }
}

TEST_F(StridePlan, SmoothPicturesNeedFewRays)
{
  Drawer drawer(this->SceneWith(StandardFunction::S1));
  const auto samplesOf = [&](int stride)
  {
    const SamplingPlan plan =
      PlanSamplings(drawer.Scene, { 64.0, drawer.Scene.SampleDistance, 2, 0, LeastCells, stride },
        [&](const RayScene& probe) { return drawer.Cast(probe); });
    EXPECT_EQ(TilesWith(plan, 2) > 0, stride > 1);
    EXPECT_EQ(TilesWith(plan, stride + 1), 0);
    drawer.Statistics = {};
    drawer.Draw(plan);
    return drawer.Statistics.SamplesTaken;
  };
  const std::int64_t all = samplesOf(1);
  const std::int64_t quarter = samplesOf(2);
  EXPECT_LT(2 * quarter, all);
  EXPECT_LT(2 * samplesOf(8), quarter);
  EXPECT_THROW(samplesOf(3), Error);
  EXPECT_THROW(samplesOf(0), Error);
  EXPECT_THROW(samplesOf(16), Error);
}

TEST_F(StridePlan, TilesWithGeometryKeepTheirRays)
{
  Drawer drawer(this->SceneWith(StandardFunction::S1));
  drawer.Scene.Depth.assign(std::size_t{ Pixels } * Pixels, 1.0f);
  // A line one pixel wide, that probes do not see.
  for (int x = 0; x < Pixels; ++x)
  {
    drawer.Scene.Depth[std::size_t{ 200 } * Pixels + x] = 0.5f;
  }
  const SamplingPlan plan = drawer.Plan(128.0, 2);
  EXPECT_GT(TilesWith(plan, 2), 20);
  for (int x = 0; x < plan.Samplings->Tiles().x; ++x)
  {
    EXPECT_EQ(StrideAt(plan, { x, 200 / TileSamplings::Edge }), 1);
  }
}

TEST_F(StridePlan, NothingIsWrongAtTheEdgesOfAViewport)
{
  Drawer drawer(this->SceneWith(StandardFunction::S1));
  const FloatImage converged = drawer.Converged();
  drawer.Scene.Viewport = { { 110, 90 }, { 331, 290 } };
  const SamplingPlan plan = drawer.Plan(32.0, 2);
  EXPECT_GT(TilesWith(plan, 2), 5);
  EXPECT_LE(ErrorIn(drawer.Draw(plan), converged, drawer.Scene.Viewport), plan.EstimatedError);
}

TEST_F(StridePlan, NothingIsWrongAtTheEdgesOfAPicture)
{
  BenchScene scene = this->SceneWith(StandardFunction::S1);
  scene.Eye = scene.Center + 0.6 * (scene.Eye - scene.Center); // all pixels see the volume
  Drawer drawer(scene);
  const FloatImage converged = drawer.Converged();
  const SamplingPlan plan = drawer.Plan(32.0, 2);
  EXPECT_GT(TilesWith(plan, 2), 5);
  EXPECT_LE(ErrorIn(drawer.Draw(plan), converged, drawer.Scene.Viewport), plan.EstimatedError);
  for (int i = 0; i < plan.Samplings->Tiles().x; ++i)
  {
    EXPECT_EQ(StrideAt(plan, { i, plan.Samplings->Tiles().y - 1 }), 1);
    EXPECT_EQ(StrideAt(plan, { plan.Samplings->Tiles().x - 1, i }), 1);
  }
}

} // namespace
