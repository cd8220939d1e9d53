// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_RangeRule_h
#define banyan_Series_Quantize_RangeRule_h

#include "Series/Quantize/Histogram.h"
#include "Series/Quantize/ValueRange.h"

#include <cstddef>
#include <cstdint>

namespace banyan
{

/// Which range of values a relative error bound (and a transform made from the data) refers to.
struct RangeRule
{
  enum class Source
  {
    Data,        ///< least to greatest finite value
    Percentiles, ///< of the finite values
    Given
  };
  Source From = Source::Data;
  double LowShare = 0.0001;  ///< for Percentiles: this share of the values may lie below, 0 to 1
  double HighShare = 0.9999; ///< for Percentiles: this share of the values lies at or below
  ValueRange Given;          ///< for Given
  /// Says what becomes of values outside of the range. false (default): they are kept within the
  /// bound like all other values (the map goes on beyond the range; what the lattice cannot hold is
  /// kept exactly). true: they are replaced by the range's nearer end *before* they are encoded,
  /// and the bound holds against that end; infinities and NaN stay.
  bool ClampOutside = false;

  /// Throws Error for shares that are not 0 <= low < high <= 1, or a given range that is empty or
  /// not finite.
  void Check() const;
};

/// The range that a rule gives for all finite values of a component (all steps, all ranks). Low and
/// high percentiles are rounded outward, by less than 1/2048 of them, but not beyond the data.
/// Empty when there is no finite value and the range is not given. Throws Error as Check does.
ValueRange ChooseRange(const RangeRule& rule, const ValueHistogram& values);

/// Replaces finite values below or above the range by the nearest T within it. NaN and infinities
/// stay. `values` and `clamped` may be the same array. An empty range leaves all as it is.
/// @return how many values were replaced
/// Throws Error when no T lies within the range. For all types of ScalarType.
template <class T>
std::int64_t ClampToRange(const ValueRange& range, const T* values, std::size_t count, T* clamped);

} // namespace banyan

#endif
