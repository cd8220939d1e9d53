// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_OctreeMesh_h
#define banyan_Data_OctreeMesh_h

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace banyan
{

class ThreadPool;

/// A block of cubes of equal size, the roots of the octrees.
struct OctreeMeshShape
{
  std::array<int, 3> Roots = { 1, 1, 1 }; ///< along x, y, z
  double RootEdge = 1.0;
  std::array<double, 3> Origin{}; ///< the corner with the smallest coordinates
  /// The deepest level there can be; roots have level 0. Roots along an axis times 2^MaxLevel is
  /// less than 2^20, and MaxLevel at most 15.
  int MaxLevel = 8;
};

/// A cube of an octree: a cell, or one that is divided further.
struct MeshOctant
{
  std::array<std::uint32_t, 3> Corner; ///< the smallest, in edges of the smallest possible cubes
  int Level;
};

/// A corner of cells that lies inside an edge or a face of a larger cell. Its value is the mean of
/// the values at four masters, which never hang themselves.
struct MeshHangingNode
{
  std::uint32_t Node;
  /// The corners of the face; for an edge its two ends, each of them twice.
  std::array<std::uint32_t, 4> Masters;
};

/// A mesh of cubes that are the leaves of octrees, for finite elements: cells that share a face or
/// an edge differ by at most one level, so that values at the hanging nodes follow from corners of
/// one larger cell.
///
/// Cells and nodes are numbered along the Morton curve (of cells: by their smallest corner). To
/// build it takes O(n log n) time; while it is built about 120 bytes a cell, later about 50.
///
/// @par Source: Tu, O'Hallaron, Lopez (2002), Etree: a database-oriented method for generating
/// large octree meshes; Sundar, Sampath, Biros (2008), Bottom-up construction and 2:1 balance
/// refinement of linear octrees in parallel.
class OctreeMesh
{
public:
  /// Whether a cube is too large. Asked once for each cube whose parent is; called from several
  /// threads at once.
  using TooLarge = std::function<bool(const MeshOctant& octant)>;

  /// Throws Error when the shape breaks the limits above or there are more than 2^32 - 1 nodes.
  OctreeMesh(const OctreeMeshShape& shape, const TooLarge& tooLarge, ThreadPool& pool);

  const OctreeMeshShape& Shape() const { return this->Layout; }
  std::size_t CellCount() const { return this->CellKeys.size(); }
  std::size_t NodeCount() const { return this->NodeKeys.size(); }
  MeshOctant Cell(std::size_t cell) const;
  /// The eight nodes of a cell, x fastest, then y, then z: the order of VTK_VOXEL.
  const std::array<std::uint32_t, 8>& Corners(std::size_t cell) const
  {
    return this->CellCorners[cell];
  }
  std::array<double, 3> Point(std::size_t node) const;
  /// Sorted by node, each once.
  const std::vector<MeshHangingNode>& Hanging() const { return this->HangingNodes; }

  double EdgeOfLevel(int level) const;
  /// Coordinates of the smallest corner of a cube.
  std::array<double, 3> CornerPoint(const MeshOctant& octant) const;
  /// The cell that a point lies in; of several, the one with the largest coordinates. Throws Error
  /// when the point is outside.
  std::size_t CellAt(const std::array<double, 3>& point) const;

private:
  void FindNodes(ThreadPool& pool);
  /// @param divided Morton keys of the cubes that have children, per level
  void FindHangingNodes(const std::vector<std::vector<std::uint64_t>>& divided, ThreadPool& pool);
  std::uint32_t NodeAt(std::uint64_t morton) const;

  OctreeMeshShape Layout;
  std::vector<std::uint64_t> CellKeys; ///< Morton key of the corner << 4 | level, sorted
  std::vector<std::uint64_t> NodeKeys; ///< Morton keys, sorted
  std::vector<std::array<std::uint32_t, 8>> CellCorners;
  std::vector<MeshHangingNode> HangingNodes;
};

} // namespace banyan

#endif
