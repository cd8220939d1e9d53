// SPDX-License-Identifier: BSD-3-Clause
// Frames of a series that plays: plans that steps share, and rays that are not cast again.
#include "Parallel/Frame/PlayedSeries.h"

namespace
{

using namespace banyan;
using namespace banyan::played;

/// What all steps took.
struct Taken
{
  double Samples = 0.0;
  double Bytes = 0.0;  ///< composited
  double Reused = 0.0; ///< the largest fraction

  void Add(const FieldFrames::Frame& frame)
  {
    this->Samples += static_cast<double>(frame.Picture.Statistics.SamplesTaken);
    this->Bytes += static_cast<double>(frame.Picture.Statistics.BytesComposited);
    this->Reused = std::max(this->Reused, frame.ReusedFraction());
  }
};

/// Plays all steps with reuse and without.
/// @param allowed largest difference of a pixel
void PlayBoth(
  Communicator& communicator, Situation now, double allowed, Taken& with, Taken& without)
{
  Player reuses(communicator);
  Player draws(communicator);
  // What both take is compared: zones must not follow the clock.
  reuses.Field.SetLoadBalancing(LoadBalancing::Off);
  draws.Field.SetLoadBalancing(LoadBalancing::Off);
  for (now.Step = 0; now.Step < Steps; ++now.Step)
  {
    const FieldFrames::Frame frame = reuses.Draw(now);
    const FieldFrames::Frame whole = draws.Draw(now, false);
    if (communicator.Rank() == 0)
    {
      EXPECT_LE(WorstDifference(*frame.Picture.Pixels, *whole.Picture.Pixels), allowed) << now.Step;
    }
    with.Add(frame);
    without.Add(whole);
  }
}

TEST(PlayedFrames, RaysThatMeetWhatTheyMetAreNotCast)
{
  for (const int ranks : { 1, 3 })
  {
    RunOnSimulatedRanks(ranks,
      [ranks](Communicator& communicator)
      {
        for (const bool shaded : { false, true })
        {
          Situation now;
          now.FixedDistance = 1.0;
          now.Shaded = shaded;
          Taken with;
          Taken without;
          PlayBoth(communicator, now, ranks == 1 ? 0.0 : 4.0 / 8.0 / 255.0 + 1e-5, with, without);
          EXPECT_EQ(without.Reused, 0.0);
          // With light, hardly a brick of so few has none beside it that changes.
          EXPECT_LE(with.Samples, (shaded ? 1.0 : 0.9) * without.Samples);
          EXPECT_LE(with.Bytes, (shaded ? 1.0 : 0.9) * without.Bytes);
          EXPECT_GE(with.Reused, shaded ? 0.0 : 0.1);
        }
      });
  }
}

TEST(PlayedFrames, PlansOfGroupsKeepTheTolerance)
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

TEST(PlayedFrames, PlansAreThoseOfOneField)
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

} // namespace
