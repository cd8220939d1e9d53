// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cells_BorderFaces_h
#define banyan_Cells_BorderFaces_h

#include "Cells/CheckMesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace banyan
{

class ThreadPool;

/// A face of a drawn cell that no other drawn cell has.
struct BorderFace
{
  std::uint32_t Cell; ///< its place in the order of cells, and not its number
  std::uint8_t Face;  ///< of FacesOf its shape

  friend bool operator==(const BorderFace& a, const BorderFace& b)
  {
    return a.Cell == b.Cell && a.Face == b.Face;
  }
};

/// The border of a mesh, sorted by cell, then by face.
///   - Faces are the same when their corners are at the same places, whatever their numbers: -0 is
///     0, and float32 compares as float64.
///   - A face with three places is a triangle, also when it has four corners; one with fewer is
///   none.
///   - Of a face that more than two cells have, none stays if their number is even, and otherwise
///     that of the first cell in the order.
///
/// Faces are compared by a hash of 64 bits. That two of the three million faces of a million
/// hexahedra are taken for one by chance has a probability below one in a million.
///
/// Takes 8 bytes per face of the border. Meanwhile it takes 8 bytes per point, and up to 56 per
/// face without a partner among 4096 cells that follow one another: about 0.4 faces per hexahedron,
/// 0.25 per tetrahedron. A grid all of whose cells are drawn takes these for its six sides alone.
/// @param order of all drawn cells
/// @return the same for any number of threads
std::vector<BorderFace> BorderFacesOf(const CellMesh& mesh, const CellFacts& facts,
  const std::vector<std::uint32_t>& order, ThreadPool& pool);

/// The same by cell: bit n of a cell's byte for its face n.
/// @param cells in the order
/// @return empty where there is no border
std::vector<std::uint8_t> BorderBitsOf(const std::vector<BorderFace>& border, std::size_t cells);

} // namespace banyan

#endif
