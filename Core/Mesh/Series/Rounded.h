// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Series_Rounded_h
#define banyan_Mesh_Series_Rounded_h

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace banyan
{

/// The number of the type next to a value (ties to even), at most at the ends of the type's range.
/// @param value no NaN where the type has none
template <class T>
T Rounded(double value)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    return static_cast<T>(value);
  }
  else
  {
    // The greatest double that is not above the type's greatest number.
    constexpr double high = sizeof(T) < 8 ? static_cast<double>(std::numeric_limits<T>::max())
                            : std::is_signed_v<T> ? 9223372036854774784.0
                                                  : 18446744073709549568.0;
    constexpr double low = static_cast<double>(std::numeric_limits<T>::lowest());
    return static_cast<T>(std::min(std::max(std::nearbyint(value), low), high));
  }
}

/// A mean as the quotient of sums that were made smaller, as those of the largest doubles are
/// infinite: finite where the sum is, also where rounding says otherwise.
/// @param part of one that the sum was made of
inline double MeanOfPart(double sum, double part)
{
  const double mean = sum / part;
  return std::isinf(mean) && std::isfinite(sum)
           ? std::copysign(std::numeric_limits<double>::max(), sum)
           : mean;
}

} // namespace banyan

#endif
