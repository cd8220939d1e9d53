// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_AsinhMath_h
#define banyan_Series_Quantize_AsinhMath_h

#include "Base/Bytes.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace banyan
{

/// y = asinh(x / scale) and back, from + - * / sqrt and bits alone, so that every CPU and build
/// gets the same bits (no library's exp or log does). Without branches, so that loops over them
/// vectorise. Measured: within 5 units in the last place of the mathematical functions.
///
/// Compiled with -ffp-contract=off; the order of operations is part of the file format.
namespace asinh_math
{

constexpr double Ln2 = 0.69314718055994530942;
/// ln 2 with 32 trailing zero bits, and the rest: products of the first with whole numbers below
/// 2^20 are exact.
constexpr double Ln2High = 0.69314718036912381649;
constexpr double Ln2Low = 1.90821492927058770002e-10;
/// Adding and subtracting it rounds to the nearest whole number; its low bits then hold that
/// number.
constexpr double Rounder = 6755399441055744.0; // 1.5 * 2^52
/// Above asinh(greatest double / least scale), and such that no power of two below overflows.
constexpr double GreatestY = 1416.0;
/// x / scale above this goes through its exponent, because squares would overflow.
constexpr double GreatestRatio = 0x1p500;

/// 2^k for a whole number k from -1022 to 1023.
inline double PowerOfTwo(double k)
{
  return BitCast<double>(BitCast<std::uint64_t>(k + (Rounder + 1023.0)) << 52);
}

/// sinh(a) / a for 0 <= a <= 1 with s = a * a: the Taylor series up to a^16.
inline double SinhSeries(double s)
{
  double sum = 1.0 / 355687428096000.0;
  sum = sum * s + 1.0 / 1307674368000.0;
  sum = sum * s + 1.0 / 6227020800.0;
  sum = sum * s + 1.0 / 39916800.0;
  sum = sum * s + 1.0 / 362880.0;
  sum = sum * s + 1.0 / 5040.0;
  sum = sum * s + 1.0 / 120.0;
  sum = sum * s + 1.0 / 6.0;
  return sum * s + 1.0;
}

/// exp(r) for |r| <= ln 2 / 2: the Taylor series up to r^13.
inline double ExpSeries(double r)
{
  double sum = 1.0 / 6227020800.0;
  sum = sum * r + 1.0 / 479001600.0;
  sum = sum * r + 1.0 / 39916800.0;
  sum = sum * r + 1.0 / 3628800.0;
  sum = sum * r + 1.0 / 362880.0;
  sum = sum * r + 1.0 / 40320.0;
  sum = sum * r + 1.0 / 5040.0;
  sum = sum * r + 1.0 / 720.0;
  sum = sum * r + 1.0 / 120.0;
  sum = sum * r + 1.0 / 24.0;
  sum = sum * r + 1.0 / 6.0;
  sum = sum * r + 0.5;
  sum = sum * r + 1.0;
  return sum * r + 1.0;
}

/// ln((1 + s) / (1 - s)) for |s| <= 0.172: the Taylor series up to s^19.
inline double LogSeries(double s)
{
  const double q = s * s;
  double sum = 1.0 / 19.0;
  sum = sum * q + 1.0 / 17.0;
  sum = sum * q + 1.0 / 15.0;
  sum = sum * q + 1.0 / 13.0;
  sum = sum * q + 1.0 / 11.0;
  sum = sum * q + 1.0 / 9.0;
  sum = sum * q + 1.0 / 7.0;
  sum = sum * q + 1.0 / 5.0;
  sum = sum * q + 1.0 / 3.0;
  return 2.0 * s + 2.0 * s * (q * sum);
}

/// scale * sinh(y), at most the greatest double in magnitude; NaN for NaN.
inline double Inverse(double y, double scale)
{
  const double magnitude = std::abs(y);
  const double a = magnitude < GreatestY ? magnitude : GreatestY;
  const double near = a < 1.0 ? a : 0.0;
  const double small = scale * (near * SinhSeries(near * near));
  // e^a = 2^n * p; sinh(a) = 2^(n - 1) * (p - 2^(-2 n) / p), the power in two steps that fit.
  const double n = (a * (1.0 / Ln2) + Rounder) - Rounder;
  const double p = ExpSeries((a - n * Ln2High) - n * Ln2Low);
  const double least = n < 511.0 ? n : 511.0;
  const double d = p - PowerOfTwo(-2.0 * least) / p;
  const double half = ((n - 1.0) * 0.5 + Rounder) - Rounder;
  const double large = scale * d * PowerOfTwo(half) * PowerOfTwo((n - 1.0) - half);
  const double x = a < 1.0 ? small : large;
  const double finite =
    x < std::numeric_limits<double>::max() ? x : std::numeric_limits<double>::max();
  return y == y ? std::copysign(finite, y) : y;
}

/// asinh(x / scale) where |x| / scale <= GreatestRatio; x itself for NaN and infinities.
/// @param inverseScale 1 / scale
inline double Forward(double x, double inverseScale)
{
  const double magnitude = std::abs(x);
  const double u = magnitude * inverseScale;
  const double root = std::sqrt(u * u + 1.0);
  // w = e^y, as 1 + t while it is small, for the digits that 1 would take.
  const double w = u + root;
  const double t = u + u * u / (1.0 + root);
  const std::uint64_t bits = BitCast<std::uint64_t>(w);
  const std::uint64_t aboveRoot = bits - 0x3FE6A09E667F3BCDu; // the bits of sqrt(1/2)
  const std::uint64_t exponent = aboveRoot >> 52;
  const double m = BitCast<double>(bits - (exponent << 52));
  const double k = BitCast<double>(exponent | 0x4330000000000000u) - 0x1p52;
  const bool small = k == 0.0;
  const double s = (small ? t : m - 1.0) / (small ? 2.0 + t : m + 1.0);
  const double y = k * Ln2High + (k * Ln2Low + LogSeries(s));
  return magnitude <= std::numeric_limits<double>::max() ? std::copysign(y, x) : x;
}

/// The same for any x.
double ForwardOfAny(double x, double scale);

/// Both for `count` numbers, with as wide registers as the processor has: the same bits. The arrays
/// may be the same.
void Forward(const double* x, std::size_t count, double scale, double* y);
void Inverse(const double* y, std::size_t count, double scale, double* x);

} // namespace asinh_math
} // namespace banyan

#endif
