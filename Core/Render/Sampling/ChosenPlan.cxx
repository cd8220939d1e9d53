// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/ChosenPlan.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

namespace banyan
{
namespace
{

using Bases = std::vector<std::shared_ptr<const PlanBasis>>;
using Chosen = SamplingChoices::Chosen;

/// Values of all lists, each once.
template <class Before>
std::vector<Choice> AllOf(
  const Bases& bases, std::vector<Choice> SamplingChoices::*list, Before&& before)
{
  std::vector<Choice> all;
  for (const auto& basis : bases)
  {
    for (const Choice& choice : basis->Choices.*list)
    {
      all.push_back({ choice.Value, {} });
    }
  }
  std::sort(all.begin(), all.end(),
    [&](const Choice& a, const Choice& b) { return before(a.Value, b.Value); });
  all.erase(std::unique(all.begin(), all.end(),
              [](const Choice& a, const Choice& b) { return a.Value == b.Value; }),
    all.end());
  return all;
}

class Chooser
{
public:
  explicit Chooser(const Bases& bases)
    : Scenes(bases)
    , Choices(bases.front()->Wish.Distance)
  {
    this->Choices.Levels = AllOf(bases, &SamplingChoices::Levels, std::greater<>());
    this->Choices.Distances = AllOf(bases, &SamplingChoices::Distances, std::greater<>());
    this->Choices.Strides = AllOf(bases, &SamplingChoices::Strides, std::less<>());
    for (const Chosen& chosen : this->Choices.CheapestFirst())
    {
      this->AddCandidate(chosen);
    }
  }

  SamplingPlan Choose() const
  {
    SamplingPlan plan;
    const SamplingWish& wish = this->Scenes.front()->Wish;
    const double allowed = AllowedError(wish);
    const glm::ivec2 size = this->Scenes.front()->ImageSize;
    const auto tiles = std::make_shared<TileSamplings>(size, this->Choices.Samplings());
    const glm::ivec2 count = tiles->Tiles();
    double largest = 0.0;
    for (int tile = 0; tile < count.x * count.y; ++tile)
    {
      const Chosen chosen = this->CheapestFor(static_cast<std::size_t>(tile), allowed);
      tiles->SetNumber({ tile % count.x, tile / count.x }, this->Choices.NumberOf(chosen));
      largest = std::max(largest, chosen.Error);
      plan.Extrapolated = plan.Extrapolated || this->IsExtrapolated(chosen);
      if (chosen.Error > allowed && plan.Limit != SamplingLimit::Distance)
      {
        plan.Limit = this->LevelIsHeld(static_cast<std::size_t>(tile)) ? SamplingLimit::Level
                                                                       : SamplingLimit::Distance;
      }
    }
    plan.Samplings = tiles;
    plan.EstimatedError = largest + wish.Tolerance * ShareOfEnds;
    return plan;
  }

private:
  /// A sampling, and per scene what its error is that of.
  struct Candidate
  {
    Chosen Sampling;
    double Level;
    std::vector<Chosen> InScenes;
  };

  void AddCandidate(const Chosen& chosen)
  {
    Candidate candidate{ chosen, this->Choices.Levels[chosen.Level].Value, {} };
    for (const auto& scene : this->Scenes)
    {
      const std::optional<Chosen> known =
        scene->Choices.NoFinerThan(this->Choices.SamplingOf(chosen));
      if (!known)
      {
        return;
      }
      candidate.InScenes.push_back(*known);
    }
    this->Candidates.push_back(std::move(candidate));
  }

  Chosen CheapestFor(std::size_t tile, double allowed) const
  {
    const int finest = this->FinestLevelOf(tile);
    Chosen closest;
    closest.Error = std::numeric_limits<double>::infinity();
    for (const Candidate& candidate : this->Candidates)
    {
      if (candidate.Level < finest)
      {
        continue;
      }
      Chosen chosen = candidate.Sampling;
      for (std::size_t i = 0; i < this->Scenes.size(); ++i)
      {
        chosen.Error =
          std::max(chosen.Error, this->Scenes[i]->Choices.ErrorOf(candidate.InScenes[i], tile));
      }
      if (chosen.Error <= allowed)
      {
        return chosen;
      }
      if (chosen.Error < closest.Error)
      {
        closest = chosen;
      }
    }
    return closest;
  }

  /// Two levels are left for each tile, as for the picture.
  int FinestLevelOf(std::size_t tile) const
  {
    int finest = std::numeric_limits<int>::max();
    for (const auto& scene : this->Scenes)
    {
      const std::vector<int>& levels = scene->Wish.FinestLevelOfTile;
      finest = std::min(finest,
        levels.empty() ? 0 : std::min(levels[tile], std::max(0, scene->Wish.CoarsestLevel - 1)));
    }
    return finest;
  }

  /// Whether a tile might have been drawn from a finer level but for the wish.
  bool LevelIsHeld(std::size_t tile) const
  {
    return this->FinestLevelOf(tile) > 0 ||
           std::any_of(this->Scenes.begin(), this->Scenes.end(),
             [](const auto& scene) { return scene->Wish.FinestLevel > 0; });
  }

  bool IsExtrapolated(const Chosen& chosen) const
  {
    const double level = this->Choices.Levels[chosen.Level].Value;
    return std::any_of(this->Scenes.begin(), this->Scenes.end(),
      [&](const auto& scene) { return level < scene->Wish.FinestProbeLevel; });
  }

  const Bases& Scenes;
  SamplingChoices Choices;           ///< of all scenes together; without errors
  std::vector<Candidate> Candidates; ///< the cheapest first
};

} // namespace

SamplingPlan ChoosePlan(const Bases& bases)
{
  SamplingPlan plan = Chooser(bases).Choose();
  plan.Basis = bases.size() == 1 ? bases.front() : nullptr;
  return plan;
}

SamplingPlan SharedPlan(const SamplingPlan& a, const SamplingPlan& b)
{
  SamplingPlan plan = !a.Basis ? b : !b.Basis ? a : ChoosePlan({ a.Basis, b.Basis });
  plan.OpacityLimit = std::max(a.OpacityLimit, b.OpacityLimit);
  plan.Probes = 0;
  plan.ProbeSeconds = 0.0;
  plan.StrideSeconds = 0.0;
  return plan;
}

} // namespace banyan
