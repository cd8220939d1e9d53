// SPDX-License-Identifier: BSD-3-Clause
// Pictures for a client that does not wait: a coarse one first, then the exact one, on any number
// of ranks, whatever comes between.
#include "Parallel/Frame/LateFramesOfRanks.h"

#include "Parallel/Communicate/Collective.h"
#include "Parallel/Frame/PlainSteps.h"

namespace
{

using namespace banyan;
using namespace banyan::played;

/// A volume that is drawn for a client.
class Volume
{
public:
  explicit Volume(Communicator& communicator, const LateFrames::Times& times = {})
    : Ranks(communicator)
    , Player(communicator)
    , Direct(communicator)
    , Served(Player.Frames, times)
  {
    this->Player.Field.SetLoadBalancing(LoadBalancing::Off);
    this->Direct.Field.SetLoadBalancing(LoadBalancing::Off);
  }

  bool Draw(const Situation& now, bool shows = false)
  {
    const RayScene scene = this->Player.Take(now);
    Situation coarse = now;
    coarse.Width /= 2;
    coarse.Height /= 2;
    return this->Served.Draw(this->Ranks, this->Player.Field, scene, SceneOf(coarse),
      PlainPlayer::WishOf(now, true), shows);
  }
  void DrawCoarse(const Situation& now)
  {
    this->Player.Take(now);
    this->Served.DrawCoarse(
      this->Ranks, this->Player.Field, SceneOf(now), PlainPlayer::WishOf(now, true));
  }
  bool GoOn(int times)
  {
    return this->Served.GoOn([times]() mutable { return --times < 0; });
  }
  void Finish()
  {
    EXPECT_TRUE(this->Served.GoOn([] { return false; }));
  }

  void ExpectCoarse(const Situation& now)
  {
    EXPECT_FALSE(this->Served.Last().Exact);
    EXPECT_TRUE(this->Served.IsDrawing());
    if (this->Ranks.Rank() == 0)
    {
      EXPECT_LE(this->Served.Last().Frame.Picture.Pixels->Rect.Hi.x, now.Width / 2);
    }
  }
  /// The last picture is that which fresh FieldFrames draw directly.
  void ExpectExact(const Situation& now)
  {
    EXPECT_TRUE(this->Served.Last().Exact);
    RayScene scene = this->Direct.Take(now);
    FieldFrames fresh;
    const FieldFrames::Frame direct =
      fresh.Draw(this->Ranks, this->Direct.Field, scene, PlainPlayer::WishOf(now, true));
    if (this->Ranks.Rank() == 0)
    {
      EXPECT_EQ(
        WorstDifference(*this->Served.Last().Frame.Picture.Pixels, *direct.Picture.Pixels), 0.0);
    }
  }

