// SPDX-License-Identifier: BSD-3-Clause
// What probes say of tiles, beside a slow way to find it; and how often they are drawn.
#include "Render/Sampling/ProbeImages.h"

#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <random>

using namespace banyan;

namespace
{

FloatImage Painted(const RayScene& probe)
{
  FloatImage image;
  image.Rect = probe.Viewport;
  image.Pixels.assign(static_cast<std::size_t>(image.Rect.Count()), glm::vec4(1.0f));
  return image;
}

/// The largest error of the probes within some tiles of a tile.
double LargestAround(
  const ProbeImages& pictures, const ProbeErrors& errors, const glm::ivec2& tile, double around)
{
  const glm::dvec2 image(pictures.ImageSize());
  const glm::dvec2 size(
    (pictures.ImageSize() + pictures.PixelsApart() - 1) / pictures.PixelsApart());
  const PixelRect& part = pictures.Part();
  const auto isNear = [&](int probe, int axis)
  {
    const double edge = TileSamplings::Edge;
    const double low = (tile[axis] - around) * edge * size[axis] / image[axis];
    const double high = (tile[axis] + 1 + around) * edge * size[axis] / image[axis];
    return probe >= std::floor(low) && probe < std::ceil(high);
  };
  double largest = 0.0;
  for (int y = part.Lo.y; y < part.Hi.y; ++y)
  {
    for (int x = part.Lo.x; x < part.Hi.x; ++x)
    {
      const auto pixel = static_cast<std::size_t>(y - part.Lo.y) * part.Size().x + (x - part.Lo.x);
      largest =
        isNear(x, 0) && isNear(y, 1) ? std::max<double>(largest, errors.Pixels[pixel]) : largest;
    }
  }
  return largest;
}

TEST(ProbeImages, ErrorsOfTilesAreTheLargestAroundThem)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<float> error(0.0f, 1.0f);
  struct Shape
  {
    glm::ivec2 Picture;
    int Spacing;
    double Around;
  };
  for (const Shape& shape : { Shape{ { 640, 480 }, 16, 2.5 }, Shape{ { 333, 517 }, 4, 1.5 },
         Shape{ { 100, 40 }, 16, 0.0 }, Shape{ { 31, 700 }, 1, 0.5 }, Shape{ { 1, 1 }, 16, 2.5 } })
  {
    const RayScene scene = scenes::Scene(glm::ivec3(9), shape.Picture);
    const ProbeImages pictures(scene, Painted, shape.Spacing, shape.Around);
    ProbeErrors errors;
    for (long long i = 0; i < pictures.Part().Count(); ++i)
    {
      errors.Pixels.push_back(error(random));
    }
    const TileErrors found = pictures.ErrorsOf(errors, 3.0, 0.5);
    const glm::ivec2 tiles = TileSamplings::TilesOf(shape.Picture);
    ASSERT_EQ(found.Tiles.size(), pictures.TileCount());
    for (int i = 0; i < tiles.x * tiles.y; ++i)
    {
      const glm::ivec2 tile(i % tiles.x, i / tiles.x);
      const double expected = std::max<double>(
        3.0f * static_cast<float>(LargestAround(pictures, errors, tile, shape.Around)),
        0.5 * errors.Largest());
      EXPECT_NEAR(found.Of(static_cast<std::size_t>(i)), expected, 1e-6) << i;
    }
  }
}

TEST(ProbeImages, NoneIsDrawnTwice)
{
  const RayScene scene = scenes::Scene(glm::ivec3(9), glm::ivec2(512));
  int drawn = 0;
  ProbeImages pictures(scene,
    [&](const RayScene& probe)
    {
      ++drawn;
      FloatImage image = Painted(probe);
      image.Pixels.front().r = static_cast<float>(probe.Samplings->Samplings().front().Distance);
      return image;
    });
  const ProbeImage first = pictures.Draw({ 0, 0.25 });
  EXPECT_EQ(pictures.Draw({ 0, 0.5 }).Pixels.front().r, 0.5f);
  EXPECT_EQ(pictures.Draw({ 1, 0.25 }).Pixels.front().r, 0.25f);
  EXPECT_EQ(pictures.Draw({ 0, 0.25 }).Pixels, first.Pixels);
  EXPECT_EQ(drawn, 3);
  EXPECT_EQ(pictures.Count(), 3);
}

} // namespace
