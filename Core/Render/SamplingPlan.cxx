#include "Render/SamplingPlan.h"

#include "Base/Error.h"
#include "Render/PilotSequence.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// Of the tolerance, what rays that end early may leave away.
constexpr double ShareOfEnds = 0.125;
/// Distances between samples go from 2^MostDoublings times the usual one to 2^-MostHalvings times.
constexpr int MostDoublings = 3;
constexpr int MostHalvings = 3;
/// What a level costs beside its samples, as bricks are entered: in samples at the usual distance.
constexpr double CostOfBricks = 0.35;

/// The error that a choice adds to those of others.
struct Choice
{
  double Value = 0.0; ///< a distance or a level
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
    this->TryDistances(MostDoublings);
    if (!this->Pictures.SawSomething())
    {
      // Coarse levels and few samples may miss all that there is to see.
      this->Wish.CoarsestLevel = this->Wish.FinestPilotLevel;
      this->TryDistances(1);
    }
    SamplingPlan plan;
    plan.OpacityLimit = this->Pictures.OpacityLimit();
    if (this->Pictures.SawSomething())
    {
      this->TryLevels();
      this->Choose(plan);
    }
    plan.Pilots = this->Pictures.Count();
    return plan;
  }

private:
  /// At the coarsest level, which costs least: the errors of distances are much the same at all.
  /// @param doublings of the usual distance to begin with, at least 1
  void TryDistances(int doublings)
  {
    const bool levels = this->Wish.CoarsestLevel > 0;
    PilotSequence pictures(this->Pictures);
    const Trial trial{ this->Wish.CoarsestLevel, std::ldexp(this->Wish.Distance, doublings),
      levels ? this->Wish.Distance : std::ldexp(this->Wish.Distance, -MostHalvings),
      (levels ? 0.5 : 1.0) * this->Allowed };
    this->Distances = this->DistancesOf(trial, pictures);
    this->Closest = pictures.Last();
  }

  struct Trial
  {
    int Level;
    double From;
    double To;
    double Allowed;
    double KnownDistance = 0.0;
    const PilotPicture* Known = nullptr; ///< need not be drawn again
  };

  /// Ever smaller distances, until all tiles are content.
  std::vector<Choice> DistancesOf(const Trial& trial, PilotSequence& pictures)
  {
    std::vector<Choice> choices;
    bool content = false;
    for (double distance = trial.From; distance >= trial.To; distance *= 0.5)
    {
      const bool known = trial.Known && distance == trial.KnownDistance;
      pictures.Add(known ? *trial.Known : this->Pictures.Draw({ trial.Level, distance }));
      choices.push_back({ distance, {} });
      // One more costs little, and may show that larger distances will do.
      if (content)
      {
        break;
      }
      content = pictures.LastIsWithin(trial.Allowed);
    }
    const std::vector<TileErrors> errors = pictures.AllErrors();
    for (std::size_t i = 0; i < choices.size(); ++i)
    {
      choices[i].Errors = errors[i];
    }
    return choices;
  }

  /// Ever finer levels at the smallest distance that was needed, until all tiles are content.
  void TryLevels()
  {
    int level = this->Wish.CoarsestLevel;
    PilotSequence pictures(this->Pictures);
    pictures.Add(this->Closest);
    std::vector<Choice> choices{ { static_cast<double>(level), {} } };
    const double distance = this->Distances.back().Value;
    while (level > this->Wish.FinestPilotLevel && !pictures.LastIsWithin(0.5 * this->Allowed))
    {
      --level;
      pictures.Add(this->Pictures.Draw({ level, distance }));
      choices.push_back({ static_cast<double>(level), {} });
    }
    if (choices.size() == 1)
    {
      choices.front().Errors.Tiles.assign(this->Pictures.TileCount(), 0.0);
      this->Levels = std::move(choices);
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
    this->Levels = std::move(choices);
    this->TryDistancesAgain(level, pictures.Last());
    if (!pictures.LastIsWithin(0.5 * this->Allowed))
    {
      this->ExtrapolateLevels();
    }
  }

  /// Adds the levels that no pilots were drawn from: cells of half the edge have at most half the
  /// error (a quarter, where the field is smooth), and the finest has none.
  void ExtrapolateLevels()
  {
    for (int level = static_cast<int>(this->Levels.back().Value) - 1; level >= 0; --level)
    {
      Choice finer{ static_cast<double>(level), this->Levels.back().Errors };
      for (double& error : finer.Errors.Tiles)
      {
        error = level > 0 ? 0.5 * error : 0.0;
      }
      this->Levels.push_back(std::move(finer));
    }
  }

  /// Finer levels show what coarser ones leave out: distances are judged there once more.
  /// @param known the finest level at the smallest distance so far
  void TryDistancesAgain(int level, const PilotPicture& known)
  {
    PilotSequence pictures(this->Pictures);
    Trial trial{ level, std::ldexp(this->Wish.Distance, MostDoublings),
      std::ldexp(this->Wish.Distance, -MostHalvings), 0.5 * this->Allowed };
    trial.KnownDistance = this->Distances.back().Value;
    trial.Known = &known;
    this->Distances = this->DistancesOf(trial, pictures);
  }

  struct Chosen
  {
    std::size_t Level = 0;    ///< position in Levels
    std::size_t Distance = 0; ///< position in Distances
    double Error = 0.0;
  };

  /// The cheapest sampling that is good enough, or the one with the smallest error.
  Chosen CheapestFor(std::size_t tile) const
  {
    Chosen best;
    double bestCost = std::numeric_limits<double>::infinity();
    Chosen closest;
    closest.Error = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < this->Levels.size(); ++i)
    {
      for (std::size_t j = 0; j < this->Distances.size(); ++j)
      {
        const double error = this->Levels[i].Errors.Of(tile) + this->Distances[j].Errors.Of(tile);
        const double cost = this->Wish.Distance / this->Distances[j].Value +
                            std::ldexp(CostOfBricks, -static_cast<int>(this->Levels[i].Value));
        if (error <= this->Allowed && cost < bestCost)
        {
          best = { i, j, error };
          bestCost = cost;
        }
        if (error < closest.Error)
        {
          closest = { i, j, error };
        }
      }
    }
    return std::isfinite(bestCost) ? best : closest;
  }

  void Choose(SamplingPlan& plan) const
  {
    std::vector<RaySampling> samplings;
    for (const Choice& level : this->Levels)
    {
      for (const Choice& distance : this->Distances)
      {
        samplings.push_back({ static_cast<int>(level.Value), distance.Value });
      }
    }
    const auto tiles =
      std::make_shared<TileSamplings>(this->Pictures.ImageSize(), std::move(samplings));
    double largest = 0.0;
    for (std::size_t tile = 0; tile < this->Pictures.TileCount(); ++tile)
    {
      const Chosen chosen = this->CheapestFor(tile);
      const glm::ivec2 position(static_cast<int>(tile % static_cast<std::size_t>(tiles->Tiles().x)),
        static_cast<int>(tile / static_cast<std::size_t>(tiles->Tiles().x)));
      tiles->SetNumber(
        position, static_cast<int>(chosen.Level * this->Distances.size() + chosen.Distance));
      largest = std::max(largest, chosen.Error);
    }
    plan.Samplings = tiles;
    plan.EstimatedError = largest + this->Wish.Tolerance * ShareOfEnds;
  }

  SamplingWish Wish;
  PilotPictures Pictures;
  double Allowed;
  std::vector<Choice> Distances; ///< from the largest on
  std::vector<Choice> Levels;    ///< from the coarsest on
  PilotPicture Closest;          ///< of the coarsest level and the smallest distance
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
  if (wish.CoarsestLevel < 0 || wish.FinestPilotLevel < 0)
  {
    throw Error("There is no level below 0, the finest");
  }
}

} // namespace

SamplingPlan PlanSamplings(const RayScene& scene, SamplingWish wish, const DrawPilot& draw)
{
  Check(wish);
  const glm::ivec3 cells = scene.DomainCells.Size();
  const int longest = std::max({ cells.x, cells.y, cells.z });
  while (wish.CoarsestLevel > 0 && longest >> wish.CoarsestLevel < wish.LeastCells)
  {
    --wish.CoarsestLevel;
  }
  // Of one level alone nothing could be told.
  wish.FinestPilotLevel = std::min(wish.FinestPilotLevel, std::max(0, wish.CoarsestLevel - 1));
  RayScene pilots = scene;
  pilots.OpacityLimit =
    static_cast<float>(1.0 - std::min(wish.Tolerance, 32.0) * ShareOfEnds / 255.0);
  return Planner(pilots, wish, draw).Plan();
}

} // namespace banyan
