// SPDX-License-Identifier: BSD-3-Clause
// Rectangles around what is covered of a picture.
#include "Render/Raycast/CoveredParts.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

using namespace banyan;

FloatImage Blank(const PixelRect& rect)
{
  FloatImage picture;
  picture.Rect = rect;
  picture.Pixels.assign(static_cast<std::size_t>(rect.Count()), glm::vec4(0.0f));
  return picture;
}

int HowOftenIn(const std::vector<PixelRect>& parts, int x, int y)
{
  int often = 0;
  for (const PixelRect& part : parts)
  {
    often += x >= part.Lo.x && x < part.Hi.x && y >= part.Lo.y && y < part.Hi.y;
  }
  return often;
}

TEST(CoveredParts, HoldCoveredPixelsOnceAndStayInThePicture)
{
  std::mt19937 random(7);
  for (const glm::ivec2 size :
    { glm::ivec2(1, 1), glm::ivec2(31, 65), glm::ivec2(100, 32), glm::ivec2(64, 130) })
  {
    for (const int oneIn : { 1, 30, 1000, 5000 })
    {
      const glm::ivec2 corner(5, 17);
      FloatImage picture = Blank({ corner, corner + size });
      for (glm::vec4& pixel : picture.Pixels)
      {
        pixel.a = random() % oneIn == 0 ? 1e-6f : 0.0f;
      }
      const std::vector<PixelRect> parts = CoveredParts(picture, picture.Rect);
      for (const PixelRect& part : parts)
      {
        EXPECT_TRUE(Intersection(part, picture.Rect) == part && !part.Empty());
      }
      for (int y = corner.y; y < corner.y + size.y; ++y)
      {
        for (int x = corner.x; x < corner.x + size.x; ++x)
        {
          const int often = HowOftenIn(parts, x, y);
          EXPECT_LE(often, 1);
          EXPECT_TRUE(often == 1 || picture.At(x, y).a == 0.0f) << x << ' ' << y;
        }
      }
    }
  }
}

TEST(CoveredParts, AreFewAndSmall)
{
  FloatImage picture = Blank({ { 0, 0 }, { 512, 512 } });
  EXPECT_TRUE(CoveredParts(picture, picture.Rect).empty());
  picture.At(200, 100).a = 1.0f;
  const std::vector<PixelRect> one = CoveredParts(picture, picture.Rect);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_LE(one.front().Count(), 32 * 32);
  for (glm::vec4& pixel : picture.Pixels)
  {
    pixel.a = 1.0f;
  }
  EXPECT_EQ(CoveredParts(picture, picture.Rect).size(), 16u);
  EXPECT_TRUE(CoveredParts(FloatImage{}, {}).empty());
}

} // namespace
