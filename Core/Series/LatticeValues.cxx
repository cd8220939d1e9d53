#include "Series/LatticeValues.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Series/LatticeValues.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

template <class Number, class T>
void Values(const Number* HWY_RESTRICT numbers, std::size_t count, double origin, double step,
  T* HWY_RESTRICT values)
{
  const hn::ScalableTag<double> real;
  const hn::Rebind<std::int32_t, decltype(real)> whole;
  const hn::Rebind<Number, decltype(real)> number;
  const auto origins = hn::Set(real, origin);
  const auto steps = hn::Set(real, step);
  const std::size_t lanes = hn::Lanes(real);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes)
  {
    hn::VFromD<decltype(whole)> n;
    if constexpr (sizeof(Number) == sizeof(std::int32_t))
    {
      n = hn::LoadU(whole, numbers + i);
    }
    else
    {
      n = hn::PromoteTo(whole, hn::LoadU(number, numbers + i));
    }
    // Not fused: a product is rounded before it is added, wherever this runs.
    const auto y = hn::Add(hn::Mul(hn::PromoteTo(real, n), steps), origins);
    if constexpr (sizeof(T) == sizeof(double))
    {
      hn::StoreU(y, real, values + i);
    }
    else
    {
      const hn::Rebind<float, decltype(real)> single;
      hn::StoreU(hn::DemoteTo(single, y), single, values + i);
    }
  }
  for (; i < count; ++i)
  {
    values[i] = static_cast<T>(origin + static_cast<double>(numbers[i]) * step);
  }
}

void ShortFloats(const std::int16_t* n, std::size_t count, double origin, double step, float* v)
{
  Values(n, count, origin, step, v);
}
void ShortDoubles(const std::int16_t* n, std::size_t count, double origin, double step, double* v)
{
  Values(n, count, origin, step, v);
}
void LongFloats(const std::int32_t* n, std::size_t count, double origin, double step, float* v)
{
  Values(n, count, origin, step, v);
}
void LongDoubles(const std::int32_t* n, std::size_t count, double origin, double step, double* v)
{
  Values(n, count, origin, step, v);
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(ShortFloats);
HWY_EXPORT(ShortDoubles);
HWY_EXPORT(LongFloats);
HWY_EXPORT(LongDoubles);

template <>
void ValuesOnLattice(
  const std::int16_t* numbers, std::size_t count, double origin, double step, float* values)
{
  HWY_DYNAMIC_DISPATCH(ShortFloats)(numbers, count, origin, step, values);
}
template <>
void ValuesOnLattice(
  const std::int16_t* numbers, std::size_t count, double origin, double step, double* values)
{
  HWY_DYNAMIC_DISPATCH(ShortDoubles)(numbers, count, origin, step, values);
}
template <>
void ValuesOnLattice(
  const std::int32_t* numbers, std::size_t count, double origin, double step, float* values)
{
  HWY_DYNAMIC_DISPATCH(LongFloats)(numbers, count, origin, step, values);
}
template <>
void ValuesOnLattice(
  const std::int32_t* numbers, std::size_t count, double origin, double step, double* values)
{
  HWY_DYNAMIC_DISPATCH(LongDoubles)(numbers, count, origin, step, values);
}

} // namespace banyan
#endif
