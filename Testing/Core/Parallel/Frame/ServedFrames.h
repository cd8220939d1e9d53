// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Parallel_Frame_ServedFrames_h
#define banyan_Testing_Core_Parallel_Frame_ServedFrames_h

#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/CollectiveTask.h"
#include "Parallel/Frame/PlayedSeries.h"
#include "Render/Dice.h"

#include <functional>
#include <string>

/// Frames that threads of all ranks draw, while main threads come and go.
namespace banyan::played
{

/// Draws frames by threads, and the same ones directly. Zones do not follow the clock, so that both
/// have the same bits.
template <class Player>
class ServedPlayer
{
public:
  explicit ServedPlayer(Communicator& communicator, LoadBalancing balancing = LoadBalancing::Off)
    : Ranks(communicator)
    , Served(communicator)
    , Direct(communicator)
    , Task(communicator)
  {
    this->Served.Field.SetLoadBalancing(balancing);
    this->Direct.Field.SetLoadBalancing(balancing);
  }

  /// Begins to draw; what is under way is broken off.
  /// @param stop that the scene gets in place of the task's
  void Begin(const Situation& now, const StopFlag* stop = nullptr)
  {
    this->Task.Stop();
    const RayScene scene = this->Served.Take(now);
    this->Task.Start(
      [=](Communicator& ranks, const StopFlag& asked)
      {
        RayScene own = scene;
        own.Stop = stop ? stop : &asked;
        this->Drawn =
          this->Served.Frames.Draw(ranks, this->Served.Field, own, Player::WishOf(now, true));
      });
  }

  /// @param times that the first rank is asked whether it leaves before it does
  /// @return whether the frame is done
  bool ServeSome(int times)
  {
    return this->Task.Serve([times]() mutable { return --times < 0; });
  }
  void Finish()
  {
    EXPECT_TRUE(this->Task.Serve([] { return false; }));
  }
  bool IsDrawing() const { return this->Task.IsStarted(); }

  /// The last frame is that which fresh FieldFrames draw directly.
  /// @param allowed largest difference of a pixel
  void ExpectDirect(const Situation& now, double allowed = 0.0)
  {
    RayScene scene = this->Direct.Take(now);
    FieldFrames fresh;
    const FieldFrames::Frame direct =
      fresh.Draw(this->Ranks, this->Direct.Field, scene, Player::WishOf(now, true));
    const double error = direct.Picture.EstimatedError;
    EXPECT_NEAR(this->Drawn.Picture.EstimatedError, error, allowed > 0.0 ? 0.01 * error : 0.0);
    if (this->Ranks.Rank() == 0)
    {
      EXPECT_LE(WorstDifference(*this->Drawn.Picture.Pixels, *direct.Picture.Pixels), allowed);
    }
  }

  /// Zones are those of all ranks: they decide alike.
  void ExpectEqualZones()
  {
    std::string mine;
    for (const Box& zone : this->Served.Field.Drawn().Zones())
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        mine += std::to_string(zone.Lo[axis]) + " " + std::to_string(zone.Hi[axis]) + " ";
      }
    }
    for (const std::string& theirs : AllGatherStrings(this->Ranks, mine))
    {
      EXPECT_EQ(theirs, mine);
    }
  }

private:
  Communicator& Ranks;
  Player Served;
  Player Direct;
  FieldFrames::Frame Drawn;
  CollectiveTask Task;
};

/// Another situation, chosen by dice.
inline void Change(Situation& now, Dice& dice)
{
  const int which = dice.Whole(0, 5);
  now.Eye = which == 0 ? 0.1 * dice.Whole(0, 20) : now.Eye;
  now.Function = which == 1 ? dice.Whole(0, 3) : now.Function;
  now.Step = which == 2 ? dice.Whole(0, Steps - 1) : now.Step;
  now.Shaded = which == 3 ? !now.Shaded : now.Shaded;
  now.Interacting = which == 4 ? !now.Interacting : now.Interacting;
  now.Width = which == 5 ? 96 + 32 * dice.Whole(0, 4) : now.Width;
}

/// Collective: changes what is to be drawn, leaves, comes back, breaks off, and compares what is
/// finished.
/// @param allowed largest difference of a pixel
/// @return frames that were broken off
template <class Player>
int DrawAndBreakOff(
  ServedPlayer<Player>& player, int operations, unsigned seed, double allowed = 0.0)
{
  Dice dice(seed);
  Situation now;
  int broken = 0;
  for (int i = 0; i < operations; ++i)
  {
    Change(now, dice);
    const bool finishes = dice.Whole(0, 1) == 0;
    Situation drawn = now;
    drawn.Interacting = now.Interacting && !finishes; // such a picture may be a better one
    player.Begin(drawn);
    const int leaves = dice.Whole(0, 2);
    for (int leave = 0; leave < leaves && player.IsDrawing(); ++leave)
    {
      player.ServeSome(dice.Whole(0, 30));
    }
    if (!finishes)
    {
      broken += player.IsDrawing() ? 1 : 0;
      continue;
    }
    if (player.IsDrawing())
    {
      player.Finish();
    }
    player.ExpectEqualZones();
    player.ExpectDirect(drawn, allowed);
  }
  return broken;
}

} // namespace banyan::played

#endif
