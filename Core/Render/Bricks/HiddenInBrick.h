// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_HiddenInBrick_h
#define banyan_Render_Bricks_HiddenInBrick_h

#include "Base/Box.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace banyan
{

class HiddenCells;

/// Which cells of a brick are hidden, a bit each, for those who draw it. No memory where none is.
class HiddenInBrick
{
public:
  HiddenInBrick() = default;
  /// @param hidden of the grid; null where nothing is hidden
  /// @param cells of the brick
  HiddenInBrick(const HiddenCells* hidden, const Box& cells);

  static std::size_t BytesFor(const Box& cells);
  std::size_t Bytes() const { return this->Bits.size() * sizeof(std::uint32_t); }

  bool Any() const { return !this->Bits.empty(); }
  /// @param cell of the brick, counted from its corner
  bool At(const glm::ivec3& cell) const { return this->Any() && this->Has(cell); }
  /// Whether all cells of a box in the brick are hidden.
  /// @param cells counted from the brick's corner
  bool All(const Box& cells) const;

  /// `[z][y][WordsPerRow]`, bit x; null unless Any.
  const std::uint32_t* Words() const { return this->Any() ? this->Bits.data() : nullptr; }
  int WordsPerRow() const { return this->RowWords; }
  int RowsPerSlice() const { return this->Rows; }

private:
  bool Has(const glm::ivec3& cell) const
  {
    const std::ptrdiff_t row = std::ptrdiff_t{ cell.z } * this->Rows + cell.y;
    const std::uint32_t word =
      this->Bits[static_cast<std::size_t>(row * this->RowWords + cell.x / 32)];
    return (word >> cell.x % 32 & 1u) != 0;
  }

  int RowWords = 0;
  int Rows = 0;
  std::vector<std::uint32_t> Bits;
};

} // namespace banyan

#endif
