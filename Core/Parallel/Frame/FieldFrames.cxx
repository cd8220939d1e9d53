// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Frame/FieldFrames.h"

#include "Base/Digest.h"
#include "Base/Progress.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Parallel/Communicate/Collective.h"
#include "Render/Scene/SceneDigest.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace banyan
{

namespace
{

/// The ranks that get pixels.
std::vector<int> RootsOf(const FieldFrames::Wish& wish)
{
  std::vector<int> roots;
  for (const PicturePlace& place : wish.Places)
  {
    roots.push_back(place.Root);
  }
  return roots.empty() ? std::vector<int>{ 0 } : roots;
}

bool GetsPixels(const FieldFrames::Wish& wish, int rank)
{
  const std::vector<int> roots = RootsOf(wish);
  return std::find(roots.begin(), roots.end(), rank) != roots.end();
}

/// The scene of all of a picture, as far as a part of it knows.
RayScene PictureAround(const RayScene& part, const PixelRect& rect)
{
  RayScene picture = part;
  picture.Viewport = rect;
  picture.Depth.clear();
  return picture;
}

RankShare ShareOf(DistributedField& field)
{
  DrawnField& drawn = field.Drawn();
  return { drawn.Source(), drawn.Zones(), field.DrawingBudget(), ThreadPool::Process(),
    drawn.PieceOfCells() };
}

/// Of what this rank has drawn.
void ReadAhead(DrawnField& drawn, const RayScene& scene, const RankShare& share, int rank)
{
  if (share.Regions.empty())
  {
    drawn.ReadAhead(scene, share.Zones[static_cast<std::size_t>(rank)]);
    return;
  }
  RayScene mine = scene;
  mine.Depth.clear();
  mine.Viewport = Intersection(scene.Viewport, share.Regions[static_cast<std::size_t>(rank)]);
  drawn.ReadAhead(mine, scene.DomainCells);
}

/// Pixels without rays would be made of those around them: mixed pixels are not known yet.
void BeginSegments(RayScene& scene, const FieldFrames::Wish& wish)
{
  scene.Segments = wish.Segments;
  if (wish.Segments && scene.Samplings)
  {
    scene.Samplings = std::make_shared<const TileSamplings>(scene.Samplings->WithAllPixels());
  }
}

void AddProbes(FrameStatistics& numbers, const FrameStatistics& probes)
{
  numbers.SamplesTaken += probes.SamplesTaken;
  numbers.BytesComposited += probes.BytesComposited;
  numbers.MessagesComposited += probes.MessagesComposited;
}

struct TimesOfFrame
{
  double Drawing;
  double Showing;
};

/// Collective: each of all ranks, in one message.
TimesOfFrame LargestOf(Communicator& communicator, const TimesOfFrame& mine)
{
  std::vector<TimesOfFrame> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), all.data());
  TimesOfFrame largest = mine;
  for (const TimesOfFrame& times : all)
  {
    largest.Drawing = std::max(largest.Drawing, times.Drawing);
    largest.Showing = std::max(largest.Showing, times.Showing);
  }
  return largest;
}

} // namespace

Hash128 FieldFrames::SceneOf(const RayScene& scene, const Wish& wish)
{
  Digest digest;
  digest.Add(DigestOf(scene));
  digest.Add(wish.Sampling.Still);
  digest.Add(wish.Sampling.MaxElementsPerPixel);
  digest.Add(wish.Sampling.ScreenErrorPixels);
  digest.Add(wish.Sampling.FixedDistance);
  digest.Add(wish.Sampling.KeepsTolerance);
  digest.Add(wish.Transport);
  if (wish.Transport == PixelTransport::WithinOne)
  {
    digest.Add(wish.Behind);
  }
  return digest.Get();
}

