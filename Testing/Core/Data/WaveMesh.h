// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_WaveMesh_h
#define banyan_Testing_WaveMesh_h

#include "HexWaveSimulation.h"

#include <array>
#include <cmath>
#include <functional>
#include <random>

namespace banyan
{

/// What the tests of elastic waves on octree meshes are made of.
struct WaveMesh
{
  static constexpr ElasticMaterial Stone = { 2500.0f, 4000.0f, 2300.0f };

  static ElasticMaterial StoneEverywhere(const std::array<double, 3>&) { return Stone; }

  /// A mesh of equal cells.
  static OctreeMesh Uniform(const std::array<int, 3>& cells, double edge, ThreadPool& pool)
  {
    OctreeMeshShape shape;
    shape.Roots = cells;
    shape.RootEdge = edge;
    shape.MaxLevel = 0;
    return OctreeMesh(
      shape, [](const MeshOctant&) { return false; }, pool);
  }

  /// Roots of 400 m, divided by chance up to three times.
  static OctreeMesh Random(const std::array<int, 3>& roots, unsigned seed, ThreadPool& pool)
  {
    OctreeMeshShape shape;
    shape.Roots = roots;
    shape.RootEdge = 400.0;
    shape.MaxLevel = 3;
    return OctreeMesh(
      shape,
      [seed](const MeshOctant& octant)
      {
        std::mt19937 random(seed + octant.Corner[0] + 1000 * octant.Corner[1] +
                            1000000 * octant.Corner[2] + 97 * octant.Level);
        random.discard(5);
        return random() % 100 < 30;
      },
      pool);
  }

  /// The node at a point. -1 when there is none.
  static std::int64_t NodeAt(const OctreeMesh& mesh, const std::array<double, 3>& point)
  {
    for (const std::uint32_t node : mesh.Corners(mesh.CellAt(point)))
    {
      const auto p = mesh.Point(node);
      if (std::hypot(p[0] - point[0], p[1] - point[1], p[2] - point[2]) < 1e-6)
      {
        return node;
      }
    }
    return -1;
  }

  static MomentPoint Source(const std::array<double, 3>& place, const std::array<double, 6>& moment)
  {
    MomentPoint source;
    source.Place = place;
    source.Moment = moment;
    source.HalfDuration = 0.15;
    source.Delay = 0.5;
    return source;
  }

  static HexWaveLosses AllOpen()
  {
    HexWaveLosses losses;
    losses.OpenSides[5] = true;
    return losses;
  }

  static HexWaveLosses Closed()
  {
    HexWaveLosses losses;
    losses.OpenSides = {};
    return losses;
  }
};

} // namespace banyan

#endif
