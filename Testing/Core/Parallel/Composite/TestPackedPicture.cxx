// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/PackedPicture.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Render/Dice.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

PlacedPicture Random(Dice& dice, int mostRows = 50)
{
  const glm::ivec2 size(dice.Whole(1, 70), dice.Whole(1, mostRows));
  BytePicture picture{ size, {}, {} };
  picture.Rect.Lo = { dice.Whole(0, size.x), dice.Whole(0, size.y) };
  picture.Rect.Hi = { dice.Whole(picture.Rect.Lo.x, size.x),
    dice.Whole(picture.Rect.Lo.y, size.y) };
  const int most = dice.Whole(0, 255);
  for (long long i = 0; i < 4 * picture.Rect.Count(); ++i)
  {
    picture.Pixels.push_back(static_cast<std::uint8_t>(dice.Whole(0, most)));
  }
  PlacedPicture placed{ picture, {} };
  for (int boxes = dice.Whole(0, 8); boxes > 0; --boxes)
  {
    const double at = dice.Whole(-9, 9);
    placed.Body.push_back(PlaceBox(glm::dvec3(at), glm::dvec3(at + 1.5), glm::dmat4(2.0)));
  }
  return placed;
}

TEST(PackedPicture, ComesBackAsItWas)
{
  Dice dice(5);
  for (int i = 0; i < 50; ++i)
  {
    const PlacedPicture placed = Random(dice, i < 40 ? 50 : 3000);
    ThreadPool threads(1 + i % 3);
    const Bytes packed = PackPicture(placed, threads);
    const PlacedPicture back = UnpackPicture(packed, threads);
    EXPECT_EQ(back.Picture.Size, placed.Picture.Size);
    EXPECT_EQ(back.Picture.Rect, placed.Picture.Rect);
    EXPECT_EQ(back.Picture.Pixels, placed.Picture.Pixels);
    ASSERT_EQ(back.Body.size(), placed.Body.size());
    for (std::size_t box = 0; box < back.Body.size(); ++box)
    {
      EXPECT_EQ(back.Body[box].Corner, placed.Body[box].Corner);
      EXPECT_EQ(back.Body[box].Edges, placed.Body[box].Edges);
    }
    ThreadPool one(1);
    EXPECT_EQ(PackPicture(placed, one), packed);
  }
}

TEST(PackedPicture, NoBoxIsLeftOut)
{
  Dice dice(7);
  ThreadPool threads(1);
  PlacedPicture placed = Random(dice);
  placed.Body.resize(9);
  EXPECT_THROW(PackPicture(placed, threads), Error);
}

TEST(PackedPicture, DamageIsAnErrorOrAnotherPicture)
{
  Dice dice(6);
  ThreadPool threads(2);
  const Bytes packed = PackPicture(Random(dice), threads);
  for (std::size_t bytes = 0; bytes < packed.size(); ++bytes)
  {
    const Bytes part(packed.begin(), packed.begin() + static_cast<int>(bytes));
    EXPECT_THROW(UnpackPicture(part, threads), Error);
  }
  for (std::size_t at = 0; at < packed.size(); ++at)
  {
    Bytes damaged = packed;
    damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ 0x55);
    try
    {
      const BytePicture back = UnpackPicture(damaged, threads).Picture;
      EXPECT_EQ(back.Pixels.size(), 4 * static_cast<std::size_t>(back.Rect.Count()));
    }
    catch (const Error&)
    {
    }
  }
}

} // namespace
