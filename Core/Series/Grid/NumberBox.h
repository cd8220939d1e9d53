// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Grid_NumberBox_h
#define banyan_Series_Grid_NumberBox_h

#include <cstdint>

namespace banyan
{

/// Samples of a plane of lattice numbers in which a brick is: rows of equally spaced ones. All
/// distances in elements.
template <class Number>
struct NumberBox
{
  const Number* Numbers = nullptr; ///< sample 0 of row 0 of slice 0
  const Number* Before = nullptr;  ///< the same of another step, laid out alike; or null
  const Number* Next = nullptr;    ///< the same of a step that comes next: is asked for; or null
  int Count = 1;                   ///< samples of a row
  int Stride = 1;                  ///< from sample to sample: 1 or 2
  std::int64_t RowGap = 0, SliceGap = 0;
  int Rows = 1, Slices = 1;
};

/// Holds what the table of bricks says of samples.
struct NumberExtremes
{
  std::int32_t Low = INT32_MAX, High = INT32_MIN;
  /// The same for the same numbers of boxes that are laid out alike, and hardly for others.
  std::uint32_t Check = 0;

  /// Whether numbers of boxes that are laid out alike may be the same.
  bool MayBeThoseOf(const NumberExtremes& other) const
  {
    return *this == other && this->Check == other.Check;
  }
  friend bool operator==(const NumberExtremes& a, const NumberExtremes& b)
  {
    return a.Low == b.Low && a.High == b.High;
  }
};

/// Adds the samples of a box.
/// @param Number std::int16_t or std::int32_t
template <class Number>
void IncludeBox(const NumberBox<Number>& box, NumberExtremes& extremes);

/// Whether every sample is that of the other step.
/// @param box with `Before`
template <class Number>
bool SameAsBefore(const NumberBox<Number>& box);

} // namespace banyan

#endif
