// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_PieceGrid_h
#define banyan_Parallel_Fields_PieceGrid_h

#include "Base/Box.h"

#include <cstdint>
#include <vector>

namespace banyan
{

/// Who holds what of a grid that lies in pieces on the ranks, and the bricks that it is cut into:
/// computed by every rank alone from the extents of all pieces, alike.
///
/// A cell belongs to the rank whose piece has all its corners; where pieces overlap (ghost layers,
/// say), to the lowest such rank. Bricks are cut by whole planes: at the borders of pieces, and in
/// between as evenly as the largest edge allows. So each brick belongs to one rank, or to none
/// where nobody has the data.
class PieceGrid
{
public:
  /// A box of cells that one rank answers for.
  struct Holding
  {
    int Rank = 0;
    Box Cells;
  };

  /// Samples that a rank needs beside its own, and who gives them.
  struct ShellPart
  {
    int From = 0;
    Box Samples;
  };

  PieceGrid() = default;
  /// @param samples of each rank's piece, in samples of the whole grid, which starts at 0; empty
  /// for
  ///        ranks without data
  /// @param brickCells most cells per axis of a brick, at least 1
  PieceGrid(std::vector<Box> samples, int brickCells);

  int Ranks() const { return static_cast<int>(this->Pieces.size()); }
  const Box& SamplesOf(int rank) const { return this->Pieces[static_cast<std::size_t>(rank)]; }
  /// Disjoint.
  const std::vector<Holding>& Holdings() const { return this->Held; }
  /// The box around all cells.
  const Box& Cells() const { return this->Domain; }

  /// x fastest.
  glm::ivec3 Bricks() const;
  std::int64_t Count() const { return static_cast<std::int64_t>(this->Holders.size()); }
  Box CellsOf(std::int64_t brick) const;
  /// The rank that answers for a brick; -1 for nobody.
  int HolderOf(std::int64_t brick) const { return this->Holders[static_cast<std::size_t>(brick)]; }

  /// The samples of a brick.
  /// @param around with one more layer on each side, where the grid has one
  Box BrickSamples(std::int64_t brick, bool around) const;

  /// Whether each of these samples is in some piece.
  bool IsKnown(const Box& samples) const;

  /// Returns the samples of others that a rank needs to give its bricks with a layer around, in
  /// disjoint boxes. Samples that nobody has are in none of them.
  std::vector<ShellPart> ShellOf(int rank) const;

private:
  void AddHoldings();
  void CutIntoBricks(int brickCells);

  std::vector<Box> Pieces;
  std::vector<Holding> Held;
  Box Domain;
  std::vector<int> Planes[3];
  std::vector<std::int32_t> Holders;
};

} // namespace banyan

#endif
