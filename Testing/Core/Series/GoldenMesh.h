// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_GoldenMesh_h
#define banyan_Testing_GoldenMesh_h

#include "Mesh/Series/StoredMesh.h"

#include <glm/vec3.hpp>

#include <memory>
#include <vector>

namespace banyan::testing
{

/// The mesh of golden series: cells of two sizes, voxels among hexahedra, in an order of their own,
/// coordinates beside the planes of the grid, and a point that no cell uses.
struct GoldenMesh
{
  std::shared_ptr<const StoredMesh> Mesh;
  std::vector<glm::ivec3> Points; ///< place of each point, in edges of the smallest cell
  std::vector<glm::ivec3> Cells;  ///< lowest corner of each cell

  GoldenMesh();
};

} // namespace banyan::testing

#endif
