// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Parallel_Frame_PlayedSeries_h
#define banyan_Testing_Core_Parallel_Frame_PlayedSeries_h

#include "Parallel/Fields/SeriesInput.h"
#include "Parallel/Frame/FieldFrames.h"
#include "Render/Scenes.h"
#include "Series/Decode/CacheContext.h"
#include "Series/SeriesTesting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

/// A series that plays, and frames of it.
namespace banyan::played
{

constexpr int Steps = 12;
inline const glm::ivec3 Samples{ 57, 49, 53 };

/// A field that rests above, and has a ball below, among the highest values, that goes round.
/// @param p from 0 to 1 along each axis
inline double FewChangesAt(const glm::dvec3& p, int step)
{
  const double turn = 6.2831853 * step / Steps;
  const glm::dvec3 ball(0.5 + 0.3 * std::cos(turn), 0.5 + 0.3 * std::sin(turn), 0.15);
  const double inside = std::max(0.0, 1.0 - glm::length(p - ball) / 0.13);
  return p.z < 0.5 ? 0.9 + 0.1 * inside : 0.8 * scenes::Standard(p);
}

inline std::vector<float> FewChanges(int step)
{
  return scenes::Sampled<float>(
    [&](const glm::dvec3& p) { return FewChangesAt(p, step); }, Samples);
}

/// Nothing of the ball.
inline glm::dvec4 Above(double value)
{
  glm::dvec4 entry = scenes::Smooth(value);
  entry.a = value < 0.85 ? entry.a : 0.0;
  return entry;
}

inline TransferFunction FunctionOf(int number)
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

inline const EncodedSteps& Encoded()
{
  static const EncodedSteps steps;
  return steps;
}

/// All that somebody can change between two frames.
struct Situation
{
  int Step = 0;
  int Again = 0;            ///< values in memory are the same ones with another stamp
  glm::ivec3 Changed{ -1 }; ///< a sample in memory that has another value
  double Eye = 0.0;
  int Function = 0;
  bool Cut = false;
  bool Shaded = false;
  bool Projected = false;
  bool Geometry = false;
  int Width = 96;
  int Height = 80;
  double Motion = 0.0;
  double FixedDistance = 0.0;
  double Tolerance = 4.0;
  bool Interacting = false;
  bool PlansOfGroups = false; ///< they depend on what was drawn before
  bool Alone = false;         ///< each rank by itself
};

inline RayScene SceneOf(const Situation& now)
{
  RayScene scene = scenes::Scene(
    Samples, { now.Width, now.Height }, glm::dmat4(1.0), 1.6 + 0.3 * std::sin(now.Eye));
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

inline void Join(SeriesInput&, const Communicator&) {}

inline void Become(SeriesInput& input, const Situation& now)
{
  input.Step = now.Step;
  input.Motion.Strength = now.Motion;
}

/// Steps that are made in memory.
struct StepsInMemory : FieldInput
{
  int Step = 0;
  int Again = 0;            ///< another stamp, and the same values
  glm::ivec3 Changed{ -1 }; ///< a sample, or point of a lattice, that has another value

  InputStamp Stamp() const override
  {
    InputStamp stamp;
    stamp.Add(this->Step);
    stamp.Add(this->Again);
    for (int axis = 0; axis < 3; ++axis)
    {
      stamp.Add(this->Changed[axis]);
    }
    return stamp;
  }
  std::shared_ptr<const SeriesFile> Series() const override { return nullptr; }
  TemporalEnhancement Enhancement() const override { return { 0.0, 1.0, 0.0 }; }
};

inline void Become(StepsInMemory& input, const Situation& now)
{
  input.Step = now.Step;
  input.Again = now.Again;
  input.Changed = now.Changed;
}

/// A field of a rank, and its frames.
template <class Input>
struct PlayerOf
{
  Communicator* Ranks;
  Input In;
  DistributedField Field;
  FieldFrames Frames;

  PlayerOf(Communicator& communicator, Input input)
    : Ranks(&communicator)
    , In(std::move(input))
  {
    Join(this->In, communicator);
    this->Field.SetLoadBalancing(LoadBalancing::MeasuredCost);
  }

  /// Goes on among other ranks, as the mapper does.
  void GoTo(Communicator& communicator)
  {
    this->Ranks = &communicator;
    Join(this->In, communicator);
    this->Field.Reset();
    this->Frames.Forget();
  }

  static FieldFrames::Wish WishOf(const Situation& now, bool reuse)
  {
    FieldFrames::Wish wish;
    wish.Sampling.Still = now.Tolerance;
    wish.Sampling.Interactive = 4.0 * now.Tolerance;
    wish.Sampling.Seconds = 0.0;
    wish.Sampling.Interacting = now.Interacting;
    wish.Sampling.FixedDistance = now.FixedDistance > 0.0;
    wish.Sampling.KeepsTolerance = !now.Projected && !wish.Sampling.FixedDistance;
    wish.Sampling.PlansOfGroups = now.PlansOfGroups;
    wish.Reuse = reuse;
    return wish;
  }

  /// Collective: the field becomes what is to be drawn. @return the scene
  RayScene Take(const Situation& now)
  {
    Become(this->In, now);
    this->Field.Update(*this->Ranks, this->In);
    EXPECT_EQ(this->Field.Problem(), "");
    RayScene scene = SceneOf(now);
    if (this->Field.Drawn().IsMesh())
    {
      scene.IndexToWorld = this->Field.Place().IndexToPhysical;
      scene.DomainCells = this->Field.Place().Cells;
    }
    return scene;
  }

  FieldFrames::Frame Draw(const Situation& now, bool reuse = true)
  {
    RayScene scene = this->Take(now);
    return this->Frames.Draw(*this->Ranks, this->Field, scene, WishOf(now, reuse));
  }
};

struct Player : PlayerOf<SeriesInput>
{
  explicit Player(Communicator& communicator, std::int64_t budget = -1)
    : PlayerOf<SeriesInput>(communicator,
        SeriesInput(SeriesFile::Open(Encoded().Path(), CacheContext::WithBudget(budget))))
  {
  }
};

/// Of any channel of a pixel.
inline double WorstDifference(const FloatImage& a, const FloatImage& b)
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

/// Draws with reuse and without: the same picture. @return the frame with
template <class Player>
FieldFrames::Frame DrawBoth(Player& with, Player& without, const Situation& now)
{
  FieldFrames::Frame frame = with.Draw(now);
  const FieldFrames::Frame whole = without.Draw(now, false);
  if (with.Ranks->Rank() == 0)
  {
    // Rays that end early end elsewhere in other zones.
    const double allowed = with.Ranks->Size() == 1 ? 0.0 : now.Tolerance / 8.0 / 255.0 + 1e-5;
    EXPECT_LE(WorstDifference(*frame.Picture.Pixels, *whole.Picture.Pixels), allowed) << now.Step;
  }
  return frame;
}

/// With light, changes values beside faces of bricks, one after the other: rays near a brick that
/// has changed meet gradients that have.
/// @param beside such faces, along each axis
template <class Player, std::size_t Count>
void ExpectRaysBesideBricksAreCast(const int (&beside)[Count])
{
  const auto alone = MakeSelfCommunicator();
  Player with(*alone);
  Player without(*alone);
  Situation now;
  now.FixedDistance = 1.0;
  now.Shaded = true;
  now.Function = 1;
  now.Width = 480; // some pixels a cell
  now.Height = 400;
  double reused = 0.0;
  for (const int x : beside)
  {
    for (const int y : beside)
    {
      for (const int z : beside)
      {
        now.Changed = { x, y, z };
        reused += DrawBoth(with, without, now).ReusedFraction();
      }
    }
  }
  EXPECT_GT(reused, 5.0);
}

} // namespace banyan::played

#endif
