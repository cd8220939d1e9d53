// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/DepthPicture.h"

#include "Render/Dice.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace banyan;

namespace
{

/// Depths in a part of a picture of 12 x 9 pixels; the part may be empty.
DepthPicture Random(Dice& dice)
{
  DepthPicture picture{ { 12, 9 }, {}, {} };
  picture.Rect.Lo = { dice.Whole(0, 12), dice.Whole(0, 9) };
  picture.Rect.Hi = { dice.Whole(0, 12), dice.Whole(0, 9) };
  for (long long i = 0; i < picture.Rect.Count(); ++i)
  {
    picture.Depths.push_back(static_cast<float>(dice.In(0.0, 1.0)));
  }
  return picture;
}

float At(const DepthPicture& picture, int x, int y)
{
  const std::vector<float> depth = picture.In({ { x, y }, { x + 1, y + 1 } });
  return depth.empty() ? 1.0f : depth.front();
}

} // namespace

TEST(DepthPicture, NearestOfPartsIsTheNearestAtEachPixel)
{
  Dice dice(5);
  for (int repeat = 0; repeat < 200; ++repeat)
  {
    std::vector<DepthPicture> parts;
    for (int i = dice.Whole(0, 4); i > 0; --i)
    {
      parts.push_back(Random(dice));
    }
    const DepthPicture nearest = NearestOf(parts);
    ASSERT_EQ(static_cast<std::size_t>(nearest.Rect.Count()), nearest.Depths.size());
    EXPECT_EQ(parts.empty() ? glm::ivec2(0) : glm::ivec2(12, 9), nearest.Size);
    for (int y = 0; y < 9; ++y)
    {
      for (int x = 0; x < 12; ++x)
      {
        float wanted = 1.0f;
        for (const DepthPicture& part : parts)
        {
          wanted = std::min(wanted, At(part, x, y));
        }
        EXPECT_EQ(wanted, At(nearest, x, y)) << x << " " << y;
      }
    }
  }
}
