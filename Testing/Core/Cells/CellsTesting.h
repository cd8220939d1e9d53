// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_CellsTesting_h
#define banyan_Testing_CellsTesting_h

#include "Cells/CellCorners.h"
#include "Cells/CellMesh.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <vector>

namespace banyan
{

/// A mesh of its own, cell after cell.
struct OwnMesh
{
  std::vector<double> Points;
  std::vector<std::int64_t> Ids;
  std::vector<std::int64_t> Offsets{ 0 };
  std::vector<std::uint8_t> Types;

  std::int64_t AddPoint(const glm::dvec3& p)
  {
    this->Points.insert(this->Points.end(), { p.x, p.y, p.z });
    return static_cast<std::int64_t>(this->Points.size() / 3) - 1;
  }

  /// @param ids as VTK has them
  void AddCell(int type, const std::vector<std::int64_t>& ids)
  {
    this->Types.push_back(static_cast<std::uint8_t>(type));
    this->Ids.insert(this->Ids.end(), ids.begin(), ids.end());
    this->Offsets.push_back(static_cast<std::int64_t>(this->Ids.size()));
  }

  /// Adds a cell with points of its own.
  void AddCellAt(int type, const std::vector<glm::dvec3>& corners)
  {
    std::vector<std::int64_t> ids(corners.size());
    std::transform(corners.begin(), corners.end(), ids.begin(),
      [this](const glm::dvec3& p) { return this->AddPoint(p); });
    this->AddCell(type, ids);
  }

  std::size_t Cells() const { return this->Types.size(); }
  std::vector<std::int64_t> IdsOf(std::size_t cell) const
  {
    return { this->Ids.begin() + this->Offsets[cell], this->Ids.begin() + this->Offsets[cell + 1] };
  }
  glm::dvec3 Point(std::int64_t id) const
  {
    const double* const p = this->Points.data() + 3 * id;
    return { p[0], p[1], p[2] };
  }

  void Move(const std::function<glm::dvec3(const glm::dvec3&)>& to)
  {
    for (std::size_t i = 0; i < this->Points.size() / 3; ++i)
    {
      const glm::dvec3 p = to(this->Point(static_cast<std::int64_t>(i)));
      std::copy_n(&p.x, 3, this->Points.data() + 3 * i);
    }
  }

