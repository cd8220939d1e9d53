// SPDX-License-Identifier: BSD-3-Clause
#include "TicketMeasure.h"

#include "Picture.h"
#include "TicketScene.h"

#include "Base/Error.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Frame/LateFramesOfRanks.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace banyan::bench
{
namespace
{

/// A field of all ranks, and views of it.
class Views
{
public:
  Views(CountingCommunicator& ranks, const BenchScene& scene, const TicketOptions& options)
    : Ranks(ranks)
    , Options(options)
    , Scene(scene)
    , Coarse(scene)
    , Meter(ranks, options.OneProcess)
  {
    this->Coarse.Picture = std::max(1, scene.Picture / 2); // every second row and column
    VolumePiece piece(*scene.Data, ranks);
    this->Field.SetLoadBalancing(options.Balancing);
    this->Field.Update(ranks, piece);
    if (!this->Field.Problem().empty())
    {
      throw Error(this->Field.Problem());
    }
  }

  /// Both ways, in turn the first.
  TicketsTook Orbit()
  {
    TicketsTook took;
    FieldFrames direct;
    FieldFrames late;
    // The first view packs bricks and finds memory cold: it does not count.
    for (int view = -1; view < this->Options.Views; ++view)
    {
      const double degrees = this->Options.ViewDegrees * view;
      PictureTook ofDirect;
      PictureTook ofLate;
      FieldFrames::Frame one;
      FieldFrames::Frame other;
      if (view % 2 == 0)
      {
        one = this->Synchronous(direct, degrees, ofDirect);
        other = this->Late(late, degrees, ofLate);
      }
      else
      {
        other = this->Late(late, degrees, ofLate);
        one = this->Synchronous(direct, degrees, ofDirect);
      }
      this->Check(one, other);
      if (view >= 0)
      {
        took.Synchronous.push_back(ofDirect);
        took.Late.push_back(ofLate);
      }
    }
    return took;
  }

  DragTook Drag()
  {
    FieldFrames frames;
    LateFramesOfRanks late(frames);
    this->Draw(late, this->At(-90.0)); // from then on it knows what a picture takes
    late.GoOn([] { return false; });
    DragTook took;
    took.Tickets = this->Options.DragTickets;
    this->Ranks.Barrier();
    const Timer clock;
    double asked = 0.0;
    for (int last = -1; last + 1 < took.Tickets;)
    {
      last = this->Await(late, last + 1, clock);
      asked = last * this->Options.DragSeconds;
      late.Stop(); // Draw would do it, too
      this->Ranks.Barrier();
      took.StopMilliseconds.push_back(1e3 * (clock.Seconds() - asked));
      this->Draw(late, this->At(1.5 * last));
      took.CoarseMilliseconds.push_back(1e3 * (clock.Seconds() - asked));
    }
    late.GoOn([] { return false; });
    took.ExactMilliseconds = 1e3 * (clock.Seconds() - asked);
    return took;
  }

private:
  /// What is to be shown, exactly and coarsely.
  struct View
  {
    RayScene Exact;
    RayScene Coarse;
  };
  View At(double degrees) const
  {
    return { Turned(this->Scene, degrees), Turned(this->Coarse, degrees) };
  }

  void Draw(LateFramesOfRanks& late, const View& view)
  {
    late.Draw(this->Ranks, this->Field, view.Exact, view.Coarse, this->Wish());
  }

  FieldFrames::Wish Wish() const
  {
    FieldFrames::Wish wish;
    wish.Sampling.FixedDistance = !this->Options.Plans;
    wish.Sampling.KeepsTolerance = this->Options.Plans;
    return wish;
  }

  FieldFrames::Frame Synchronous(FieldFrames& frames, double degrees, PictureTook& took)
  {
    RayScene scene = Turned(this->Scene, degrees);
    this->Meter.Begin();
    FieldFrames::Frame frame = frames.Draw(this->Ranks, this->Field, scene, this->Wish());
    took = this->Meter.End(0.0);
    return frame;
  }

  FieldFrames::Frame Late(FieldFrames& frames, double degrees, PictureTook& took)
  {
    // A new one does not know that the picture takes little, and never draws it without a thread.
    LateFramesOfRanks late(frames);
    const View view = this->At(degrees);
    double asks = 0.0;
    this->Meter.Begin();
    this->Draw(late, view);
    const double coarse = this->Meter.Milliseconds();
    late.GoOn(
      [&]
      {
        ++asks; // the main threads have gathered what they know once more
        return false;
      });
    took = this->Meter.End(asks);
    took.CoarseMilliseconds = coarse;
    return late.Last().Frame;
  }

  /// Collective: throws Error unless both are new and alike.
  void Check(const FieldFrames::Frame& one, const FieldFrames::Frame& other)
  {
    Collective(this->Ranks,
      [&]
      {
        if (one.ReusedFraction() > 0.0 || other.ReusedFraction() > 0.0)
        {
          throw Error("A picture took something from one before it: all views have to differ.");
        }
        if (this->Ranks.Rank() == 0 &&
            ErrorOf(*one.Picture.Pixels, *other.Picture.Pixels).Largest > 1.0)
        {
          throw Error("The late picture is another one than that which is drawn directly.");
        }
      });
  }

  /// Collective: serves the threads until a ticket is due.
  /// @return the newest one that is due: who is late has left out those between
  int Await(LateFramesOfRanks& late, int next, const Timer& clock)
  {
    const double due = next * this->Options.DragSeconds;
    late.GoOn([&] { return clock.Seconds() >= due; });
    int ticket = next;
    if (this->Ranks.Rank() == 0)
    {
      std::this_thread::sleep_for(
        std::chrono::duration<double>(std::max(0.0, due - clock.Seconds())));
      const int newest = static_cast<int>(clock.Seconds() / this->Options.DragSeconds);
      ticket = std::clamp(newest, next, this->Options.DragTickets - 1);
    }
    this->Ranks.Broadcast(0, &ticket, sizeof(ticket));
    return ticket;
  }

  CountingCommunicator& Ranks;
  const TicketOptions& Options;
  BenchScene Scene;
  BenchScene Coarse;
  TicketMeter Meter;
  DistributedField Field;
};

} // namespace

TicketsTook MeasureTickets(
  Communicator& ranks, const BenchScene& scene, const TicketOptions& options)
{
  CountingCommunicator counting(ranks);
  Views views(counting, scene, options);
  TicketsTook took = views.Orbit();
  if (options.DragTickets > 0)
  {
    took.Drag = views.Drag();
  }
  return took;
}

double QuantileOf(std::vector<double> values, double part)
{
  if (values.empty())
  {
    return 0.0;
  }
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(part * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
}

} // namespace banyan::bench
