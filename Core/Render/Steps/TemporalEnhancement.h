// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Steps_TemporalEnhancement_h
#define banyan_Render_Steps_TemporalEnhancement_h

#include "Series/Quantize/ValueRange.h"

namespace banyan
{

struct ArrayIndex;

/// Brings out what moves, at all scales: waves that have become weak are drawn nearly as bright as
/// they were when they were strong, and what rests is dimmed.
///
/// With v a value (or the length of a vector) and v-, v+ the same point's in the steps before and
/// after, the *temporal contrast* is
///
///   c = (|v - v-| + |v+ - v|) / (|v-| + 2 |v| + |v+| + 2 NoiseFloor)     in [0, 1],
///
/// which does not depend on how strong the motion is; where there is one neighbour only, its terms
/// alone. The enhanced value mixes it with the value by a weighted geometric mean,
///
///   e = sign(v) |v|^(1 - Strength) (Scale min(1, Sensitivity c))^Strength,
///
/// so that a range of n decades becomes one of (1 - Strength) n, Scale is left where it is, and
/// Strength 0 leaves every value as it is. Per value two steps more are read, and nothing else is.
///
/// Source: section 5 and figure 12 of "Visualizing Very Large-Scale Earthquake Simulations", which
/// says that values of the previous or next step, or both, are used locally, and no more; the
/// formula is ours.
struct TemporalEnhancement
{
  double Strength = 0.5;   ///< in [0, 1]
  double Scale = 1.0;      ///< a large magnitude, in units of the data; positive
  double NoiseFloor = 0.0; ///< motion of values well below it is not brought out; not negative
  /// 1 / contrast that counts as full motion; positive. Of a wave of period T, steps dt apart, the
  /// contrast is about 2 dt / T on average: with 4, waves of up to 8 steps per period are in full
  /// motion.
  double Sensitivity = 4.0;
};

/// With what the index knows of an array of a series: the scale is the largest magnitude of all
/// steps, and the floor the error bound.
/// @param component or -1 for the length of vectors
TemporalEnhancement EnhancementFor(const ArrayIndex& array, double strength, int component);

/// @param previous, next the value in the step before and after; null where there is none, or where
/// it is not to be used. One that is not finite counts as none. Without any the value stays.
/// NaN stays NaN, infinities stay.
double EnhancedValue(
  const TemporalEnhancement& how, double now, const double* previous, const double* next);

/// Bounds of what values of a range can become, whatever their neighbours are: at least `range`'s
/// and those of (|v| / Scale)^(1 - Strength) Scale, with room for rounding to float32; empty when
/// `range` is.
ValueRange EnhancedRange(const TemporalEnhancement& how, const ValueRange& range);

} // namespace banyan

#endif
