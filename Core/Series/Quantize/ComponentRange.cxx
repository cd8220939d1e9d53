// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/ComponentRange.h"

#include "Base/ThreadPool.h"
#include "Series/Quantize/ValueArithmetic.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace banyan
{
namespace
{

template <class T>
ValueRange RangeOfTuples(const T* values, std::int64_t first, std::int64_t last, int components,
  const std::uint8_t* hidden)
{
  ValueRange range;
  for (std::int64_t i = first; i < last; ++i)
  {
    const T value = values[i * components];
    if ((hidden == nullptr || hidden[i] == 0) && std::isfinite(static_cast<double>(value)))
    {
      range.Include({ DoubleNotAbove(value), DoubleNotBelow(value) });
    }
  }
  return range;
}

} // namespace

ValueRange RangeOfComponent(ScalarType type, const void* values, std::int64_t tuples,
  int components, int component, ThreadPool& pool, const std::uint8_t* hidden)
{
  constexpr std::int64_t chunk = 65536;
  std::vector<ValueRange> parts(static_cast<std::size_t>((tuples + chunk - 1) / chunk));
  Dispatch(type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const T* start = static_cast<const T*>(values) + component;
      pool.ParallelFor(static_cast<std::int64_t>(parts.size()),
        [&](std::int64_t i)
        {
          parts[static_cast<std::size_t>(i)] =
            RangeOfTuples(start, i * chunk, std::min(tuples, (i + 1) * chunk), components, hidden);
        });
    });
  ValueRange range;
  for (const ValueRange& part : parts)
  {
    range.Include(part);
  }
  return range;
}

} // namespace banyan