/// Collective: takes a picture that was drawn before.
/// @return whether there is one
bool FieldFrames::TakeKept(
  Communicator& communicator, const Sight& sight, const Wish& wish, Frame& frame)
{
  const DrawnPicture* const kept = this->Pictures.Find(sight.Scene, sight.Content, sight.Quality);
  struct Answer
  {
    Hash128 Scene;
    double EstimatedError;
    FrameStatistics Statistics;
    bool Found;
  };
  Answer mine{ sight.Mine, 0.0, {}, kept != nullptr };
  if (kept)
  {
    frame.Picture = *kept;
    mine.EstimatedError = kept->EstimatedError;
    mine.Statistics = kept->Statistics;
  }
  std::vector<Answer> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), all.data());
  // Whoever sees another scene has to draw, and nobody can do that alone.
  const std::vector<int> roots = RootsOf(wish);
  const auto at = [&](int rank) -> const Answer& { return all[static_cast<std::size_t>(rank)]; };
  frame.Kept = std::all_of(roots.begin(), roots.end(), [&](int root) { return at(root).Found; }) &&
               std::all_of(all.begin(), all.end(),
                 [&](const Answer& answer) { return answer.Scene == all[0].Scene; });
  if (!frame.Kept)
  {
    frame.Picture = {};
    return false;
  }
  frame.Picture.EstimatedError = at(roots.front()).EstimatedError;
  frame.Picture.Statistics = at(roots.front()).Statistics;
  frame.Picture.Limit =
    AllGatherStrings(communicator, frame.Picture.Limit)[static_cast<std::size_t>(roots.front())];
  return true;
}

void FieldFrames::BeginLooking(std::uint64_t version)
{
  // Two in a row, because rays are compared with those of the picture before.
  constexpr int patience = 8;
  constexpr int every = 16;
  Looking& looking = this->Values;
  if (version == looking.Version)
  {
    return;
  }
  looking.Version = version;
  looking.Looks = looking.Useless < patience || looking.Useless % every < 2;
  looking.Judged = false;
  ++looking.Useless;
}

/// @param taken whether the frame took anything; the first one of a version counts
void FieldFrames::EndLooking(bool taken)
{
  Looking& looking = this->Values;
  if (!std::exchange(looking.Judged, true) && taken)
  {
    looking.Useless = 0;
  }
}

/// Collective.
FieldFrames::Sight FieldFrames::Look(
  Communicator& communicator, DistributedField& field, const RayScene& scene, const Wish& wish)
{
  Sight sight;
  const Hash128 view = SceneOf(scene, wish);
  Digest pixels;
  pixels.Add(view);
  pixels.Add(wish.Places);
  sight.Scene = pixels.Get();
  this->BeginLooking(field.Version());
  const bool looks = wish.Reuse && this->Values.Looks;
  Collective(communicator, [&] { sight.Content = field.VisibleContent(scene, looks); });
  Digest whole;
  whole.Add(sight.Scene);
  whole.Add(sight.Content);
  sight.Mine = whole.Get();
  // What follows has messages: all ranks go by the names that the first one has for the scene.
  sight.Agreed = { view, sight.Mine };
  communicator.Broadcast(0, &sight.Agreed, sizeof(sight.Agreed));
  sight.Aim = this->Tolerance.Begin(wish.Sampling);
  sight.Quality = { sight.Aim.Coarseness, sight.Aim.Interacting };
  const bool keeps = wish.Reuse && GetsPixels(wish, communicator.Rank());
  this->Pictures.KeepIn(keeps ? field.Drawn().Caches() : nullptr);
  return sight;
}

std::optional<FieldFrames::Frame> FieldFrames::Kept(
  Communicator& communicator, DistributedField& field, const RayScene& scene, const Wish& wish)
{
  Frame frame;
  const Sight sight = this->Look(communicator, field, scene, wish);
  if (!this->TakeKept(communicator, sight, wish, frame))
  {
    return std::nullopt;
  }
  this->EndLooking(true);
  return frame;
}

FieldFrames::Frame FieldFrames::Draw(
  Communicator& communicator, DistributedField& field, RayScene& scene, const Wish& wish)
{
  Frame frame;
  scene.Passing = wish.Passing;
  if (wish.Passing || !wish.Whole.Empty())
  {
    const Hash128 name = SceneOf(scene, wish);
    this->DrawAnew(communicator, field, scene, { name, name }, wish,
      this->Tolerance.Begin(wish.Sampling), frame);
    return frame;
  }
  const Sight sight = this->Look(communicator, field, scene, wish);
  if (!this->TakeKept(communicator, sight, wish, frame))
  {
    this->DrawAnew(communicator, field, scene, sight.Agreed, wish, sight.Aim, frame);
    if (wish.Reuse && frame.Picture.Pixels)
    {
      std::set<int> levels = scene.Samplings ? scene.Samplings->UsedLevels() : std::set<int>();
      levels.insert(0); // the error is that against the finest one
      this->Pictures.Keep(sight.Scene, sight.Content, levels, sight.Quality, frame.Picture);
    }
  }
  this->EndLooking(frame.Kept || scene.Reused);
  return frame;
}

