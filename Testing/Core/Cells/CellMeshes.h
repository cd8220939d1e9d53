// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Cells_CellMeshes_h
#define banyan_Testing_Core_Cells_CellMeshes_h

#include "Cells/CellMesh.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

/// Meshes of cells to test and to measure with. All are made from seeds: the same on any machine.
namespace cellmeshes
{

/// A mesh that has its arrays, and a value at each point.
struct OwnedCellMesh
{
  banyan::CellMesh::Kind Is = banyan::CellMesh::Kind::Cells;
  /// x, y, z of each point; of a rectilinear grid, the coordinates along x, then y, then z.
  std::vector<double> Points;
  std::vector<float> FloatPoints; ///< in place of Points, which are empty then
  std::vector<std::int64_t> Ids;  ///< cell after cell, as VTK has them
  std::vector<std::int64_t> Offsets;
  std::vector<std::uint8_t> Types; ///< as VTK numbers them
  glm::ivec3 Size{ 0 };            ///< points of grids
  std::vector<float> Values;       ///< one per point

  std::int64_t PointCount() const;
  std::int64_t CellCount() const;
  /// Refers to this mesh.
  banyan::CellMesh View() const;
  std::function<double(std::int64_t)> ValueOfPoint() const;
  std::vector<std::uint32_t> Order() const; ///< all cells, as they stand

  /// @param corners in the order of VTK
  void AddCell(std::uint8_t type, const std::vector<std::int64_t>& corners);
};

using Field = std::function<double(const glm::dvec3&)>;

/// Gives all points their values, at where they are now.
void SetValues(OwnedCellMesh& mesh, const Field& field);
/// slope . p + value
Field LinearField(const glm::dvec3& slope, double value);
/// Eight blobs and two waves over [0, 1]^3, from 0 to 1: the project's standard field.
Field StandardField();

/// How points of a grid over the unit cube are moved.
struct Warp
{
  double Bend = 0.0;       ///< smoothly, by up to this part of the cube along each axis
  double Offset = 0.0;     ///< then each by up to this part of an edge along each axis
  bool KeepBorder = false; ///< points of the cube's faces stay
  std::uint64_t Seed = 1;
};

enum class Cut
{
  Hexahedra,
  Voxels,         ///< hexahedra, with the corners of VTK_VOXEL
  Tetrahedra,     ///< six for each hexahedron
  FiveTetrahedra, ///< five for each hexahedron
  Wedges,         ///< two for each hexahedron
  Pyramids,       ///< six for each hexahedron, around its middle
  Mixed           ///< blocks of all; the faces of neighbours match
};

/// The unit cube in n^3 boxes, which are cut further. Faces of neighbours match.
OwnedCellMesh Cube(int n, Cut cut, const Warp& warp = {});

/// A curvilinear grid between two cylinders around the z axis.
/// @param cells along the radius, the angle and the height
/// @param inner radius; the outer one is 1, and the height is 1
/// @param angle of the sector, from 0 on
OwnedCellMesh Sector(const glm::ivec3& cells, double inner = 0.4, double angle = 2.0);

/// A rectilinear grid over the unit cube.
/// @param uneven the longest edge may be this many times as long as the shortest one
OwnedCellMesh Rectilinear(const glm::ivec3& cells, double uneven = 4.0, std::uint64_t seed = 1);

/// One cell of a shape: a part of the unit cube.
OwnedCellMesh OneCell(banyan::CellShape shape);

/// One hexahedron that is turned inside out near its last corner.
OwnedCellMesh FoldedCell();

/// A grid as cells with numbers of points.
OwnedCellMesh AsCells(const OwnedCellMesh& grid);

/// Adds the cells and points of another mesh; neither is a grid.
void Append(OwnedCellMesh& mesh, const OwnedCellMesh& other);
/// The same cells in the same places with corners in the order of mirrored ones.
void MirrorCells(OwnedCellMesh& mesh);
/// Other orders of cells and points.
void Shuffle(OwnedCellMesh& mesh, std::uint64_t seed = 1);
/// Every cell gets points of its own.
void SeparatePoints(OwnedCellMesh& mesh);
/// p * factor + offset; a negative factor mirrors.
void Place(OwnedCellMesh& mesh, const glm::dvec3& factor, const glm::dvec3& offset);
/// Turns points around an axis through the origin.
void Turn(OwnedCellMesh& mesh, const glm::dvec3& axis, double angle);
/// Rounds points to float.
void RoundPoints(OwnedCellMesh& mesh);

/// Seeded numbers: splitmix64 of the seed and a count.
class Numbers
{
public:
  explicit Numbers(std::uint64_t seed)
    : State(seed)
  {
  }
  std::uint64_t Next();
  double Between(double low, double high);
  /// From 0 to below `count`.
  std::uint64_t Below(std::uint64_t count);

private:
  std::uint64_t State;
};

} // namespace cellmeshes

#endif
