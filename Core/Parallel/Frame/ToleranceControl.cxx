// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Frame/ToleranceControl.h"

#include "Base/Digest.h"
#include "Base/ThreadPool.h"
#include "Parallel/Balance/LevelZones.h"
#include "Parallel/Communicate/Collective.h"
#include "Render/Sampling/ElementsPerPixel.h"
#include "Render/Sampling/ScreenLevels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

namespace banyan
{
namespace
{

constexpr double MostSlack = 16.0;
/// Of the promised time, however long it takes to show a picture.
constexpr double LeastForDrawing = 0.1;

/// Whether a value that occurs is opaque however short its part of a ray.
bool HasOpaqueValues(const TransferFunction& function, const ValueRange& values)
{
  const auto last = static_cast<std::ptrdiff_t>(function.Entries.size()) - 1;
  const auto entryOf = [&](double value) -> std::ptrdiff_t
  {
    if (!function.Edges.empty())
    {
      const auto above = std::find_if(function.Edges.begin(), function.Edges.end(),
        [&](const FunctionEdge& edge)
        { return edge.Value > value || (edge.Below && edge.Value == value); });
      return above - function.Edges.begin();
    }
    const double part = (value - function.Low) / (function.High - function.Low);
    const bool flat = !(function.High > function.Low);
    const double position = flat ? (value > function.Low ? 1.0 : 0.0) : std::clamp(part, 0.0, 1.0);
    return static_cast<std::ptrdiff_t>(std::lround(position * static_cast<double>(last)));
  };
  const auto first = function.Entries.begin();
  return last >= 0 && !values.Empty() &&
         std::any_of(first + entryOf(values.Low), first + entryOf(values.High) + 1,
           [](const glm::vec4& entry) { return entry.a >= 1.0f; });
}

/// @param wanted tolerance, in 1/255
/// @param planned the one that the plan had
std::string LimitOf(const SamplingPlan& plan, double wanted, double planned,
  const ToleranceControl::Wish& wish, bool opaque)
{
  std::string text;
  if (plan.Limit == SamplingLimit::Distance)
  {
    text = "The finest sampling was reached: samples get no closer than 1/8 of a voxel. Where the "
           "opacity function jumps, single pixels may be off by more than the estimated error. ";
  }
  else if (plan.Limit == SamplingLimit::Level)
  {
    text = wish.Interacting
             ? "While the camera moves, no finer level is drawn than memory may hold. "
             : "Max Elements Per Pixel allows no finer elements. ";
  }
  else if (planned > wanted)
  {
    text = "Interactive Frame Seconds were exceeded: the tolerance is larger than the one that was "
           "set. ";
  }
  if (plan.Extrapolated)
  {
    text += "More can be seen than the cache budget holds: what the finest levels "
            "are off was extrapolated from coarser ones, and other budgets or numbers of ranks may "
            "sample otherwise. ";
  }
  if (opaque)
  {
    text +=
      "The opacity function reaches 1: a single sample of such a value hides all that is behind "
      "it, and single pixels may be off by more than the estimated error. ";
  }
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

/// The coarsest level that a field is sampled at.
int CoarsestLevelOf(const DrawnField& drawn, const RayScene& scene)
{
  return drawn.IsMesh() ? ToleranceControl::CoarsestMeshLevel
                        : DrawnField::CoarsestLevelOf(scene.DomainCells.Size());
}

} // namespace

ToleranceControl::Aim ToleranceControl::Begin(const Wish& wish)
{
  this->BySteps = !wish.KeepsTolerance;
  if (!wish.Interacting)
  {
    return { this->BySteps || wish.ScreenErrorPixels > 0.0 ? 0.0 : wish.Still, false };
  }
  if (this->BySteps)
  {
    const int step = this->Steps.Step(wish.BeginsCoarse);
    return { static_cast<double>(wish.Between ? step / 2 : step), true };
  }
  return { wish.Interactive * (wish.Seconds > 0.0 ? this->Slack : 1.0), true };
}

double ToleranceControl::Plan(Communicator& communicator, DistributedField& field, RayScene& scene,
  const Hash128& view, const Wish& wish, const Aim& aim, std::uint64_t budgetBytes,
  FrameStatistics& frame)
{
  this->LimitText.clear();
  if (this->BySteps)
  {
    this->PlanSteps(communicator, field, scene, aim);
    return 0.0;
  }
  DrawnField& drawn = field.Drawn();
  const int coarsest = CoarsestLevelOf(drawn, scene);
  scene.Levels = drawn.Levels(scene.DomainCells.Size());
  const bool byScreen = wish.ScreenErrorPixels > 0.0;
  // Plain data has coarser levels only when they are made; still pictures of it do without.
  const bool levels = (drawn.IsEncoded() || drawn.IsMesh() || wish.Interacting || byScreen) &&
                      LevelsHaveOneOrder(scene, drawn.Zones(), coarsest);
  if (levels)
  {
    drawn.BringLevels(communicator, scene, coarsest);
  }
  if (byScreen)
  {
    PlanByScreen(communicator, field, scene, wish, levels ? coarsest : 0);
    return 0.0;
  }
  const double tolerance = aim.Coarseness;
  SamplingWish sampling{ tolerance, scene.SampleDistance, levels ? coarsest : 0 };
  sampling.LeastCells = drawn.LeastCells();
  if (drawn.IsMesh() && wish.MaxElementsPerPixel > 0.0)
  {
    sampling.FinestLevelOfTile =
      FinestLevelsOfTiles(scene, wish.MaxElementsPerPixel, sampling.CoarsestLevel);
  }
  sampling.StaysInMemory = wish.Interacting && wish.Seconds > 0.0;
  const SamplingPlan plan =
    this->PlanWithin(communicator, field, scene, view, sampling, wish, budgetBytes, frame);
  scene.Samplings = plan.Samplings;
  scene.OpacityLimit = plan.OpacityLimit;
  frame.ProbeSeconds = plan.ProbeSeconds;
  frame.StrideSeconds = plan.StrideSeconds;
  frame.Probes = plan.Probes;
  this->LimitText = LimitOf(plan, wish.Interacting ? wish.Interactive : wish.Still, tolerance, wish,
    HasOpaqueValues(scene.Transfer, field.Range()));
  // No pixel can be off by more; several times what probes are off can be.
  return std::min(plan.EstimatedError, 255.0);
}

/// Collective: the plan of the step that is drawn, or of its group while the series plays.
SamplingPlan ToleranceControl::PlanWithin(Communicator& communicator, DistributedField& field,
  const RayScene& scene, const Hash128& view, const SamplingWish& sampling, const Wish& wish,
  std::uint64_t budgetBytes, FrameStatistics& frame)
{
  DrawnField& drawn = field.Drawn();
  const auto planOf = [&](BrickSource* source, std::uint64_t bytes)
  {
    const RankShare share{ source, drawn.Zones(), bytes, ThreadPool::Process(),
      drawn.PieceOfCells() };
    return PlanDistributed(communicator, scene, share, sampling, frame);
  };
  const DrawnField::Place place = drawn.InSeries();
  if (!wish.PlansOfGroups || wish.Interacting || place.Steps == 1 || drawn.Source()->Hidden())
  {
    return planOf(drawn.Source(), budgetBytes);
  }
  const auto planStep = [&](double step) -> GroupPlans::End
  {
    if (step == place.Step)
    {
      return { planOf(drawn.Source(), budgetBytes), SignsOf(scene, *drawn.Source()) };
    }
    // Half of the room for bricks of that step, and half for those that are kept of this one.
    drawn.Source()->Kept().BeginPicture(
      PackedBrickCache::PartOf(budgetBytes / 2), PackedBrickCache::Picture::Part);
    std::unique_ptr<BrickSource> source;
    VisibleSigns signs;
    Collective(communicator,
      [&]
      {
        source = drawn.SourceOfStep(static_cast<int>(step)); // ends of groups are whole
        signs = SignsOf(scene, *source);
      });
    return { planOf(source.get(), budgetBytes / 2), signs };
  };
  Digest all;
  all.Add(view);
  all.Add(place.Field);
  all.Add(sampling.Tolerance);
  all.Add(sampling.CoarsestLevel);
  return this->Plans.at(static_cast<std::size_t>(wish.Eye))
    .Of(all.Get(), place.Step, place.Steps, SignsOf(scene, *drawn.Source()), planStep);
}

void ToleranceControl::PlanSteps(
  Communicator& communicator, DistributedField& field, RayScene& scene, const Aim& aim)
{
  if (!aim.Interacting)
  {
    return;
  }
  const auto step = static_cast<int>(aim.Coarseness);
  DrawnField& drawn = field.Drawn();
  const int coarsest = CoarsestLevelOf(drawn, scene);
  scene.Levels = drawn.Levels(scene.DomainCells.Size());
  // Projections combine in any order.
  const bool levels =
    scene.Blend.Mode != BlendMode::Composite || LevelsHaveOneOrder(scene, drawn.Zones(), coarsest);
  if (levels)
  {
    drawn.BringLevels(communicator, scene, coarsest);
  }
  this->CoarsestStepLevel =
    CommonLevel(communicator, drawn.Source(), scene.DomainCells, levels ? coarsest : 0);
  if (step > 0)
  {
    scene.Samplings = std::make_shared<const TileSamplings>(scene.Camera.ImageSize(),
      std::vector<RaySampling>{
        InteractiveLevels::SamplingOf(step, scene.SampleDistance, this->CoarsestStepLevel) });
  }
}

void ToleranceControl::PlanByScreen(Communicator& communicator, DistributedField& field,
  RayScene& scene, const Wish& wish, int coarsest)
{
  const int common = CommonLevel(communicator, field.Drawn().Source(), scene.DomainCells, coarsest);
  scene.Samplings = std::make_shared<const TileSamplings>(SamplingsByScreen(
    scene, wish.ScreenErrorPixels, scene.SampleDistance, common, !wish.FixedDistance));
}

void ToleranceControl::ForgetPlans()
{
  for (GroupPlans& plans : this->Plans)
  {
    plans.Forget();
  }
}

void ToleranceControl::FrameTook(const Wish& wish, double drawing, double showing)
{
  if (!wish.Interacting || wish.Between)
  {
    return;
  }
  if (this->BySteps)
  {
    // A step changes what drawing takes, and nothing else.
    const double left = std::max(wish.Seconds - showing, LeastForDrawing * wish.Seconds);
    this->Steps.FrameTook(drawing, left, this->CoarsestStepLevel);
    return;
  }
  const double seconds = drawing + showing;
  if (!(wish.Seconds > 0.0))
  {
    this->Slack = 1.0;
  }
  else if (seconds > wish.Seconds)
  {
    this->Slack = std::min(MostSlack, 2.0 * this->Slack);
  }
  else if (seconds < 0.3 * wish.Seconds)
  {
    // Half the tolerance takes up to twice the time: not so much that it swings back.
    this->Slack = std::max(1.0, 0.5 * this->Slack);
  }
}

} // namespace banyan
