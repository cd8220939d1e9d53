// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Steps/TemporalEnhancement.h"

#include "Series/Format/SeriesIndex.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// A weighted geometric mean of a magnitude and the contrast in its units.
double Mean(const TemporalEnhancement& how, double magnitude, double contrast)
{
  if (how.Strength == 0.5)
  {
    return std::sqrt(magnitude) * std::sqrt(how.Scale * contrast);
  }
  return std::pow(magnitude, 1.0 - how.Strength) * std::pow(how.Scale * contrast, how.Strength);
}

} // namespace

TemporalEnhancement EnhancementFor(const ArrayIndex& array, double strength, int component)
{
  TemporalEnhancement how;
  how.Strength = strength;
  double squares = 0.0;
  double floors = 0.0;
  for (std::size_t c = 0; c < array.Components.size(); ++c)
  {
    const ComponentIndex& here = array.Components[c];
    if ((component >= 0 && c != static_cast<std::size_t>(component)) || here.Range.Empty())
    {
      continue;
    }
    const double largest = std::max(std::abs(here.Range.Low), std::abs(here.Range.High));
    squares += largest * largest;
    floors += here.ErrorBoundAbsolute * here.ErrorBoundAbsolute;
  }
  how.Scale = squares > 0.0 ? std::sqrt(squares) : 1.0;
  how.NoiseFloor = std::sqrt(floors);
  return how;
}

double EnhancedValue(
  const TemporalEnhancement& how, double now, const double* previous, const double* next)
{
  double change = 0.0;
  double size = 0.0;
  bool any = false;
  for (const double* other : { previous, next })
  {
    if (other && std::isfinite(*other))
    {
      change += std::abs(now - *other);
      size += std::abs(now) + std::abs(*other) + how.NoiseFloor;
      any = true;
    }
  }
  if (!any || !std::isfinite(now) || how.Strength == 0.0)
  {
    return now;
  }
  // Where all is zero, nothing moves.
  const double contrast = size > 0.0 ? std::min(how.Sensitivity * (change / size), 1.0) : 0.0;
  return std::copysign(Mean(how, std::abs(now), contrast), now);
}

ValueRange EnhancedRange(const TemporalEnhancement& how, const ValueRange& range)
{
  if (range.Empty())
  {
    return range;
  }
  // Bricks are rounded to float32.
  constexpr double above = 1.0 + 1.0 / (1 << 23);
  ValueRange result = range; // for steps without neighbours
  result.Include(std::copysign(Mean(how, std::abs(range.Low), 1.0) * above, range.Low));
  result.Include(std::copysign(Mean(how, std::abs(range.High), 1.0) * above, range.High));
  result.Include(0.0); // what rests
  if (range.Low <= 0.0 && range.High >= 0.0)
  {
    result.Include(Mean(how, 0.0, 1.0) * above);
  }
  return result;
}

} // namespace banyan
