// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_MeshSeries_StoredMeshes_h
#define banyan_Testing_Core_MeshSeries_StoredMeshes_h

#include "Mesh/Octree/TinyMeshes.h"
#include "Mesh/Series/StoredMesh.h"

#include <cstring>
#include <string>
#include <vector>

namespace meshes
{

/// Gives each cell points of its own.
template <class Real, class Id>
OwnMesh<Real, Id> Separated(const OwnMesh<Real, Id>& mesh)
{
  OwnMesh<Real, Id> own;
  for (const Id id : mesh.Ids)
  {
    const auto from = static_cast<std::size_t>(id);
    own.Ids.push_back(static_cast<Id>(own.Places.size()));
    own.Places.push_back(mesh.Places[from]);
    own.Points.insert(own.Points.end(), &mesh.Points[3 * from], &mesh.Points[3 * from] + 3);
  }
  return own;
}

/// Adds points that no cell uses, not finite ones among them, and moves the ids of others up.
template <class Real, class Id>
void AddLoosePoints(OwnMesh<Real, Id>& mesh)
{
  const std::vector<Real> loose{ Real(1e30), Real(-0.0), std::numeric_limits<Real>::quiet_NaN() };
  mesh.Points.insert(mesh.Points.begin(), loose.begin(), loose.end());
  mesh.Places.insert(mesh.Places.begin(), glm::ivec3{ 0 });
  for (Id& id : mesh.Ids)
  {
    ++id;
  }
  mesh.Points.insert(mesh.Points.end(), 3, Real(7));
  mesh.Places.push_back(glm::ivec3{ 7 });
}

/// Leaves out every fifth cube.
inline std::vector<Cube> WithHoles(std::vector<Cube> cubes)
{
  std::vector<Cube> left;
  for (std::size_t i = 0; i < cubes.size(); ++i)
  {
    if (i % 5 != 3)
    {
      left.push_back(cubes[i]);
    }
  }
  return left;
}

inline std::shared_ptr<const banyan::StoredMesh> Store(
  const banyan::HexMesh& mesh, const std::uint8_t* types = nullptr)
{
  return banyan::StoreMesh(*Find(mesh), types);
}

} // namespace meshes

#endif
