#include "Render/SamplingPlan.h"

#include "Base/Error.h"
#include "Render/PilotPictures.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// The worst pixel of a tile against the worst of its pilots.
constexpr double Safety = 4.0;
/// Of the largest error anywhere, what a tile without pilots of its own is taken to have.
constexpr double ShareOfLargest = 1.0;
/// Of the tolerance, what rays that end early may leave away.
constexpr double ShareOfEnds = 0.125;
/// Halvings of the usual distance, and doublings beyond that of a level.
constexpr int MostHalvings = 3;
constexpr int MostDoublings = 3;
/// What a level costs beside its samples, as bricks are entered: in samples at the usual distance.
constexpr double CostOfBricks = 0.35;

/// A sampling that was tried, and the error that it is expected to have in each tile.
struct Tried
{
  RaySampling Sampling;
  double Cost = 0.0; ///< in samples at the usual distance
  TileErrors Errors;
};

class Planner
{
public:
  Planner(const RayScene& scene, const SamplingWish& wish, const DrawPilot& draw)
    : Wish(wish)
    , Pictures(scene, draw)
    , Allowed(wish.Tolerance * (1.0 - ShareOfEnds))
  {
  }

  SamplingPlan Plan()
  {
    this->GoFiner();
    SamplingPlan plan;
    plan.OpacityLimit = this->Pictures.OpacityLimit();
    if (this->Pictures.SawSomething())
    {
      this->GoFarther();
      this->Choose(plan);
    }
    plan.Pilots = this->Pictures.Count();
    return plan;
  }

private:
  /// The samplings that GoFiner tries, in order.
  std::vector<RaySampling> Ladder() const
  {
    std::vector<RaySampling> ladder;
    if (this->Wish.CoarsestLevel == 0)
    {
      for (int doublings = MostHalvings; doublings > 0; --doublings)
      {
        ladder.push_back({ 0, std::ldexp(this->Wish.Distance, doublings) });
      }
    }
    for (int level = this->Wish.CoarsestLevel; level > 0; --level)
    {
      ladder.push_back({ level, std::ldexp(this->Wish.Distance, level) });
    }
    for (int halvings = 0; halvings <= MostHalvings; ++halvings)
    {
      ladder.push_back({ 0, std::ldexp(this->Wish.Distance, -halvings) });
    }
    return ladder;
  }

  void GoFiner()
  {
    PilotPicture last;
    double differenceBefore = 0.0;
    for (const RaySampling& sampling : this->Ladder())
    {
      PilotPicture now = this->Pictures.Draw(sampling);
      if (!last.Pixels.empty())
      {
        const PilotErrors difference = this->Pictures.Difference(now, last);
        const double largest = difference.Largest();
        if (this->All.size() == 1)
        {
          // Of the first one nothing else is known.
          this->All.front().Errors = this->Pictures.ErrorsOf(difference, 2.0 * Safety, 2.0);
        }
        const bool known = this->All.size() > 1 && largest > 0.0;
        const double ratio = known ? std::clamp(differenceBefore / largest, 1.7, 4.0) : 2.0;
        const double part = 1.0 / (ratio - 1.0);
        this->Add(sampling,
          this->Pictures.ErrorsOf(difference, Safety * part, ShareOfLargest * part), now);
        this->Refine(difference);
        differenceBefore = largest;
        if (this->All.back().Errors.Largest() <= this->Allowed)
        {
          break;
        }
      }
      else
      {
        this->Add(sampling, {}, now);
      }
      last = std::move(now);
    }
  }

  /// Now that there is a finer picture, the one before it is judged by that one too.
  void Refine(const PilotErrors& difference)
  {
    TileErrors errors = this->Pictures.ErrorsOf(difference, Safety, ShareOfLargest);
    errors.Add(this->All.back().Errors);
    this->All[this->All.size() - 2].Errors.Lower(errors);
  }

  void Add(const RaySampling& sampling, TileErrors errors, const PilotPicture& picture)
  {
    const double samples = this->Wish.Distance / sampling.Distance;
    this->All.push_back(
      { sampling, samples + std::ldexp(CostOfBricks, -sampling.Level), std::move(errors) });
    this->Drawn.push_back(picture);
  }

