// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_HexOctree_TinyMeshes_h
#define banyan_Testing_Core_HexOctree_TinyMeshes_h

#include "Mesh/Octree/ElementOctree.h"

#include "Base/ThreadPool.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <tuple>
#include <vector>

namespace meshes
{

/// A cube of an octree.
struct Cube
{
  glm::ivec3 Corner{ 0 };
  int Level = 0;
};

/// Leaves of an octree over roots of 2^level finest cells: a cube is split where `split` says so.
inline std::vector<Cube> Leaves(
  const glm::ivec3& roots, int level, const std::function<bool(const Cube&)>& split)
{
  std::vector<Cube> leaves;
  const std::function<void(const Cube&)> visit = [&](const Cube& cube)
  {
    if (cube.Level == 0 || !split(cube))
    {
      leaves.push_back(cube);
      return;
    }
    const int half = 1 << (cube.Level - 1);
    for (int child = 0; child < 8; ++child)
    {
      visit(
        { cube.Corner + half * glm::ivec3(child & 1, child >> 1 & 1, child >> 2), cube.Level - 1 });
    }
  };
  for (int z = 0; z < roots.z; ++z)
  {
    for (int y = 0; y < roots.y; ++y)
    {
      for (int x = 0; x < roots.x; ++x)
      {
        visit({ glm::ivec3(x, y, z) * (1 << level), level });
      }
    }
  }
  return leaves;
}

/// Splits cubes near a ball: levels 0 to `level`, mostly balanced 2:1.
inline std::vector<Cube> Ball(const glm::ivec3& roots, int level)
{
  const glm::dvec3 centre = glm::dvec3(roots) * double(1 << level) * 0.4;
  return Leaves(roots, level,
    [=](const Cube& cube)
    {
      const double edge = 1 << cube.Level;
      const glm::dvec3 away = glm::dvec3(cube.Corner) + 0.5 * edge - centre;
      return std::sqrt(away.x * away.x + away.y * away.y + away.z * away.z) < 1.8 * edge;
    });
}

/// Splits at random: neighbours of any sizes.
inline std::vector<Cube> Wild(const glm::ivec3& roots, int level, unsigned seed)
{
  const auto random = std::make_shared<std::mt19937>(seed);
  return Leaves(
    roots, level, [=](const Cube& cube) { return cube.Level == level || (*random)() % 3 != 0; });
}

/// A mesh that owns its arrays.
template <class Real = double, class Id = std::int64_t>
struct OwnMesh
{
  std::vector<Real> Points;
  std::vector<Id> Ids;
  std::vector<glm::ivec3> Places; ///< of the points, on the lattice

  banyan::HexMesh Mesh() const
  {
    banyan::HexMesh mesh;
    mesh.Points = this->Points.data();
    mesh.PointType = banyan::ScalarTypeOf<Real>();
    mesh.PointCount = static_cast<std::int64_t>(this->Points.size() / 3);
    mesh.Connectivity = this->Ids.data();
    mesh.IdType = banyan::ScalarTypeOf<Id>();
    mesh.CellCount = static_cast<std::int64_t>(this->Ids.size() / 8);
    return mesh;
  }

  Id& IdAt(std::size_t cell, std::size_t corner) { return this->Ids[8 * cell + corner]; }

  glm::dvec3 PointAt(std::size_t point) const
  {
    return { this->Points[3 * point], this->Points[3 * point + 1], this->Points[3 * point + 2] };
  }

  /// A value per point.
  template <class Value = double>
  std::vector<Value> Sampled(const std::function<double(const glm::dvec3&)>& field) const
  {
    std::vector<Value> values;
    for (std::size_t i = 0; i < this->Places.size(); ++i)
    {
      values.push_back(static_cast<Value>(field(glm::dvec3(this->Places[i]))));
    }
    return values;
  }
};

/// The corners of a hexahedron as VTK has them.
inline glm::ivec3 VtkCorner(int i)
{
  return { (i & 3) == 1 || (i & 3) == 2 ? 1 : 0, (i & 3) >= 2 ? 1 : 0, i >> 2 };
}

/// Makes a mesh of cubes; points are shared where they coincide.
/// @param shuffle not 0: cells, points, and the corners of each cell stand in any order
template <class Real = double, class Id = std::int64_t>
OwnMesh<Real, Id> Make(const std::vector<Cube>& cubes, const glm::dvec3& origin = glm::dvec3(0.0),
  const glm::dvec3& edge = glm::dvec3(1.0), unsigned shuffle = 0)
{
  std::mt19937 random(shuffle);
  std::vector<Cube> order = cubes;
  if (shuffle != 0)
  {
    std::shuffle(order.begin(), order.end(), random);
  }
  OwnMesh<Real, Id> mesh;
  std::map<std::tuple<int, int, int>, Id> numbers;
  for (const Cube& cube : order)
  {
    std::array<int, 8> corners{ 0, 1, 2, 3, 4, 5, 6, 7 };
    if (shuffle != 0)
    {
      std::shuffle(corners.begin(), corners.end(), random);
    }
    for (const int corner : corners)
    {
      const glm::ivec3 p = cube.Corner + VtkCorner(corner) * (1 << cube.Level);
      const auto found = numbers.emplace(std::make_tuple(p.x, p.y, p.z), Id(mesh.Places.size()));
      if (found.second)
      {
        mesh.Places.push_back(p);
        for (int axis = 0; axis < 3; ++axis)
        {
          mesh.Points.push_back(static_cast<Real>(origin[axis] + p[axis] * edge[axis]));
        }
      }
      mesh.Ids.push_back(found.first->second);
    }
  }
  return mesh;
}

inline std::shared_ptr<const banyan::ElementOctree> Find(
  const banyan::HexMesh& mesh, int threads = 2)
{
  banyan::ThreadPool pool(threads);
  return banyan::ElementOctree::Find(mesh, pool);
}

} // namespace meshes

#endif
