// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantizer_h
#define banyan_Series_Quantizer_h

#include "Base/ScalarType.h"
#include "Series/SeriesIndex.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace banyan
{

/// The lattice that the values of one component lie on in version 1 (see FieldLattice.h for what is
/// written today).
///
/// Real types: decoded = (T)(Origin + k * Step) in double precision. Integer types: decoded =
/// k * IntegerStep, clamped to the type. Either way what a value decodes to depends on that value
/// and on the quantizer alone, so samples shared by bricks are equal in both.
///
/// @par Source: "A study of time-varying octree and difference encoding", section 3.1 (the uniform
/// quantizer), here with a bound that holds for each value.
struct Quantizer
{
  double Origin = 0.0;
  double Step = 0.0;             ///< real types; 0: no lattice, values stay bit-exact
  std::uint64_t IntegerStep = 1; ///< integer types; odd; 1: exact

  /// As the format keeps them; see Documentation/format.md.
  std::uint64_t OriginBits(ScalarType type) const;
  std::uint64_t StepBits(ScalarType type) const;
};

/// Inverse of the two `Bits` functions. Throws Error when no quantizer has these bits.
Quantizer QuantizerFromBits(ScalarType type, std::uint64_t origin, std::uint64_t step);

/// What the lattice numbers of a type are computed in.
template <class T>
using LatticeNumber = std::conditional_t<std::is_floating_point_v<T>, std::int32_t,
  std::conditional_t<std::is_signed_v<T>, std::int64_t, std::uint64_t>>;

/// Greatest |k| of real types: beyond, the lattice saves nothing over the values themselves.
constexpr double LatticeLimit = 1073741824.0;

/// decoded[i] from the number base + offsets[i]. Any input is safe (crafted files): it decodes to
/// something.
template <class T>
void Dequantize(const Quantizer& quantizer, std::int64_t base, const std::uint32_t* offsets,
  std::size_t count, T* decoded);

/// The greatest double that is not above, and the least that is not below a value.
template <class T>
double DoubleNotAbove(T value)
{
  const double d = static_cast<double>(value);
  if constexpr (sizeof(T) == 8 && std::is_integral_v<T>)
  {
    using Wide = long double;
    if (static_cast<Wide>(d) > static_cast<Wide>(value))
    {
      return std::nextafter(d, -std::numeric_limits<double>::infinity());
    }
  }
  return d;
}

template <class T>
double DoubleNotBelow(T value)
{
  const double d = static_cast<double>(value);
  if constexpr (sizeof(T) == 8 && std::is_integral_v<T>)
  {
    using Wide = long double;
    if (static_cast<Wide>(d) < static_cast<Wide>(value))
    {
      return std::nextafter(d, std::numeric_limits<double>::infinity());
    }
  }
  return d;
}

/// |a - b| as a double: as double arithmetic gives it for real types, rounded once for integers.
template <class T>
double Difference(T a, T b)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    const double d = static_cast<double>(a) - static_cast<double>(b);
    return d < 0 ? -d : d;
  }
  else
  {
    const std::uint64_t ua = static_cast<std::uint64_t>(a);
    const std::uint64_t ub = static_cast<std::uint64_t>(b);
    return static_cast<double>(a > b ? ua - ub : ub - ua);
  }
}

} // namespace banyan

#endif
