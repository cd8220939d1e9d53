// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Sampling_CellShapes_h
#define banyan_Mesh_Sampling_CellShapes_h

#include "Mesh/Octree/HexMesh.h"
#include "Mesh/Sampling/CellHull.h"
#include "Mesh/Sampling/TrilinearCell.h"

#include <cstdint>
#include <vector>

namespace banyan
{

class ThreadPool;

/// The shapes of a mesh of general hexahedra, on a lattice that suits them: its coarse edges are
/// the medians of the cells' extents along x, y and z, and begin where the mesh does.
///
/// The corners of a cell stand as VTK_HEXAHEDRON has them, or, when the cell is close to an
/// axis-aligned box (as a VTK_VOXEL is), in any order. Takes 580 bytes per cell.
class CellShapes
{
public:
  /// Throws Error for the first cell with points that do not exist or are not finite, or without
  /// volume.
  /// @param refinement how many times thinner than the thinnest cell the finest edge shall be, as
  /// a power of two; less where the lattice would have more than 2^19 of them along an axis
  CellShapes(const HexMesh& mesh, int refinement, ThreadPool& pool);

  /// Positions of the lattice are in units of its finest edges.
  const glm::dvec3& Origin() const { return this->LatticeOrigin; }
  const glm::dvec3& Edge() const { return this->FinestEdge; }
  /// Finest edges from the origin on that the mesh takes up.
  const glm::ivec3& Extent() const { return this->Size; }

  std::int64_t Count() const { return static_cast<std::int64_t>(this->Heights.size()); }
  /// The box around a cell.
  const glm::dvec3& Low(std::int64_t cell) const { return this->Lows[Index(cell)]; }
  const glm::dvec3& High(std::int64_t cell) const { return this->Highs[Index(cell)]; }
  /// The smallest height of the parallelepiped that the cell is in its middle.
  double Height(std::int64_t cell) const { return this->Heights[Index(cell)]; }
  const TrilinearCell& Shape(std::int64_t cell) const { return this->Cells[Index(cell)]; }
  /// False when no point of a cube is in the cell: the parallelepiped that the cell is in its
  /// middle, and how far it may be from it at most, tell.
  /// @param half of the cube's edge; may be 0
  bool MayTouch(std::int64_t cell, const glm::dvec3& centre, double half) const
  {
    const Middle& middle = this->Middles[Index(cell)];
    const glm::dvec3 off = glm::abs(middle.Inverse * (centre - middle.Centre));
    const glm::dvec3 reach = middle.Reach + half * middle.PerUnit;
    return off.x <= reach.x && off.y <= reach.y && off.z <= reach.z;
  }
  /// False when a point is not in the cell: there are planes between them.
  bool MayHold(std::int64_t cell, const glm::dvec3& point) const
  {
    return this->Hulls[Index(cell)].MayHold(point);
  }
  /// Where in the cell a point is if the cell is taken for this parallelepiped.
  glm::dvec3 LinearPlace(std::int64_t cell, const glm::dvec3& point) const
  {
    const Middle& middle = this->Middles[Index(cell)];
    return 0.5 + middle.Inverse * (point - middle.Centre);
  }
  /// Numbers of the points of a cell, in the order of TrilinearCell.
  void NodesOf(std::int64_t cell, std::array<std::int64_t, 8>& nodes) const;

  /// Cells that are turned inside out at some corners: where they overlap themselves one of the
  /// values is drawn.
  std::int64_t Tangled() const { return this->TangledCells; }
  std::int64_t FirstTangled() const { return this->FirstTangledCell; }

private:
  static std::size_t Index(std::int64_t i) { return static_cast<std::size_t>(i); }
  /// The order of a cell's points in the mesh.
  enum class Order : std::uint8_t
  {
    Hexahedron,
    Voxel,
    Other
  };

  /// The parallelepiped that a cell is in its middle.
  struct Middle
  {
    glm::dmat3 Inverse{ 1.0 }; ///< from space to parts of the cell
    glm::dvec3 Centre{ 0.0 };
    glm::dvec3 Reach{ 0.5 };   ///< largest distance of the cell's points from the centre, in parts
    glm::dvec3 PerUnit{ 0.0 }; ///< the same of a cube of half-edge 1
  };

  void FindBoxes(ThreadPool& pool);
  void FindOrders(ThreadPool& pool);
  void GivenNodes(std::int64_t cell, std::array<std::int64_t, 8>& nodes) const;
  std::array<int, 8> OrderOf(std::int64_t cell, std::array<std::int64_t, 8>& given) const;
  glm::dvec3 ChooseCoarseEdges();
  double FindHeights(ThreadPool& pool);
  void ChooseLattice(int refinement, ThreadPool& pool);
  void ToLattice(ThreadPool& pool);
  std::array<glm::dvec3, 8> CornersOf(std::int64_t cell) const;
  glm::dvec3 PointAt(std::int64_t node) const;

  HexMesh Mesh;
  glm::dvec3 LatticeOrigin{ 0.0 };
  glm::dvec3 FinestEdge{ 1.0 };
  glm::ivec3 Size{ 0 };
  std::vector<glm::dvec3> Lows;
  std::vector<glm::dvec3> Highs;
  std::vector<TrilinearCell> Cells;
  std::vector<Middle> Middles;
  std::vector<CellHull> Hulls;
  std::vector<float> Heights;
  std::vector<Order> Orders;
  std::int64_t TangledCells = 0;
  std::int64_t FirstTangledCell = -1;
};

} // namespace banyan

#endif
