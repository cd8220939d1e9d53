// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_RowAbove_h
#define banyan_Parallel_Composite_RowAbove_h

#include "Parallel/Composite/FragmentMessage.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace banyan
{

/// Numbers of the row above the one that is written or read: 0 where nothing is drawn.
class RowAbove
{
public:
  explicit RowAbove(const std::vector<DrawnSegment>& segments)
  {
    int hi = std::numeric_limits<int>::min();
    this->Lo = std::numeric_limits<int>::max();
    for (const DrawnSegment& segment : segments)
    {
      const int last = segment.X + segment.Step * (segment.Count - 1);
      this->Lo = std::min({ this->Lo, segment.X, last });
      hi = std::max({ hi, segment.X, last });
    }
    this->Rows.assign(static_cast<std::size_t>(hi - this->Lo + 1), NoRow);
    this->Numbers.resize(4 * this->Rows.size());
  }

  /// Calls `action(numbers, above)` for each pixel and keeps what `numbers` are afterwards, if
  /// `after`, or were before.
  template <bool after, typename Action>
  void ForEach(
    const std::vector<DrawnSegment>& segments, std::uint16_t* numbers, const Action& action)
  {
    constexpr std::uint16_t nothing[4] = {};
    for (const DrawnSegment& segment : segments)
    {
      int column = segment.X - this->Lo;
      for (int i = 0; i < segment.Count; ++i, column += segment.Step, numbers += 4)
      {
        std::uint16_t* above = &this->Numbers[4 * static_cast<std::size_t>(column)];
        const bool drawn = this->Rows[column] == segment.Y - 1;
        std::uint16_t kept[4];
        std::memcpy(kept, numbers, sizeof(kept));
        action(numbers, drawn ? above : nothing);
        std::memcpy(above, after ? numbers : kept, sizeof(kept));
        this->Rows[column] = segment.Y;
      }
    }
  }

private:
  static constexpr int NoRow = std::numeric_limits<int>::min();
  int Lo;
  std::vector<int> Rows; ///< per column, which row the numbers are of
  std::vector<std::uint16_t> Numbers;
};

inline void SubtractAbove(const std::vector<DrawnSegment>& segments, std::uint16_t* numbers)
{
  RowAbove(segments).ForEach<false>(segments, numbers,
    [](std::uint16_t* pixel, const std::uint16_t* above)
    {
      for (int c = 0; c < 4; ++c)
      {
        pixel[c] = static_cast<std::uint16_t>(pixel[c] - above[c]);
      }
    });
}

inline void AddAbove(const std::vector<DrawnSegment>& segments, std::uint16_t* numbers)
{
  RowAbove(segments).ForEach<true>(segments, numbers,
    [](std::uint16_t* pixel, const std::uint16_t* above)
    {
      for (int c = 0; c < 4; ++c)
      {
        pixel[c] = static_cast<std::uint16_t>(pixel[c] + above[c]);
      }
    });
}

} // namespace banyan

#endif
