// SPDX-License-Identifier: BSD-3-Clause
// How frames of all ranks are sampled: by tolerance, by the size of cells, or by time.
#include "Parallel/Fields/ArrayInput.h"
#include "Parallel/Frame/ToleranceControl.h"
#include "Render/Scene/SceneDigest.h"

#include <gtest/gtest.h>

namespace
{

using namespace array_input;

constexpr std::uint64_t Budget = 1u << 26;

/// A field on all ranks, and the frames of it.
struct Frames
{
  Communicator& Ranks;
  Dealt Data;
  DistributedField Field;
  ToleranceControl Control;
  ToleranceControl::Wish Wish;

  explicit Frames(Communicator& communicator)
    : Ranks(communicator)
    , Data(communicator)
  {
    this->Field.Update(communicator, this->Data.In);
  }

  /// @return the scene, with its samplings
  RayScene Plan(double& error)
  {
    RayScene scene = scenes::Scene(GridSamples, { 96, 80 }, glm::dmat4(1.0), 1.4, false);
    scene.Transfer = scenes::Tabulate(scenes::Sparse);
    FrameStatistics frame;
    this->Field.Drawn().BeginFrame(this->Ranks, scene);
    const ToleranceControl::Aim aim = this->Control.Begin(this->Wish);
    error = this->Control.Plan(
      this->Ranks, this->Field, scene, DigestOf(scene), this->Wish, aim, Budget, frame);
    this->Field.Drawn().EndFrame(this->Ranks);
    return scene;
  }
};

TEST(ToleranceControl, StillPicturesKeepTheTolerance)
{
  RunOnSimulatedRanks(3,
    [](Communicator& communicator)
    {
      Frames frames(communicator);
      double error = 0.0;
      for (const double tolerance : { 16.0, 2.0 })
      {
        frames.Wish.Still = tolerance;
        const RayScene scene = frames.Plan(error);
        EXPECT_NE(scene.Samplings, nullptr);
        EXPECT_TRUE(error <= tolerance || !frames.Control.Limit().empty()) << error;
        EXPECT_EQ(AllMax(communicator, error), error) << "the same on all ranks";
      }
    });
}

TEST(ToleranceControl, WithoutToleranceFramesThatTakeTooLongGetCoarser)
{
  RunOnSimulatedRanks(2,
    [](Communicator& communicator)
    {
      Frames frames(communicator);
      frames.Wish.KeepsTolerance = false;
      frames.Wish.Interacting = true;
      frames.Wish.Seconds = 0.1;
      double error = -1.0;
      EXPECT_EQ(frames.Plan(error).Samplings, nullptr);
      EXPECT_EQ(error, 0.0);
      frames.Control.FrameTook(frames.Wish, 10.0, 0.0);
      const RayScene coarser = frames.Plan(error);
      ASSERT_NE(coarser.Samplings, nullptr);
      EXPECT_GT(coarser.Samplings->Samplings().front().Distance, coarser.SampleDistance);
      frames.Wish.Interacting = false;
      EXPECT_EQ(frames.Plan(error).Samplings, nullptr) << "still pictures have all samples";
    });
}

/// Showing a picture takes half of what is promised: drawing may have the other half.
TEST(ToleranceControl, FramesBecomeFinerThoughShowingThemTakesLong)
{
  const auto alone = MakeSelfCommunicator();
  Frames frames(*alone);
  frames.Wish.KeepsTolerance = false;
  frames.Wish.Interacting = true;
  frames.Wish.Seconds = 0.025;
  const auto coarseness = [&] { return frames.Control.Begin(frames.Wish).Coarseness; };
  double error = 0.0;
  frames.Plan(error);
  frames.Control.FrameTook(frames.Wish, 1.0, 0.0125);
  const double slow = coarseness();
  EXPECT_GT(slow, 1.0);
  for (int i = 0; i < 200; ++i)
  {
    frames.Plan(error);
    frames.Control.FrameTook(frames.Wish, 0.004, 0.0125);
  }
  EXPECT_EQ(coarseness(), 0.0);
  for (int i = 0; i < 20; ++i)
  {
    frames.Plan(error);
    frames.Control.FrameTook(frames.Wish, 0.004, 0.1);
  }
  EXPECT_GE(coarseness(), slow) << "nothing else is left to do";
}

TEST(ToleranceControl, SizesOfCellsOnTheScreenDecideIfTheyShall)
{
  RunOnSimulatedRanks(2,
    [](Communicator& communicator)
    {
      Frames frames(communicator);
      frames.Wish.ScreenErrorPixels = 32.0;
      double error = -1.0;
      const RayScene scene = frames.Plan(error);
      EXPECT_EQ(error, 0.0) << "nothing tells it";
      ASSERT_NE(scene.Samplings, nullptr);
      int coarsest = 0;
      for (const RaySampling& sampling : scene.Samplings->Samplings())
      {
        coarsest = std::max(coarsest, sampling.Level);
      }
      EXPECT_GT(coarsest, 0);
    });
}

} // namespace
