// SPDX-License-Identifier: BSD-3-Clause
// Pictures that nobody waits for: coarse ones at once, and the exact ones, which have the bits of
// those that are waited for.
#include "Parallel/Frame/LateFrames.h"
#include "Parallel/Frame/PlayedSeries.h"
#include "Render/Dice.h"

#include <thread>

namespace
{

using namespace banyan;
using namespace banyan::played;

/// Draws frames late, and others that are waited for.
struct LatePlayer
{
  std::unique_ptr<Communicator> Alone = MakeSelfCommunicator();
  Player With{ *Alone };
  Player Without{ *Alone };
  LateFrames Late;

  /// Whatever an exact picture takes, a coarse one is drawn before it.
  static constexpr LateFrames::Times Never{ 0.0, 0.0, 60.0, 0.0 };

  explicit LatePlayer(const LateFrames::Times& times = Never)
    : Late(With.Frames, times)
  {
  }

  LateFrames::Shown Draw(const Situation& now)
  {
    Become(this->With.In, now);
    if (this->With.Field.Version() == 0 || now.Step != this->Step)
    {
      this->Late.Stop();
      this->Step = now.Step;
    }
    this->With.Field.Update(*this->Alone, this->With.In);
    return this->Late.Draw(
      *this->Alone, this->With.Field, SceneOf(now), this->With.WishOf(now, true));
  }

  /// The exact picture, once the thread has drawn it.
  LateFrames::Shown DrawAtLast(const Situation& now)
  {
    this->Draw(now);
    this->Late.Finish();
    return this->Draw(now);
  }

  void ExpectExact(const LateFrames::Shown& shown, const Situation& now)
  {
    ASSERT_TRUE(shown.Exact);
    const FieldFrames::Frame whole = this->Without.Draw(now, false);
    EXPECT_EQ(WorstDifference(*shown.Frame.Picture.Pixels, *whole.Picture.Pixels), 0.0);
    EXPECT_EQ(shown.Frame.Picture.EstimatedError, whole.Picture.EstimatedError);
  }

