// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_HexSampling_WarpedMeshes_h
#define banyan_Testing_Core_HexSampling_WarpedMeshes_h

#include "Mesh/Octree/TinyMeshes.h"
#include "Mesh/Sampling/SampledMesh.h"

#include <cmath>
#include <random>

namespace warped
{

using Mesh = meshes::OwnMesh<double, std::int64_t>;
using Map = std::function<glm::dvec3(const glm::dvec3&)>;

/// A grid of n cells over [0, 1]^3, its points moved by a map.
inline Mesh Grid(const glm::ivec3& n, const Map& map, unsigned shuffle = 0)
{
  Mesh mesh = meshes::Make(meshes::Leaves(n, 0, [](const meshes::Cube&) { return false; }),
    glm::dvec3(0.0), glm::dvec3(1.0), shuffle);
  for (std::size_t i = 0; i < mesh.Places.size(); ++i)
  {
    const glm::dvec3 moved = map(glm::dvec3(mesh.Places[i]) / glm::dvec3(n));
    for (int axis = 0; axis < 3; ++axis)
    {
      mesh.Points[3 * i + static_cast<std::size_t>(axis)] = moved[axis];
    }
  }
  return mesh;
}

/// Points inside are moved by up to 0.3 of an edge.
inline Map Warp(const glm::ivec3& n, unsigned seed = 1)
{
  return [=](const glm::dvec3& p)
  {
    const glm::ivec3 place(p * glm::dvec3(n) + 0.5);
    std::mt19937 random(static_cast<unsigned>(place.x + 1000 * (place.y + 1000 * place.z)) + seed);
    std::uniform_real_distribution<double> part(-0.3, 0.3);
    glm::dvec3 moved = p;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double by = part(random) / n[axis];
      moved[axis] += place[axis] == 0 || place[axis] == n[axis] ? 0.0 : by;
    }
    return moved;
  };
}

/// Layers grow by a tenth from one to the next: boxes that no octree has.
inline glm::dvec3 Graded(const glm::dvec3& p)
{
  const auto graded = [](double x)
  { return (std::pow(1.1, 8.0 * x) - 1.0) / (std::pow(1.1, 8.0) - 1.0); };
  return { graded(p.x), p.y, graded(p.z) };
}

/// A quarter of a hollow cylinder.
inline glm::dvec3 Bent(const glm::dvec3& p)
{
  const double angle = 0.5 * M_PI * p.x;
  const double radius = 1.0 + p.y;
  return { radius * std::sin(angle), radius * std::cos(angle), p.z };
}

/// A column whose top is a mountain.
inline glm::dvec3 Mountain(const glm::dvec3& p)
{
  const double top =
    1.0 + 0.4 * std::exp(-20.0 * ((p.x - 0.5) * (p.x - 0.5) + (p.y - 0.5) * (p.y - 0.5)));
  return { p.x, p.y, p.z * top };
}

inline std::shared_ptr<const banyan::SampledMesh> Sample(
  const Mesh& mesh, const banyan::MeshSampling& sampling = {}, int threads = 2)
{
  banyan::ThreadPool pool(threads);
  return banyan::SampledMesh::Of(mesh.Mesh(), sampling, pool);
}

/// The value of the mesh's own field at a point, looked for in all cells: slow and obvious.
/// @return false outside of the mesh
inline bool SlowValue(const banyan::CellShapes& shapes, const std::vector<double>& values,
  const glm::dvec3& point, double& value, double margin = 1e-9)
{
  const glm::dvec3 at = (point - shapes.Origin()) / shapes.Edge();
  for (std::int64_t cell = 0; cell < shapes.Count(); ++cell)
  {
    glm::dvec3 part(0.5);
    if (!shapes.Shape(cell).Find(at, part) || glm::any(glm::lessThan(part, glm::dvec3(-margin))) ||
        glm::any(glm::greaterThan(part, glm::dvec3(1.0 + margin))))
    {
      continue;
    }
    std::array<std::int64_t, 8> nodes;
    shapes.NodesOf(cell, nodes);
    const std::array<double, 8> weights = banyan::TrilinearWeights(part);
    value = 0.0;
    for (std::size_t i = 0; i < 8; ++i)
    {
      value += weights[i] * values[static_cast<std::size_t>(nodes[i])];
    }
    return true;
  }
  return false;
}

} // namespace warped

#endif
