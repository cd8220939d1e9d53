// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Mesh_CellSeries_CellLattices_h
#define banyan_Testing_Core_Mesh_CellSeries_CellLattices_h

#include "Mesh/CellSeries/StoredCells.h"

#include <cmath>
#include <initializer_list>
#include <vector>

namespace cell_lattices
{

/// The kinds of cells that a cube of a lattice can be cut into.
enum class Kind
{
  Hexahedra,
  Voxels,
  Tetrahedra,
  Wedges,
  Polyhedra,
  Mixed ///< one after the other, with lines, polygons, and a cell without points
};

inline void AddCell(banyan::StoredCells& mesh, int type, const std::vector<std::int64_t>& points)
{
  mesh.Types.push_back(static_cast<std::uint8_t>(type));
  mesh.Connectivity.insert(mesh.Connectivity.end(), points.begin(), points.end());
  mesh.Offsets.push_back(static_cast<std::int64_t>(mesh.Connectivity.size()));
}

/// @param c corners of the cube, x first, then y, then z
inline void AddCube(banyan::StoredCells& mesh, Kind kind, const std::vector<std::int64_t>& c)
{
  const auto add = [&](int type, std::initializer_list<int> corners)
  {
    std::vector<std::int64_t> points;
    for (const int corner : corners)
    {
      points.push_back(c[static_cast<std::size_t>(corner)]);
    }
    AddCell(mesh, type, points);
  };
  switch (kind)
  {
    case Kind::Voxels:
      add(11, { 0, 1, 2, 3, 4, 5, 6, 7 });
      break;
    case Kind::Tetrahedra:
      add(10, { 0, 1, 3, 5 });
      add(10, { 0, 3, 2, 6 });
      add(10, { 0, 5, 6, 4 });
      add(10, { 3, 6, 5, 7 });
      add(10, { 0, 3, 5, 6 });
      break;
    case Kind::Wedges:
      add(13, { 0, 1, 2, 4, 5, 6 });
      add(13, { 1, 3, 2, 5, 7, 6 });
      break;
    case Kind::Polyhedra:
      add(42, { 7, 6, 5, 4, 3, 2, 1, 0 });
      mesh.Faces.push_back(6);
      for (const std::vector<int>& face : { std::vector<int>{ 0, 2, 3, 1 }, { 4, 5, 7, 6 },
             { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } })
      {
        mesh.Faces.push_back(4);
        for (const int corner : face)
        {
          mesh.Faces.push_back(c[static_cast<std::size_t>(corner)]);
        }
      }
      break;
    default:
      add(12, { 0, 1, 3, 2, 4, 5, 7, 6 });
      break;
  }
}

inline void AddOthers(banyan::StoredCells& mesh, const std::vector<std::int64_t>& c, int number)
{
  constexpr Kind kinds[] = { Kind::Tetrahedra, Kind::Polyhedra, Kind::Hexahedra, Kind::Wedges,
    Kind::Voxels };
  AddCube(mesh, kinds[number % 5], c);
  if (number % 7 == 0)
  {
    AddCell(mesh, 0, {});                                                              // no cell
    AddCell(mesh, 3, { c[0], c[7] });                                                  // a line
    AddCell(mesh, 7, { c[0], c[1], c[3], c[2], c[6] });                                // a polygon
    AddCell(mesh, 14, { c[0], c[1], c[3], c[2], c[7] });                               // a pyramid
    AddCell(mesh, 24, { c[0], c[1], c[3], c[5], c[2], c[4], c[6], c[7], c[0], c[1] }); // quadratic
  }
}

/// A bent lattice of cubes, divided.
/// @param cubes per axis
template <class Real>
banyan::StoredCells Make(Kind kind, const glm::ivec3& cubes, double bend = 0.2)
{
  banyan::StoredCells mesh;
  mesh.PointType = banyan::ScalarTypeOf<Real>();
  mesh.Offsets.push_back(0);
  const glm::ivec3 n = cubes + 1;
  mesh.Points.resize(3 * sizeof(Real) * static_cast<std::size_t>(n.x * n.y * n.z));
  std::uint8_t* to = mesh.Points.data();
  for (int z = 0; z < n.z; ++z)
  {
    for (int y = 0; y < n.y; ++y)
    {
      for (int x = 0; x < n.x; ++x)
      {
        const double at[] = { x + bend * std::sin(0.7 * y), y + bend * std::cos(0.4 * z + x),
          z + bend * std::sin(0.3 * x * y) };
        for (const double value : at)
        {
          banyan::StoreNumber(to, static_cast<Real>(value));
          to += sizeof(Real);
        }
      }
    }
  }
  int number = 0;
  for (int z = 0; z < cubes.z; ++z)
  {
    for (int y = 0; y < cubes.y; ++y)
    {
      for (int x = 0; x < cubes.x; ++x, ++number)
      {
        std::vector<std::int64_t> corners;
        for (int i = 0; i < 8; ++i)
        {
          corners.push_back(((z + (i >> 2)) * n.y + y + (i >> 1 & 1)) * n.x + x + (i & 1));
        }
        if (kind == Kind::Mixed)
        {
          AddOthers(mesh, corners, number);
        }
        else
        {
          AddCube(mesh, kind, corners);
        }
      }
    }
  }
  return mesh;
}

} // namespace cell_lattices

#endif
