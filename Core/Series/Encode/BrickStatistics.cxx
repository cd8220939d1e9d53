// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/BrickStatistics.h"

#include "Base/ForEachScalarType.h"
#include "Series/Quantize/ValueArithmetic.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace banyan
{
namespace
{

template <class T>
bool IsFinite(T value)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    return std::abs(value) <= std::numeric_limits<T>::max();
  }
  else
  {
    (void)value;
    return true;
  }
}

template <class T>
bool AllBitsEqual(const T* values, std::size_t count)
{
  return std::memcmp(values, values + 1, (count - 1) * sizeof(T)) == 0;
}

} // namespace

template <class T>
BrickSummary Summarize(const T* decoded, std::size_t count)
{
  BrickSummary summary;
  T low = std::numeric_limits<T>::max();
  T high = std::numeric_limits<T>::lowest();
  std::size_t finite = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const bool good = IsFinite(decoded[i]);
    finite += good ? 1 : 0;
    low = good && decoded[i] < low ? decoded[i] : low;
    high = good && decoded[i] > high ? decoded[i] : high;
  }
  summary.HasNonFinite = finite < count;
  if (finite == 0)
  {
    return summary;
  }
  summary.Range = { DoubleNotAbove(low), DoubleNotBelow(high) };
  if (finite == count && summary.Range.Low == summary.Range.High && AllBitsEqual(decoded, count))
  {
    summary.Uniform = true;
    summary.Range.Low = summary.Range.High = static_cast<double>(decoded[0]); // keeps -0
  }
  return summary;
}

#define BANYAN_INSTANTIATE(T) template BrickSummary Summarize<T>(const T*, std::size_t)
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