  /// Tries longer distances at the levels that tiles would use as things stand.
  void GoFarther()
  {
    const std::size_t known = this->All.size();
    std::vector<bool> used(known, false);
    for (std::size_t tile = 0; tile < this->Pictures.TileCount(); ++tile)
    {
      used[this->CheapestFor(tile)] = true;
    }
    for (std::size_t i = 0; i < known; ++i)
    {
      const RaySampling from = this->All[i].Sampling;
      const bool isFirstOfLevel = i == 0 || this->All[i - 1].Sampling.Level != from.Level;
      if (!used[i] || !isFirstOfLevel)
      {
        continue;
      }
      for (int doublings = 1; doublings <= MostDoublings; ++doublings)
      {
        const RaySampling sampling{ from.Level, std::ldexp(from.Distance, doublings) };
        const PilotPicture picture = this->Pictures.Draw(sampling);
        const PilotErrors difference = this->Pictures.Difference(picture, this->Drawn[i]);
        TileErrors errors = this->Pictures.ErrorsOf(difference, Safety, ShareOfLargest);
        if (from.Level == 0 && doublings == 1)
        {
          // Twice as distant samples have at least twice the error, and differ by that of these.
          this->All[i].Errors.Lower(errors);
        }
        errors.Add(this->All[i].Errors);
        const bool hopeless = errors.Smallest() > this->Allowed;
        this->Add(sampling, std::move(errors), picture);
        if (hopeless)
        {
          break;
        }
      }
    }
  }

  /// The cheapest sampling that is good enough, or the one with the smallest error.
  std::size_t CheapestFor(std::size_t tile) const
  {
    std::size_t best = 0;
    double bestCost = std::numeric_limits<double>::infinity();
    std::size_t closest = 0;
    for (std::size_t i = 0; i < this->All.size(); ++i)
    {
      const double error = this->All[i].Errors.Of(tile);
      if (error <= this->Allowed && this->All[i].Cost < bestCost)
      {
        best = i;
        bestCost = this->All[i].Cost;
      }
      closest = error < this->All[closest].Errors.Of(tile) ? i : closest;
    }
    return std::isfinite(bestCost) ? best : closest;
  }

  void Choose(SamplingPlan& plan) const
  {
    std::vector<RaySampling> samplings;
    for (const Tried& tried : this->All)
    {
      samplings.push_back(tried.Sampling);
    }
    const auto tiles =
      std::make_shared<TileSamplings>(this->Pictures.ImageSize(), std::move(samplings));
    double largest = 0.0;
    for (std::size_t tile = 0; tile < this->Pictures.TileCount(); ++tile)
    {
      const std::size_t number = this->CheapestFor(tile);
      const glm::ivec2 position(static_cast<int>(tile % static_cast<std::size_t>(tiles->Tiles().x)),
        static_cast<int>(tile / static_cast<std::size_t>(tiles->Tiles().x)));
      tiles->SetNumber(position, static_cast<int>(number));
      largest = std::max(largest, this->All[number].Errors.Of(tile));
    }
    plan.Samplings = tiles;
    plan.EstimatedError = largest + this->Wish.Tolerance * ShareOfEnds;
  }

  SamplingWish Wish;
  PilotPictures Pictures;
  double Allowed;
  std::vector<Tried> All;
  std::vector<PilotPicture> Drawn; ///< of each of All
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
  if (wish.CoarsestLevel < 0)
  {
    throw Error("There is no level below 0, the finest");
  }
}

} // namespace

SamplingPlan PlanSamplings(const RayScene& scene, const SamplingWish& wish, const DrawPilot& draw)
{
  Check(wish);
  RayScene pilots = scene;
  pilots.OpacityLimit =
    static_cast<float>(1.0 - std::min(wish.Tolerance, 32.0) * ShareOfEnds / 255.0);
  return Planner(pilots, wish, draw).Plan();
}

} // namespace banyan
