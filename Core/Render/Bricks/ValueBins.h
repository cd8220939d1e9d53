// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_ValueBins_h
#define banyan_Render_Bricks_ValueBins_h

#include "Series/Grid/ValueMask.h"
#include "Series/Quantize/ValueRange.h"

#include <cstddef>
#include <cstdint>

namespace banyan
{

/// Rows of values in memory.
/// @tparam T float or double
template <class T>
struct ValueRows
{
  const T* Values;
  std::ptrdiff_t Stride; ///< values from row to row
  int Width;
  int Rows;
};

/// Bins of a slice of positions: the lowest and the highest at each. One without a value has
/// NoBinLow and NoBinHigh, and so has what stands behind each row.
struct BinRowsOut
{
  static constexpr std::uint8_t NoBinLow = 255;
  static constexpr std::uint8_t NoBinHigh = 0;

  std::uint8_t* Low;
  std::uint8_t* High;
  /// From row to row: a value per sample, and one behind the row.
  static std::ptrdiff_t PitchOf(int width) { return std::ptrdiff_t{ width } + 1; }
};

/// The bin of each value, as MaskRange::BinOf but for rounding at the edges of bins, for which
/// TransferFunction::VisibleBins has room. What is not finite has none.
/// @param range takes in the finite values
/// Exactness: the same on all processors, that of one value after the other.
void BinValues(
  const ValueRows<float>& rows, const MaskRange& over, const BinRowsOut& out, ValueRange& range);
void BinValues(
  const ValueRows<double>& rows, const MaskRange& over, const BinRowsOut& out, ValueRange& range);

/// All bins from the lowest to the highest of each of some positions.
ValueMask BinsBetween(const std::uint8_t* low, const std::uint8_t* high, std::size_t count);

} // namespace banyan

#endif
