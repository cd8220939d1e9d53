// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_PieceRange_h
#define banyan_Series_Decode_PieceRange_h

#include "Series/Decode/SeriesFile.h"

#include <vector>

namespace banyan
{

/// Ranges of the finite values in a part of a field, told from the tree alone: nothing is decoded.
struct PieceRange
{
  std::vector<ValueRange> Components; ///< one per component
  /// The range of the length (L2 norm) of the vectors. It contains the true range, and is exact for
  /// the whole of level 0. Elsewhere it may be wider, because the tree knows components only. It
  /// never goes beyond the range of the whole step, so that pieces together have that range
  /// exactly. Equal to Components[0] for scalars.
  ValueRange Magnitude;
  /// Whether Components are the exact extremes of the part: true when every brick that touches it
  /// lies in it completely. Otherwise they contain the true range.
  bool Exact = true;
  bool HasNonFinite = false; ///< some brick that touches the part holds NaN or infinities
};

/// @param array of the series, at `step` and `level`
/// @param samples of the level, as in BrickLayout; empty gives empty ranges
/// Throws Error when the tree cannot be read.
PieceRange RangeOfPiece(
  const SeriesFile& series, int step, int array, int level, const Box& samples);

/// The same over all steps, from the index: exact for level 0, and contains the true ranges of
/// coarser levels. Components whose range was chosen (percentiles, given) or that have fill values
/// get that range instead, for colours.
PieceRange RangeOfSeries(const SeriesFile& series, int array);

/// Ranges of values between two steps, from those of the same part at both: they contain the true
/// ranges. Empty where one is: nothing is between a number and none.
PieceRange RangeBetween(const PieceRange& earlier, const PieceRange& later);

/// Numbers of the bricks that together cover `samples`, in ascending order.
std::vector<std::int64_t> BricksTouching(const BrickLayout& layout, const Box& samples);

} // namespace banyan

#endif
