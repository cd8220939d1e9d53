// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/PackedDepths.h"

#include "Base/Error.h"
#include "Render/Dice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace banyan;

DepthPicture Random(Dice& dice)
{
  const glm::ivec2 size(dice.Whole(1, 70), dice.Whole(1, 50));
  DepthPicture picture{ size, {}, {} };
  picture.Rect.Lo = { dice.Whole(0, size.x), dice.Whole(0, size.y) };
  picture.Rect.Hi = { dice.Whole(picture.Rect.Lo.x, size.x),
    dice.Whole(picture.Rect.Lo.y, size.y) };
  for (long long i = 0; i < picture.Rect.Count(); ++i)
  {
    picture.Depths.push_back(
      dice.Whole(0, 2) > 0 ? 1.0f : static_cast<float>(dice.Whole(0, 1000)) / 1000.0f);
  }
  return picture;
}

/// A surface in a window of 1024^2, in 24 bits as of OpenGL.
template <class Surface>
DepthPicture Surfaced(Surface depth)
{
  DepthPicture picture{ glm::ivec2(1024), { glm::ivec2(200), glm::ivec2(800) }, {} };
  for (int y = 200; y < 800; ++y)
  {
    for (int x = 200; x < 800; ++x)
    {
      picture.Depths.push_back(
        static_cast<float>(std::round(depth(x, y) * 16777215.0) / 16777215.0));
    }
  }
  return picture;
}

DepthPicture Plane()
{
  return Surfaced([](int x, int y) { return 0.7 + 1e-4 * x - 2.3e-4 * y; });
}

DepthPicture Sphere()
{
  return Surfaced(
    [](int x, int y)
    {
      const double from = std::hypot(x - 500, y - 500) / 250.0;
      return from < 1.0 ? 0.8 - 0.1 * std::sqrt(1.0 - from * from) : 1.0;
    });
}

TEST(PackedDepths, ComeBackWithin24Bits)
{
  Dice dice(7);
  for (int i = 0; i < 50; ++i)
  {
    const DepthPicture picture = Random(dice);
    const DepthPicture back = UnpackDepths(PackDepths(picture));
    ASSERT_EQ(back.Size, picture.Size);
    ASSERT_EQ(back.Rect, picture.Rect);
    ASSERT_EQ(back.Depths.size(), picture.Depths.size());
    for (std::size_t at = 0; at < back.Depths.size(); ++at)
    {
      ASSERT_NEAR(back.Depths[at], picture.Depths[at], std::ldexp(1.0, -24));
      ASSERT_EQ(back.Depths[at] < 1.0f, picture.Depths[at] < 1.0f);
    }
  }
}

TEST(PackedDepths, ThoseOfOpenGLComeBackAsTheyWere)
{
  for (const DepthPicture& picture : { Plane(), Sphere() })
  {
    EXPECT_EQ(UnpackDepths(PackDepths(picture)).Depths, picture.Depths);
  }
}

TEST(PackedDepths, SurfacesTakeFewBytes)
{
  EXPECT_LT(PackDepths(Plane()).size(), 5000u);
  EXPECT_LT(PackDepths(Sphere()).size(), 196350u); // a byte a pixel
  DepthPicture nothing = Plane();
  std::fill(nothing.Depths.begin(), nothing.Depths.end(), 1.0f);
  EXPECT_LT(PackDepths(nothing).size(), 1000u);
}

TEST(PackedDepths, DamageIsAnErrorOrOtherDepths)
{
  Dice dice(8);
  DepthPicture picture;
  while (picture.Depths.size() < 100)
  {
    picture = Random(dice);
  }
  const Bytes packed = PackDepths(picture);
  for (std::size_t bytes = 0; bytes < packed.size(); ++bytes)
  {
    EXPECT_THROW(UnpackDepths({ packed.begin(), packed.begin() + static_cast<int>(bytes) }), Error);
  }
  for (std::size_t at = 0; at < packed.size(); ++at)
  {
    Bytes damaged = packed;
    damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ 0x55);
    try
    {
      const DepthPicture back = UnpackDepths(damaged);
      EXPECT_EQ(back.Depths.size(), static_cast<std::size_t>(back.Rect.Count()));
    }
    catch (const Error&)
    {
    }
  }
}

TEST(DepthPicture, PartsHaveWhatThePictureHas)
{
  Dice dice(9);
  for (int i = 0; i < 50; ++i)
  {
    const DepthPicture picture = Random(dice);
    const PixelRect all{ glm::ivec2(0), picture.Size };
    std::vector<float> depths = picture.In(all);
    if (depths.empty())
    {
      depths.assign(static_cast<std::size_t>(all.Count()), 1.0f);
    }
    const DepthPicture trimmed = picture.Trimmed();
    std::vector<float> again = trimmed.In(all);
    if (again.empty())
    {
      again.assign(static_cast<std::size_t>(all.Count()), 1.0f);
    }
    EXPECT_EQ(again, depths);
    const bool isEmpty = std::all_of(depths.begin(), depths.end(), [](float d) { return d == 1; });
    EXPECT_EQ(trimmed.Rect.Empty(), isEmpty);
    EXPECT_LE(trimmed.Rect.Count(), picture.Rect.Count());
  }
}

TEST(DepthPicture, ACoarserOneHasDepthsFromTheMiddleOfItsPixels)
{
  Dice dice(10);
  for (int i = 0; i < 50; ++i)
  {
    const DepthPicture picture = Random(dice);
    const int every = 1 << dice.Whole(0, 3);
    const DepthPicture coarser = picture.Coarser(every);
    ASSERT_EQ(coarser.Size, (picture.Size + (every - 1)) / every);
    const PixelRect all{ glm::ivec2(0), coarser.Size };
    std::vector<float> depths = coarser.In(all);
    depths.resize(static_cast<std::size_t>(all.Count()), 1.0f);
    const std::vector<float> fine = picture.In({ glm::ivec2(0), picture.Size });
    for (int y = 0; y < coarser.Size.y; ++y)
    {
      for (int x = 0; x < coarser.Size.x; ++x)
      {
        const glm::dvec2 middle =
          (glm::dvec2(x, y) + 0.5) * glm::dvec2(picture.Size) / glm::dvec2(coarser.Size);
        const auto at =
          static_cast<std::size_t>(middle.y) * static_cast<std::size_t>(picture.Size.x) +
          static_cast<std::size_t>(middle.x);
        const float expected = fine.empty() ? 1.0f : fine[at];
        const auto here = static_cast<std::size_t>(y * coarser.Size.x + x);
        ASSERT_EQ(depths[here], expected);
      }
    }
  }
}

} // namespace
