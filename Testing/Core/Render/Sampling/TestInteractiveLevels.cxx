// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/InteractiveLevels.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

TEST(InteractiveLevels, GapsBetweenRaysComeBeforeLevels)
{
  const std::vector<RaySampling> steps{ { 0, 0.5, 1 }, { 0, 0.5, 2 }, { 0, 0.5, 4 }, { 1, 1.0, 4 },
    { 1, 1.0, 8 }, { 2, 2.0, 8 }, { 3, 4.0, 8 } };
  for (std::size_t step = 0; step < steps.size(); ++step)
  {
    EXPECT_EQ(InteractiveLevels::SamplingOf(static_cast<int>(step), 0.5, 3), steps[step]) << step;
  }
  EXPECT_EQ(InteractiveLevels::SamplingOf(99, 0.5, 3), steps.back());
  EXPECT_EQ(InteractiveLevels::SamplingOf(99, 0.5, 1), (RaySampling{ 1, 1.0, 8 }));
  EXPECT_EQ(InteractiveLevels::SamplingOf(2, 0.5, 0), (RaySampling{ 0, 0.5, 4 }));
  EXPECT_EQ(InteractiveLevels::SamplingOf(3, 0.5, 0), (RaySampling{ 0, 0.5, 8 }));
  EXPECT_EQ(InteractiveLevels::Last(3), 6);
}

/// Frames of a scene that takes so long at step 0, and per step so many times less.
struct Frames
{
  double Seconds;
  double Times;
  double Promised = 0.2;
  StepControl Control{};

  double Draw()
  {
    const double taken = this->Seconds / std::pow(this->Times, this->Control.Step());
    this->Control.FrameTook(taken, this->Promised, 3);
    return taken;
  }
};

TEST(StepControl, HeavyScenesKeepThePromise)
{
  for (const double seconds : { 0.25, 0.5, 1.0, 3.0, 12.0 })
  {
    Frames frames{ seconds, 2.0 };
    int late = 0;
    for (int i = 0; i < 100; ++i)
    {
      late += frames.Draw() > 0.2 ? 1 : 0;
    }
    EXPECT_LE(late, 7) << seconds;
    EXPECT_GT(frames.Draw(), 0.2 / 3.0 / 2.0) << "no coarser than it has to be";
  }
}

/// Two steps between which lies more than is allowed for: pictures do not swing between them.
TEST(StepControl, WhatWasTooSlowIsNotTriedSoonAgain)
{
  Frames frames{ 2.0, 50.0 };
  int late = 0;
  for (int i = 0; i < 200; ++i)
  {
    late += frames.Draw() > 0.2 ? 1 : 0;
  }
  EXPECT_GE(late, 2) << "in the end it is, for the camera has moved on";
  EXPECT_LE(late, 4);
}

TEST(StepControl, GoesBackWhenScenesBecomeLight)
{
  Frames frames{ 3.0, 2.0 };
  for (int i = 0; i < 10; ++i)
  {
    frames.Draw();
  }
  EXPECT_GT(frames.Control.Step(), 2);
  frames.Seconds = 0.05;
  for (int i = 0; i < 150; ++i)
  {
    frames.Draw();
  }
  EXPECT_EQ(frames.Control.Step(), 0);
}

TEST(StepControl, NothingIsPromised)
{
  Frames frames{ 3.0, 2.0 };
  frames.Draw();
  EXPECT_EQ(frames.Control.Step(), 4) << "a sixteenth of 3 is within 0.2";
  frames.Promised = 0.0;
  frames.Draw();
  EXPECT_EQ(frames.Control.Step(), 0);
}

/// Nobody waits for a first frame that is as fine as can be.
TEST(StepControl, MayBeginWithTheLastStep)
{
  for (const double seconds : { 0.1, 1.0, 12.0 })
  {
    Frames frames{ seconds, 3.0 };
    EXPECT_GE(frames.Control.Step(true), InteractiveLevels::Last(3));
    frames.Control.FrameTook(seconds / std::pow(3.0, InteractiveLevels::Last(3)), 0.2, 3);
    EXPECT_LE(seconds / std::pow(3.0, frames.Control.Step(true)), 0.2);
    EXPECT_GT(frames.Draw(), 0.2 / 3.0 / 3.0 / 3.0) << "the second one is nearly as fine as may be";
  }
}

/// A volume without coarser levels has fewer steps than the one before it.
TEST(StepControl, StaysWithinTheSteps)
{
  StepControl control;
  for (int i = 0; i < 20; ++i)
  {
    control.FrameTook(1.0, 0.2, 3);
  }
  EXPECT_EQ(control.Step(), InteractiveLevels::Last(3));
  control.FrameTook(1.0, 0.2, 0);
  EXPECT_EQ(control.Step(), InteractiveLevels::Last(0));
}

} // namespace
