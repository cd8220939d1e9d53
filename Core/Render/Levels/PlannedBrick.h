// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Levels_PlannedBrick_h
#define banyan_Render_Levels_PlannedBrick_h

#include "Render/Bricks/BrickSource.h"
#include "Render/Scene/FloatImage.h"

#include <cstdint>
#include <optional>

namespace banyan
{

/// A brick that is to be drawn, or several bricks side by side that are drawn as one.
struct PlannedBrick
{
  std::int64_t Number = 0; ///< in the source; the first one's, where several are drawn as one
  Box Together;            ///< positions of the bricks drawn as one; empty for a single brick
  int Level = 0;           ///< BrickSource::BrickLevel
  Box Cells;               ///< cells to pack, counted in cells of the brick
  Box Drawn;               ///< the part of them to draw, counted in cells of the source
  PixelRect Footprint;     ///< of Drawn; inside the viewport, never empty
  float HighestRank = 0;   ///< that a sample of it may have; projections only
  /// The entry of the opacity table that all samples have, where they have one and are not shaded.
  /// Such a brick is never loaded.
  std::optional<int> Entry;

  /// How many bricks of the source it is made of.
  int Count() const
  {
    return this->Together.Empty() ? 1 : static_cast<int>(this->Together.Count());
  }

  /// Calls function(number) for each brick of the source that it is made of.
  template <class Function>
  void ForEach(const BrickSource& source, Function&& function) const;

  /// The range of all finite values in it.
  ValueRange RangeIn(const BrickSource& source) const;
  /// Bytes that it takes as the source loads it.
  std::uint64_t LoadBytes(const BrickSource& source) const;
  /// Bytes that it takes as packed for drawing.
  std::uint64_t PackedBytes(const BrickSource& source, bool shaded) const;
  /// Bytes that it takes as loaded and as packed for drawing; 0 if it is never loaded.
  std::uint64_t BytesToDraw(const BrickSource& source, bool shaded) const;
  /// The number under which its packed form is kept. Bricks that are packed together have numbers
  /// of their own, one kind for groups of at most 8 and another for larger ones.
  std::int64_t KeptNumber(const BrickSource& source) const;
};

template <class Function>
void PlannedBrick::ForEach(const BrickSource& source, Function&& function) const
{
  if (this->Together.Empty())
  {
    function(this->Number);
    return;
  }
  const glm::ivec3 counts = source.Bricks();
  const glm::ivec3 size = this->Together.Size();
  for (std::int64_t i = 0; i < this->Together.Count(); ++i)
  {
    const auto place = static_cast<int>(i);
    const glm::ivec3 p = this->Together.Lo + glm::ivec3(place % size.x, place / size.x % size.y,
                                               place / size.x / size.y);
    function(BrickSource::NumberOf(p, counts));
  }
}

} // namespace banyan

#endif
