// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Octree_CoarserOctree_h
#define banyan_Mesh_Octree_CoarserOctree_h

#include "Mesh/Octree/ElementOctree.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

/// The octree of a coarser mesh, on the lattice of the mesh that it was made of: positions mean the
/// same in both.
struct CoarserOctree
{
  /// Its Mesh() has connectivity, but no coordinates: those of its points are not needed any more.
  std::shared_ptr<const ElementOctree> Tree;
  /// The point of the finer mesh that each of its points is.
  std::vector<std::uint32_t> NodeOfPoint;
};

/// Merges elements that are smaller than 2^level finest edges where they fill cubes (LeafMerging).
/// The corners of the larger ones are points of the mesh, and keep their values; points that lie on
/// faces and edges of larger elements hang now, so that the field has no cracks there (NodalField).
///
/// In O(n log n). Takes about 14 bytes per element and 5 per point, and while it is made 4 bytes
/// per point of the finer mesh.
/// @par Source: section 4.1 of "Visualizing Very Large-Scale Earthquake Simulations" moves up the
/// octree, too; what it does at the borders of levels it does not say.
/// @param level at least 1
CoarserOctree CoarserOctreeOf(const ElementOctree& finer, int level, ThreadPool& pool);

} // namespace banyan

#endif
