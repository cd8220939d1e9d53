// SPDX-License-Identifier: BSD-3-Clause
// Frames that take from those before what is the same: whatever is done in between, pictures are
// those of frames that are drawn from nothing.
#include "Parallel/Fields/ArrayInput.h"
#include "Parallel/Fields/SeriesInput.h"
#include "Parallel/Frame/FieldFrames.h"
#include "Render/Dice.h"
#include "Render/Scenes.h"
#include "Series/Decode/CacheContext.h"
#include "Series/SeriesTesting.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace banyan;

constexpr int Steps = 12;
const glm::ivec3 Samples{ 57, 49, 53 };

/// A field that rests above, and has a ball below, among the highest values, that goes round.
std::vector<float> FewChanges(int step)
{
  const double turn = 6.2831853 * step / Steps;
  const glm::dvec3 ball(0.5 + 0.3 * std::cos(turn), 0.5 + 0.3 * std::sin(turn), 0.15);
  return scenes::Sampled<float>(
    [&](const glm::dvec3& p)
    {
      const double inside = std::max(0.0, 1.0 - glm::length(p - ball) / 0.13);
      return p.z < 0.5 ? 0.9 + 0.1 * inside : 0.8 * scenes::Standard(p);
    },
    Samples);
}

/// Nothing of the ball.
glm::dvec4 Above(double value)
{
  glm::dvec4 entry = scenes::Smooth(value);
  entry.a = value < 0.85 ? entry.a : 0.0;
  return entry;
}

TransferFunction FunctionOf(int number)
{
  TransferFunction function = scenes::Tabulate(number == 0 || number == 3 ? scenes::Sparse
                                               : number == 1              ? scenes::Smooth
                                                                          : Above);
  for (std::size_t i = function.Entries.size() * 9 / 10; number == 3 && i < function.Entries.size();
       ++i)
  {
    function.Entries[i].a *= 0.5f;
  }
  return function;
}

/// Encoded without loss, so that unchanged bricks are equal.
class EncodedSteps
{
public:
  EncodedSteps()
  {
    ThreadPool pool(2);
    EncodeOptions options;
    options.ErrorBound = 0.0;
    options.BrickCells = 16;
    options.KeyframeInterval = 4;
    SeriesEncoder encoder(this->Path(), banyan::testing::GridOf(Samples.x, Samples.y, Samples.z),
      { { "field", ScalarType::Float32, { "" }, { { 0.0, 1.0 } } } }, options, pool);
    for (int step = 0; step < Steps; ++step)
    {
      const std::vector<float> values = FewChanges(step);
      encoder.AddStep(step, { { values.data() } });
    }
    encoder.Finish();
  }

  std::string Path() const { return this->Folder / "few.banyan"; }

private:
  banyan::testing::TemporaryFolder Folder;
};

const EncodedSteps& Encoded()
{
  static const EncodedSteps steps;
  return steps;
}

/// All that somebody can change between two frames.
struct Situation
{
  int Step = 0;
  double Eye = 0.0;
  int Function = 0;
  bool Cut = false;
  bool Shaded = false;
  bool Projected = false;
  bool Geometry = false;
  int Width = 96;
  double Motion = 0.0;
  double FixedDistance = 0.0;
  double Tolerance = 4.0;
  bool Interacting = false;
  bool Passes = false;
  bool PlansOfGroups = false; ///< they depend on what was drawn before
};

RayScene SceneOf(const Situation& now)
{
  RayScene scene =
    scenes::Scene(Samples, { now.Width, 80 }, glm::dmat4(1.0), 1.6 + 0.3 * std::sin(now.Eye));
  scene.Shading.On = now.Shaded;
  scene.Transfer = FunctionOf(now.Function);
  if (now.Cut)
  {
    scene.ClipPlanes.push_back({ glm::dvec3(1.0, 0.3, 0.0), -0.4 * Samples.x });
  }
  if (now.Projected)
  {
    scene.Blend.Mode = BlendMode::Maximum;
  }
  if (now.Geometry)
  {
    scene.Depth.assign(static_cast<std::size_t>(scene.Viewport.Count()), 0.98f);
  }
  if (now.FixedDistance > 0.0)
  {
    scene.SampleDistance = now.FixedDistance;
  }
  return scene;
}