/// Collective: looks which rays need not be cast.
/// @param name of the picture
/// @return whether rays of this picture are to be kept: where the budget has room for one
bool FieldFrames::BeginRays(Communicator& communicator, DrawnField& drawn, RayScene& scene,
  const Hash128& name, const Wish& wish)
{
  scene.Reused.reset();
  if (wish.Passing || !wish.Whole.Empty())
  {
    return false;
  }
  // Of a picture with places no rank has all pixels. What bricks rays meet is another question on
  // each rank where cells are dealt in any way.
  const bool isInPieces = drawn.PieceOfCells() && communicator.Size() > 1;
  if (!wish.Reuse || !wish.Places.empty() || scene.Blend.Mode != BlendMode::Composite || isInPieces)
  {
    this->Rays.Forget();
    return false;
  }
  bool keeps = false;
  Hash128 kept;
  Collective(communicator,
    [&]
    {
      const std::uint64_t bytes =
        static_cast<std::uint64_t>(scene.Viewport.Count()) * sizeof(glm::vec4);
      keeps = drawn.Source() && drawn.Caches()->PictureBudgetBytes() >= bytes;
      if (keeps)
      {
        kept = this->Rays.Begin(scene, *drawn.Source(), name);
      }
      else
      {
        this->Rays.Forget();
      }
    });
  // A ray that one rank does not cast has to be one that no rank casts.
  std::vector<Hash128> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&kept, sizeof(kept), all.data());
  if (std::any_of(all.begin(), all.end(), [&](const Hash128& other) { return other != all[0]; }))
  {
    scene.Reused.reset();
  }
  return keeps;
}

/// Whether ranks divide the picture. No pixel is composited then and none travels that is shown
/// where it is drawn; but bricks come to other ranks when the camera moves.
bool FieldFrames::DividesPicture(
  const Communicator& communicator, const DrawnField& drawn, const Wish& wish)
{
  return communicator.Size() > 1 && drawn.IsOnEachRank() &&
         (wish.Divides == Division::ByPicture ||
           (wish.Divides == Division::Automatic && wish.Places.size() > 1));
}

/// Collective: decides how finely the picture is sampled.
void FieldFrames::Plan(Communicator& communicator, DistributedField& field, RayScene& scene,
  const Hash128& view, const Wish& wish, const ToleranceControl::Aim& aim, DrawnPicture& picture)
{
  const PhaseScope sampling(Phase::Sampling);
  picture.EstimatedError = this->Tolerance.Plan(communicator, field, scene, view, wish.Sampling,
    aim, field.DrawingBudget(), picture.Statistics);
  picture.Limit = this->Tolerance.Limit();
}

