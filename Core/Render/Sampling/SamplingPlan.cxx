// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/SamplingPlan.h"

#include "Base/Error.h"
#include "Base/Timer.h"
#include "Render/Levels/SharedPlans.h"
#include "Render/Sampling/ChosenPlan.h"
#include "Render/Sampling/ProbeSequence.h"
#include "Render/Sampling/SubsamplingProbe.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// What rays of probes that end early may leave away, as a share of the tolerance. It is little: a
/// ray that ends in one zone goes on in the next one, and what is left away then decides otherwise.
/// Plans would depend on the number of ranks.
constexpr double ShareOfProbeEnds = ShareOfEnds / 64.0;
/// Distances between samples go down to 2^-MostHalvings times the usual one.
constexpr int MostHalvings = 3;
/// They go up to 2^MostDoublings times it. Longer ones save nothing: frames then take what rays and
/// bricks do, and probes of such distances cost as much as what they save.
constexpr int MostDoublings = 3;
/// Without pictures of samples this close, times the usual distance, no tile is content.
constexpr double FewestSamples = 4.0;
/// The picture that judges strides is of a sampling whose errors leave so much of what is allowed,
/// in so many of the tiles: others keep their rays.
constexpr double ShareOfSubsamplingProbe = 0.75;
constexpr double TilesOfSubsamplingProbe = 0.9;

/// What single pixels of a shaded picture may be off, in 1/255, where a ray meets a place without a
/// gradient and the normal turns over from one sample to the next. They are so few that no probe
/// meets one. Measured of the standard scene S1: 0.10, 0.32, 1.08, 1.43 and 4.07 with a distance of
/// a quarter of a cell, half, one, two and four cells.
double ErrorOfNormals(double distanceInCells)
{
  return 1.1 * (distanceInCells < 1.0 ? std::pow(distanceInCells, 1.7) : distanceInCells);
}

/// The opacity at which rays end that may leave away a share of a tolerance.
float OpacityLimitFor(double tolerance, double share)
{
  return static_cast<float>(1.0 - std::min(tolerance, 32.0) * share / 255.0);
}

class Planner
{
public:
  Planner(const RayScene& scene, const SamplingWish& wish, const DrawProbe& draw)
    : Scene(scene)
    , DrawScene(draw)
    , Wish(wish)
    , Pictures(scene, draw)
    , Allowed(AllowedError(wish))
    , Choices(wish.Distance)
  {
  }

  SamplingPlan Plan()
  {
    const Timer timer;
    this->TryDistances(MostDoublings);
    if (!this->Pictures.SawSomething())
    {
      // Coarse levels and few samples may miss all that there is to see.
      this->Wish.CoarsestLevel = this->Wish.FinestProbeLevel;
      this->TryDistances(1);
    }
    SamplingPlan plan;
    int strideProbes = 0;
    double strideSeconds = 0.0;
    if (this->Pictures.SawSomething())
    {
      this->TryLevels();
      const Timer strides;
      strideProbes = this->TryStrides() ? 1 : 0;
      strideSeconds = strides.Seconds();
      plan = ChoosePlan({ std::make_shared<const PlanBasis>(
        PlanBasis{ this->Choices, this->Wish, this->Pictures.ImageSize() }) });
    }
    plan.OpacityLimit = OpacityLimitFor(this->Wish.Tolerance, ShareOfEnds);
    plan.Probes = strideProbes + this->Pictures.Count();
    plan.StrideSeconds = strideSeconds;
    plan.ProbeSeconds = timer.Seconds() - strideSeconds;
    return plan;
  }

private:
  /// At the coarsest level, which costs least: the errors of distances are much the same at all.
  /// @param doublings of the usual distance to begin with, at least 1
  void TryDistances(int doublings)
  {
    const bool levels = this->Wish.CoarsestLevel > 0;
    ProbeSequence pictures(this->Pictures);
    const Trial trial{ this->Wish.CoarsestLevel, std::ldexp(this->Wish.Distance, doublings),
      levels ? this->Wish.Distance : std::ldexp(this->Wish.Distance, -MostHalvings),
      (levels ? 0.5 : 1.0) * this->Allowed };
    this->Choices.Distances = this->DistancesOf(trial, pictures);
    this->ClosestDistance = this->Choices.Distances.back().Value;
  }

  struct Trial
  {
    int Level;
    double From;
    double To;
    double Allowed;
  };

