#include "BenchMesh.h"

#include "EarthquakeMesh.h"
#include "HexWaveSimulation.h"

#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>

namespace banyan::bench
{

BenchMesh EarthquakeMeshAt(double cells, double seconds, ThreadPool& pool)
{
  constexpr std::uint64_t seed = 1;
  constexpr double slowest = 500.0;
  const NorthridgeModel ground(seed, slowest);
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

  BenchMesh mesh;
  mesh.Voxels = true;
  int deepest = 0;
  for (std::size_t cell = 0; cell < tree.CellCount(); ++cell)
  {
    deepest = std::max(deepest, tree.Cell(cell).Level);
    const auto& corners = tree.Corners(cell);
    mesh.Ids.insert(mesh.Ids.end(), corners.begin(), corners.end());
  }
  const double edge = tree.EdgeOfLevel(deepest);
  for (std::size_t node = 0; node < tree.NodeCount(); ++node)
  {
    const std::array<double, 3> point = tree.Point(node);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      mesh.Points.push_back(
        static_cast<float>(std::round((point[axis] - tree.Shape().Origin[axis]) / edge)));
    }
    const float* const v = &waves.Velocity()[3 * node];
    mesh.Values.push_back(std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
  }
  return mesh;
}

} // namespace banyan::bench
