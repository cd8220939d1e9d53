// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/FillValues.h"

#include "Base/ForEachScalarType.h"
#include "Series/Quantize/Histogram.h"
#include "Series/Quantize/RangeRule.h"
#include "Series/Quantize/Transform.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace banyan
{
namespace
{

/// Values that are looked at a time.
constexpr std::int64_t Tile = 4096;

} // namespace

template <class T>
FillSet<T>::FillSet(const std::vector<double>& values)
{
  for (const double value : values)
  {
    const T fill = ValueFromReal<T>(value);
    const bool stands = std::is_floating_point_v<T> ? std::isfinite(static_cast<double>(fill))
                                                    : static_cast<double>(fill) == value;
    if (stands)
    {
      this->Values.push_back(fill);
    }
  }
}

void CountComponent(ScalarType type, const void* values, std::int64_t tuples, int components,
  int component, const std::vector<double>& fillValues, ValueHistogram& histogram,
  const std::uint8_t* hidden)
{
  Dispatch(type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const FillSet<T> fills(fillValues);
      const T* from = static_cast<const T*>(values) + component;
      T packed[Tile];
      std::size_t count = 0;
      for (std::int64_t i = 0; i < tuples; ++i)
      {
        const T value = from[i * components];
        packed[count] = value;
        count += fills.Holds(value) || (hidden != nullptr && hidden[i] != 0) ? 0 : 1;
        if (count == Tile)
        {
          histogram.Add(packed, count);
          count = 0;
        }
      }
      histogram.Add(packed, count);
    });
}

std::int64_t ClampComponent(ScalarType type, const void* values, int stride, std::int64_t count,
  const ValueRange& range, const std::vector<double>& fillValues, const std::uint8_t* hidden,
  void* clamped)
{
  std::int64_t replaced = 0;
  Dispatch(type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const FillSet<T> fills(fillValues);
      const T* from = static_cast<const T*>(values);
      T* to = static_cast<T*>(clamped);
      for (std::int64_t i = 0; i < count; ++i)
      {
        to[i] = from[i * stride];
      }
      replaced = ClampToRange(range, to, static_cast<std::size_t>(count), to);
      for (std::int64_t i = 0; i < count && (!fills.Empty() || hidden != nullptr); ++i)
      {
        const T original = from[i * stride];
        const bool stays = fills.Holds(original) || (hidden != nullptr && hidden[i] != 0);
        if (stays && std::memcmp(&to[i], &original, sizeof(T)) != 0)
        {
          to[i] = original;
          --replaced;
        }
      }
    });
  return replaced;
}

#define BANYAN_INSTANTIATE(T) template class FillSet<T>
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
