// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Frame/ToleranceControl.h"

#include "Base/ThreadPool.h"
#include "Parallel/Balance/LevelZones.h"
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
    text = wish.Interacting
             ? "Interactive Frame Seconds were exceeded: the tolerance is larger than "
               "the one that was set. "
             : "The picture is still being refined. ";
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

} // namespace

double ToleranceControl::Plan(Communicator& communicator, DistributedField& field, RayScene& scene,
  const Wish& wish, std::uint64_t budgetBytes, FrameStatistics& frame)
{
  this->LimitText.clear();
  this->BySteps = !wish.KeepsTolerance;
  if (this->BySteps)
  {
    this->PlanSteps(communicator, field, scene, wish);
    return 0.0;
  }
  DrawnField& drawn = field.Drawn();
  const int coarsest = drawn.IsMesh() ? CoarsestMeshLevel : CoarsestLevel;
  scene.LevelsShareCells = drawn.IsMesh();
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
  if (wish.Interacting)
  {
    this->Passes.at(wish.Eye).Interacted();
  }
  const double tolerance = wish.Interacting
                             ? wish.Interactive * this->Slack
                             : this->StillTolerance(communicator, field, scene, wish.Eye,
                                 { wish.Passes, wish.Still, wish.Interactive });
  SamplingWish sampling{ tolerance, scene.SampleDistance, levels ? coarsest : 0 };
  if (drawn.IsMesh() && wish.MaxElementsPerPixel > 0.0)
  {
    sampling.FinestLevelOfTile =
      FinestLevelsOfTiles(scene, wish.MaxElementsPerPixel, sampling.CoarsestLevel);
  }
  sampling.StaysInMemory = wish.Interacting && wish.Seconds > 0.0;
  const SamplingPlan plan = PlanDistributed(communicator, scene,
    { drawn.Source(), drawn.Zones(), budgetBytes, ThreadPool::Process() }, sampling, frame);
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

/// Collective: the tolerance of the next picture of one eye, the same on all ranks.
double ToleranceControl::StillTolerance(Communicator& communicator, const DistributedField& field,
  const RayScene& scene, int eye, const RefinementPasses::Wish& wish)
{
  RefinementPasses& passes = this->Passes.at(static_cast<std::size_t>(eye));
  if (!wish.Passes)
  {
    return passes.ToleranceOf(false, wish);
  }
  const bool changed = passes.SceneChanged(scene, field.Version());
  return passes.ToleranceOf(AllMax(communicator, changed ? 1.0 : 0.0) > 0.0, wish);
}

void ToleranceControl::PlanSteps(
  Communicator& communicator, DistributedField& field, RayScene& scene, const Wish& wish)
{
  if (wish.Interacting)
  {
    this->Passes.at(wish.Eye).Interacted();
  }
  // A pass divides its tolerance by four: so each takes one step. Still pictures leave out no rays:
  // where a coarse level is far off, pixels between rays may be better by chance.
  const double tolerance =
    wish.Interacting
      ? 0.0
      : this->StillTolerance(communicator, field, scene, wish.Eye,
          { wish.Passes, 1.0,
            std::ldexp(1.0, 2 * std::min(this->Steps.Step(), this->CoarsestStepLevel)) });
  const int step = wish.Interacting ? this->Steps.Step() : std::ilogb(tolerance) / 2;
  if (!wish.Interacting && step == 0)
  {
    return;
  }
  DrawnField& drawn = field.Drawn();
  const int coarsest = drawn.IsMesh() ? CoarsestMeshLevel : CoarsestLevel;
  scene.LevelsShareCells = drawn.IsMesh();
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

bool ToleranceControl::RefineNext()
{
  const bool first = this->Passes[0].Next();
  const bool second = this->Passes[1].Next();
  return first || second;
}

void ToleranceControl::FrameTook(const Wish& wish, double seconds)
{
  if (!wish.Interacting)
  {
    return;
  }
  if (this->BySteps)
  {
    this->Steps.FrameTook(seconds, wish.Seconds, this->CoarsestStepLevel);
    return;
  }
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
