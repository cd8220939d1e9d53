// SPDX-License-Identifier: BSD-3-Clause
// Frames of which ranks divide the pixels, and frames whose pixels end on several ranks: they have
// the bits of one rank.
#include "Parallel/Frame/MeshSteps.h"
#include "Parallel/Frame/PlainSteps.h"

#include <functional>

namespace
{

using namespace banyan;
using namespace banyan::played;

/// Somebody turns, changes the function, cuts, and goes on in time.
std::vector<Situation> Situations()
{
  std::vector<Situation> all(14);
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    all[i].Eye = 0.3 * static_cast<double>(i / 2); // twice the same
    all[i].Shaded = i >= 4;
    all[i].Function = i >= 6 ? 1 : 0;
    all[i].Cut = i >= 8;
    all[i].Geometry = i >= 10;
    all[i].Step = i >= 12 ? 2 : 0;
  }
  return all;
}

/// Rays that end early end elsewhere in other zones.
constexpr double OfZones = 0.5 * 4.0 / 255.0 + 1e-5;

/// Draws all situations on ranks, and on each of them alone.
/// @param placesOf a situation, by its number: none for one picture on the first rank
/// @param judge gets each frame, and how often it was drawn before
template <class Plays>
void ExpectFramesOfOneRank(int ranks, FieldFrames::Division division, double allowed,
  const std::function<std::vector<PicturePlace>(int)>& placesOf,
  const std::function<void(const FieldFrames::Frame&, bool again)>& judge)
{
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      const auto self = MakeSelfCommunicator();
      Plays divided(communicator);
      Plays alone(*self);
      int number = 0;
      for (const Situation& now : Situations())
      {
        const std::vector<PicturePlace> places = placesOf(number);
        RayScene scene = divided.Take(now);
        FieldFrames::Wish wish = Plays::WishOf(now, true);
        wish.Divides = division;
        wish.Places = places;
        const FieldFrames::Frame frame =
          divided.Frames.Draw(communicator, divided.Field, scene, wish);
        judge(frame, number++ % 2 == 1);
        const FieldFrames::Frame expected = alone.Draw(now, false);
        const bool isFirst = places.empty() && communicator.Rank() == 0;
        PixelRect mine = isFirst ? scene.Viewport : PixelRect{};
        for (const PicturePlace& place : places)
        {
          mine = place.Root == communicator.Rank() ? place.Rect : mine;
        }
        ASSERT_EQ(frame.Picture.Pixels != nullptr, !mine.Empty());
        for (int y = mine.Lo.y; y < mine.Hi.y && !mine.Empty(); ++y)
        {
          for (int x = mine.Lo.x; x < mine.Hi.x; ++x)
          {
            const glm::vec4 off =
              glm::abs(frame.Picture.Pixels->At(x, y) - expected.Picture.Pixels->At(x, y));
            ASSERT_LE(std::max({ off.r, off.g, off.b, off.a }), allowed) << x << " " << y;
          }
        }
      }
    });
}

std::vector<PicturePlace> Nowhere(int)
{
  return {};
}

TEST(DividedFrames, DividedByPictureTheyHaveTheBitsOfOneRank)
{
  const auto judge = [](const FieldFrames::Frame& frame, bool again)
  {
    EXPECT_EQ(frame.Kept, again);
    EXPECT_NE(frame.ByPicture, frame.Kept);
  };
  for (int ranks = 2; ranks <= 5; ++ranks)
  {
    ExpectFramesOfOneRank<Player>(ranks, FieldFrames::Division::ByPicture, 0.0, Nowhere, judge);
  }
  ExpectFramesOfOneRank<MeshPlayer>(3, FieldFrames::Division::ByPicture, 0.0, Nowhere, judge);
}

TEST(DividedFrames, ValuesOfOtherRanksAreDividedByData)
{
  ExpectFramesOfOneRank<PlainPlayer>(3, FieldFrames::Division::ByPicture, OfZones, Nowhere,
    [](const FieldFrames::Frame& frame, bool) { EXPECT_FALSE(frame.ByPicture); });
}

TEST(DividedFrames, OfPlacesEachRankHasItsOwn)
{
  const std::vector<PicturePlace> places{ { { { 0, 0 }, { 41, 80 } }, 2, {} },
    { { { 41, 0 }, { 96, 80 } }, 0, {} } };
  for (const bool byData : { false, true })
  {
    const auto division = byData ? FieldFrames::Division::ByData : FieldFrames::Division::Automatic;
    ExpectFramesOfOneRank<Player>(
      3, division, byData ? OfZones : 0.0, [&](int) { return places; },
      [&](const FieldFrames::Frame& frame, bool again)
      {
        EXPECT_EQ(frame.Kept, again);
        EXPECT_EQ(frame.ByPicture, !byData && !again);
        if (!byData && !again && frame.Picture.Pixels)
        {
          EXPECT_EQ(frame.ReusedFraction(), 0.0);
        }
      });
  }
}

TEST(DividedFrames, APlaceMayGoFromRankToRank)
{
  // Who shows the picture now has nothing of the one before.
  ExpectFramesOfOneRank<Player>(
    3, FieldFrames::Division::Automatic, OfZones,
    [](int number) -> std::vector<PicturePlace> {
      return { { { { 10, 0 }, { 90, 80 } }, number % 3, {} } };
    },
    [](const FieldFrames::Frame& frame, bool)
    {
      EXPECT_FALSE(frame.Kept);
      EXPECT_FALSE(frame.ByPicture);
    });
}

} // namespace
