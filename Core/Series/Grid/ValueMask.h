// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Grid_ValueMask_h
#define banyan_Series_Grid_ValueMask_h

#include <cstdint>

namespace banyan
{

/// The 64-bit occupancy mask of a brick: bit b is set when some point inside the brick (not only a
/// sample: any trilinear interpolant too) may have a value in bin b of the range. Together with the
/// mask of values that a transfer function makes visible, one AND tells whether the brick can be
/// seen. Conservative: a bit too many costs time, a bit too few would lose a picture.
using ValueMask = std::uint64_t;

/// The range that masks are made over: 64 equal bins over [Low, High]. Values outside count for the
/// first or last bin. A degenerate range puts everything into bin 0.
struct MaskRange
{
  double Low = 0.0;
  double High = 1.0;

  bool operator==(const MaskRange& other) const
  {
    return this->Low == other.Low && this->High == other.High;
  }

  int BinOf(double value) const
  {
    if (!(this->High > this->Low) || !(value > this->Low))
    {
      return 0;
    }
    // Halves, because the width of a range of doubles may overflow.
    const double width = 0.5 * this->High - 0.5 * this->Low;
    const double bin = width > 0.0 ? (0.5 * value - 0.5 * this->Low) / width * 64.0 : 0.0;
    return bin >= 63.0 ? 63 : static_cast<int>(bin);
  }
};

/// Bits first..last, both included.
inline ValueMask MaskOfBins(int first, int last)
{
  const ValueMask upTo = last >= 63 ? ~ValueMask{ 0 } : (ValueMask{ 1 } << (last + 1)) - 1;
  return upTo & ~((ValueMask{ 1 } << first) - 1);
}

} // namespace banyan

#endif
