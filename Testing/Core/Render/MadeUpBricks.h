// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Render_MadeUpBricks_h
#define banyan_Testing_Core_Render_MadeUpBricks_h

#include "Base/Error.h"
#include "Render/Bricks/BrickSource.h"
#include "Render/Dice.h"

#include <algorithm>
#include <array>
#include <vector>

namespace scenes
{

/// Many bricks without values, cut by planes at random places: regions of bricks that are much
/// alike, single ones that are not, some of one value, and some without any.
class MadeUpBricks : public banyan::BrickSource
{
public:
  /// @param cells of all bricks, which begin at 0
  /// @param edge cells per axis of most bricks
  MadeUpBricks(Dice& dice, const glm::ivec3& cells, int edge)
  {
    const bool even = dice.Whole(0, 1) == 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      std::vector<int>& planes = this->Planes[static_cast<std::size_t>(axis)];
      for (int at = 0; at < cells[axis]; at += even ? edge : dice.Whole(1, edge))
      {
        planes.push_back(at);
      }
      planes.push_back(cells[axis]);
    }
    const int alike = dice.Whole(1, 20);
    double value = 0.0;
    for (std::int64_t i = 0; i < banyan::Box{ glm::ivec3(0), this->Bricks() }.Count(); ++i)
    {
      value = dice.Whole(0, alike) == 0 ? dice.In(0.0, 1.0) : value;
      banyan::ValueRange range{ value, std::min(1.0, value + dice.In(0.0, 0.2)) };
      const int kind = dice.Whole(0, 30);
      range = kind == 0   ? banyan::ValueRange{}
              : kind == 1 ? banyan::ValueRange{ value, value }
                          : range;
      const banyan::MaskRange over = this->MasksAreOver();
      this->Ranges.push_back(range);
      this->Masks.push_back(
        range.Empty() ? 0 : banyan::MaskOfBins(over.BinOf(range.Low), over.BinOf(range.High)));
    }
  }

  glm::ivec3 Bricks() const override
  {
    return { this->CountAlong(0), this->CountAlong(1), this->CountAlong(2) };
  }
  banyan::Box CellsOf(std::int64_t brick) const override
  {
    const glm::ivec3 counts = this->Bricks();
    const std::int64_t at[3] = { brick % counts.x, brick / counts.x % counts.y,
      brick / counts.x / counts.y };
    banyan::Box cells;
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::vector<int>& planes = this->Planes[static_cast<std::size_t>(axis)];
      cells.Lo[axis] = planes[static_cast<std::size_t>(at[axis])];
      cells.Hi[axis] = planes[static_cast<std::size_t>(at[axis]) + 1];
    }
    return cells;
  }
  banyan::ValueRange RangeOf(std::int64_t brick) const override
  {
    return this->Ranges[static_cast<std::size_t>(brick)];
  }
  banyan::ValueMask MaskOf(std::int64_t brick) const override
  {
    return this->Masks[static_cast<std::size_t>(brick)];
  }
  banyan::MaskRange MasksAreOver() const override { return { 0.0, 1.0 }; }
  std::optional<banyan::UniformValue> UniformValueOf(std::int64_t brick) const override
  {
    const banyan::ValueRange range = this->RangeOf(brick);
    return range.Low == range.High ? std::optional(banyan::UniformValue{ range.Low })
                                   : std::nullopt;
  }
  std::size_t LoadBytes(std::int64_t brick) const override
  {
    return static_cast<std::size_t>(this->CellsOf(brick).Count() + brick % 7);
  }
  banyan::BrickView Load(std::int64_t /*brick*/) override { throw banyan::Error("No values"); }

private:
  int CountAlong(std::size_t axis) const { return static_cast<int>(this->Planes[axis].size()) - 1; }

  std::array<std::vector<int>, 3> Planes;
  std::vector<banyan::ValueRange> Ranges;
  std::vector<banyan::ValueMask> Masks;
};

} // namespace scenes

#endif
