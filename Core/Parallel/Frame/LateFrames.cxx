// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Frame/LateFrames.h"

#include "Base/Digest.h"
#include "Render/Scene/SceneDigest.h"

#include <mutex>
#include <set>
#include <utility>

namespace banyan
{
namespace
{

/// All objects of the process.
std::set<LateFrames*>& All()
{
  static std::set<LateFrames*> all;
  return all;
}

} // namespace

/// What the thread draws.
struct LateFrames::Coming
{
  std::mutex Mutex; ///< of what is between
  std::optional<FieldFrames::Frame> Between;
  Drawn Exact; ///< when the thread has ended

  bool HasBetween()
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    return this->Between.has_value();
  }
};

FieldFrames::Wish LateFrames::CoarseOf(FieldFrames::Wish wish, double seconds)
{
  wish.Sampling.Interacting = true;
  wish.Sampling.KeepsTolerance = false;
  wish.Sampling.BeginsCoarse = true;
  wish.Sampling.Seconds = seconds;
  wish.ReadAhead = false;
  wish.Passing = true;
  return wish;
}

LateFrames::LateFrames(FieldFrames& frames, const Times& times)
  : Frames(frames)
  , Waits(times)
{
  All().insert(this);
}

LateFrames::~LateFrames()
{
  All().erase(this);
}

void LateFrames::Stop()
{
  this->Exact.Stop();
  this->Begin = nullptr;
  this->Next = nullptr;
}

void LateFrames::PauseAll()
{
  for (LateFrames* const frames : All())
  {
    if (frames->IsDrawing())
    {
      frames->Exact.Stop();
    }
  }
}

Hash128 LateFrames::NameOf(
  const DistributedField& field, const RayScene& scene, const FieldFrames::Wish& wish)
{
  Digest digest;
  digest.Add(field.Version());
  digest.Add(FieldFrames::SceneOf(scene, wish));
  return digest.Get();
}

void LateFrames::Settle(
  const DistributedField& field, const RayScene& scene, const FieldFrames::Wish& wish)
{
  if (NameOf(field, scene, wish) == this->Name)
  {
    this->Finish();
  }
  else if (this->IsDrawing())
  {
    this->Exact.Stop();
  }
}

/// @return whether the series plays
bool LateFrames::Plays(const DistributedField& field, const FieldFrames::Wish& wish)
{
  return field.Version() != this->Version && this->Version != 0 && !wish.Sampling.Interacting &&
         this->SinceVersion.Seconds() < this->Waits.Playing;
}

/// Takes what the thread has drawn.
void LateFrames::Take()
{
  if (this->Next && this->Next->HasBetween())
  {
    const std::lock_guard<std::mutex> lock(this->Next->Mutex);
    this->Last = { std::move(*std::exchange(this->Next->Between, std::nullopt)), false };
  }
  if (!this->Exact.HasEnded())
  {
    return;
  }
  const std::shared_ptr<Coming> next = std::exchange(this->Next, nullptr);
  this->Begin = nullptr;
  try
  {
    this->Exact.Wait();
  }
  catch (...)
  {
    this->Name = Hash128{};
    throw;
  }
  this->Last = { next->Exact.Frame, true };
  this->Learn(next->Exact);
}

/// A picture of which something was there says little of one with another camera.
void LateFrames::Learn(const Drawn& drawn)
{
  if (drawn.Frame.ReusedFraction() == 0.0)
  {
    this->ExactSeconds = drawn.Seconds;
  }
}

/// Starts the thread.
void LateFrames::Start(
  const Drawing& draw, const RayScene& scene, const FieldFrames::Wish& exact, double coarseSeconds)
{
  const bool between = this->ExactSeconds && *this->ExactSeconds > this->Waits.Long;
  this->Next = std::make_shared<Coming>();
  this->Exact.Start(
    [draw, scene, exact, coarseSeconds, between, next = this->Next](const StopFlag& stop)
    {
      RayScene stoppable = scene;
      stoppable.Stop = &stop;
      if (between)
      {
        FieldFrames::Wish better = CoarseOf(exact, coarseSeconds);
        better.Sampling.Between = true;
        Drawn drawn = draw(stoppable, better);
        const std::lock_guard<std::mutex> lock(next->Mutex);
        next->Between = std::move(drawn.Frame);
      }
      next->Exact = draw(stoppable, exact);
    });
}

LateFrames::Shown LateFrames::Draw(Communicator& communicator, DistributedField& field,
  const RayScene& scene, const FieldFrames::Wish& wish, double coarseSeconds)
{
  const Hash128 name = NameOf(field, scene, wish);
  if (name != this->Name)
  {
    this->Stop();
    PauseAll();
    this->Last = Shown{};
    this->Name = name;
  }
  this->Take();
  FieldFrames::Wish exact = wish;
  exact.Sampling.Interacting = false;
  const Drawing draw = [this, &communicator, &field](
                         const RayScene& picture, const FieldFrames::Wish& as)
  {
    const Timer timer;
    RayScene own = picture;
    Drawn drawn{ this->Frames.Draw(communicator, field, own, as), 0.0 };
    drawn.Seconds = timer.Seconds();
    return drawn;
  };
  if (!this->Last.Frame.Picture.Pixels)
  {
    const bool little = this->ExactSeconds && *this->ExactSeconds <= this->Waits.Patience;
    std::optional<FieldFrames::Frame> kept;
    if (little || this->Plays(field, wish))
    {
      Drawn drawn = draw(scene, exact);
      this->Learn(drawn);
      kept = std::move(drawn.Frame);
    }
    else
    {
      kept = this->Frames.Kept(communicator, field, scene, exact);
    }
    this->Last.Exact = kept.has_value();
    this->Last.Frame = kept ? std::move(*kept) : draw(scene, CoarseOf(exact, coarseSeconds)).Frame;
  }
  if (!this->Last.Exact && !this->Exact.IsStarted())
  {
    this->Begin = [=] { this->Start(draw, scene, exact, coarseSeconds); };
    if (!wish.Sampling.Interacting)
    {
      this->Begin();
    }
  }
  if (field.Version() != this->Version)
  {
    this->Version = field.Version();
    this->SinceVersion = Timer();
  }
  this->SinceDrawn = Timer();
  return this->Last;
}

bool LateFrames::GoOn()
{
  if (this->Exact.HasEnded() || (this->Next && this->Next->HasBetween()))
  {
    return true;
  }
  if (this->Begin && !this->Exact.IsStarted() && this->SinceDrawn.Seconds() > this->Waits.Pause)
  {
    try
    {
      this->Begin();
    }
    catch (const Error&)
    {
      this->Begin = nullptr;
      return true; // Draw will fail the same way, and say so
    }
  }
  return false;
}

} // namespace banyan
