// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_BetweenSteps_h
#define banyan_Series_Decode_BetweenSteps_h

#include "Base/ScalarType.h"
#include "Series/Decode/SeriesFile.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace banyan
{

/// A step of a series, and how far a time lies from it to the next one.
struct StepAndFraction
{
  int Step = 0;
  double Fraction = 0.0; ///< in [0, 1): of the time between both; 0 is the step itself
};

/// @param times of the steps, increasing, one at least
/// @param time before the first step and from the last one on, that step; NaN gives the last one
StepAndFraction PlaceOfTime(const std::vector<double>& times, double time);

/// Whether values of a type have any between steps. Integers may be labels, and have none.
bool AreInterpolated(ScalarType type);

/// How values of a component between two steps are made of both: (1 - Fraction) a + Fraction b.
///
/// @par Exactness:
/// Computed in double precision and rounded to the type once; never outside of a and b, and equal
/// values stay as they are, bit by bit. NaN where one is NaN. Where one is a fill value, that one:
/// no value is made of what stands for none.
struct BetweenSteps
{
  double Fraction = 0.0;          ///< in (0, 1)
  std::vector<double> FillValues; ///< see FillSet

  /// @param type float32 or float64; throws Error for others
  /// @param values `count` of the earlier step, `stride` values apart; replaced by the result
  /// @param later as many of the later step, without gaps
  void Interpolate(
    ScalarType type, void* values, int stride, const void* later, std::int64_t count) const;
};

/// Reads values of one step: `count` of them, as ReadBetween() is told.
using ReadStep =
  std::function<void(const FieldKey& field, void* values, int stride, int component)>;

/// Reads values at a step, or between it and the next one: then on all threads, with memory for as
/// many values more.
/// @param fraction see StepAndFraction; 0 reads the step alone
/// @param values receives `count` of them: the value goes to `values[i * stride + component]`, in
/// the array's own type
/// Throws Error as `read` does, and for values that are not interpolated.
void ReadBetween(const SeriesFile& series, const FieldKey& field, double fraction,
  std::int64_t count, void* values, int stride, int component, const ReadStep& read);

} // namespace banyan

#endif