/// A field of a rank, and its frames.
struct Player
{
  Communicator& Ranks;
  SeriesInput Input;
  DistributedField Field;
  FieldFrames Frames;

  explicit Player(Communicator& communicator, std::int64_t budget = -1)
    : Ranks(communicator)
    , Input(SeriesFile::Open(Encoded().Path(), CacheContext::WithBudget(budget)))
  {
    this->Field.SetLoadBalancing(LoadBalancing::MeasuredCost);
  }

  FieldFrames::Frame Draw(const Situation& now, bool reuse = true)
  {
    this->Input.Step = now.Step;
    this->Input.Motion.Strength = now.Motion;
    this->Field.Update(this->Ranks, this->Input);
    EXPECT_EQ(this->Field.Problem(), "");
    RayScene scene = SceneOf(now);
    FieldFrames::Wish wish;
    wish.Sampling.Still = now.Tolerance;
    wish.Sampling.Interactive = 4.0 * now.Tolerance;
    wish.Sampling.Seconds = 0.0;
    wish.Sampling.Interacting = now.Interacting;
    wish.Sampling.Passes = now.Passes;
    wish.Sampling.FixedDistance = now.FixedDistance > 0.0;
    wish.Sampling.KeepsTolerance = !now.Projected && !wish.Sampling.FixedDistance;
    wish.Sampling.PlansOfGroups = now.PlansOfGroups;
    wish.Reuse = reuse;
    return this->Frames.Draw(this->Ranks, this->Field, scene, wish);
  }
};

/// Changes one thing, as somebody in front of a window does.
void ChangeSomething(Situation& now, Dice& dice, const std::vector<Situation>& before)
{
  switch (dice.Whole(0, 14))
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
      now.Passes = !now.Passes;
      break;
    default:
      now = before[static_cast<std::size_t>(dice.Whole(0, static_cast<int>(before.size()) - 1))];
      break;
  }
}

/// Of any channel of a pixel.
double WorstDifference(const FloatImage& a, const FloatImage& b)
{
  EXPECT_TRUE(a.Rect == b.Rect);
  float worst = 0.0f;
  for (std::size_t i = 0; i < std::min(a.Pixels.size(), b.Pixels.size()); ++i)
  {
    const glm::vec4 difference = glm::abs(a.Pixels[i] - b.Pixels[i]);
    worst = std::max({ worst, difference.r, difference.g, difference.b, difference.a });
  }
  return worst;
}

struct Outcome
{
  int Kept = 0;        ///< frames that were not drawn
  double Reused = 0.0; ///< of the others, pictures' worth of rays that were not cast
};

