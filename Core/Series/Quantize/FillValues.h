// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_FillValues_h
#define banyan_Series_Quantize_FillValues_h

#include "Base/ScalarType.h"
#include "Series/Quantize/ValueRange.h"

#include <cstdint>
#include <vector>

namespace banyan
{

class ValueHistogram;

/// Fill values as values of a type: what a simulation writes where it has no value (1e20, -9999).
/// They are kept bit-exact and never count for a range. None is guessed: the user names them.
template <class T>
class FillSet
{
public:
  /// Reals are rounded to the type, as the program that wrote them did; what no T stands for
  /// (1e20 and fractions among integers, 1e300 in single precision) is left out.
  explicit FillSet(const std::vector<double>& values);

  bool Empty() const { return this->Values.empty(); }
  bool Holds(T value) const
  {
    for (const T fill : this->Values)
    {
      if (value == fill)
      {
        return true;
      }
    }
    return false;
  }

private:
  std::vector<T> Values;
};

/// Adds a component to a histogram, fill values left out.
/// @param values `[tuples][components]`
/// @param hidden by tuple: those where it is not 0 are left out; may be null
void CountComponent(ScalarType type, const void* values, std::int64_t tuples, int components,
  int component, const std::vector<double>& fillValues, ValueHistogram& histogram,
  const std::uint8_t* hidden = nullptr);

/// Copies a component with finite values beyond a range replaced by its nearer end (see
/// ClampToRange); fill values, NaN, infinities and what is hidden stay.
/// @param values the component's first value, `stride` from one to the next
/// @param hidden by value: not 0 where it is; may be null
/// @param clamped receives `count` values without gaps
/// @return how many values were replaced
/// Throws Error when no value of the type lies within the range.
std::int64_t ClampComponent(ScalarType type, const void* values, int stride, std::int64_t count,
  const ValueRange& range, const std::vector<double>& fillValues, const std::uint8_t* hidden,
  void* clamped);

} // namespace banyan

#endif
