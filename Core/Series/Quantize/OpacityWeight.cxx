// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/OpacityWeight.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{

OpacityFunction::OpacityFunction(std::vector<OpacityKnot> knots)
  : Points(std::move(knots))
{
  if (this->Points.empty())
  {
    throw Error("An opacity function needs at least one knot");
  }
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    const OpacityKnot& knot = this->Points[i];
    if (!std::isfinite(knot.Value) || !(knot.Opacity >= 0.0) || !(knot.Opacity <= 1.0))
    {
      throw Error("A knot of an opacity function must have a finite value and an opacity within 0 "
                  "and 1");
    }
    if (i > 0 && !(knot.Value > this->Points[i - 1].Value))
    {
      throw Error("The values of an opacity function's knots must increase strictly");
    }
  }
}

double OpacityFunction::operator()(double value) const
{
  if (value != value)
  {
    return 0.0;
  }
  const auto above = std::upper_bound(this->Points.begin(), this->Points.end(), value,
    [](double v, const OpacityKnot& knot) { return v < knot.Value; });
  if (above == this->Points.begin() || above == this->Points.end())
  {
    return above == this->Points.begin() ? above->Opacity : std::prev(above)->Opacity;
  }
  const OpacityKnot& below = *std::prev(above);
  // Halves, because the distance of two doubles may overflow.
  const double way = (0.5 * value - 0.5 * below.Value) / (0.5 * above->Value - 0.5 * below.Value);
  return below.Opacity + way * (above->Opacity - below.Opacity);
}

InvisibleIntervals::InvisibleIntervals(const OpacityFunction& opacity)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::vector<OpacityKnot>& knots = opacity.Knots();
  for (std::size_t first = 0; first < knots.size(); ++first)
  {
    if (knots[first].Opacity > 0)
    {
      continue;
    }
    std::size_t last = first;
    while (last + 1 < knots.size() && knots[last + 1].Opacity == 0)
    {
      ++last;
    }
    const double low = first == 0 ? -infinity : knots[first].Value;
    const double high = last + 1 == knots.size() ? infinity : knots[last].Value;
    if (low < high)
    {
      this->Ranges.push_back({ low, high });
    }
    first = last;
  }
}

int InvisibleIntervals::IntervalOf(double value) const
{
  const auto behind = std::upper_bound(this->Ranges.begin(), this->Ranges.end(), value,
    [](double v, const ValueRange& range) { return v < range.Low; });
  if (behind == this->Ranges.begin() || !(value <= std::prev(behind)->High))
  {
    return -1;
  }
  return static_cast<int>(behind - this->Ranges.begin()) - 1;
}

bool InvisibleIntervals::Invisible(double low, double high) const
{
  const int interval = this->IntervalOf(low);
  return low <= high && interval >= 0 &&
         high <= this->Ranges[static_cast<std::size_t>(interval)].High;
}

bool InvisibleIntervals::MayDecodeTo(double original, double decoded, double bound) const
{
  // False for NaN, and for the difference of equal infinities.
  const bool near = original == decoded || std::abs(original - decoded) <= bound;
  const bool up = original <= decoded;
  return near || this->Invisible(up ? original : decoded, up ? decoded : original);
}

} // namespace banyan