  /// Ever smaller distances, until all tiles are content.
  std::vector<Choice> DistancesOf(const Trial& trial, ProbeSequence& pictures)
  {
    std::vector<Choice> choices;
    bool content = false;
    for (double distance = trial.From; distance >= trial.To && !content; distance *= 0.5)
    {
      pictures.Add(this->Pictures.Draw({ trial.Level, distance }));
      choices.push_back({ distance, {} });
      // Pictures with few samples may look alike because all of them miss what is thin.
      content = distance <= FewestSamples * this->Wish.Distance &&
                this->LeastErrorAt(distance) <= trial.Allowed &&
                pictures.LastIsWithin(trial.Allowed);
    }
    const std::vector<TileErrors> errors = pictures.AllErrors();
    for (std::size_t i = 0; i < choices.size(); ++i)
    {
      choices[i].Errors = errors[i];
      const double least = this->LeastErrorAt(choices[i].Value);
      for (double& error : choices[i].Errors.Tiles)
      {
        error = std::max(error, least);
      }
    }
    return choices;
  }

  /// What no picture of that distance is taken to be better than.
  double LeastErrorAt(double distance) const
  {
    return this->Scene.Shading.On ? ErrorOfNormals(distance / this->Wish.Distance) : 0.0;
  }

  /// Ever finer levels at the smallest distance that was needed, until all tiles are content.
  void TryLevels()
  {
    int level = this->Wish.CoarsestLevel;
    ProbeSequence pictures(this->Pictures);
    const double distance = this->ClosestDistance;
    pictures.Add(this->Pictures.Draw({ level, distance }));
    std::vector<Choice> choices{ { static_cast<double>(level), {} } };
    while (level > this->Wish.FinestProbeLevel && !pictures.LastIsWithin(0.5 * this->Allowed))
    {
      --level;
      pictures.Add(this->Pictures.Draw({ level, distance }));
      choices.push_back({ static_cast<double>(level), {} });
    }
    if (choices.size() == 1)
    {
      choices.front().Errors.Tiles.assign(this->Pictures.TileCount(), 0.0);
      this->Choices.Levels = std::move(choices);
      return;
    }
    if (level == 0)
    {
      pictures.LastIsExact();
    }
    const std::vector<TileErrors> errors = pictures.AllErrors();
    for (std::size_t i = 0; i < choices.size(); ++i)
    {
      choices[i].Errors = errors[i];
    }
    this->Choices.Levels = std::move(choices);
    const std::size_t needed = this->FinestThatIsNeeded();
    const bool last = needed + 1 == this->Choices.Levels.size();
    // No tile is drawn from a finer level than the one where distances are judged, unless what
    // distances leave of the tolerance asks for it.
    const std::vector<Choice> all = this->Choices.Levels;
    this->Choices.Levels.resize(needed + 1);
    this->TryDistancesAgain(static_cast<int>(this->Choices.Levels.back().Value));
    if (this->Choices.Distances.back().Errors.Largest() > 0.5 * this->Allowed)
    {
      this->Choices.Levels = all;
    }
    if (last && !pictures.LastIsWithin(0.5 * this->Allowed))
    {
      this->ExtrapolateLevels();
    }
  }

  /// Adds the levels that no probes were drawn from: cells of half the edge have at most half the
  /// error (a quarter, where the field is smooth), and the finest has none.
  void ExtrapolateLevels()
  {
    for (int level = static_cast<int>(this->Choices.Levels.back().Value) - 1;
         level >= this->Wish.FinestLevel; --level)
    {
      Choice finer{ static_cast<double>(level), this->Choices.Levels.back().Errors };
      for (double& error : finer.Errors.Tiles)
      {
        error = level > 0 ? 0.5 * error : 0.0;
      }
      this->Choices.Levels.push_back(std::move(finer));
    }
  }

  /// The first of the levels that is good enough for all tiles, or the last.
  std::size_t FinestThatIsNeeded() const
  {
    std::size_t finest = 0;
    while (finest + 1 < this->Choices.Levels.size() &&
           this->Choices.Levels[finest].Errors.Largest() > 0.5 * this->Allowed)
    {
      ++finest;
    }
    return finest;
  }

  /// Finer levels show what coarser ones leave out: distances are judged at the level that is
  /// needed, from the longest that may be good enough for some tile.
  void TryDistancesAgain(int level)
  {
    double longest = this->ClosestDistance;
    for (const Choice& choice : this->Choices.Distances)
    {
      if (choice.Errors.Smallest() <= this->Allowed)
      {
        longest = std::max(longest, choice.Value);
      }
    }
    ProbeSequence pictures(this->Pictures);
    // The finest level leaves all of it to distances.
    const Trial trial{ level,
      std::min(longest, std::ldexp(SamplingChoices::MostCellsPerStep * this->Wish.Distance, level)),
      std::ldexp(this->Wish.Distance, -MostHalvings), (level > 0 ? 0.5 : 1.0) * this->Allowed };
    this->Choices.Distances = this->DistancesOf(trial, pictures);
  }

