// SPDX-License-Identifier: BSD-3-Clause
// Frames of values in memory: what the frame before had of them is told by what they are.
#include "Parallel/Frame/PlainSteps.h"

namespace
{

using namespace banyan;
using namespace banyan::played;

void ExpectEqualValuesAreKept(Communicator& communicator)
{
  PlainPlayer player(communicator);
  Situation now;
  EXPECT_FALSE(player.Draw(now).Kept);
  ++now.Again;
  EXPECT_TRUE(player.Draw(now).Kept);
  ++now.Again;
  now.Changed = { 30, 25, 40 };
  EXPECT_FALSE(player.Draw(now).Kept) << "a sample has changed";
  now.Changed = glm::ivec3(-1);
  EXPECT_TRUE(player.Draw(now).Kept) << "the first ones again";
  now.Function = 2;
  EXPECT_FALSE(player.Draw(now).Kept);
  now.Changed = { 30, 25, 5 };
  EXPECT_TRUE(player.Draw(now).Kept) << "nobody sees that one";
}

TEST(PlainFrames, EqualValuesAreNotDrawnAgain)
{
  for (const int ranks : { 1, 2, 3 })
  {
    RunOnSimulatedRanks(ranks, ExpectEqualValuesAreKept);
  }
}

void ExpectFewRays(Communicator& communicator, bool shaded)
{
  PlainPlayer with(communicator);
  PlainPlayer without(communicator);
  Situation now;
  now.FixedDistance = 1.0;
  now.Shaded = shaded;
  double reused = 0.0;
  for (const int step : { 0, 1, 2, 3, PlainInput::OtherRange, 4, 3 })
  {
    now.Step = step;
    const FieldFrames::Frame frame = DrawBoth(with, without, now);
    EXPECT_EQ(frame.ReusedFraction() > 0.0, step >= 2)
      << "it begins with the second picture: " << step;
    reused += frame.ReusedFraction();
  }
  EXPECT_GT(reused, 0.3);
}

TEST(PlainFrames, RaysThatMeetWhatTheyMetAreNotCast)
{
  for (const int ranks : { 1, 2, 3 })
  {
    for (const bool shaded : { false, true })
    {
      RunOnSimulatedRanks(
        ranks, [&](Communicator& communicator) { ExpectFewRays(communicator, shaded); });
    }
  }
}

TEST(PlainFrames, PackedBricksThatHoldTheSameStay)
{
  const auto alone = MakeSelfCommunicator();
  for (const bool shaded : { false, true })
  {
    PlainPlayer player(*alone);
    Situation now;
    now.Shaded = shaded;
    const auto keptAt = [&](int step)
    {
      now.Step = step;
      Become(player.In, now);
      player.Field.Update(*alone, player.In);
      const std::uint64_t bytes = player.Field.Drawn().Source()->Kept().Bytes();
      player.Draw(now);
      return bytes;
    };
    EXPECT_EQ(keptAt(0), 0u);
    EXPECT_GT(keptAt(1), 0u);
    EXPECT_EQ(keptAt(PlainInput::OtherRange) > 0, !shaded) << "gradients are parts of the range";
    EXPECT_GT(keptAt(PlainInput::OtherRange), 0u);
    EXPECT_EQ(keptAt(PlainInput::SomeHidden), 0u) << "packed without the hidden cells";
    EXPECT_EQ(keptAt(0), 0u) << "packed with them";
  }
}

TEST(PlainFrames, WithLightALayerAroundCounts)
{
  const auto alone = MakeSelfCommunicator();
  PlainPlayer with(*alone);
  PlainPlayer without(*alone);
  Situation now;
  now.FixedDistance = 1.0;
  now.Shaded = true;
  DrawBoth(with, without, now);
  // The bricks before have samples up to 32, and those at 33 count for their gradients.
  for (const glm::ivec3& at : { glm::ivec3(28, 24, 33), glm::ivec3(33, 24, 40) })
  {
    now.Changed = at;
    EXPECT_FALSE(DrawBoth(with, without, now).Kept);
  }
  for (const bool shaded : { false, true })
  {
    now.Function = 2; // below 26 nothing shows, so that brick 0 along z does not
    now.Shaded = shaded;
    now.Changed = glm::ivec3(-1);
    EXPECT_FALSE(DrawBoth(with, without, now).Kept);
    now.Changed = { 28, 24, 15 };
    EXPECT_EQ(DrawBoth(with, without, now).Kept, !shaded);
  }
}

TEST(PlainFrames, WithLightRaysBesideBricksThatChangeAreCast)
{
  ExpectRaysBesideBricksAreCast<PlainPlayer>({ 17, 31, 33, 47 });
}

TEST(PlainFrames, HiddenCellsThatChangeAreNoticed)
{
  const auto alone = MakeSelfCommunicator();
  PlainPlayer with(*alone);
  PlainPlayer without(*alone);
  Situation now;
  now.FixedDistance = 1.0;
  now.Function = 2; // steps differ by what is hidden alone
  constexpr int first = PlainInput::SomeHidden;
  for (const int step : { first - 1, first, first + 1, first + 2 })
  {
    now.Step = step;
    EXPECT_EQ(DrawBoth(with, without, now).Kept, step == first + 2) << step;
  }
}

TEST(PlainFrames, ValuesOfWhichNothingCanBeTakenAreHardlyLookedAt)
{
  const auto alone = MakeSelfCommunicator();
  PlainPlayer player(*alone);
  Situation now;
  const auto looks = [&]
  {
    ++now.Again;
    player.Draw(now);
    const BrickSource& source = *player.Field.Drawn().Source();
    const glm::ivec3 counts = source.Bricks();
    return source.ContentOf(BrickSource::NumberOf(counts / 2, counts)).has_value();
  };
  int looked = 0;
  for (int step = 0; step < 48; ++step)
  {
    now.Eye += 0.01; // another view each time
    looked += looks() ? 1 : 0;
  }
  EXPECT_GE(looked, 8 + 2 * 2) << "it has to look whether something can be taken again";
  EXPECT_LE(looked, 8 + 2 * 3 + 1);
  int until = 0;
  while (!player.Draw(now).Kept && until < 40)
  {
    ++until;
    ++now.Again;
  }
  EXPECT_LE(until, 16) << "the view rests";
  for (int step = 0; step < 10; ++step)
  {
    EXPECT_TRUE(looks());
  }
}

} // namespace