/// Collective: the same for a part of a picture. Where nothing opaque is, the plan is that of the
/// picture, made with the first such part.
/// @param whole the scene of the picture, without depths
void FieldFrames::PlanPart(Communicator& communicator, DistributedField& field, RayScene& whole,
  RayScene& scene, const Wish& wish, const ToleranceControl::Aim& aim, DrawnPicture& picture)
{
  const bool ofWhole = scene.Depth.empty() || wish.Segments;
  RayScene& planned = ofWhole ? whole : scene;
  // All ranks go by the name that the first one has.
  Hash128 view = SceneOf(planned, wish);
  communicator.Broadcast(0, &view, sizeof(view));
  if (!ofWhole)
  {
    this->Plan(communicator, field, scene, view, wish, aim, picture);
    return;
  }
  Digest name;
  name.Add(view);
  name.Add(field.Version());
  name.Add(aim.Coarseness);
  name.Add(aim.Interacting);
  PlanOfParts& plan = this->OfParts.at(static_cast<std::size_t>(wish.Sampling.Eye));
  if (AllMax(communicator, name.Get() == plan.Name ? 0.0 : 1.0) > 0.0)
  {
    plan = {};
    this->Plan(communicator, field, whole, view, wish, aim, picture);
    plan = { name.Get(), whole.Samplings, whole.OpacityLimit, whole.Levels, picture.EstimatedError,
      picture.Limit };
  }
  else if (plan.Samplings && *plan.Samplings->UsedLevels().rbegin() > 0)
  {
    field.Drawn().BringLevels(communicator, whole, *plan.Samplings->UsedLevels().rbegin());
  }
  scene.Samplings = plan.Samplings;
  scene.OpacityLimit = plan.OpacityLimit;
  scene.Levels = plan.Levels;
  picture.EstimatedError = plan.EstimatedError;
  picture.Limit = plan.Limit;
}

/// Collective.
void FieldFrames::DrawAnew(Communicator& communicator, DistributedField& field, RayScene& scene,
  const Names& names, const Wish& wish, const ToleranceControl::Aim& aim, Frame& frame)
{
  const Timer drawing;
  DrawnField& drawn = field.Drawn();
  const bool isPart = !wish.Whole.Empty();
  std::optional<RayScene> whole =
    isPart ? std::optional(PictureAround(scene, wish.Whole)) : std::nullopt;
  {
    const PhaseScope fetching(Phase::Fetching);
    RayScene& looksAt = isPart ? *whole : scene;
    drawn.BeginFrame(communicator, looksAt);
    scene.Work = looksAt.Work;
  }
  FrameStatistics& numbers = frame.Picture.Statistics;
  isPart ? this->PlanPart(communicator, field, *whole, scene, wish, aim, frame.Picture)
         : this->Plan(communicator, field, scene, names.View, wish, aim, frame.Picture);
  RankShare share = ShareOf(field);
  frame.ByPicture = DividesPicture(communicator, drawn, wish);
  PictureRegions ofPart;
  PictureRegions& regions = isPart ? ofPart : this->Regions;
  if (frame.ByPicture)
  {
    share.Regions = regions.BeginFrame(scene, communicator.Size(), wish.Places);
  }
  const bool keeps = this->BeginRays(communicator, drawn, scene, names.Whole, wish);
  const FrameStatistics probes = numbers;
  BeginSegments(scene, wish);
  CompositeOptions compositing;
  compositing.Behind = wish.Behind;
  compositing.Transport = wish.Transport;
  compositing.Plans = &this->Plans;
  // The other eye's picture is no step of a camera that moves.
  if (wish.ReadAhead && wish.Sampling.Eye == 0 && !isPart)
  {
    compositing.AfterCasting = [&] { ReadAhead(drawn, scene, share, communicator.Rank()); };
  }
  FloatImage picture =
    DrawDistributed(communicator, scene, share, numbers, compositing, wish.Places);
  if (GetsPixels(wish, communicator.Rank()) && !wish.Segments)
  {
    frame.Picture.Pixels = std::make_shared<const FloatImage>(std::move(picture));
  }
  if (keeps)
  {
    this->Rays.Keep(frame.Picture.Pixels);
  }
  AddProbes(numbers, probes);
  const PhaseScope balancing(Phase::Balancing);
  if (!scene.Reused && !isPart && !wish.Passing) // others say little of the next exact one
  {
    frame.ByPicture ? regions.EndFrame(communicator) : drawn.EndFrame(communicator);
  }
  if (!wish.Segments)
  {
    this->FrameTook(communicator, wish, drawing.Seconds());
  }
}

void FieldFrames::FrameTook(Communicator& communicator, const Wish& wish, double seconds)
{
  const TimesOfFrame took = LargestOf(communicator, { seconds, wish.ShowSeconds });
  this->Tolerance.FrameTook(wish.Sampling, took.Drawing, took.Showing);
}

void FieldFrames::Forget()
{
  this->Pictures.Clear();
  this->Rays.Forget();
  this->Tolerance.ForgetPlans();
  this->OfParts = {};
}

} // namespace banyan
