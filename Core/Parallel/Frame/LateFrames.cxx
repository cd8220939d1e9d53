// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Frame/LateFrames.h"

#include "Base/Digest.h"
#include "Base/Timer.h"
#include "Render/Scene/SceneDigest.h"

#include <set>
#include <utility>

namespace banyan
{
namespace
{

/// What a coarse picture is drawn with: no probe is drawn for it, and time decides how coarse it
/// is.
FieldFrames::Wish CoarseOf(FieldFrames::Wish wish)
{
  wish.Sampling.Interacting = true;
  wish.Sampling.KeepsTolerance = false;
  wish.Sampling.Seconds = LateFrames::CoarseSeconds;
  wish.ReadAhead = false;
  return wish;
}

/// All objects of the process.
std::set<LateFrames*>& All()
{
  static std::set<LateFrames*> all;
  return all;
}

} // namespace

LateFrames::LateFrames(FieldFrames& frames, double patience)
  : Frames(frames)
  , WaitsFor(patience)
{
  All().insert(this);
}

LateFrames::~LateFrames()
{
  All().erase(this);
}

void LateFrames::StopAll()
{
  for (LateFrames* const frames : All())
  {
    frames->Stop();
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
  else
  {
    this->Stop();
  }
}

/// Takes what the thread has drawn.
void LateFrames::Take()
{
  const std::shared_ptr<Drawn> drawn = std::exchange(this->Coming, nullptr);
  try
  {
    this->Exact.Wait();
  }
  catch (...)
  {
    this->Name = Hash128{};
    throw;
  }
  this->Last = { std::move(drawn->Frame), true };
  this->ExactSeconds = drawn->Seconds;
}

LateFrames::Shown LateFrames::Draw(Communicator& communicator, DistributedField& field,
  const RayScene& scene, const FieldFrames::Wish& wish)
{
  const Hash128 name = NameOf(field, scene, wish);
  if (name != this->Name)
  {
    this->Exact.Stop();
    this->Last = Shown{};
    this->Name = name;
  }
  if (this->Exact.HasEnded())
  {
    this->Take();
  }
  if (this->Last.Exact || this->Exact.IsStarted())
  {
    return this->Last;
  }
  FieldFrames::Wish still = wish;
  still.Sampling.Interacting = false;
  const auto draw = [this, &communicator, &field](
                      const RayScene& picture, const FieldFrames::Wish& as)
  {
    const Timer timer;
    RayScene own = picture;
    Drawn drawn{ this->Frames.Draw(communicator, field, own, as), 0.0 };
    drawn.Seconds = timer.Seconds();
    return drawn;
  };
  if (this->ExactSeconds && *this->ExactSeconds <= this->WaitsFor)
  {
    Drawn drawn = draw(scene, still);
    this->ExactSeconds = drawn.Seconds;
    return this->Last = { std::move(drawn.Frame), true };
  }
  if (std::optional<FieldFrames::Frame> kept = this->Frames.Kept(communicator, field, scene, still))
  {
    return this->Last = { std::move(*kept), true };
  }
  this->Last = { draw(scene, CoarseOf(wish)).Frame, false };
  if (!wish.Sampling.Interacting)
  {
    this->Coming = std::make_shared<Drawn>();
    this->Exact.Start(
      [draw, still, scene, coming = this->Coming](const StopFlag& stop)
      {
        RayScene stoppable = scene;
        stoppable.Stop = &stop;
        *coming = draw(stoppable, still);
      });
  }
  return this->Last;
}

} // namespace banyan
