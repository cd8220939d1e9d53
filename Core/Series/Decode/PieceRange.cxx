// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/PieceRange.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// Bounds of the length of a vector whose components lie in the given ranges; empty if one is.
ValueRange LengthOf(const std::vector<ValueRange>& components)
{
  double low = 0.0;
  double high = 0.0;
  for (const ValueRange& range : components)
  {
    if (range.Empty())
    {
      return {};
    }
    const double nearest = range.Low > 0.0 ? range.Low : (range.High < 0.0 ? -range.High : 0.0);
    const double farthest = std::max(std::abs(range.Low), std::abs(range.High));
    low += nearest * nearest;
    high += farthest * farthest;
  }
  return { std::sqrt(low), std::sqrt(high) };
}

ValueRange Hull(const ValueRange& a, const ValueRange& b)
{
  ValueRange hull = a;
  hull.Include(b);
  return hull;
}

ValueRange Common(const ValueRange& a, const ValueRange& b)
{
  const ValueRange common{ std::max(a.Low, b.Low), std::min(a.High, b.High) };
  return common.Empty() ? ValueRange{} : common;
}

} // namespace

std::vector<std::int64_t> BricksTouching(const BrickLayout& layout, const Box& samples)
{
  std::vector<std::int64_t> bricks;
  if (samples.Empty())
  {
    return bricks;
  }
  const Box box = layout.BricksCovering(samples);
  bricks.reserve(static_cast<std::size_t>(box.Count()));
  for (int z = box.Lo.z; z < box.Hi.z; ++z)
  {
    for (int y = box.Lo.y; y < box.Hi.y; ++y)
    {
      for (int x = box.Lo.x; x < box.Hi.x; ++x)
      {
        bricks.push_back(layout.IndexOf({ x, y, z }));
      }
    }
  }
  return bricks;
}

PieceRange RangeOfPiece(
  const SeriesFile& series, int step, int array, int level, const Box& samples)
{
  const BrickLayout layout = series.Layout(level);
  const std::vector<std::int64_t> bricks = BricksTouching(layout, samples);
  const int components = static_cast<int>(series.Index().Arrays.at(array).Components.size());

  std::vector<std::shared_ptr<const std::vector<BrickNode>>> nodes;
  nodes.reserve(static_cast<std::size_t>(components));
  for (int component = 0; component < components; ++component)
  {
    nodes.push_back(series.Nodes({ step, array, component, level }));
  }
  PieceRange result;
  result.Components.resize(components);
  std::vector<ValueRange> here(components);
  for (const std::int64_t brick : bricks)
  {
    result.Exact = result.Exact && samples.Contains(layout.SamplesOf(brick));
    for (int component = 0; component < components; ++component)
    {
      const BrickNode& node = (*nodes[component])[brick];
      here[component] = node.Range;
      result.Components[component].Include(node.Range);
      result.HasNonFinite = result.HasNonFinite || node.HasNonFinite;
    }
    result.Magnitude.Include(LengthOf(here));
  }
  if (components == 1)
  {
    result.Magnitude = result.Components[0];
    return result;
  }
  // A sample decodes to the same value at every level: the step's range bounds them all.
  const ValueRange& ofStep =
    series.Index().Arrays[array].Magnitudes[static_cast<std::size_t>(step)];
  const bool whole = level == 0 && samples.Contains(Box{ glm::ivec3(0), layout.Samples() });
  result.Magnitude = whole ? ofStep : Common(result.Magnitude, ofStep);
  return result;
}

PieceRange RangeBetween(const PieceRange& earlier, const PieceRange& later)
{
  PieceRange result;
  result.Exact = false;
  result.HasNonFinite = earlier.HasNonFinite || later.HasNonFinite;
  for (std::size_t c = 0; c < earlier.Components.size(); ++c)
  {
    const ValueRange& a = earlier.Components[c];
    const ValueRange& b = later.Components[c];
    result.Components.push_back(a.Empty() || b.Empty() ? ValueRange{} : Hull(a, b));
  }
  // Vectors that turn are shorter between than at either step.
  result.Magnitude =
    result.Components.size() == 1 ? result.Components[0] : LengthOf(result.Components);
  return result;
}

PieceRange RangeOfSeries(const SeriesFile& series, int array)
{
  PieceRange result;
  for (const ComponentIndex& component : series.Index().Arrays.at(array).Components)
  {
    // Neither outliers nor fill values are to spoil colours.
    result.Components.push_back(component.ReferenceRange());
    result.HasNonFinite = result.HasNonFinite || component.NonFiniteCount > 0;
  }
  if (result.Components.size() == 1)
  {
    result.Magnitude = result.Components[0];
  }
  for (const ValueRange& magnitude : series.Index().Arrays[array].Magnitudes)
  {
    result.Magnitude.Include(magnitude);
  }
  return result;
}

} // namespace banyan
