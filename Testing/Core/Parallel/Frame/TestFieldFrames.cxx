// SPDX-License-Identifier: BSD-3-Clause
// Frames that take from those before what is the same: whatever is done in between, pictures are
// those of frames that are drawn from nothing.
#include "Parallel/Fields/ArrayInput.h"
#include "Parallel/Frame/MeshSteps.h"
#include "Parallel/Frame/PlainSteps.h"
#include "Render/Dice.h"

namespace
{

using namespace banyan;
using namespace banyan::played;

/// Changes one thing, as somebody in front of a window does.
void ChangeSomething(Situation& now, Dice& dice, const std::vector<Situation>& before)
{
  switch (dice.Whole(0, 16))
  {
    case 0:
    case 1:
    case 2:
      now.Step = (now.Step + 1) % Steps;
      break;
    case 3:
      now.Step = dice.Whole(0, Steps - 1);
      break;
    case 4:
      now.Eye = 0.1 * dice.Whole(0, 20);
      break;
    case 5:
      now.Function = dice.Whole(0, 3);
      break;
    case 6:
      now.Cut = !now.Cut;
      break;
    case 7:
      now.Shaded = !now.Shaded;
      break;
    case 8:
      now.Projected = !now.Projected;
      break;
    case 9:
      now.Geometry = !now.Geometry;
      break;
    case 10:
      now.Width = dice.Whole(0, 1) == 0 ? 96 : 64;
      break;
    case 11:
      now.Motion = now.Motion > 0.0 ? 0.0 : 0.5;
      break;
    case 12:
      now.Interacting = !now.Interacting;
      break;
    case 13:
      ++now.Again;
      break;
    case 14:
      now.Alone = !now.Alone;
      break;
    default:
      now = before[static_cast<std::size_t>(dice.Whole(0, static_cast<int>(before.size()) - 1))];
      break;
  }
}

struct Outcome
{
  int Kept = 0;        ///< frames that were not drawn
  double Reused = 0.0; ///< of the others, pictures' worth of rays that were not cast
};

/// @param budget of the caches in which frames of a series are kept
template <class Plays = Player>
Outcome PlayAtRandom(
  Communicator& communicator, int operations, unsigned seed, std::int64_t budget, double allowed)
{
  const auto alone = MakeSelfCommunicator();
  Plays with(communicator, budget);
  Plays without(communicator, budget);
  Dice dice(seed);
  Situation now;
  std::vector<Situation> before{ now };
  Outcome outcome;
  for (int i = 0; i < operations; ++i)
  {
    ChangeSomething(now, dice, before);
    before.push_back(now);
    if (dice.Whole(0, 9) == 0)
    {
      continue; // nobody sees it: the volume is hidden
    }
    Communicator& ranks = now.Alone ? *alone : communicator;
    if (&ranks != with.Ranks && communicator.Size() > 1)
    {
      with.GoTo(ranks);
      without.GoTo(ranks);
    }
    const FieldFrames::Frame frame = with.Draw(now);
    outcome.Kept += frame.Kept ? 1 : 0;
    outcome.Reused += frame.Kept ? 0.0 : frame.ReusedFraction();
    const FieldFrames::Frame expected = without.Draw(now, false);
    EXPECT_TRUE(frame.Picture.EstimatedError <= now.Tolerance * (now.Interacting ? 4.0 : 1.0) ||
                !frame.Picture.Limit.empty())
      << i << ": " << frame.Picture.EstimatedError;
    EXPECT_EQ(frame.Picture.Pixels != nullptr, with.Ranks->Rank() == 0);
    if (with.Ranks->Rank() == 0 && !now.Interacting)
    {
      EXPECT_LE(WorstDifference(*frame.Picture.Pixels, *expected.Picture.Pixels), allowed)
        << "operation " << i << " of seed " << seed << (frame.Kept ? ", kept" : "");
    }
  }
  return outcome;
}

TEST(FieldFrames, AtRandomTheyAreThoseOfNothingKept)
{
  const auto alone = MakeSelfCommunicator();
  const Outcome plenty = PlayAtRandom(*alone, 300, 1, 64 << 20, 0.0);
  EXPECT_GT(plenty.Kept, 30);
  EXPECT_GT(plenty.Reused, 0.5);
  EXPECT_GT(PlayAtRandom(*alone, 60, 2, 8 << 20, 0.0).Kept, 3) << "room for a few pictures";
  const Outcome nothing = PlayAtRandom(*alone, 60, 3, 0, 0.0);
  EXPECT_EQ(nothing.Kept, 0) << "no budget";
  EXPECT_EQ(nothing.Reused, 0.0);
}

TEST(FieldFrames, AtRandomPlainOnesAreThoseOfNothingKept)
{
  const auto alone = MakeSelfCommunicator();
  const Outcome outcome = PlayAtRandom<PlainPlayer>(*alone, 300, 5, -1, 0.0);
  EXPECT_GT(outcome.Kept, 30);
  EXPECT_GT(outcome.Reused, 0.5);
}

TEST(FieldFrames, AtRandomMeshesAreThoseOfNothingKept)
{
  const auto alone = MakeSelfCommunicator();
  const Outcome outcome = PlayAtRandom<MeshPlayer>(*alone, 150, 7, -1, 0.0);
  EXPECT_GT(outcome.Kept, 15);
  EXPECT_GT(outcome.Reused, 0.2);
}

TEST(FieldFrames, AtRandomRanksAgree)
{
  for (const int ranks : { 2, 3 })
  {
    RunOnSimulatedRanks(ranks,
      [](Communicator& communicator)
      {
        // Rays that end early end elsewhere in other zones.
        constexpr double allowed = 4.0 / 8.0 / 255.0 + 1e-5;
        EXPECT_GT(PlayAtRandom(communicator, 60, 4, 64 << 20, allowed).Kept, 3);
        EXPECT_GT(PlayAtRandom<PlainPlayer>(communicator, 60, 6, -1, allowed).Kept, 3);
        EXPECT_GT(PlayAtRandom<MeshPlayer>(communicator, 60, 8, -1, allowed).Kept, 3);
      });
  }
}

TEST(FieldFrames, TheSameSceneIsNotDrawnAgain)
{
  RunOnSimulatedRanks(2,
    [](Communicator& communicator)
    {
      Player player(communicator);
      Situation now;
      EXPECT_FALSE(player.Draw(now).Kept);
      const FieldFrames::Frame again = player.Draw(now);
      EXPECT_TRUE(again.Kept);
      EXPECT_GT(again.Picture.Statistics.SamplesTaken, 0) << "of the frame that drew it";
      EXPECT_FALSE(player.Draw(now, false).Kept) << "nobody wants that";
      EXPECT_FALSE(player.Draw(now).Kept) << "all was forgotten then";
      now.Interacting = true;
      EXPECT_TRUE(player.Draw(now).Kept) << "the still picture is finer";
      now.Interacting = false;
      now.Tolerance = 8.0;
      EXPECT_FALSE(player.Draw(now).Kept) << "another tolerance is wanted";
      now.Tolerance = 4.0;
      EXPECT_TRUE(player.Draw(now).Kept);
    });
}

TEST(FieldFrames, ALoopIsDrawnOnce)
{
  const auto alone = MakeSelfCommunicator();
  Player player(*alone);
  std::uint64_t bytes = 0;
  for (int frame = 0; frame < 3 * Steps; ++frame)
  {
    Situation now;
    now.Step = frame % Steps;
    const FieldFrames::Frame drawn = player.Draw(now);
    EXPECT_EQ(drawn.Kept, frame >= Steps) << frame;
    bytes += drawn.Kept ? 0 : drawn.Picture.Pixels->Pixels.size() * sizeof(glm::vec4);
  }
  EXPECT_EQ(player.Frames.PictureBytes(), bytes);
}

TEST(FieldFrames, AStepWithoutAVisibleChangeIsNotDrawn)
{
  const auto alone = MakeSelfCommunicator();
  Player player(*alone);
  Situation now;
  now.Function = 2;
  EXPECT_FALSE(player.Draw(now).Kept);
  now.Step = 3;
  EXPECT_TRUE(player.Draw(now).Kept);
  now.Projected = true;
  EXPECT_FALSE(player.Draw(now).Kept);
  now.Step = 4;
  EXPECT_FALSE(player.Draw(now).Kept) << "a maximum shows the ball";
}

TEST(FieldFrames, PicturesOfACameraThatMovesAreHardlyKept)
{
  const auto alone = MakeSelfCommunicator();
  Player player(*alone);
  Situation now;
  now.Interacting = true;
  for (const double eye : { 0.0, 0.1, 0.2, 0.3 })
  {
    now.Eye = eye;
    EXPECT_FALSE(player.Draw(now).Kept);
  }
  EXPECT_TRUE(player.Draw(now).Kept) << "the last one";
  now.Eye = 0.2;
  EXPECT_FALSE(player.Draw(now).Kept);
  now.Interacting = false;
  EXPECT_FALSE(player.Draw(now).Kept) << "a still picture is finer";
}

TEST(FieldFrames, OtherValuesInMemoryAreDrawn)
{
  using namespace array_input;
  RunOnSimulatedRanks(2,
    [](Communicator& communicator)
    {
      Dealt data(communicator);
      DistributedField field;
      FieldFrames frames;
      const auto draw = [&]
      {
        field.Update(communicator, data.In);
        RayScene scene = scenes::Scene(GridSamples, { 48, 40 }, glm::dmat4(1.0), 1.4, false);
        return frames.Draw(communicator, field, scene, {}).Kept;
      };
      EXPECT_FALSE(draw());
      EXPECT_TRUE(draw());
      data.In.Changes += communicator.Rank() == 1 ? 1 : 0;
      EXPECT_TRUE(draw()) << "they are the same";
      data.Mine.Values.front() += communicator.Rank() == 1 ? 0.5 : 0.0;
      data.In.Changes += communicator.Rank() == 1 ? 1 : 0;
      EXPECT_FALSE(draw());
      EXPECT_TRUE(draw());
    });
}

} // namespace
