// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/BetweenSteps.h"

#include "Base/LargePages.h"
#include "Base/ThreadPool.h"
#include "Series/Quantize/FillValues.h"

#include <algorithm>
#include <type_traits>

namespace banyan
{
namespace
{

/// Enough values for a thread to be worth waking.
constexpr std::int64_t ValuesAtOnce = 1 << 16;

template <class T>
T ValueBetween(T a, T b, double fraction)
{
  const double low = static_cast<double>(std::min(a, b));
  const double high = static_cast<double>(std::max(a, b));
  const double value =
    (1.0 - fraction) * static_cast<double>(a) + fraction * static_cast<double>(b);
  // Rounding may go beyond an end. NaN is neither below nor above.
  return a == b ? a : static_cast<T>(value < low ? low : (value > high ? high : value));
}

template <class T>
void InterpolateValues(const BetweenSteps& how, T* values, int stride, const T* later,
  std::int64_t count, const FillSet<T>& fills)
{
  for (std::int64_t i = 0; i < count; ++i)
  {
    T& value = values[i * stride];
    if (fills.Empty())
    {
      value = ValueBetween(value, later[i], how.Fraction);
    }
    else if (!fills.Holds(value))
    {
      value = fills.Holds(later[i]) ? later[i] : ValueBetween(value, later[i], how.Fraction);
    }
  }
}

} // namespace

StepAndFraction PlaceOfTime(const std::vector<double>& times, double time)
{
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  if (after == times.begin() || after == times.end())
  {
    return { after == times.begin() ? 0 : static_cast<int>(times.size()) - 1, 0.0 };
  }
  // Halves, because the time between may overflow.
  const double from = 0.5 * *(after - 1);
  const double fraction = (0.5 * time - from) / (0.5 * *after - from);
  constexpr double largest = 1.0 - 0x1p-53;
  return { static_cast<int>(after - times.begin()) - 1,
    fraction > 0.0 ? std::min(fraction, largest) : 0.0 };
}

bool AreInterpolated(ScalarType type)
{
  return type == ScalarType::Float32 || type == ScalarType::Float64;
}

void BetweenSteps::Interpolate(
  ScalarType type, void* values, int stride, const void* later, std::int64_t count) const
{
  Dispatch(type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      if constexpr (std::is_floating_point_v<T>)
      {
        InterpolateValues(*this, static_cast<T*>(values), stride, static_cast<const T*>(later),
          count, FillSet<T>(this->FillValues));
      }
      else
      {
        throw Error("Integers are not interpolated between steps, because they may be labels");
      }
    });
}

void ReadBetween(const SeriesFile& series, const FieldKey& field, double fraction,
  std::int64_t count, void* values, int stride, int component, const ReadStep& read)
{
  read(field, values, stride, component);
  if (fraction == 0.0 || count == 0)
  {
    return;
  }
  const ArrayIndex& array = series.Index().Arrays.at(static_cast<std::size_t>(field.Array));
  const BetweenSteps how{ fraction,
    array.Components.at(static_cast<std::size_t>(field.Component)).FillValues };
  const auto bytes = static_cast<std::int64_t>(SizeOf(array.Type));
  const auto later =
    NewInLargePages<unsigned char>(static_cast<std::size_t>(count) * SizeOf(array.Type));
  FieldKey next = field;
  ++next.Step;
  read(next, later.get(), 1, 0);
  auto* const first = static_cast<unsigned char*>(values) + component * bytes;
  ThreadPool::Process().ParallelFor((count + ValuesAtOnce - 1) / ValuesAtOnce,
    [&](std::int64_t part)
    {
      const std::int64_t from = part * ValuesAtOnce;
      how.Interpolate(array.Type, first + from * stride * bytes, stride, later.get() + from * bytes,
        std::min(ValuesAtOnce, count - from));
    });
}

} // namespace banyan
