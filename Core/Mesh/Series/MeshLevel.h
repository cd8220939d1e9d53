// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Series_MeshLevel_h
#define banyan_Mesh_Series_MeshLevel_h

#include "Mesh/Series/StoredMesh.h"

#include <vector>

namespace banyan
{

/// Cells of a mesh, or of a coarser one, with points of the mesh.
struct MeshCells
{
  std::vector<std::int64_t> Connectivity; ///< `[cell][8]`: points of the mesh, corners x fastest
  /// The leaves that became this cell: from this one on, up to those of the next.
  std::vector<std::uint32_t> FirstLeaf;
  std::int64_t Count() const { return static_cast<std::int64_t>(this->Connectivity.size() / 8); }
};

/// The cells of a coarser mesh: cubes of 2^level finest cells that smaller cells fill become one
/// cell each, with the points of the mesh at its corners. Cubes with holes become cells of smaller
/// cubes, as large as can be. Cells that are larger stay. In the order of Morton keys.
/// @param level 1 or more; from the level of the whole octree on, one cell is what is left of a
/// cube
MeshCells CoarserCells(const StoredMesh& mesh, int level);

} // namespace banyan

#endif
