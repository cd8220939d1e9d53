// SPDX-License-Identifier: BSD-3-Clause
// Frames of meshes: what the frame before had of them is told by their elements and values.
#include "Parallel/Frame/MeshSteps.h"

namespace
{

using namespace banyan;
using namespace banyan::played;

void ExpectEqualValuesAreKept(Communicator& communicator)
{
  MeshPlayer player(communicator);
  Situation now;
  EXPECT_FALSE(player.Draw(now).Kept);
  ++now.Again;
  EXPECT_TRUE(player.Draw(now).Kept);
  now.Step = 1;
  EXPECT_FALSE(player.Draw(now).Kept);
  now.Step = 0;
  EXPECT_TRUE(player.Draw(now).Kept) << "a loop";
  now.Step = MeshInput::Farther;
  EXPECT_FALSE(player.Draw(now).Kept) << "the mesh is another one";
}

TEST(MeshFrames, EqualValuesAreNotDrawnAgain)
{
  for (const int ranks : { 1, 2, 3 })
  {
    RunOnSimulatedRanks(ranks, ExpectEqualValuesAreKept);
  }
}

void ExpectFewRays(Communicator& communicator, bool shaded, bool fixed)
{
  MeshPlayer with(communicator);
  MeshPlayer without(communicator);
  Situation now;
  now.Shaded = shaded;
  now.FixedDistance = fixed ? 1.0 : 0.0;
  now.Tolerance = 8.0;
  double reused = 0.0;
  for (const int step : { 0, 1, 2, 3, MeshInput::Farther, 4, 3 })
  {
    now.Step = step;
    reused += DrawBoth(with, without, now).ReusedFraction();
  }
  EXPECT_GT(reused, 0.1) << shaded << fixed << " " << communicator.Size();
}

TEST(MeshFrames, RaysThatMeetWhatTheyMetAreNotCast)
{
  for (const int ranks : { 1, 3 })
  {
    for (const bool shaded : { false, true })
    {
      for (const bool fixed : { false, true })
      {
        RunOnSimulatedRanks(
          ranks, [&](Communicator& communicator) { ExpectFewRays(communicator, shaded, fixed); });
      }
    }
  }
}

TEST(MeshFrames, WithLightRaysBesideBricksThatChangeAreCast)
{
  ExpectRaysBesideBricksAreCast<MeshPlayer>({ 36, 60, 68 });
}

} // namespace
