// SPDX-License-Identifier: BSD-3-Clause
#include "BenchMesh.h"

#include "EarthquakeMesh.h"
#include "HexWaveSimulation.h"
#include "StandardField.h"

#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>

namespace banyan::bench
{

namespace
{

NorthridgeModel Ground()
{
  constexpr std::uint64_t seed = 1;
  constexpr double slowest = 500.0;
  return { seed, slowest };
}

/// Without values.
BenchMesh CellsOf(const OctreeMesh& tree)
{
  BenchMesh mesh;
  mesh.Voxels = true;
  int deepest = 0;
  mesh.Ids.reserve(8 * tree.CellCount());
  for (std::size_t cell = 0; cell < tree.CellCount(); ++cell)
  {
    deepest = std::max(deepest, tree.Cell(cell).Level);
    const auto& corners = tree.Corners(cell);
    mesh.Ids.insert(mesh.Ids.end(), corners.begin(), corners.end());
  }
  const double edge = tree.EdgeOfLevel(deepest);
  mesh.Points.reserve(3 * tree.NodeCount());
  for (std::size_t node = 0; node < tree.NodeCount(); ++node)
  {
    const std::array<double, 3> point = tree.Point(node);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      mesh.Points.push_back(
        static_cast<float>(std::round((point[axis] - tree.Shape().Origin[axis]) / edge)));
    }
  }
  return mesh;
}

} // namespace

BenchMesh EarthquakeMeshAt(double cells, double seconds, ThreadPool& pool)
{
  const NorthridgeModel ground = Ground();
  const double hertz = EarthquakeMesh::FrequencyForCells(ground, cells, pool);
  const OctreeMesh tree = EarthquakeMesh::ForFrequency(ground, hertz, pool);
  const double half = EarthquakeMesh::HalfDuration(hertz);
  HexWaveLosses losses;
  losses.DecayRate = [half](const ElasticMaterial& material)
  { return NorthridgeModel::DecayRate(material, EarthquakeMesh::StrongestHertz(half)); };
  HexWaveSimulation waves(
    tree, [&](const std::array<double, 3>& point) { return ground.At(point); }, ground.Fault(half),
    losses, pool);
  waves.AdvanceTo(seconds);

  BenchMesh mesh = CellsOf(tree);
  for (std::size_t node = 0; node < tree.NodeCount(); ++node)
  {
    const float* const v = &waves.Velocity()[3 * node];
    mesh.Values.push_back(std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
  }
  return mesh;
}

BenchMesh GroundMesh(double cells, ThreadPool& pool)
{
  const NorthridgeModel ground = Ground();
  const double hertz = EarthquakeMesh::FrequencyForCells(ground, cells, pool);
  BenchMesh mesh = CellsOf(EarthquakeMesh::ForFrequency(ground, hertz, pool));
  const float longest = *std::max_element(mesh.Points.begin(), mesh.Points.end());
  mesh.Values.resize(mesh.PointCount());
  pool.ParallelFor(static_cast<std::int64_t>(mesh.Values.size()),
    [&](std::int64_t i)
    {
      const float* const p = &mesh.Points[static_cast<std::size_t>(3 * i)];
      mesh.Values[static_cast<std::size_t>(i)] =
        static_cast<float>(StandardField({ p[0] / longest, p[1] / longest, p[2] / longest }));
    });
  return mesh;
}

} // namespace banyan::bench
