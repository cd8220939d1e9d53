// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Octree_ElementOctree_h
#define banyan_Mesh_Octree_ElementOctree_h

#include "Base/Box.h"
#include "Base/Hash.h"
#include "Base/HeldArray.h"
#include "Base/Morton.h"
#include "Mesh/Octree/HexMesh.h"
#include "Mesh/Octree/MeshSurvey.h"

#include <glm/mat4x4.hpp>

#include <array>
#include <memory>

namespace banyan
{

class ThreadPool;

/// A point of the mesh that is no corner of a cell that it touches: it lies on a face or an edge of
/// a larger one.
struct HangingNode
{
  std::int64_t Node = 0;
  std::int64_t Leaf = 0;  ///< the largest cell that it hangs on
  glm::vec3 Part{ 0.0f }; ///< where in that cell, from 0 to 1 along each axis: exact
};

/// A point with the place of another one, whose value counts for both.
struct TwinNode
{
  std::int64_t Node = 0;
  std::int64_t First = 0; ///< the one that counts: the lowest number of all at this place
};

/// The octree that the cells of a mesh of axis-aligned boxes are the leaves of.
///
/// Cells may be longer along one axis than along another, as long as all have the same shape scaled
/// by powers of two. Positions are whole numbers of the finest edges: those of the *lattice*. Where
/// no cell is, there is a hole; nothing else has to be complete. Neighbours may differ by any
/// number of levels.
///
/// Found once per mesh, in O(n log n): nothing here depends on values. Takes about 14 bytes per
/// cell, and one per point, beside the mesh itself, which it refers to (40 more while it is made).
/// @par Source: section 4 of "Visualizing Very Large-Scale Earthquake Simulations" builds it once
/// per mesh, too, from the mesh generator's octree; here the mesh is all there is.
class ElementOctree
{
public:
  /// Throws Error with a sentence that says which cell does not fit into an octree, and why:
  /// - out-of-range points, coordinates that are not finite, cells without extent,
  /// - cells that are not axis-aligned boxes within LatticeAxis::Tolerance,
  /// - edges that are not one power of two of the finest edge along all axes,
  /// - cells that begin elsewhere than at multiples of their size, and cells that overlap,
  /// - more than 2^21 finest cells along an axis, or 2^32 - 2 cells.
  /// @param tolerance how far a point may lie beside the lattice, in finest edges: it counts as if
  /// it were there. At most LargestTolerance. More than the default is for meshes whose points were
  /// moved, by the displacements of an earthquake, say
  static std::shared_ptr<const ElementOctree> Find(
    const HexMesh& mesh, ThreadPool& pool, double tolerance = DefaultTolerance);
  static constexpr double DefaultTolerance = 1.0 / 1024;
  static constexpr double LargestTolerance = 1.0 / 16;

  /// How many were found in this process so far: new values do not add to it.
  static std::int64_t FoundSoFar();

  /// Without its points if they had an owner of their own (HexMesh::PointOwner).
  const HexMesh& Mesh() const { return this->Cells; }

  /// World = Origin + position * Edge.
  const glm::dvec3& Origin() const { return this->LatticeOrigin; }
  const glm::dvec3& Edge() const { return this->FinestEdge; }
  const glm::dvec3& Tolerance() const { return this->LatticeTolerance; }
  glm::dmat4 LatticeToWorld() const;

  /// All cells, in finest cells of the lattice.
  const Box& Domain() const { return this->DomainCells; }

  /// Leaves stand in the order of their Morton keys.
  std::int64_t LeafCount() const { return static_cast<std::int64_t>(this->Keys.size()); }
  MortonKey KeyOfLeaf(std::int64_t leaf) const { return this->Keys[Index(leaf)]; }
  int LevelOfLeaf(std::int64_t leaf) const { return this->Levels[Index(leaf)]; }
  glm::ivec3 CornerOfLeaf(std::int64_t leaf) const { return PositionOfKey(this->KeyOfLeaf(leaf)); }
  std::int64_t CellOfLeaf(std::int64_t leaf) const { return this->CellNumbers[Index(leaf)]; }
  int CoarsestLevel() const { return this->CoarsestLeaf; }
  /// Of where leaves are that follow one another.
  Hash128 HashOfLeaves(std::int64_t first, std::int64_t end) const;

