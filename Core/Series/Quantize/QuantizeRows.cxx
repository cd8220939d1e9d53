// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/QuantizeRows.h"

#include <algorithm>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Series/Quantize/QuantizeRows.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// A vector has as many lanes as the processor has, but not more than sums have.
using Reals = hn::CappedTag<double, RowErrors::Lanes>;
using Real = hn::Vec<Reals>;

template <class T>
HWY_INLINE Real LoadReals(const T* from)
{
  const Reals real;
  const hn::Rebind<T, Reals> own;
  if constexpr (sizeof(T) == sizeof(double))
  {
    return hn::LoadU(own, from);
  }
  else
  {
    return hn::PromoteTo(real, hn::LoadU(own, from));
  }
}

template <class Number>
HWY_INLINE Real LoadNumbers(const Number* from)
{
  const Reals real;
  const hn::Rebind<std::int32_t, Reals> whole;
  const hn::Rebind<Number, Reals> own;
  if constexpr (sizeof(Number) == sizeof(std::int32_t))
  {
    return hn::PromoteTo(real, hn::LoadU(own, from));
  }
  else
  {
    return hn::PromoteTo(real, hn::PromoteTo(whole, hn::LoadU(own, from)));
  }
}

template <class Number>
HWY_INLINE void StoreNumbers(Real rounded, Number* to)
{
  const hn::Rebind<std::int32_t, Reals> whole;
  const hn::Rebind<Number, Reals> own;
  const auto numbers = hn::DemoteTo(whole, rounded);
  if constexpr (sizeof(Number) == sizeof(std::int32_t))
  {
    hn::StoreU(numbers, own, to);
  }
  else
  {
    hn::StoreU(hn::DemoteTo(own, numbers), own, to);
  }
}

/// Calls body(values, numbers) for groups of as many as sums have lanes. At the row's end both are
/// copies, which repeat its last pair.
template <class T, class Number, class Body>
HWY_INLINE void ForEachGroup(const T* values, Number* numbers, std::size_t count, const Body& body)
{
  constexpr std::size_t lanes = RowErrors::Lanes;
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes)
  {
    body(values + i, numbers + i, lanes);
  }
  if (i < count)
  {
    T lastValues[lanes];
    std::remove_const_t<Number> lastNumbers[lanes];
    for (std::size_t lane = 0; lane < lanes; ++lane)
    {
      lastValues[lane] = values[std::min(i + lane, count - 1)];
      lastNumbers[lane] = numbers[std::min(i + lane, count - 1)];
    }
    body(lastValues, lastNumbers, count - i);
    if constexpr (!std::is_const_v<Number>)
    {
      std::copy_n(lastNumbers, count - i, numbers + i);
    }
  }
}

/// Calls body(values, numbers) for each row.
template <class T, class Number, class Body>
HWY_INLINE void ForEachRow(const QuantizedRows<T, Number>& rows, const Body& body)
{
  T copy[64];
  for (int slice = 0; slice < rows.Slices; ++slice)
  {
    for (int row = 0; row < rows.Rows; ++row)
    {
      const T* values = rows.Values + slice * rows.ValueSlice + row * rows.ValueRow;
      // A row is a line of the cache or two, far from the next one: ask in time.
      __builtin_prefetch(values + rows.Next);
      if (rows.Gap != 1)
      {
        for (int i = 0; i < rows.Count; ++i)
        {
          copy[i] = values[i * rows.Gap];
        }
        values = copy;
      }
      body(values, rows.Numbers + slice * rows.NumberSlice + row * rows.NumberRow);
    }
  }
}

template <class T, class Number>
bool Numbers(const QuantizedRows<T, Number>& rows, const LatticeScale& scale)
{
  const Reals real;
  const Real origin = hn::Set(real, scale.Origin);
  const Real inverse = hn::Set(real, 1.0 / scale.Step);
  const Real nearest = hn::Set(real, scale.Nearest), furthest = hn::Set(real, scale.Furthest);
  const Real least = hn::Set(real, scale.Least), greatest = hn::Set(real, scale.Greatest);
  const Real rounder = hn::Set(real, 6755399441055744.0); // 1.5 * 2^52: adding it rounds
  auto held = hn::Eq(origin, origin);
  const auto group = [&](const T* from, Number* to, std::size_t)
  {
    for (std::size_t i = 0; i < RowErrors::Lanes; i += hn::Lanes(real))
    {
      const Real y = LoadReals(from + i);
      held = hn::And(held, hn::And(hn::Ge(y, nearest), hn::Le(y, furthest))); // not for NaN
      const Real number = hn::Mul(hn::Sub(y, origin), inverse);
      const Real bounded = hn::Min(hn::Max(number, least), greatest);
      StoreNumbers(hn::Sub(hn::Add(bounded, rounder), rounder), to + i);
    }
  };
  ForEachRow(rows, [&](const T* values, Number* numbers)
    { ForEachGroup(values, numbers, static_cast<std::size_t>(rows.Count), group); });
  return hn::AllTrue(real, held);
}

/// Extremes of numbers, lane by lane.
template <class Number>
struct Extremes
{
  using Tag = hn::CappedTag<Number, 16>;
  hn::Vec<Tag> Low, High;

  /// @param first one of the numbers
  HWY_INLINE explicit Extremes(Number first)
    : Low(hn::Set(Tag(), first))
    , High(Low)
  {
  }

