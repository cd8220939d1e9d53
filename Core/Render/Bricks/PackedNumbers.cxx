// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/PackedNumbers.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Render/Bricks/PackedNumbers.cxx"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include "Render/Bricks/PacketVectors-inl.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

#if HWY_TARGET != HWY_SCALAR && BANYAN_HAS_NUMBERS

/// Numbers of a vector of values. @return lanes whose value they stand for
HWY_INLINE hn::Mask<D> TakeNumbers(
  const float* values, const NumberScale& scale, VF inverse, std::int16_t* numbers)
{
  const D d;
  const hn::Rebind<std::int16_t, D> narrow;
  const VF value = hn::LoadU(d, values);
  const auto number = hn::DemoteTo(narrow, hn::NearestInt(hn::Mul(value, inverse))); // saturates
  hn::StoreU(number, narrow, numbers);
  const VF n = hn::ConvertTo(d, hn::PromoteTo(DI(), number));
  const VF stands = hn::MulAdd(n, hn::Set(d, scale.High), hn::Mul(n, hn::Set(d, scale.Low)));
  return hn::Eq(stands, value); // not for NaN
}

bool NumbersHere(
  const float* values, std::size_t count, const NumberScale& scale, std::int16_t* numbers)
{
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  const VF inverse = hn::Set(d, 1.0f / scale.High);
  auto good = hn::Eq(inverse, inverse);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes)
  {
    good = hn::And(good, TakeNumbers(values + i, scale, inverse, numbers + i));
  }
  if (i < count)
  {
    float rest[RayPacket::Size] = {};
    std::int16_t restNumbers[RayPacket::Size];
    std::copy(values + i, values + count, rest);
    good = hn::And(good, TakeNumbers(rest, scale, inverse, restNumbers));
    std::copy(restNumbers, restNumbers + (count - i), numbers + i);
  }
  return hn::AllTrue(d, good);
}

#else

bool NumbersHere(const float*, std::size_t, const NumberScale&, std::int16_t*)
{
  return false;
}

#endif

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(NumbersHere);

bool NumbersOfValues(
  const float* values, std::size_t count, double step, NumberScale& scale, std::int16_t* numbers)
{
  // What float32 leaves of the step, times any number, is a normal number then, and nothing
  // overflows.
  constexpr double least = 1e-25;
  constexpr double most = 1e30;
  if (!(step >= least && step <= most))
  {
    return false;
  }
  scale.High = static_cast<float>(step);
  scale.Low = static_cast<float>(step - static_cast<double>(scale.High));
  return HWY_DYNAMIC_DISPATCH(NumbersHere)(values, count, scale, numbers);
}

float ValueOfNumber(std::int16_t number, const NumberScale& scale)
{
  const auto n = static_cast<float>(number);
  return std::fma(n, scale.High, n * scale.Low);
}

} // namespace banyan
#endif