  int Step = 0;
};

TEST(LateFrames, ACoarsePictureIsThereAtOnceAndTheExactOneLater)
{
  LatePlayer player;
  Situation now;
  const LateFrames::Shown first = player.Draw(now);
  EXPECT_FALSE(first.Exact);
  ASSERT_TRUE(first.Frame.Picture.Pixels);
  player.Late.Finish();
  EXPECT_TRUE(player.Late.GoOn());
  const LateFrames::Shown second = player.Draw(now);
  EXPECT_FALSE(player.Late.GoOn());
  player.ExpectExact(second, now);
  EXPECT_EQ(player.Draw(now).Frame.Picture.Pixels, second.Frame.Picture.Pixels) << "it stays";
}

TEST(LateFrames, WhatTakesLittleIsWaitedFor)
{
  LatePlayer player({ 60.0, 0.0, 60.0, 0.0 });
  Situation now;
  EXPECT_FALSE(player.Draw(now).Exact) << "nobody knows yet how long it takes";
  player.DrawAtLast(now);
  now.Function = 1;
  player.ExpectExact(player.Draw(now), now);
}

TEST(LateFrames, WhileTheCameraMovesTheExactPictureBeginsAfterAPause)
{
  LateFrames::Times times = LatePlayer::Never;
  times.Pause = 3600.0;
  LatePlayer player(times);
  Situation now;
  now.Interacting = true;
  EXPECT_FALSE(player.Draw(now).Exact);
  EXPECT_FALSE(player.Late.GoOn());
  EXPECT_FALSE(player.Late.IsDrawing());
  now.Interacting = false;
  const auto coarse = player.Draw(now).Frame.Picture.Pixels;
  player.Late.Finish();
  EXPECT_TRUE(player.Late.GoOn()) << "without a pause when it stops";
  player.ExpectExact(player.Draw(now), now);

  LatePlayer paused;
  now.Interacting = true;
  EXPECT_FALSE(paused.Draw(now).Exact);
  EXPECT_FALSE(paused.Late.GoOn());
  paused.Late.Finish();
  EXPECT_TRUE(paused.Late.GoOn());
  now.Interacting = false;
  paused.ExpectExact(paused.Draw(now), now);
}

TEST(LateFrames, ACoarsePictureIsDrawnOnce)
{
  LatePlayer player;
  Situation now;
  now.Interacting = true;
  const auto moving = player.Draw(now).Frame.Picture.Pixels;
  player.Late.Stop();
  now.Interacting = false;
  EXPECT_EQ(player.Draw(now).Frame.Picture.Pixels, moving);
}

TEST(LateFrames, CoarsePicturesLeaveTheBricksToTheExactOneAfterThem)
{
  LatePlayer player;
  Situation now;
  player.DrawAtLast(now);
  const auto kept = [&] { return player.With.Field.Drawn().Source()->Kept().Bytes(); };
  const std::uint64_t ofExact = kept();
  ASSERT_GT(ofExact, 0u);
  now.Interacting = true;
  for (int move = 0; move < 6; ++move)
  {
    now.Eye += 0.01;
    EXPECT_FALSE(player.Draw(now).Exact);
    EXPECT_GE(kept(), ofExact);
  }
}

TEST(LateFrames, PicturesThatTakeLongHaveOneBetween)
{
  LateFrames::Times times = LatePlayer::Never;
  times.Long = 0.0;
  LatePlayer player(times);
  Situation now;
  player.DrawAtLast(now);
  now.Function = 1;
  now.Width = 160;
  const auto coarse = player.Draw(now).Frame.Picture.Pixels;
  LateFrames::Shown shown;
  int pictures = 0;
  while (!shown.Exact)
  {
    while (!player.Late.GoOn())
    {
      std::this_thread::yield();
    }
    const auto last = shown.Frame.Picture.Pixels;
    shown = player.Draw(now);
    pictures += shown.Frame.Picture.Pixels != last ? 1 : 0;
  }
  EXPECT_GE(pictures, 1);
  player.ExpectExact(shown, now);
}

TEST(LateFrames, APictureBetweenIsNotShownForAnotherScene)
{
  LateFrames::Times times = LatePlayer::Never;
  times.Long = 0.0;
  LatePlayer player(times);
  Situation now;
  player.DrawAtLast(now);
  now.Function = 1;
  player.Draw(now);
  player.Late.Finish();
  EXPECT_TRUE(player.Late.GoOn()) << "one between has come, and the exact one";
  now.Width = 160;
  const LateFrames::Shown shown = player.Draw(now);
  EXPECT_FALSE(shown.Exact);
  EXPECT_TRUE(shown.Frame.Picture.Pixels->Rect == SceneOf(now).Viewport);
}

TEST(LateFrames, PicturesThatWereThereDoNotTellHowLongOthersTake)
{
  LateFrames::Times times{ 1e-3, 0.0, 60.0, 3600.0 };
  LatePlayer player(times);
  Situation now;
  player.DrawAtLast(now);
  for (const int step : { 1, 0, 1, 0 })
  {
    now.Step = step; // a loop, whose steps are kept
    EXPECT_TRUE(player.Draw(now).Exact);
  }
  now.Function = 1;
  EXPECT_FALSE(player.Draw(now).Exact);
}

TEST(LateFrames, StepsOfAPlayAreWaitedFor)
{
  LateFrames::Times times = LatePlayer::Never;
  times.Playing = 3600.0;
  LatePlayer player(times);
  Situation now;
  EXPECT_FALSE(player.Draw(now).Exact);
  for (now.Step = 1; now.Step < 4; ++now.Step)
  {
    player.ExpectExact(player.Draw(now), now);
  }
  now.Interacting = true;
  now.Eye = 0.7;
  EXPECT_FALSE(player.Draw(now).Exact) << "but not while the camera moves";
}

TEST(LateFrames, OtherVolumesGoOnWhenThisOneIsThere)
{
  LatePlayer first;
  LatePlayer second;
  Situation now;
  first.Draw(now);
  second.Draw(now);
  EXPECT_FALSE(first.Late.IsDrawing());
  first.Late.GoOn();
  first.Late.Finish();
  first.ExpectExact(first.Draw(now), now);
  second.Late.Finish();
  second.ExpectExact(second.Draw(now), now);
}

TEST(LateFrames, WhatIsToBeWaitedForTakesWhatTheThreadDraws)
{
  LatePlayer player;
  Situation now;
  player.Draw(now);
  const FieldFrames::Wish wish = Player::WishOf(now, true);
  player.Late.Settle(player.With.Field, SceneOf(now), wish);
  EXPECT_TRUE(player.With.Draw(now).Kept);
  Situation other = now;
  other.Function = 1;
  player.Draw(other);
  player.Late.Settle(player.With.Field, SceneOf(now), wish);
  EXPECT_FALSE(player.Late.IsDrawing()) << "it was stopped";
  EXPECT_FALSE(player.With.Draw(other).Kept);
  player.Draw(now);
  player.Late.Stop();
  EXPECT_FALSE(player.Late.GoOn());
}

TEST(LateFrames, WhateverIsDoneTheExactPictureIsTheOneThatIsWaitedFor)
{
  LatePlayer player;
  Dice dice(5);
  Situation now;
  int exact = 0;
  for (int i = 0; i < 200; ++i)
  {
    const int which = dice.Whole(0, 5);
    now.Eye = which == 0 ? 0.1 * dice.Whole(0, 20) : now.Eye;
    now.Function = which == 1 ? dice.Whole(0, 3) : now.Function;
    now.Step = which == 2 ? dice.Whole(0, Steps - 1) : now.Step;
    now.Shaded = which == 3 ? !now.Shaded : now.Shaded;
    now.Interacting = which == 4 ? !now.Interacting : now.Interacting;
    now.Width = which == 5 ? 96 + 32 * dice.Whole(0, 4) : now.Width;
    if (dice.Whole(0, 2) == 0)
    {
      player.Draw(now); // nobody waits for what comes of it
      continue;
    }
    Situation still = now;
    still.Interacting = false;
    player.ExpectExact(player.DrawAtLast(still), still);
    ++exact;
  }
  EXPECT_GT(exact, 100);
}

} // namespace