  /// One small picture, drawn at little cost, tells which pixels need rays.
  /// @return whether it was drawn
  bool TryStrides()
  {
    Choice every{ 1.0, {} };
    every.Errors.Tiles.assign(this->Pictures.TileCount(), 0.0);
    this->Choices.Strides = { std::move(every) };
    if (this->Wish.LargestPixelStride == 1 ||
        !SubsamplingProbe::MaySay(this->Scene, this->Pictures.PixelsApart()) ||
        !SubsamplingProbe::MayPay(this->Pictures, this->Allowed))
    {
      return false;
    }
    SamplingChoices::Chosen sampling = this->Choices.CheapestForMost(
      TilesOfSubsamplingProbe, ShareOfSubsamplingProbe * this->Allowed);
    while (this->Choices.Levels[sampling.Level].Value < this->Wish.FinestProbeLevel)
    {
      --sampling.Level;
    }
    SubsamplingProbe probe(this->Scene, this->DrawScene, this->Allowed);
    RaySampling drawn = this->Choices.SamplingOf(sampling);
    drawn.Distance = std::max(drawn.Distance, this->Wish.Distance);
    probe.Draw(drawn);
    for (int stride = 2; stride <= this->Wish.LargestPixelStride; stride *= 2)
    {
      this->Choices.Strides.push_back({ static_cast<double>(stride), probe.ErrorsAt(stride) });
    }
    this->Choices.StridesAreThoseOf(sampling);
    return true;
  }

  const RayScene& Scene;
  const DrawProbe& DrawScene;
  SamplingWish Wish;
  ProbeImages Pictures;
  double Allowed;
  SamplingChoices Choices;
  double ClosestDistance = 1.0; ///< the smallest that was tried at the coarsest level
};

void Check(const SamplingWish& wish)
{
  if (!(wish.Tolerance > 0.0) || !std::isfinite(wish.Tolerance))
  {
    throw Error("The tolerance for errors of the picture must be above 0");
  }
  if (!(wish.Distance > 0.0) || !std::isfinite(wish.Distance))
  {
    throw Error("The sample distance must be above 0");
  }
  if (wish.CoarsestLevel < 0 || wish.FinestProbeLevel < 0 || wish.FinestLevel < 0 ||
      std::any_of(wish.FinestLevelOfTile.begin(), wish.FinestLevelOfTile.end(),
        [](int level) { return level < 0; }))
  {
    throw Error("There is no level below 0, the finest");
  }
  const int stride = wish.LargestPixelStride;
  if (stride < 1 || stride > RaySampling::LargestStride || (stride & (stride - 1)) != 0)
  {
    throw Error(
      "Every pixel, or every 2nd, 4th or 8th may have a ray: the largest stride is no other");
  }
}

} // namespace

SamplingPlan PlanSamplings(const RayScene& scene, SamplingWish wish, const DrawProbe& draw)
{
  Check(wish);
  const glm::ivec2 tiles = TileSamplings::TilesOf(scene.Camera.ImageSize());
  if (!wish.FinestLevelOfTile.empty() &&
      wish.FinestLevelOfTile.size() != static_cast<std::size_t>(tiles.x) * tiles.y)
  {
    throw Error("Each tile of the picture has its finest level, or none has");
  }
  const glm::ivec3 cells = scene.DomainCells.Size();
  const int longest = std::max({ cells.x, cells.y, cells.z });
  while (wish.CoarsestLevel > 0 &&
         (longest + (1 << wish.CoarsestLevel) - 1) >> wish.CoarsestLevel < wish.LeastCells)
  {
    --wish.CoarsestLevel;
  }
  if (!wish.FinestLevelOfTile.empty())
  {
    wish.FinestLevel = std::max(wish.FinestLevel,
      *std::min_element(wish.FinestLevelOfTile.begin(), wish.FinestLevelOfTile.end()));
  }
  // Of one level alone nothing could be told.
  const int secondCoarsest = std::max(0, wish.CoarsestLevel - 1);
  wish.FinestLevel = std::min(wish.FinestLevel, secondCoarsest);
  wish.FinestProbeLevel =
    std::max(wish.FinestLevel, std::min(wish.FinestProbeLevel, secondCoarsest));
  RayScene probes = scene;
  probes.Reused = nullptr;
  probes.Plans = std::make_shared<SharedPlans>();
  probes.OpacityLimit = OpacityLimitFor(wish.Tolerance, ShareOfProbeEnds);
  return Planner(probes, wish, draw).Plan();
}

} // namespace banyan
