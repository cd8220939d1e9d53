// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_HiddenCells_h
#define banyan_Render_Bricks_HiddenCells_h

#include "Base/Box.h"

#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace banyan
{

/// Which cells of a whole grid are hidden: a sample in one has no colour. The corners of a hidden
/// cell keep their values, so its neighbours are drawn as ever.
///
/// A bit per cell in blocks of which some cells are hidden; other blocks take no memory of their
/// own.
class HiddenCells
{
public:
  static constexpr int BlockEdge = 16; ///< cells; a row of them is one 16-bit number

  /// Nothing is hidden at first.
  /// @param cells of the whole grid, which begins at 0
  explicit HiddenCells(const glm::ivec3& cells);

  /// Hides the cells that have a flag.
  /// @param cells of a piece of the grid
  /// @param flags a byte per cell of the piece, x fastest
  /// @param bits those that hide a cell
  void Hide(const Box& cells, const std::uint8_t* flags, std::uint8_t bits);

  /// How many cells of a box are hidden; the box may reach beyond the grid.
  std::int64_t CountIn(const Box& cells) const;
  bool Any(const Box& cells) const { return this->CountIn(cells) > 0; }
  /// Whether a box has cells of the grid, and all of these are hidden.
  bool All(const Box& cells) const;

  /// Sets a bit for each hidden cell of a box.
  /// @param words `[z][y][wordsPerRow]`, all 0; bit i of a row is that of its cell i
  void CopyBits(const Box& cells, int wordsPerRow, std::uint32_t* words) const;

  /// Hidden cells of the grid whose cells are longer: those of which at least half is.
  /// @param edges of its cells, in cells of this one
  HiddenCells Coarser(const glm::ivec3& edges) const;

  /// For ranks to tell each other what is hidden in their pieces.
  std::string ToBytes() const;
  /// Hides what is hidden in another one of the same grid.
  /// @param bytes ToBytes() of it
  void Add(const std::string& bytes);

private:
  using Rows = std::array<std::uint16_t, BlockEdge * BlockEdge>; ///< `[z][y]`, bit x

  struct Block
  {
    Rows Bits{};
    int Count = 0;
  };

  template <class Function>
  void ForBlocks(const Box& cells, Function&& function) const;
  template <class Function>
  static void ForRows(const Rows& bits, const Box& block, const Box& part, Function&& function);
  std::int64_t NumberOf(const glm::ivec3& block) const;
  Box CellsOf(const glm::ivec3& block) const;
  void HideIn(const glm::ivec3& block, const Rows& bits);
  void HideAll(const glm::ivec3& block);
  Rows RowsOf(std::int64_t number) const;

  enum class State : std::uint8_t
  {
    None,
    Some,
    All
  };

  glm::ivec3 Cells;
  glm::ivec3 Blocks;
  std::vector<State> States; ///< per block, x fastest
  std::unordered_map<std::int64_t, Block> Mixed;
};

} // namespace banyan

#endif
