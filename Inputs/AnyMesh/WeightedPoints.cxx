// SPDX-License-Identifier: BSD-3-Clause
#include "AnyMesh/WeightedPoints.h"

#include "vtkPoints.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

using Source = WeightedPointMaker::Source;

/// Points that a collapsed cell repeats count once.
void MergeRepeated(std::vector<Source>& sources)
{
  std::sort(sources.begin(), sources.end());
  std::size_t kept = 0;
  for (std::size_t i = 1; i < sources.size(); ++i)
  {
    if (sources[i].first == sources[kept].first)
    {
      sources[kept].second += sources[i].second;
    }
    else
    {
      sources[++kept] = sources[i];
    }
  }
  sources.resize(kept + 1);
  // Nothing of the value of a point whose weights cancel is taken, not even that it is missing.
  sources.erase(std::remove_if(sources.begin(), sources.end(),
                  [](const Source& source) { return source.second == 0.0; }),
    sources.end());
}

} // namespace

WeightedPointMaker::WeightedPointMaker(vtkPoints* points)
  : Points(points)
  , Count(points->GetNumberOfPoints())
{
}

void WeightedPointMaker::Reserve(std::size_t points, std::size_t sources)
{
  this->Made.Ends.reserve(points);
  this->Made.Sources.reserve(sources);
  this->Made.Weights.reserve(sources);
  this->Known.reserve(points / 2); // faces have two cells
}

vtkIdType WeightedPointMaker::Add(std::vector<Source>& sources)
{
  if (sources.size() > 1)
  {
    MergeRepeated(sources);
  }
  if (sources.size() == 1 && sources[0].second == 1.0)
  {
    return sources[0].first;
  }
  static_assert(sizeof(Source) == 16, "hashed without gaps");
  const Hash128 key = HashOf(sources.data(), sources.size() * sizeof(Source));
  const auto next = this->Count + static_cast<vtkIdType>(this->Made.Count());
  const auto [place, isNew] = this->Known.try_emplace(key, next);
  if (isNew)
  {
    this->Keep(sources);
  }
  return place->second;
}

vtkIdType WeightedPointMaker::AddMean(const std::vector<vtkIdType>& points)
{
  this->Sources.clear();
  for (const vtkIdType point : points)
  {
    this->Sources.emplace_back(point, 1.0 / static_cast<double>(points.size()));
  }
  return this->Add(this->Sources);
}

/// Keeps a new point's sources in the order of their places.
void WeightedPointMaker::Keep(const std::vector<Source>& sources)
{
  this->Sorted.clear();
  for (const Source& source : sources)
  {
    std::array<double, 3> at{};
    this->Points->GetPoint(source.first, at.data());
    for (double& along : at)
    {
      // What is no number has no order.
      along = std::isnan(along) ? std::numeric_limits<double>::infinity() : along;
    }
    this->Sorted.emplace_back(at, source);
  }
  std::sort(this->Sorted.begin(), this->Sorted.end());
  for (const auto& each : this->Sorted)
  {
    this->Made.Sources.push_back(each.second.first);
    this->Made.Weights.push_back(each.second.second);
  }
  this->Made.Ends.push_back(this->Made.Sources.size());
}

} // namespace banyan