  CellMesh View() const
  {
    CellMesh mesh;
    mesh.Points = this->Points.data();
    mesh.PointType = ScalarType::Float64;
    mesh.PointCount = static_cast<std::int64_t>(this->Points.size() / 3);
    mesh.Connectivity = this->Ids.data();
    mesh.ConnectivityCount = static_cast<std::int64_t>(this->Ids.size());
    mesh.Offsets = this->Offsets.data();
    mesh.Types = this->Types.data();
    mesh.CellCount = static_cast<std::int64_t>(this->Types.size());
    return mesh;
  }
};

/// What the cubes of a box are made of.
enum class Split
{
  Hexahedra,
  Voxels,
  Wedges,
  Pyramids,
  Tetrahedra,
  Mixed ///< cubes in turn of hexahedra, pyramids, and both kinds of hexahedra
};

/// Adds one cube with these corners, in the order of VTK_HEXAHEDRON.
inline void AddCube(OwnMesh& mesh, Split split, const std::array<std::int64_t, 8>& c)
{
  switch (split)
  {
    case Split::Hexahedra:
    case Split::Mixed:
      mesh.AddCell(12, { c.begin(), c.end() });
      break;
    case Split::Voxels:
      mesh.AddCell(11, { c[0], c[1], c[3], c[2], c[4], c[5], c[7], c[6] });
      break;
    case Split::Wedges:
      mesh.AddCell(13, { c[0], c[1], c[2], c[4], c[5], c[6] });
      mesh.AddCell(13, { c[0], c[2], c[3], c[4], c[6], c[7] });
      break;
    case Split::Pyramids:
    {
      const std::int64_t middle = mesh.AddPoint((mesh.Point(c[0]) + mesh.Point(c[6])) / 2.0);
      static constexpr int sides[6][4] = { { 0, 1, 2, 3 }, { 4, 7, 6, 5 }, { 0, 4, 5, 1 },
        { 1, 5, 6, 2 }, { 2, 6, 7, 3 }, { 3, 7, 4, 0 } };
      for (const auto& side : sides)
      {
        mesh.AddCell(14, { c[side[0]], c[side[1]], c[side[2]], c[side[3]], middle });
      }
      break;
    }
    case Split::Tetrahedra:
    {
      // Around the diagonal, so that the diagonals of cubes side by side agree.
      static constexpr int ring[6] = { 1, 2, 3, 7, 4, 5 };
      for (int i = 0; i < 6; ++i)
      {
        mesh.AddCell(10, { c[0], c[ring[i]], c[ring[(i + 1) % 6]], c[6] });
      }
      break;
    }
  }
}

/// A box of cubes of edge 1, from the origin on.
inline OwnMesh BoxOf(Split split, int nx, int ny, int nz)
{
  OwnMesh mesh;
  for (int i = 0; i < (nx + 1) * (ny + 1) * (nz + 1); ++i)
  {
    mesh.AddPoint({ i % (nx + 1), i / (nx + 1) % (ny + 1), i / (nx + 1) / (ny + 1) });
  }
  const auto at = [&](int x, int y, int z) -> std::int64_t
  { return x + (nx + 1) * (y + (ny + 1) * z); };
  static constexpr Split turn[3] = { Split::Hexahedra, Split::Pyramids, Split::Voxels };
  for (int i = 0; i < nx * ny * nz; ++i)
  {
    const int x = i % nx;
    const int y = i / nx % ny;
    const int z = i / nx / ny;
    AddCube(mesh, split == Split::Mixed ? turn[i % 3] : split,
      { at(x, y, z), at(x + 1, y, z), at(x + 1, y + 1, z), at(x, y + 1, z), at(x, y, z + 1),
        at(x + 1, y, z + 1), at(x + 1, y + 1, z + 1), at(x, y + 1, z + 1) });
  }
  return mesh;
}

/// The same cells and points in another order.
inline OwnMesh Shuffled(const OwnMesh& mesh, unsigned seed)
{
  std::mt19937 random(seed);
  std::vector<std::int64_t> points(mesh.Points.size() / 3);
  std::iota(points.begin(), points.end(), 0);
  std::shuffle(points.begin(), points.end(), random);
  std::vector<std::size_t> cells(mesh.Cells());
  std::iota(cells.begin(), cells.end(), 0u);
  std::shuffle(cells.begin(), cells.end(), random);
  OwnMesh result;
  std::vector<std::int64_t> to(points.size());
  for (const std::int64_t point : points)
  {
    to[static_cast<std::size_t>(point)] = result.AddPoint(mesh.Point(point));
  }
  for (const std::size_t cell : cells)
  {
    std::vector<std::int64_t> ids = mesh.IdsOf(cell);
    std::transform(ids.begin(), ids.end(), ids.begin(),
      [&](std::int64_t id) { return to[static_cast<std::size_t>(id)]; });
    result.AddCell(mesh.Types[cell], ids);
  }
  return result;
}

/// Points off by up to a part of an edge.
inline void Shake(OwnMesh& mesh, double most, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> off(-most, most);
  mesh.Move(
    [&](const glm::dvec3& p) { return p + glm::dvec3(off(random), off(random), off(random)); });
}

/// Where the corners of a cell are, in its order.
inline std::vector<std::array<double, 3>> CornersAt(const CellMesh& mesh, std::int64_t cell)
{
  const MeshCell is = mesh.Cell(cell);
  std::vector<std::array<double, 3>> corners;
  for (int i = 0; i < CornersOf(is.Shape); ++i)
  {
    const glm::dvec3 p = mesh.Point(is.Points[static_cast<std::size_t>(i)]);
    corners.push_back({ p.x, p.y, p.z });
  }
  return corners;
}

} // namespace banyan

#endif
