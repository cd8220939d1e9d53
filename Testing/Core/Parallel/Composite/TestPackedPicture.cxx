// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/PackedPicture.h"

#include "Base/Error.h"
#include "Render/Dice.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

BytePicture Random(Dice& dice)
{
  const glm::ivec2 size(dice.Whole(1, 70), dice.Whole(1, 50));
  BytePicture picture{ size, {}, {} };
  picture.Rect.Lo = { dice.Whole(0, size.x), dice.Whole(0, size.y) };
  picture.Rect.Hi = { dice.Whole(picture.Rect.Lo.x, size.x),
    dice.Whole(picture.Rect.Lo.y, size.y) };
  const int most = dice.Whole(0, 255);
  for (long long i = 0; i < 4 * picture.Rect.Count(); ++i)
  {
    picture.Pixels.push_back(static_cast<std::uint8_t>(dice.Whole(0, most)));
  }
  return picture;
}

TEST(PackedPicture, ComesBackAsItWas)
{
  Dice dice(5);
  for (int i = 0; i < 50; ++i)
  {
    const BytePicture picture = Random(dice);
    const BytePicture back = UnpackPicture(PackPicture(picture));
    EXPECT_EQ(back.Size, picture.Size);
    EXPECT_EQ(back.Rect, picture.Rect);
    EXPECT_EQ(back.Pixels, picture.Pixels);
  }
}

TEST(PackedPicture, DamageIsAnErrorOrAnotherPicture)
{
  Dice dice(6);
  const Bytes packed = PackPicture(Random(dice));
  for (std::size_t bytes = 0; bytes < packed.size(); ++bytes)
  {
    EXPECT_THROW(
      UnpackPicture({ packed.begin(), packed.begin() + static_cast<int>(bytes) }), Error);
  }
  for (std::size_t at = 0; at < packed.size(); ++at)
  {
    Bytes damaged = packed;
    damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ 0x55);
    try
    {
      const BytePicture back = UnpackPicture(damaged);
      EXPECT_EQ(back.Pixels.size(), 4 * static_cast<std::size_t>(back.Rect.Count()));
    }
    catch (const Error&)
    {
    }
  }
}

} // namespace
