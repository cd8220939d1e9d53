// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cells_CheckMesh_h
#define banyan_Cells_CheckMesh_h

#include "Cells/CellMesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace banyan
{

class ThreadPool;

/// How many cells of a mesh are drawn, and what is wrong with the others. Plain memory: ranks send
/// it as it is.
struct CellCounts
{
  /// Cells with something in common.
  struct Some
  {
    std::int64_t Count = 0;
    std::int64_t First = -1; ///< the lowest number of them
    std::int64_t Rank = -1;  ///< where the first is; -1 where all cells are on one rank
  };

  std::array<std::int64_t, 5> PerShape{}; ///< drawn cells, by the number of their CellShape
  Some NotFinite;                         ///< left out: coordinates not finite, or too large
  Some WithoutVolume;                     ///< left out: all corners in a plane
  Some OtherTypes;                        ///< left out: not of a shape that is drawn
  int FirstOtherType = 0;                 ///< as VTK numbers types
  Some OtherCounts;                       ///< left out: not as many points as their type has
  std::int64_t FirstCount = 0;            ///< of points that the first of these has
  int FirstCorners = 0;                   ///< that it should have
  Some Folded; ///< drawn, but with corners at which they are mirrored, and others where not

  std::int64_t Repeated = 0; ///< left out by OrderOfCells; CheckCells does not count them

  /// How many cells are drawn.
  std::int64_t Drawn() const;

  /// Counts cells of another rank's piece, too.
  /// @param rank higher than those that were counted before
  void Count(CellCounts other, int rank);

  /// Sentences about cells that are left out or folded, each with the first of them.
  std::vector<std::string> Remarks() const;
};

/// Which cells of a mesh are drawn. Takes a byte per cell where some are not drawn.
struct CellFacts : CellCounts
{
  /// Coordinates beyond this are not drawn: their products would not be finite.
  static constexpr double MostCoordinate = 1e150;

  std::vector<std::uint8_t> LeftOut; ///< not 0 for cells that are not drawn; empty where all are

  bool Draws(std::int64_t cell) const
  {
    return this->LeftOut.empty() || this->LeftOut[static_cast<std::size_t>(cell)] == 0;
  }
};

/// Looks at all cells, in parallel. Hidden ones are not looked at, and not counted.
/// Throws Error when a cell refers to a point that is not there, or a grid has not the points and
/// cells that follow from its size.
CellFacts CheckCells(const CellMesh& mesh, ThreadPool& pool);

} // namespace banyan

#endif