/// @param budget of the caches in which frames are kept
Outcome PlayAtRandom(
  Communicator& communicator, int operations, unsigned seed, std::int64_t budget, double allowed)
{
  Player with(communicator, budget);
  Player without(communicator, budget);
  Dice dice(seed);
  Situation now;
  std::vector<Situation> before{ now };
  Outcome outcome;
  for (int i = 0; i < operations; ++i)
  {
    ChangeSomething(now, dice, before);
    before.push_back(now);
    if (dice.Whole(0, 3) == 0)
    {
      with.Frames.RefineNext();
    }
    const FieldFrames::Frame frame = with.Draw(now);
    outcome.Kept += frame.Kept ? 1 : 0;
    outcome.Reused += frame.Kept ? 0.0 : frame.ReusedFraction();
    // Passes and interaction are shown finer than they would be drawn, if they were.
    Situation still = now;
    still.Passes = false;
    const bool finer = now.Passes || now.Interacting;
    const FieldFrames::Frame expected = without.Draw(finer ? still : now, false);
    EXPECT_TRUE(frame.Picture.EstimatedError <= now.Tolerance * (finer ? 4.0 : 1.0) ||
                !frame.Picture.Limit.empty())
      << i << ": " << frame.Picture.EstimatedError;
    EXPECT_EQ(frame.Picture.Pixels != nullptr, communicator.Rank() == 0);
    if (communicator.Rank() == 0 && !finer)
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

TEST(FieldFrames, AtRandomRanksAgree)
{
  for (const int ranks : { 2, 3 })
  {
    RunOnSimulatedRanks(ranks,
      [](Communicator& communicator)
      {
        // Rays that end early end elsewhere in other zones.
        EXPECT_GT(PlayAtRandom(communicator, 60, 4, 64 << 20, 4.0 / 8.0 / 255.0 + 1e-5).Kept, 3);
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
  for (int frame = 0; frame < 3 * Steps; ++frame)
  {
    Situation now;
    now.Step = frame % Steps;
    EXPECT_EQ(player.Draw(now).Kept, frame >= Steps) << frame;
  }
}

TEST(FieldFrames, RaysThatMeetWhatTheyMetAreNotCast)
{
  const auto alone = MakeSelfCommunicator();
  Player with(*alone);
  Player without(*alone);
  for (const bool shaded : { false, true })
  {
    Situation now;
    now.FixedDistance = 1.0;
    now.Shaded = shaded;
    std::int64_t cast = 0;
    std::int64_t all = 0;
    for (now.Step = 0; now.Step < Steps; ++now.Step)
    {
      const FieldFrames::Frame frame = with.Draw(now);
      const FieldFrames::Frame whole = without.Draw(now, false);
      EXPECT_EQ(WorstDifference(*frame.Picture.Pixels, *whole.Picture.Pixels), 0.0) << now.Step;
      EXPECT_EQ(whole.ReusedFraction(), 0.0);
      cast += frame.Picture.Statistics.SamplesTaken;
      all += whole.Picture.Statistics.SamplesTaken;
    }
    // With light, hardly a brick of so few has none beside it that changes.
    EXPECT_LE(static_cast<double>(cast), (shaded ? 1.0 : 0.9) * static_cast<double>(all));
  }
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

TEST(FieldFrames, PlansOfGroupsKeepTheTolerance)
{
  for (const int ranks : { 1, 3 })
  {
    RunOnSimulatedRanks(ranks,
      [](Communicator& communicator)
      {
        Player player(communicator);
        Situation now;
        now.PlansOfGroups = true;
        int planned = 0;
        for (now.Step = 0; now.Step < Steps; ++now.Step)
        {
          const FieldFrames::Frame frame = player.Draw(now);
          planned += frame.Picture.Statistics.Probes > 0 ? 1 : 0;
          EXPECT_LE(frame.Picture.EstimatedError, now.Tolerance);
          Situation fine = now;
          fine.FixedDistance = 0.125;
          const FieldFrames::Frame truth = player.Draw(fine, false);
          if (communicator.Rank() == 0)
          {
            EXPECT_LE(
              255.0 * WorstDifference(*frame.Picture.Pixels, *truth.Picture.Pixels), now.Tolerance)
              << "step " << now.Step;
          }
        }
        EXPECT_EQ(planned, 3) << "the first step, and the ends of two groups";
      });
  }
}

TEST(FieldFrames, PlansAreThoseOfOneField)
{
  const auto alone = MakeSelfCommunicator();
  Player player(*alone);
  Situation now;
  now.PlansOfGroups = true;
  for (now.Step = 0; now.Step < 3; ++now.Step)
  {
    player.Draw(now);
  }
  EXPECT_EQ(player.Draw(now).Picture.Statistics.Probes, 0);
  now.Motion = 0.5;
  EXPECT_GT(player.Draw(now).Picture.Statistics.Probes, 0) << "other values in the same view";
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
      EXPECT_FALSE(draw()) << "nobody looks whether they are the same";
      EXPECT_TRUE(draw());
    });
}

} // namespace