  HWY_INLINE void Include(const Number* numbers, int count)
  {
    const Tag tag;
    const int lanes = static_cast<int>(hn::Lanes(tag));
    int i = 0;
    for (; i + lanes <= count; i += lanes)
    {
      const auto some = hn::LoadU(tag, numbers + i);
      this->Low = hn::Min(this->Low, some);
      this->High = hn::Max(this->High, some);
    }
    for (; i < count; ++i)
    {
      const auto one = hn::Set(tag, numbers[i]);
      this->Low = hn::Min(this->Low, one);
      this->High = hn::Max(this->High, one);
    }
  }

  HWY_INLINE void AddTo(std::int32_t& low, std::int32_t& high) const
  {
    const Tag tag;
    Number lows[16], highs[16];
    hn::StoreU(this->Low, tag, lows);
    hn::StoreU(this->High, tag, highs);
    low = std::min<std::int32_t>(low, *std::min_element(lows, lows + hn::Lanes(tag)));
    high = std::max<std::int32_t>(high, *std::max_element(highs, highs + hn::Lanes(tag)));
  }
};

template <class T, class Number>
bool Errors(const QuantizedRows<T, const Number>& rows, const LatticeScale& scale, double bound,
  RowErrors& errors)
{
  const Reals real;
  constexpr std::size_t parts = RowErrors::Lanes / hn::MaxLanes(Reals());
  const Real origin = hn::Set(real, scale.Origin), step = hn::Set(real, scale.Step);
  Real greatest[parts], squares[parts];
  for (std::size_t part = 0; part < parts; ++part)
  {
    greatest[part] = hn::LoadU(real, errors.Greatest + part * hn::Lanes(real));
    squares[part] = hn::LoadU(real, errors.Squares + part * hn::Lanes(real));
  }
  Extremes<Number> extremes(rows.Numbers[0]);
  const auto group = [&](const T* from, const Number* number, std::size_t left)
  {
    for (std::size_t part = 0; part < parts; ++part)
    {
      const std::size_t i = part * hn::Lanes(real);
      // Not fused: a product is rounded before it is added, wherever this runs.
      Real decoded = hn::Add(hn::Mul(LoadNumbers(number + i), step), origin);
      if constexpr (sizeof(T) != sizeof(double))
      {
        const hn::Rebind<T, Reals> own;
        decoded = hn::PromoteTo(real, hn::DemoteTo(own, decoded));
      }
      Real difference = hn::Abs(hn::Sub(LoadReals(from + i), decoded));
      if (left < RowErrors::Lanes)
      {
        const Real end = hn::Set(real, static_cast<double>(left));
        difference =
          hn::IfThenElseZero(hn::Lt(hn::Iota(real, static_cast<double>(i)), end), difference);
      }
      greatest[part] = hn::Max(greatest[part], difference);
      squares[part] = hn::Add(squares[part], hn::Mul(difference, difference));
    }
  };
  ForEachRow(rows,
    [&](const T* values, const Number* numbers)
    {
      ForEachGroup(values, numbers, static_cast<std::size_t>(rows.Count), group);
      extremes.Include(numbers, rows.Count);
    });
  const Real most = hn::Set(real, bound);
  auto within = hn::Eq(origin, origin);
  for (std::size_t part = 0; part < parts; ++part)
  {
    within = hn::And(within, hn::Le(greatest[part], most));
    within = hn::And(within, hn::Eq(squares[part], squares[part])); // a NaN stays in the sum
    hn::StoreU(greatest[part], real, errors.Greatest + part * hn::Lanes(real));
    hn::StoreU(squares[part], real, errors.Squares + part * hn::Lanes(real));
  }
  extremes.AddTo(errors.Low, errors.High);
  return hn::AllTrue(real, within);
}

#define BANYAN_ROWS(name, T, Number)                                                               \
  bool Numbers##name(const QuantizedRows<T, Number>& rows, const LatticeScale& scale)              \
  {                                                                                                \
    return Numbers(rows, scale);                                                                   \
  }                                                                                                \
  bool Errors##name(const QuantizedRows<T, const Number>& rows, const LatticeScale& scale,         \
    double bound, RowErrors& errors)                                                               \
  {                                                                                                \
    return Errors<T, Number>(rows, scale, bound, errors);                                          \
  }
BANYAN_ROWS(ShortFloats, float, std::int16_t)
BANYAN_ROWS(ShortDoubles, double, std::int16_t)
BANYAN_ROWS(LongFloats, float, std::int32_t)
BANYAN_ROWS(LongDoubles, double, std::int32_t)
#undef BANYAN_ROWS

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

#define BANYAN_ROWS(name, T, Number)                                                               \
  HWY_EXPORT(Numbers##name);                                                                       \
  HWY_EXPORT(Errors##name);                                                                        \
  template <>                                                                                      \
  bool QuantizeRows(const QuantizedRows<T, Number>& rows, const LatticeScale& scale)               \
  {                                                                                                \
    return HWY_DYNAMIC_DISPATCH(Numbers##name)(rows, scale);                                       \
  }                                                                                                \
  template <>                                                                                      \
  bool ErrorsOnLattice(const QuantizedRows<T, const Number>& rows, const LatticeScale& scale,      \
    double bound, RowErrors& errors)                                                               \
  {                                                                                                \
    return HWY_DYNAMIC_DISPATCH(Errors##name)(rows, scale, bound, errors);                         \
  }
BANYAN_ROWS(ShortFloats, float, std::int16_t)
BANYAN_ROWS(ShortDoubles, double, std::int16_t)
BANYAN_ROWS(LongFloats, float, std::int32_t)
BANYAN_ROWS(LongDoubles, double, std::int32_t)
#undef BANYAN_ROWS

} // namespace banyan
#endif
