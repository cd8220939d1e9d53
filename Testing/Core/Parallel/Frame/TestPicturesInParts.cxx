// SPDX-License-Identifier: BSD-3-Clause
// A picture that is drawn part by part is the one that is drawn at once, and is planned once.
#include "Parallel/Frame/PlainSteps.h"
#include "Render/Scene/DepthPicture.h"

namespace
{

using namespace banyan;
using namespace banyan::played;

constexpr int Margin = RaySampling::LargestStride;

/// Parts with seams in tiles, and at their edges.
std::vector<PixelRect> PartsOf(const PixelRect& rect)
{
  std::vector<PixelRect> parts;
  for (const auto& [low, high] : { std::pair(0, 31), std::pair(31, 32), std::pair(32, 1000) })
  {
    for (const auto& [left, right] : { std::pair(0, 45), std::pair(45, 1000) })
    {
      parts.push_back(Intersection(rect, { { left, low }, { right, high } }));
    }
  }
  return parts;
}

struct Drawn
{
  FloatImage Picture; ///< on rank 0
  int Plans = 0;      ///< parts for which small pictures were drawn
  std::int64_t Samples = 0;
};

/// Draws all parts of a situation, one after the other.
/// @param whole taken by the player
template <class Plays>
Drawn DrawParts(
  Plays& player, const Situation& now, FieldFrames::Division division, const RayScene& whole)
{
  FieldFrames::Wish wish = Plays::WishOf(now, true);
  wish.Divides = division;
  wish.Whole = whole.Viewport;
  Drawn drawn;
  drawn.Picture.Rect = whole.Viewport;
  drawn.Picture.Pixels.resize(static_cast<std::size_t>(whole.Viewport.Count()));
  for (const PixelRect& part : PartsOf(whole.Viewport))
  {
    RayScene scene = whole;
    scene.Viewport = Intersection(whole.Viewport, { part.Lo - Margin, part.Hi + Margin });
    if (!whole.Depth.empty())
    {
      scene.Depth = DepthPicture{ {}, whole.Viewport, whole.Depth }.In(scene.Viewport);
    }
    wish.Places = { { part, 0, {} } };
    const FieldFrames::Frame frame = player.Frames.Draw(*player.Ranks, player.Field, scene, wish);
    EXPECT_FALSE(frame.Kept);
    drawn.Plans += frame.Picture.Statistics.Probes > 0 ? 1 : 0;
    drawn.Samples += frame.Picture.Statistics.SamplesTaken;
    for (int y = part.Lo.y; y < part.Hi.y && frame.Picture.Pixels; ++y)
    {
      std::copy_n(
        &frame.Picture.Pixels->At(part.Lo.x, y), part.Size().x, &drawn.Picture.At(part.Lo.x, y));
    }
  }
  return drawn;
}

template <class Plays>
Drawn DrawParts(Plays& player, const Situation& now, FieldFrames::Division division)
{
  const RayScene whole = player.Take(now);
  return DrawParts(player, now, division, whole);
}

/// @param allowed between parts and the picture that one rank draws at once
template <class Plays>
void ExpectPartsOfThePicture(int ranks, FieldFrames::Division division, double allowed)
{
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      const auto self = MakeSelfCommunicator();
      Plays inParts(communicator);
      Plays alone(*self);
      for (int i = 0; i < 8; ++i)
      {
        Situation now;
        now.Eye = 0.4 * (i / 2);
        now.Shaded = i >= 4;
        now.Function = i % 2;
        now.Projected = i == 5;
        now.Step = i >= 6 ? 2 : 0;
        // Frames that were measured move zones: bricks of parts come from other ranks.
        Situation before = now;
        before.Eye -= 0.2;
        inParts.Draw(before, false);
        const Drawn drawn = DrawParts(inParts, now, division);
        // Projections have levels that follow from the camera alone.
        EXPECT_EQ(drawn.Plans, now.Projected ? 0 : 1) << i;
        const FieldFrames::Frame expected = alone.Draw(now, false);
        ASSERT_GT(drawn.Samples, 0);
        if (communicator.Rank() == 0)
        {
          EXPECT_LE(WorstDifference(drawn.Picture, *expected.Picture.Pixels), allowed) << i;
        }
      }
    });
}

TEST(PicturesInParts, HaveTheBitsOfThoseDrawnAtOnce)
{
  ExpectPartsOfThePicture<Player>(1, FieldFrames::Division::Automatic, 0.0);
  ExpectPartsOfThePicture<PlainPlayer>(1, FieldFrames::Division::Automatic, 0.0);
  ExpectPartsOfThePicture<Player>(3, FieldFrames::Division::ByPicture, 0.0);
}

TEST(PicturesInParts, AreThoseOfOneRankByDataToo)
{
  // Rays that end early end elsewhere in other zones.
  constexpr double ofZones = 0.5 * 4.0 / 255.0 + 1e-5;
  ExpectPartsOfThePicture<Player>(3, FieldFrames::Division::ByData, ofZones);
  ExpectPartsOfThePicture<PlainPlayer>(3, FieldFrames::Division::ByData, ofZones);
}

TEST(PicturesInParts, KeepTheToleranceBesideSomethingOpaque)
{
  const auto self = MakeSelfCommunicator();
  Player inParts(*self);
  Player exact(*self);
  Situation now;
  now.Function = 1;
  // A wall with an edge across tiles.
  RayScene scene = inParts.Take(now);
  scene.Depth.assign(static_cast<std::size_t>(scene.Viewport.Count()), 1.0f);
  for (std::size_t i = 0; i < scene.Depth.size(); ++i)
  {
    const auto width = static_cast<std::size_t>(scene.Viewport.Size().x);
    scene.Depth[i] = i % width + i / width < 80 ? 0.97f : 1.0f;
  }
  const Drawn drawn = DrawParts(inParts, now, FieldFrames::Division::Automatic, scene);
  now.Tolerance = 0.25;
  exact.Take(now);
  const FieldFrames::Frame expected =
    exact.Frames.Draw(*self, exact.Field, scene, Player::WishOf(now, false));
  EXPECT_LE(WorstDifference(drawn.Picture, *expected.Picture.Pixels), 4.0 / 255.0);
}

TEST(PicturesInParts, ArePlannedAnewForAnotherPicture)
{
  const auto self = MakeSelfCommunicator();
  Player player(*self);
  Situation now;
  EXPECT_EQ(DrawParts(player, now, FieldFrames::Division::Automatic).Plans, 1);
  EXPECT_EQ(DrawParts(player, now, FieldFrames::Division::Automatic).Plans, 0);
  now.Step = 3;
  EXPECT_EQ(DrawParts(player, now, FieldFrames::Division::Automatic).Plans, 1);
  now.Tolerance = 2.0;
  EXPECT_EQ(DrawParts(player, now, FieldFrames::Division::Automatic).Plans, 1);
}

} // namespace
