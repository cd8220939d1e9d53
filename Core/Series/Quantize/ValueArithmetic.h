// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_ValueArithmetic_h
#define banyan_Series_Quantize_ValueArithmetic_h

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace banyan
{

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
