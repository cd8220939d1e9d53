// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/AsinhMath.h"

// One source, compiled twice: for any processor, and with registers twice as wide.
#if defined(__x86_64__) && defined(__GNUC__)
#define BANYAN_HAS_WIDE_LOOPS 1
#define BANYAN_INTO_BOTH inline __attribute__((always_inline))
#else
#define BANYAN_HAS_WIDE_LOOPS 0
#define BANYAN_INTO_BOTH inline
#endif

namespace banyan::asinh_math
{
namespace
{

/// For |x| / scale above GreatestRatio, and finite.
double ForwardOfHuge(double x, double scale)
{
  // asinh(u) is ln(2 u) here, to the last bit; neither number is denormal.
  constexpr std::uint64_t mantissa = (std::uint64_t{ 1 } << 52) - 1;
  constexpr std::uint64_t one = std::uint64_t{ 1023 } << 52;
  const std::uint64_t a = BitCast<std::uint64_t>(std::abs(x));
  const std::uint64_t b = BitCast<std::uint64_t>(scale);
  double ratio =
    BitCast<double>((a & mantissa) | one) / BitCast<double>((b & mantissa) | one); // 0.5 to 2
  double k = static_cast<double>(a >> 52) - static_cast<double>(b >> 52) + 1.0;
  constexpr double root = 1.4142135623730951;
  if (ratio > root)
  {
    ratio *= 0.5;
    k += 1.0;
  }
  else if (ratio < 0.5 * root)
  {
    ratio *= 2.0;
    k -= 1.0;
  }
  const double y = k * Ln2High + (k * Ln2Low + LogSeries((ratio - 1.0) / (ratio + 1.0)));
  return std::copysign(y, x);
}

BANYAN_INTO_BOTH double GreatestRatioOf(const double* x, std::size_t count, double inverseScale)
{
  double greatest = 0.0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const double ratio = std::abs(x[i]) * inverseScale;
    greatest = ratio > greatest ? ratio : greatest;
  }
  return greatest;
}

BANYAN_INTO_BOTH void ForwardLoop(const double* x, std::size_t count, double scale, double* y)
{
  const double inverseScale = 1.0 / scale;
  if (GreatestRatioOf(x, count, inverseScale) > GreatestRatio)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      y[i] = ForwardOfAny(x[i], scale);
    }
    return;
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    y[i] = Forward(x[i], inverseScale);
  }
}

BANYAN_INTO_BOTH void InverseLoop(const double* y, std::size_t count, double scale, double* x)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    x[i] = Inverse(y[i], scale);
  }
}

#if BANYAN_HAS_WIDE_LOOPS
__attribute__((target("avx2"))) void ForwardWide(
  const double* x, std::size_t count, double scale, double* y)
{
  ForwardLoop(x, count, scale, y);
}

__attribute__((target("avx2"))) void InverseWide(
  const double* y, std::size_t count, double scale, double* x)
{
  InverseLoop(y, count, scale, x);
}

const bool HasWideRegisters = __builtin_cpu_supports("avx2");
#endif

} // namespace

double ForwardOfAny(double x, double scale)
{
  const double inverseScale = 1.0 / scale;
  const double magnitude = std::abs(x);
  const bool huge =
    magnitude * inverseScale > GreatestRatio && magnitude <= std::numeric_limits<double>::max();
  return huge ? ForwardOfHuge(x, scale) : Forward(x, inverseScale);
}

void Forward(const double* x, std::size_t count, double scale, double* y)
{
#if BANYAN_HAS_WIDE_LOOPS
  if (HasWideRegisters)
  {
    ForwardWide(x, count, scale, y);
    return;
  }
#endif
  ForwardLoop(x, count, scale, y);
}

void Inverse(const double* y, std::size_t count, double scale, double* x)
{
#if BANYAN_HAS_WIDE_LOOPS
  if (HasWideRegisters)
  {
    InverseWide(y, count, scale, x);
    return;
  }
#endif
  InverseLoop(y, count, scale, x);
}

} // namespace banyan::asinh_math
