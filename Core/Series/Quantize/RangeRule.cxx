// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/RangeRule.h"

#include "Base/Error.h"
#include "Base/ForEachScalarType.h"
#include "Series/Quantize/Transform.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace banyan
{
namespace
{

/// The T next above (or below) another one, or the same when there is none.
template <class T>
T Neighbour(T value, bool above)
{
  using Limits = std::numeric_limits<T>;
  if constexpr (std::is_floating_point_v<T>)
  {
    return std::nextafter(value, above ? Limits::max() : Limits::lowest());
  }
  else
  {
    const T limit = above ? Limits::max() : Limits::lowest();
    return value == limit ? value : static_cast<T>(above ? value + 1 : value - 1);
  }
}

/// Least and greatest T within a range of doubles.
template <class T>
struct Ends
{
  T Low;
  T High;

  explicit Ends(const ValueRange& range)
  {
    const double least = static_cast<double>(std::numeric_limits<T>::lowest());
    const double greatest = static_cast<double>(std::numeric_limits<T>::max());
    this->Low = ValueFromReal<T>(std::max(range.Low, least));
    this->High = ValueFromReal<T>(std::min(range.High, greatest));
    if (range.Low > static_cast<double>(this->Low))
    {
      this->Low = Neighbour(this->Low, true);
    }
    if (range.High < static_cast<double>(this->High))
    {
      this->High = Neighbour(this->High, false);
    }
    const bool within =
      static_cast<double>(this->Low) >= range.Low && static_cast<double>(this->High) <= range.High;
    if (!within || this->Low > this->High)
    {
      throw Error("No value of the array's type lies within the range that values are clamped to");
    }
  }
};

} // namespace

void RangeRule::Check() const
{
  if (this->From == Source::Percentiles &&
      (!(this->LowShare >= 0.0) || !(this->LowShare < this->HighShare) ||
        !(this->HighShare <= 1.0)))
  {
    throw Error("The percentiles of a range must lie within 0 and 100 %, the low one first");
  }
  if (this->From == Source::Given &&
      (this->Given.Empty() || !std::isfinite(this->Given.Low) || !std::isfinite(this->Given.High)))
  {
    throw Error("A given range must be finite, the low end first");
  }
}

ValueRange ChooseRange(const RangeRule& rule, const ValueHistogram& values)
{
  rule.Check();
  if (rule.From == RangeRule::Source::Given)
  {
    return rule.Given;
  }
  if (rule.From == RangeRule::Source::Data || values.FiniteCount() == 0)
  {
    return values.Range();
  }
  return { values.Percentile(rule.LowShare).Low, values.Percentile(rule.HighShare).High };
}

template <class T>
std::int64_t ClampToRange(const ValueRange& range, const T* values, std::size_t count, T* clamped)
{
  if (range.Empty())
  {
    std::copy(values, values + count, clamped);
    return 0;
  }
  const Ends<T> ends(range);
  std::int64_t replaced = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const T value = values[i];
    bool outside = value < ends.Low || value > ends.High; // false for NaN
    if constexpr (std::is_floating_point_v<T>)
    {
      outside = outside && std::abs(value) <= std::numeric_limits<T>::max();
    }
    clamped[i] = outside ? (value < ends.Low ? ends.Low : ends.High) : value;
    replaced += outside ? 1 : 0;
  }
  return replaced;
}

#define BANYAN_INSTANTIATE(T)                                                                      \
  template std::int64_t ClampToRange<T>(const ValueRange&, const T*, std::size_t, T*)
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
