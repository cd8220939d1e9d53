// SPDX-License-Identifier: BSD-3-Clause
// When the picture that tells which pixels need rays is worth drawing, from made-up probes.
#include "Render/Sampling/SamplingPlan.h"

#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

using namespace banyan;

namespace
{

constexpr int Edge = 1024;

/// Of a pixel by its place in the picture.
using Pattern = std::function<double(const glm::dvec2&)>;

double Smooth(const glm::dvec2& at)
{
  return 0.5 + 0.2 * std::sin(0.01 * at.x) * std::cos(0.01 * at.y);
}

double Striped(const glm::dvec2& at)
{
  return static_cast<int>(at.x / 75.0) % 2;
}

/// How many pixels are apart of which it is drawn for a picture; 0 if it is not drawn.
int PixelsApart(const Pattern& pattern, double tolerance)
{
  const RayScene scene = scenes::Scene(glm::ivec3(65), glm::ivec2(Edge));
  const SamplingWish wish{ tolerance, 1.0, 2, 0, /*LeastCells=*/1, /*LargestPixelStride=*/8 };
  int apart = 0;
  const SamplingPlan plan = PlanSamplings(scene, wish,
    [&](const RayScene& probe)
    {
      const int edge = probe.Camera.ImageSize().x;
      EXPECT_EQ(apart, 0) << "it is the last one";
      apart = edge > Edge / 16 ? Edge / edge : 0;
      FloatImage image;
      image.Rect = probe.Viewport;
      for (int y = image.Rect.Lo.y; y < image.Rect.Hi.y; ++y)
      {
        for (int x = image.Rect.Lo.x; x < image.Rect.Hi.x; ++x)
        {
          const double value = pattern((glm::dvec2(x, y) + 0.5) * (1.0 * Edge / edge));
          image.Pixels.emplace_back(static_cast<float>(value), 0.5f, 0.5f, 1.0f);
        }
      }
      return image;
    });
  EXPECT_LE(plan.EstimatedError, tolerance);
  bool some = false;
  for (const RaySampling& sampling : plan.Samplings->Samplings())
  {
    some = some || sampling.PixelStride > 1;
  }
  EXPECT_TRUE(apart > 0 || !some) << "no pixel is left out unknown";
  return apart;
}

TEST(SubsamplingProbe, IsDrawnWhereSomeTileMayDoWithoutPixels)
{
  for (const double tolerance : { 1.0, 8.0 })
  {
    EXPECT_EQ(PixelsApart(Smooth, tolerance), 4) << tolerance;
  }
  // A quarter of the pixels will do where much is allowed.
  for (const double tolerance : { 16.0, 255.0 })
  {
    EXPECT_EQ(PixelsApart(Smooth, tolerance), 8) << tolerance;
  }
  EXPECT_EQ(PixelsApart(Striped, 255.0), 8);
}

TEST(SubsamplingProbe, IsNotDrawnWhereNoneMay)
{
  for (const double tolerance : { 0.25, 1.0, 2.0 })
  {
    EXPECT_EQ(PixelsApart(Striped, tolerance), 0) << tolerance;
  }
}

} // namespace
