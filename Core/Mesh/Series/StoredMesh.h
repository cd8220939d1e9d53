// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Series_StoredMesh_h
#define banyan_Mesh_Series_StoredMesh_h

#include "Base/Bytes.h"
#include "Mesh/Octree/ElementOctree.h"
#include "Mesh/Series/MeshAtlas.h"

#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace banyan
{

/// The order of a cell's corners: the place in the cell of each corner of the leaf, whose corners
/// count x first, then y, then z.
using CornerOrder = std::array<std::uint8_t, 8>;

/// A mesh as a series keeps it: everything that brings back the grid that it was, bit for bit, and
/// where each of its points and cells lies in the image that values are encoded as.
///
/// *Leaves* are cells in the order of their Morton keys, *nodes* points in the order in which
/// leaves use them first (corners as above); behind them come points that no cell uses.
struct StoredMesh
{
  // The grid, in its own order.
  ScalarType PointType = ScalarType::Float32;
  Bytes Points;                           ///< x, y, z of each point, as numbers of PointType
  std::vector<std::int64_t> Connectivity; ///< `[cell][8]`, in the cells' own order of corners
  std::vector<std::uint8_t> CellTypes;    ///< VTK's numbers: 11 (voxel) or 12 (hexahedron)

  // The octree.
  OctreeLeaves Leaves;
  std::vector<std::uint32_t> CellOfLeaf;
  std::vector<CornerOrder> Orders;
  std::vector<std::uint16_t> OrderOfLeaf;
  std::vector<std::uint32_t> PointOfNode;
  glm::dvec3 Origin{
    0.0
  }; ///< of the lattice, and the edges of its cells: where points are expected
  glm::dvec3 Edge{ 1.0 };

  // The image.
  std::optional<MeshAtlas> Atlas;
  std::vector<std::uint32_t> SampleOfPoint;
  std::vector<std::uint32_t> SampleOfCell;
  /// Samples that are not needed, but are known: they show a node that is kept elsewhere (first the
  /// sample, then the one that it equals).
  std::vector<std::pair<std::uint32_t, std::uint32_t>> Copies;

  std::int64_t PointCount() const
  {
    return static_cast<std::int64_t>(this->Points.size() / (3 * SizeOf(this->PointType)));
  }
  std::int64_t CellCount() const { return this->Leaves.Count(); }

  /// The point at a corner of a leaf.
  std::int64_t PointAt(std::size_t leaf, std::size_t corner) const
  {
    return this->Connectivity[8 * std::size_t{ this->CellOfLeaf[leaf] } +
                              this->Orders[this->OrderOfLeaf[leaf]][corner]];
  }
};

/// Makes all of that of a mesh whose octree is known.
/// @param cellTypes of each cell, or null: all are hexahedra
/// Throws Error when the mesh is too large for one series, or a point lies at two places.
std::shared_ptr<const StoredMesh> StoreMesh(
  const ElementOctree& tree, const std::uint8_t* cellTypes);

/// The mesh as the content of a file: see Documentation/format.md. Equal meshes give equal bytes.
Bytes MeshToBytes(const StoredMesh& mesh);

/// Inverse of MeshToBytes. Throws Error when the bytes are no such file, or say what cannot be:
/// nothing of it is trusted.
std::shared_ptr<const StoredMesh> MeshFromBytes(const Bytes& bytes);

} // namespace banyan

#endif
