// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_OpacityWeight_h
#define banyan_Series_Quantize_OpacityWeight_h

#include "Series/Quantize/ValueRange.h"

#include <cstddef>
#include <vector>

namespace banyan
{

struct OpacityKnot
{
  double Value = 0.0;
  double Opacity = 0.0; ///< 0 to 1
};

/// Opacity over values: linear between knots, constant beyond the first and the last.
class OpacityFunction
{
public:
  /// @param knots at least one, finite values strictly increasing, opacities in [0, 1]. Throws
  /// Error otherwise.
  explicit OpacityFunction(std::vector<OpacityKnot> knots);

  /// 0 for NaN; infinities are beyond the ends.
  double operator()(double value) const;

  const std::vector<OpacityKnot>& Knots() const { return this->Points; }

private:
  std::vector<OpacityKnot> Points;
};

/// The maximal intervals of values whose opacity is exactly 0. Within one, a value may decode to
/// any other: no *sample* becomes visible. Single values are left out.
///
/// @par Limits: a picture shows what is interpolated between samples. Changing an invisible sample
/// beside a visible one moves the edge of what is visible between the two; only where all corners
/// of a cell lie in the same interval nothing can be seen of the change (interpolants stay between
/// the corners). Ask for the range of a brick with its shared layer of samples, or of a voxel with
/// its neighbours.
class InvisibleIntervals
{
public:
  /// None: everything is visible.
  InvisibleIntervals() = default;
  explicit InvisibleIntervals(const OpacityFunction& opacity);

  /// Ordered, disjoint, closed; the first may start at -infinity, the last end at infinity.
  const std::vector<ValueRange>& Intervals() const { return this->Ranges; }

  /// Number of the interval that holds a value, or -1: visible, or NaN.
  int IntervalOf(double value) const;

  /// Whether one interval holds all of [low, high]: none of these values can be seen, nor anything
  /// interpolated between them. False when low > high.
  bool Invisible(double low, double high) const;

  /// Whether a value may decode to another: |original - decoded| <= bound, or one interval holds
  /// both. NaN may not.
  bool MayDecodeTo(double original, double decoded, double bound) const;

private:
  std::vector<ValueRange> Ranges;
};

} // namespace banyan

#endif
