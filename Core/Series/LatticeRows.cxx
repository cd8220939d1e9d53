#include "Series/LatticeRows.h"

#include <algorithm>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Series/LatticeRows.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// As many lanes as the processor has, but not more than sums have.
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

template <class T, class Number>
bool Numbers(const T* values, std::size_t count, const LatticeScale& scale, Number* numbers)
{
  const Reals real;
  const Real origin = hn::Set(real, scale.Origin);
  const Real inverse = hn::Set(real, 1.0 / scale.Step);
  const Real nearest = hn::Set(real, scale.Nearest), furthest = hn::Set(real, scale.Furthest);
  const Real least = hn::Set(real, scale.Least), greatest = hn::Set(real, scale.Greatest);
  const Real rounder = hn::Set(real, 6755399441055744.0); // 1.5 * 2^52: adding it rounds
  auto held = hn::Eq(origin, origin);
  ForEachGroup(values, numbers, count,
    [&](const T* from, Number* to, std::size_t)
    {
      for (std::size_t i = 0; i < RowErrors::Lanes; i += hn::Lanes(real))
      {
        const Real y = LoadReals(from + i);
        held = hn::And(held, hn::And(hn::Ge(y, nearest), hn::Le(y, furthest))); // not for NaN
        const Real number = hn::Mul(hn::Sub(y, origin), inverse);
        const Real bounded = hn::Min(hn::Max(number, least), greatest);
        StoreNumbers(hn::Sub(hn::Add(bounded, rounder), rounder), to + i);
      }
    });
  return hn::AllTrue(real, held);
}

template <class T, class Number>
bool AddErrors(const T* values, const Number* numbers, std::size_t count,
  const LatticeScale& scale, double bound, RowErrors& errors)
{
  const Reals real;
  const Real origin = hn::Set(real, scale.Origin), step = hn::Set(real, scale.Step);
  const Real most = hn::Set(real, bound);
  auto within = hn::Eq(origin, origin);
  Number low = numbers[0], high = numbers[0];
  for (std::size_t i = 0; i < count; ++i)
  {
    low = numbers[i] < low ? numbers[i] : low;
    high = high < numbers[i] ? numbers[i] : high;
  }
  errors.Low = std::min<std::int32_t>(errors.Low, low);
  errors.High = std::max<std::int32_t>(errors.High, high);
  ForEachGroup(values, numbers, count,
    [&](const T* from, const Number* number, std::size_t left)
    {
      for (std::size_t i = 0; i < RowErrors::Lanes; i += hn::Lanes(real))
      {
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
          const auto last = hn::Set(real, static_cast<double>(left));
          difference = hn::IfThenElseZero(hn::Lt(hn::Iota(real, i), last), difference);
        }
        within = hn::And(within, hn::Le(difference, most)); // not for NaN
        const Real greatest = hn::LoadU(real, errors.Greatest + i);
        const Real squares = hn::LoadU(real, errors.Squares + i);
        hn::StoreU(hn::Max(greatest, difference), real, errors.Greatest + i);
        hn::StoreU(hn::Add(squares, hn::Mul(difference, difference)), real, errors.Squares + i);
      }
    });
  return hn::AllTrue(real, within);
}

#define BANYAN_ROWS(name, T, Number)                                                               \
  bool Numbers##name(const T* v, std::size_t count, const LatticeScale& scale, Number* n)          \
  {                                                                                                \
    return Numbers(v, count, scale, n);                                                            \
  }                                                                                                \
  bool AddErrors##name(const T* v, const Number* n, std::size_t count, const LatticeScale& scale,  \
    double bound, RowErrors& errors)                                                               \
  {                                                                                                \
    return AddErrors(v, n, count, scale, bound, errors);                                           \
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
  HWY_EXPORT(AddErrors##name);                                                                     \
  template <>                                                                                      \
  bool NumbersOnLattice(const T* v, std::size_t count, const LatticeScale& scale, Number* n)       \
  {                                                                                                \
    return HWY_DYNAMIC_DISPATCH(Numbers##name)(v, count, scale, n);                                \
  }                                                                                                \
  template <>                                                                                      \
  bool AddRowErrors(const T* v, const Number* n, std::size_t count, const LatticeScale& scale,     \
    double bound, RowErrors& errors)                                                               \
  {                                                                                                \
    return HWY_DYNAMIC_DISPATCH(AddErrors##name)(v, n, count, scale, bound, errors);               \
  }
BANYAN_ROWS(ShortFloats, float, std::int16_t)
BANYAN_ROWS(ShortDoubles, double, std::int16_t)
BANYAN_ROWS(LongFloats, float, std::int32_t)
BANYAN_ROWS(LongDoubles, double, std::int32_t)
#undef BANYAN_ROWS

} // namespace banyan
#endif