  Communicator& Ranks;
  PlainPlayer Player;
  PlainPlayer Direct;
  LateFramesOfRanks Served;
};

/// On 1 to 4 ranks.
void OnRanks(const std::function<void(Volume&)>& body, const LateFrames::Times& times = {})
{
  for (int ranks = 1; ranks <= 4; ++ranks)
  {
    RunOnSimulatedRanks(ranks,
      [&](Communicator& communicator)
      {
        Volume volume(communicator, times);
        body(volume);
      });
  }
}

TEST(CoarseThenExact, TheExactPictureIsThatOfAFrame)
{
  OnRanks(
    [](Volume& volume)
    {
      Situation now;
      EXPECT_TRUE(volume.Draw(now));
      volume.ExpectCoarse(now);
      EXPECT_FALSE(volume.GoOn(0)) << "the client has sent more";
      EXPECT_FALSE(volume.Draw(now)) << "the same scene goes on";
      EXPECT_TRUE(volume.Served.IsDrawing());
      volume.Finish();
      volume.ExpectExact(now);
      EXPECT_FALSE(volume.Served.IsDrawing());
      EXPECT_FALSE(volume.Draw(now)) << "nothing better is to be had";
      EXPECT_FALSE(volume.GoOn(0));
    });
}

TEST(CoarseThenExact, AnotherSceneStopsWhatIsUnderWay)
{
  OnRanks(
    [](Volume& volume)
    {
      Situation now;
      for (int move = 0; move < 5; ++move)
      {
        now.Eye += 0.2;
        // What is drawn quickly needs no coarse picture; here that is what an earlier one took.
        volume.Draw(now);
        volume.GoOn(move);
      }
      if (volume.Served.IsDrawing())
      {
        volume.Finish();
      }
      volume.ExpectExact(now);
    });
}

TEST(CoarseThenExact, CoarsePicturesDoNotMoveZones)
{
  OnRanks(
    [](Volume& volume)
    {
      volume.Player.Field.SetLoadBalancing(LoadBalancing::MeasuredCost);
      const auto zones = [&] { return volume.Player.Field.Drawn().Zones(); };
      const Situation now;
      volume.DrawCoarse(now);
      const std::vector<Box> first = zones();
      for (int move = 0; move < 4; ++move)
      {
        volume.DrawCoarse(now);
        EXPECT_EQ(zones(), first);
      }
    });
}

TEST(CoarseThenExact, AfterACoarsePictureOfAnotherSceneTheLastOneIsDrawnAnew)
{
  OnRanks(
    [](Volume& volume)
    {
      Situation now;
      volume.Draw(now);
      volume.Finish();
      Situation other;
      other.Eye += 0.2;
      volume.DrawCoarse(other);
      EXPECT_FALSE(volume.Served.IsComing());
      EXPECT_TRUE(volume.Draw(now));
      if (volume.Served.IsDrawing())
      {
        volume.Finish();
      }
      volume.ExpectExact(now);
    });
}

TEST(CoarseThenExact, AnotherStepIsAnotherPicture)
{
  OnRanks(
    [](Volume& volume)
    {
      Situation now;
      volume.Draw(now);
      volume.Served.Stop(); // as the field changes
      now.Step = 3;
      EXPECT_TRUE(volume.Draw(now));
      if (volume.Served.IsDrawing())
      {
        volume.Finish();
      }
      volume.ExpectExact(now);
    });
}

TEST(CoarseThenExact, WhoeverWasStoppedBeginsAnew)
{
  OnRanks(
    [](Volume& volume)
    {
      Situation now;
      volume.Draw(now);
      EXPECT_TRUE(volume.Served.IsDrawing());
      volume.Served.Stop();
      EXPECT_FALSE(volume.Served.IsDrawing());
      EXPECT_FALSE(volume.GoOn(0));
      EXPECT_TRUE(volume.Draw(now));
      volume.Finish();
      volume.ExpectExact(now);
    });
}

TEST(CoarseThenExact, PicturesThatTakeLongHaveOneBetween)
{
  LateFrames::Times times;
  times.Patience = 0.0;
  times.Long = 0.0; // all that were drawn before take long
  OnRanks(
    [](Volume& volume)
    {
      Situation now;
      volume.Draw(now);
      volume.Finish();
      EXPECT_FALSE(volume.Served.TakeBetween()) << "nothing is known of the first picture";
      now.Eye += 0.2;
      volume.Draw(now);
      std::optional<FieldFrames::Frame> between;
      const auto comes = [&]
      {
        between = between ? std::move(between) : volume.Served.TakeBetween();
        return between.has_value();
      };
      if (volume.Served.GoOn(comes))
      {
        return; // both came at once
      }
      if (volume.Ranks.Rank() == 0)
      {
        ASSERT_TRUE(between);
        EXPECT_EQ(between->Picture.Pixels->Rect.Hi.x > now.Width / 2, true) << "of the whole size";
      }
      volume.Finish();
      volume.ExpectExact(now);
      EXPECT_FALSE(volume.Served.TakeBetween()) << "the exact picture is better";
    },
    times);
}

TEST(CoarseThenExact, AtRestQuickPicturesHaveNoCoarseOne)
{
  LateFrames::Times times;
  times.Patience = 0.0; // none is quick enough to be waited for
  times.AtRest = 1e6;   // all are quick enough to come alone
  OnRanks(
    [](Volume& volume)
    {
      Situation now;
      volume.Draw(now);
      volume.ExpectCoarse(now); // nobody knows yet what an exact one takes
      volume.Finish();
      now.Eye = 0.3;
      EXPECT_TRUE(volume.Draw(now));
      EXPECT_FALSE(volume.Served.HasAny());
      EXPECT_TRUE(volume.Served.IsDrawing());
      volume.Finish();
      volume.ExpectExact(now);
      EXPECT_TRUE(volume.Served.HasAny());
      now.Eye = 0.6;
      now.Interacting = true;
      volume.Draw(now);
      volume.ExpectCoarse(now);
    },
    times);
}

TEST(CoarseThenExact, WhatIsShownAtOnceWaitsForQuickPictures)
{
  for (const double shown : { 1e6, 0.0 })
  {
    LateFrames::Times times;
    times.Patience = 0.0;
    times.Shown = shown;
    OnRanks(
      [shown](Volume& volume)
      {
        Situation now;
        volume.Draw(now, /*shows=*/true);
        volume.ExpectCoarse(now); // nobody knows yet what an exact one takes
        volume.Finish();
        now.Eye = 0.3;
        EXPECT_TRUE(volume.Draw(now, /*shows=*/true));
        EXPECT_TRUE(volume.Served.HasAny());
        EXPECT_EQ(volume.Served.IsComing(), shown == 0.0);
        if (shown == 0.0)
        {
          volume.ExpectCoarse(now);
          volume.Finish();
        }
        volume.ExpectExact(now);
        EXPECT_FALSE(volume.Draw(now, /*shows=*/true));
        EXPECT_TRUE(volume.Draw(now)) << "a client that shows it itself has no picture yet";
        volume.ExpectExact(now);
      },
      times);
  }
}

TEST(CoarseThenExact, WhatWasPausedForAnotherViewGoesOn)
{
  RunOnSimulatedRanks(2,
    [](Communicator& communicator)
    {
      Volume one(communicator);
      Volume other(communicator);
      Situation now;
      one.Draw(now);
      other.Draw(now);
      EXPECT_FALSE(one.Served.IsDrawing());
      EXPECT_TRUE(one.Served.IsComing());
      EXPECT_FALSE(one.GoOn(0)) << "the other one comes first";
      EXPECT_TRUE(other.Served.IsDrawing());
      EXPECT_FALSE(one.Draw(now)) << "the same scene";
      other.Finish();
      one.Finish();
      EXPECT_FALSE(one.Served.IsComing());
      one.ExpectExact(now);
      other.ExpectExact(now);
    });
}

TEST(CoarseThenExact, AFailureIsThatOfAllRanksAndTheNextPictureComes)
{
  RunOnSimulatedRanks(3,
    [](Communicator& communicator)
    {
      Volume volume(communicator);
      Situation now;
      RayScene scene = volume.Player.Take(now);
      RayScene wrong = scene;
      StopFlag stop;
      stop.Ask();
      wrong.Stop = communicator.Rank() == 1 ? &stop : nullptr; // casting throws
      EXPECT_THROW(volume.Served.Draw(communicator, volume.Player.Field, scene, wrong,
                     PlainPlayer::WishOf(now, true)),
        CollectiveError);
      EXPECT_TRUE(volume.Draw(now));
      volume.Finish();
      volume.ExpectExact(now);
    });
}

} // namespace
