// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_AdaptiveTransform_h
#define banyan_Series_Quantize_AdaptiveTransform_h

#include "Series/Quantize/Histogram.h"
#include "Series/Quantize/Transform.h"

namespace banyan
{

/// How a transform follows a histogram.
///
/// Over cells of equal width of the range, with d the share of the values in a cell relative to an
/// even distribution (mean 1), the slope is
///
///     s = (1 - Equalization) + Equalization * min(d, cap), scaled so that its mean is 1,
///
/// with the cap at which the greatest slope cannot be more than SlopeRatio times the least. Because
/// y spans as much as x does, the error at x is that of the uniform quantizer with as many levels,
/// divided by s. So no value has an error of more than 1 / (1 - Equalization) times the uniform one
/// (4 times, by default); where values are dense it is smaller, down to 1 / SlopeRatio of the
/// largest.
struct AdaptiveRule
{
  double Equalization = 0.75; ///< 0 (uniform) up to 0.999
  double SlopeRatio = 64.0;   ///< 1 up to 2^20
  int Cells = 256;            ///< 1 to GreatestCells

  static constexpr int GreatestCells = 4094; ///< a table has one knot more, and one for 0
};

/// The table of a rule. Knots lie at the edges of cells; those between cells of equal slope are
/// left out. When 0 lies in the range there is a knot (0, 0), for which an edge is moved there or
/// added (zeros stay exact, and do not count as values: they need no levels); otherwise y = low at
/// x = low. Values beyond the range do not count. Deterministic: depends on the histogram's counts
/// and extremes alone.
/// @param range what the table is made over; not empty, within +- 2^999. The identity comes back
/// for a range that doubles do not resolve into cells, and when no value other than 0 lies within.
/// Throws Error for a rule or range that is not as above.
///
/// @par Source: "A study of time-varying octree and difference encoding", section 3.1: "set
/// quantization levels adaptively" from source data statistics.
Transform MakeAdaptive(
  const ValueHistogram& values, const ValueRange& range, const AdaptiveRule& rule = {});

/// How the scale of an asinh transform follows a histogram: the magnitude that `Share` of the
/// non-zero values lie below, but at least `LeastShareOfGreatest` of the greatest magnitude (what
/// is smaller counts as noise: logarithms of it would eat up the levels).
struct AsinhRule
{
  double Share = 0.1;                 ///< 0 to 1
  double LeastShareOfGreatest = 1e-5; ///< 0 to 1: five decades
};

/// A scale for Transform::Asinh; 1 when there is no value other than 0. Magnitudes beyond the range
/// count as its ends. Throws Error for a rule that is not as above.
double AsinhScale(
  const ValueHistogram& values, const ValueRange& range, const AsinhRule& rule = {});

} // namespace banyan

#endif
