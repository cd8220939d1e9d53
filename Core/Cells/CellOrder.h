// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cells_CellOrder_h
#define banyan_Cells_CellOrder_h

#include "Cells/CellLattice.h"

#include <cstdint>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Where a cell stands in the order. Cells with all corners in common have the same key.
struct CellKey
{
  std::uint64_t Place = 0; ///< on the Morton curve
  std::uint64_t Hash = 0;  ///< of the places of corners

  friend bool operator==(const CellKey& a, const CellKey& b)
  {
    return a.Place == b.Place && a.Hash == b.Hash;
  }
  friend bool operator<(const CellKey& a, const CellKey& b)
  {
    return a.Place != b.Place ? a.Place < b.Place : a.Hash < b.Hash;
  }
};

/// The numbers of all drawn cells in the one order that they are drawn in: along a Morton curve by
/// their middles, quantised to 21 bits along the longest axis of the lattice. Cells with the same
/// key follow one another by a hash of the places of their corners, which does not depend on how
/// these are numbered. So the same cells come in the same order, however a mesh numbers its cells
/// and points, for any number of threads. Of cells with all corners in common the last one counts,
/// and the others are left out.
///
/// Takes 4 bytes per cell, and 24 more meanwhile.
/// @param lattice around all drawn cells
/// Throws Error when the mesh has 2^32 cells or more.
std::vector<std::uint32_t> OrderOfCells(
  const CellMesh& mesh, const CellFacts& facts, const CellLattice& lattice, ThreadPool& pool);

/// Keys of some cells of a mesh: those of pieces of it compare as all do.
class CellKeys
{
public:
  /// Both must stay.
  /// @param lattice that cells were brought into order by
  CellKeys(const CellMesh& mesh, const CellLattice& lattice)
    : Mesh(mesh)
    , Lattice(lattice)
  {
  }

  /// @param number of a cell that is drawn
  CellKey Of(std::int64_t number) const;

private:
  const CellMesh& Mesh;
  const CellLattice& Lattice;
};

} // namespace banyan

#endif
