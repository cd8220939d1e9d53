// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Frame/LateFramesOfRanks.h"

#include "Base/Digest.h"

#include <algorithm>
#include <set>
#include <utility>

namespace banyan
{
namespace
{

/// All objects of this main thread: where ranks are threads, each has its own.
std::set<LateFramesOfRanks*>& All()
{
  static thread_local std::set<LateFramesOfRanks*> all;
  return all;
}

} // namespace

LateFramesOfRanks::LateFramesOfRanks(FieldFrames& frames, const LateFrames::Times& times)
  : Frames(frames)
  , Waits(times)
{
  All().insert(this);
}

LateFramesOfRanks::~LateFramesOfRanks()
{
  All().erase(this);
}

void LateFramesOfRanks::Stop()
{
  if (this->IsComing())
  {
    this->Name = Hash128{}; // whoever wants it has to begin anew
  }
  this->Begin = nullptr;
  this->Task.reset();
  this->Between.reset();
}

void LateFramesOfRanks::PauseAll()
{
  for (LateFramesOfRanks* const frames : All())
  {
    if (frames->IsDrawing())
    {
      frames->Task.reset();
      frames->Between.reset();
    }
  }
}

bool LateFramesOfRanks::AnyDraws()
{
  return std::any_of(All().begin(), All().end(),
    [](const LateFramesOfRanks* frames) { return frames->IsDrawing(); });
}

bool LateFramesOfRanks::Draw(Communicator& communicator, DistributedField& field,
  const RayScene& scene, const RayScene& coarse, const FieldFrames::Wish& wish, bool shows)
{
  // Coarse pictures of both kinds have other sizes, and whoever shows one has not the other.
  Digest digest;
  digest.Add(LateFrames::NameOf(field, scene, wish));
  digest.Add(shows);
  const Hash128 name = digest.Get();
  if (AllMax(communicator, name == this->Name ? 0.0 : 1.0) == 0.0)
  {
    return false;
  }
  PauseAll();
  this->Stop();
  this->Name = Hash128{};
  FieldFrames::Wish exact = wish;
  exact.Sampling.Interacting = false;
  const bool waits = !shows && !wish.Sampling.Interacting && this->ExactSeconds &&
                     *this->ExactSeconds <= this->Waits.AtRest;
  this->DrawBest(communicator, field, scene, waits ? nullptr : &coarse, exact,
    shows ? this->Waits.Shown : this->Waits.Patience);
  if (!this->Best.Exact)
  {
    this->Begin = [this, &communicator, &field, scene, exact]
    { this->Start(communicator, field, scene, exact); };
    this->Begin();
  }
  this->Name = name;
  return true;
}

void LateFramesOfRanks::DrawCoarse(Communicator& communicator, DistributedField& field,
  const RayScene& coarse, const FieldFrames::Wish& wish)
{
  PauseAll();
  this->Stop();
  this->Name = Hash128{};
  RayScene own = coarse;
  this->Any = true;
  this->Best = { this->Frames.Draw(
                   communicator, field, own, LateFrames::CoarseOf(wish, LateFrames::CoarseSeconds)),
    false };
}

/// A picture of which something was there says little of one with another camera.
void LateFramesOfRanks::Learn(const LateFrames::Drawn& drawn)
{
  if (drawn.Frame.ReusedFraction() == 0.0)
  {
    this->ExactSeconds = drawn.Seconds;
  }
}

/// Collective: draws what can be had at once.
/// @param coarse null when it is not worth its time
/// @param patience seconds that an exact picture may take that is waited for
void LateFramesOfRanks::DrawBest(Communicator& communicator, DistributedField& field,
  const RayScene& scene, const RayScene* coarse, const FieldFrames::Wish& exact, double patience)
{
  this->Any = true;
  RayScene own = scene;
  if (this->ExactSeconds && *this->ExactSeconds <= patience)
  {
    const Timer timer;
    this->Best = { this->Frames.Draw(communicator, field, own, exact), true };
    this->Learn({ this->Best.Frame, AllMax(communicator, timer.Seconds()) });
    return;
  }
  std::optional<FieldFrames::Frame> kept = this->Frames.Kept(communicator, field, scene, exact);
  if (kept)
  {
    this->Best = { std::move(*kept), true };
  }
  else if (coarse)
  {
    this->DrawCoarse(communicator, field, *coarse, exact);
  }
  else
  {
    this->Best = {};
    this->Any = false;
  }
}

/// Starts the threads.
void LateFramesOfRanks::Start(Communicator& communicator, DistributedField& field,
  const RayScene& scene, const FieldFrames::Wish& exact)
{
  const bool between = this->ExactSeconds && *this->ExactSeconds > this->Waits.Long;
  this->Task.emplace(communicator);
  this->Task->Start(
    [this, &field, scene, exact, between](Communicator& ranks, const StopFlag& stop)
    {
      RayScene own = scene;
      own.Stop = &stop;
      if (between)
      {
        FieldFrames::Wish better = LateFrames::CoarseOf(exact, LateFrames::CoarseSeconds);
        better.Sampling.Between = true;
        FieldFrames::Frame frame = this->Frames.Draw(ranks, field, own, better);
        const std::lock_guard<std::mutex> lock(this->Mutex);
        this->Between = std::move(frame);
      }
      const Timer timer;
      own = scene;
      own.Stop = &stop;
      this->Next.Frame = this->Frames.Draw(ranks, field, own, exact);
      this->Next.Seconds = AllMax(ranks, timer.Seconds());
    });
}

std::optional<FieldFrames::Frame> LateFramesOfRanks::TakeBetween()
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  std::optional<FieldFrames::Frame> taken = std::exchange(this->Between, std::nullopt);
  return taken && taken->Picture.Pixels ? taken : std::nullopt;
}

bool LateFramesOfRanks::GoOn(const std::function<bool()>& leave)
{
  if (!this->IsComing())
  {
    return false;
  }
  if (!this->IsDrawing())
  {
    if (AnyDraws())
    {
      return false;
    }
    this->Begin();
  }
  try
  {
    if (!this->Task->Serve(leave))
    {
      return false;
    }
  }
  catch (...)
  {
    this->Stop();
    throw;
  }
  this->Begin = nullptr;
  this->Between.reset();
  this->Any = true;
  this->Best = { this->Next.Frame, true };
  this->Learn(this->Next);
  return true;
}

} // namespace banyan