  /// Points at the corners of a leaf: bit 0 of the corner's number is along x, bit 1 y, bit 2 z.
  void NodesOfLeaf(std::int64_t leaf, std::int64_t (&nodes)[8]) const
  {
    this->NodesOfCell(this->CellOfLeaf(leaf), nodes);
  }
  /// The same of a cell of the mesh: the quicker way through all of them, since they lie one after
  /// another.
  void NodesOfCell(std::int64_t cell, std::int64_t (&nodes)[8]) const
  {
    const std::size_t order = this->OrderOfCell.empty() ? 0 : this->OrderOfCell[Index(cell)];
    const std::array<std::uint8_t, 8>& places = this->CornerOrders[order];
    const auto take = [&](const auto* ids)
    {
      for (std::size_t i = 0; i < 8; ++i)
      {
        nodes[places[i]] = ids[i];
      }
    };
    this->Cells.IdType == ScalarType::Int64
      ? take(static_cast<const std::int64_t*>(this->Cells.Connectivity) + 8 * cell)
      : take(static_cast<const std::int32_t*>(this->Cells.Connectivity) + 8 * cell);
  }
  /// Begins to read what NodesOfLeaf needs of a leaf soon: leaves that follow one another may be
  /// cells far from each other.
  /// @param leaf may lie behind the last one
  void PrefetchLeaf(std::int64_t leaf) const
  {
    if (leaf < this->LeafCount())
    {
      const auto bytes = 8 * static_cast<std::int64_t>(SizeOf(this->Cells.IdType));
      const char* const ids =
        static_cast<const char*>(this->Cells.Connectivity) + this->CellOfLeaf(leaf) * bytes;
      __builtin_prefetch(ids);
      __builtin_prefetch(ids + bytes - 1);
    }
  }

  /// The leaf that contains a finest cell; -1 in holes and outside.
  std::int64_t LeafAt(const glm::ivec3& cell) const;

  /// A leaf that touches a point of the lattice: the largest one; -1 when there is none.
  std::int64_t LargestLeafAround(const glm::ivec3& point) const;

  /// The first leaf with a key that is not below this one.
  std::int64_t LeafFrom(MortonKey key) const;

  /// Hanging nodes of larger cells come first: the corners of a cell that hang themselves stand
  /// before the nodes that hang on it.
  const HeldArray<HangingNode>& Hanging() const { return this->HangingNodes; }
  /// Some meshes have points of their own for each cell, or for each part.
  const HeldArray<TwinNode>& Twins() const { return this->TwinNodes; }

  /// Bytes that it takes, beside the mesh that it refers to.
  std::size_t Bytes() const;

  /// Finest cells in the domain that no leaf covers.
  std::int64_t HoleCells() const { return this->Holes; }
  /// Hanging points on cells that are more than twice as large as another cell at their side: 0 for
  /// meshes that are balanced 2:1 across faces and edges.
  std::int64_t UnbalancedNodes() const { return this->Unbalanced; }

private:
  friend class OctreeCoarsener;
  friend class OctreeFinder;
  friend class NodeFinder;
  friend class OctreeBytes;
  ElementOctree() = default;

  static std::size_t Index(std::int64_t i) { return static_cast<std::size_t>(i); }
  void MakeStarts();

  HexMesh Cells;
  glm::dvec3 LatticeOrigin{ 0.0 };
  glm::dvec3 FinestEdge{ 1.0 };
  glm::dvec3 LatticeTolerance{ 0.0 }; ///< lengths
  Box DomainCells;
  int CoarsestLeaf = 0;
  std::int64_t Holes = 0;
  std::int64_t Unbalanced = 0;
  HeldArray<MortonKey> Keys;
  HeldArray<std::uint32_t> CellNumbers; ///< of leaves
  HeldArray<std::uint8_t> Levels;       ///< of leaves
  /// The place in a cell of each corner, three bits each: as cells have it.
  HeldArray<std::array<std::uint8_t, 8>> CornerOrders;
  HeldArray<std::uint16_t> OrderOfCell; ///< empty when all have the first one
  HeldArray<HangingNode> HangingNodes;
  HeldArray<TwinNode> TwinNodes;
  int StartShift = 0;
  HeldArray<std::uint32_t> Starts; ///< of each run of keys: its first leaf
};

} // namespace banyan

#endif
