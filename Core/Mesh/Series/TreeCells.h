// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Series_TreeCells_h
#define banyan_Mesh_Series_TreeCells_h

#include "Mesh/Series/StoredMesh.h"
#include "Series/Quantize/FillValues.h"

#include <vector>

namespace banyan
{

/// The cells of a mesh as the leaves of a grid of trees.
///
/// Trees are cubes of one size: as large as the largest cell at least, and larger ones where the
/// mesh then still has FewestTrees of them and ends where they end. A mesh that ends within the
/// cubes of its largest cells has trees that are filled in part.
struct TreeCells
{
  static constexpr std::int64_t FewestTrees = 64;

  // In the order of Morton keys.
  OctreeLeaves Leaves;
  std::vector<std::int64_t> Corners; ///< `[leaf][8]`: points of the mesh, x fastest
  /// The cells of the mesh in each leaf: from this one on (in the order of keys) up to those of the
  /// next; one more than there are leaves.
  std::vector<std::uint32_t> FirstCell;

  int RootLevel = 0;         ///< trees have 2^RootLevel finest cells along an axis
  glm::ivec3 FirstRoot{ 0 }; ///< of the grid of trees, in trees
  glm::ivec3 Roots{ 0 };     ///< trees along each axis
};

/// @param level 0 for the mesh itself; otherwise as CoarserCells has it
TreeCells TreeCellsOf(const StoredMesh& mesh, int level);

/// The value of the element at its centre, which is the mean of its corners.
/// If one of them is a fill value, that is the result.
/// @param isFill receives whether it is; may be null
template <class T>
double ValueAtCentre(const T (&corners)[8], const FillSet<T>& fills, bool* isFill = nullptr)
{
  double mean = 0.0;
  for (const T value : corners)
  {
    const bool fill = fills.Holds(value);
    if (isFill)
    {
      *isFill = fill;
    }
    if (fill)
    {
      return static_cast<double>(value);
    }
    mean += static_cast<double>(value) / 8.0; // a sum might be infinite
  }
  return mean;
}

} // namespace banyan

#endif
