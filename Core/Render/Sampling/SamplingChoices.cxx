// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/SamplingChoices.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace banyan
{
namespace
{

/// What a level costs beside its samples, as bricks are entered: in samples at the usual distance.
constexpr double CostOfBricks = 0.35;
/// What a ray costs before it has a sample, in the same, per cell that it goes through.
constexpr double CostOfRay = 0.05;

} // namespace

std::vector<SamplingChoices::Chosen> SamplingChoices::CheapestFirst() const
{
  std::vector<std::pair<double, Chosen>> all;
  for (std::size_t i = 0; i < this->Levels.size(); ++i)
  {
    for (std::size_t j = 0; j < this->Distances.size(); ++j)
    {
      for (std::size_t k = 0; k < this->Strides.size() && this->CanStep(i, j); ++k)
      {
        all.emplace_back(this->CostOf({ i, j, k }), Chosen{ i, j, k });
      }
    }
  }
  std::stable_sort(
    all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Chosen> order;
  order.reserve(all.size());
  for (const auto& [cost, chosen] : all)
  {
    order.push_back(chosen);
  }
  return order;
}

SamplingChoices::Chosen SamplingChoices::CheapestForMost(double share, double allowed) const
{
  const std::size_t tiles = this->Levels.front().Errors.Tiles.size();
  for (const Chosen& chosen : this->CheapestFirst())
  {
    std::size_t good = 0;
    for (std::size_t tile = 0; tile < tiles && chosen.Stride == 0; ++tile)
    {
      good += this->ErrorOf(chosen, tile) <= allowed ? 1 : 0;
    }
    if (chosen.Stride == 0 && static_cast<double>(good) >= share * static_cast<double>(tiles))
    {
      return chosen;
    }
  }
  return { this->Levels.size() - 1, this->Distances.size() - 1 };
}

std::vector<RaySampling> SamplingChoices::Samplings() const
{
  std::vector<RaySampling> samplings;
  for (std::size_t i = 0; i < this->Levels.size(); ++i)
  {
    for (std::size_t j = 0; j < this->Distances.size(); ++j)
    {
      for (std::size_t k = 0; k < this->Strides.size(); ++k)
      {
        samplings.push_back(this->SamplingOf({ i, j, k }));
      }
    }
  }
  return samplings;
}

int SamplingChoices::NumberOf(const Chosen& chosen) const
{
  const std::size_t pair = chosen.Level * this->Distances.size() + chosen.Distance;
  return static_cast<int>(pair * this->Strides.size() + chosen.Stride);
}

RaySampling SamplingChoices::SamplingOf(const Chosen& chosen) const
{
  return { static_cast<int>(this->Levels[chosen.Level].Value),
    this->Distances[chosen.Distance].Value, static_cast<int>(this->Strides[chosen.Stride].Value) };
}

std::optional<SamplingChoices::Chosen> SamplingChoices::NoFinerThan(
  const RaySampling& sampling) const
{
  const auto lastFrom = [](const std::vector<Choice>& list, double value)
  {
    return static_cast<std::size_t>(std::find_if(list.begin(), list.end(),
                                      [&](const Choice& choice) { return choice.Value < value; }) -
                                    list.begin());
  };
  const std::size_t level = lastFrom(this->Levels, sampling.Level);
  const std::size_t distance = lastFrom(this->Distances, sampling.Distance);
  const auto stride = std::find_if(this->Strides.begin(), this->Strides.end(),
    [&](const Choice& choice) { return choice.Value == sampling.PixelStride; });
  if (level == 0 || distance == 0 || stride == this->Strides.end())
  {
    return std::nullopt;
  }
  return Chosen{ level - 1, distance - 1,
    static_cast<std::size_t>(stride - this->Strides.begin()) };
}

bool SamplingChoices::CanStep(std::size_t level, std::size_t distance) const
{
  const double cell = std::ldexp(this->UsualDistance, static_cast<int>(this->Levels[level].Value));
  return this->Distances[distance].Value <= MostCellsPerStep * cell;
}

/// In samples at the usual distance, per cell that a ray goes through, for each pixel.
double SamplingChoices::CostOf(const Chosen& chosen) const
{
  const RaySampling sampling = this->SamplingOf(chosen);
  const double alongRay =
    this->UsualDistance / sampling.Distance + std::ldexp(CostOfBricks, -sampling.Level) + CostOfRay;
  return alongRay / (sampling.PixelStride * sampling.PixelStride);
}

double SamplingChoices::ErrorOf(const Chosen& chosen, std::size_t tile) const
{
  double level = this->Levels[chosen.Level].Errors.Of(tile);
  if (chosen.Stride > 0 && this->SubsamplingProbe)
  {
    level = std::max(level, this->Levels[this->SubsamplingProbe->Level].Errors.Of(tile));
  }
  return level + this->Distances[chosen.Distance].Errors.Of(tile) +
         this->Strides[chosen.Stride].Errors.Of(tile);
}

} // namespace banyan
