// SPDX-License-Identifier: BSD-3-Clause
#include "BenchMesh.h"

#include "Base/ThreadPool.h"
#include "OctreeMesh.h"
#include "StandardField.h"

#include <algorithm>
#include <cmath>

namespace banyan::bench
{
namespace
{

void SetStandardValues(BenchMesh& mesh, int n, ThreadPool& pool)
{
  mesh.Values.resize(mesh.PointCount());
  const double edge = 1.0 / n;
  pool.ParallelFor(static_cast<std::int64_t>(mesh.Values.size()),
    [&](std::int64_t i)
    {
      const float* p = &mesh.Points[static_cast<std::size_t>(3 * i)];
      mesh.Values[static_cast<std::size_t>(i)] =
        static_cast<float>(StandardField({ p[0] * edge, p[1] * edge, p[2] * edge }));
    });
}

} // namespace

HexMesh BenchMesh::Input() const
{
  HexMesh input;
  input.Points = this->Points.data();
  input.PointCount = static_cast<std::int64_t>(this->PointCount());
  input.Connectivity = this->Ids.data();
  input.CellCount = static_cast<std::int64_t>(this->Cells());
  return input;
}

BenchMesh UniformMesh(int n, ThreadPool& pool)
{
  const std::int64_t samples = n + 1;
  BenchMesh mesh;
  mesh.Points.resize(static_cast<std::size_t>(3 * samples * samples * samples));
  mesh.Ids.resize(static_cast<std::size_t>(std::int64_t{ 8 } * n * n * n));
  pool.ParallelFor(samples,
    [&](std::int64_t z)
    {
      float* point = &mesh.Points[static_cast<std::size_t>(3 * z * samples * samples)];
      for (std::int64_t y = 0; y < samples; ++y)
      {
        for (std::int64_t x = 0; x < samples; ++x)
        {
          *point++ = static_cast<float>(x);
          *point++ = static_cast<float>(y);
          *point++ = static_cast<float>(z);
        }
      }
      for (std::int64_t i = 0; z < n && i < std::int64_t{ n } * n; ++i)
      {
        std::int64_t* ids = &mesh.Ids[static_cast<std::size_t>(8 * (z * n * n + i))];
        for (int corner = 0; corner < 8; ++corner)
        {
          // The order of VTK_HEXAHEDRON.
          const int round = corner & 3;
          const std::int64_t p = i % n + (round == 1 || round == 2 ? 1 : 0);
          const std::int64_t q = i / n + (round >= 2 ? 1 : 0);
          ids[corner] = p + samples * (q + samples * (z + (corner >> 2)));
        }
      }
    });
  SetStandardValues(mesh, n, pool);
  return mesh;
}

BenchMesh GradedMesh(int n, ThreadPool& pool)
{
  OctreeMeshShape shape;
  shape.RootEdge = n;
  shape.MaxLevel = std::ilogb(n);
  const double finest = 1.0 / n;
  const auto tooLarge = [&](const MeshOctant& octant)
  {
    // Where values differ by more than a little across a cube.
    const double edge = std::ldexp(1.0, -octant.Level);
    double low = 1.0;
    double high = 0.0;
    for (int i = 0; i < 27; ++i)
    {
      const double x = octant.Corner[0] * finest + 0.5 * edge * (i % 3);
      const double y = octant.Corner[1] * finest + 0.5 * edge * (i / 3 % 3);
      const double z = octant.Corner[2] * finest + 0.5 * edge * (i / 9);
      const double value = StandardField({ x, y, z });
      low = std::min(low, value);
      high = std::max(high, value);
    }
    return octant.Level < 3 || high - low > 8.0 * finest;
  };
  const OctreeMesh tree(shape, tooLarge, pool);
  BenchMesh mesh;
  mesh.Voxels = true;
  for (std::size_t node = 0; node < tree.NodeCount(); ++node)
  {
    for (const double x : tree.Point(node))
    {
      mesh.Points.push_back(static_cast<float>(x));
    }
  }
  for (std::size_t cell = 0; cell < tree.CellCount(); ++cell)
  {
    const auto& corners = tree.Corners(cell);
    mesh.Ids.insert(mesh.Ids.end(), corners.begin(), corners.end());
  }
  SetStandardValues(mesh, n, pool);
  return mesh;
}

/// A permutation without a table: steps of a number that shares no divisor with the count.
void Shuffle(BenchMesh& mesh)
{
  const std::size_t cells = mesh.Cells();
  std::size_t step = 2654435761u % cells | 1u;
  const auto divisor = [](std::size_t a, std::size_t b)
  {
    while (b != 0)
    {
      const std::size_t rest = a % b;
      a = b;
      b = rest;
    }
    return a;
  };
  while (divisor(step, cells) != 1)
  {
    step += 2;
  }
  std::vector<std::int64_t> ids(mesh.Ids.size());
  for (std::size_t cell = 0; cell < cells; ++cell)
  {
    std::copy_n(&mesh.Ids[8 * (cell * step % cells)], 8, &ids[8 * cell]);
  }
  mesh.Ids = std::move(ids);
}

} // namespace banyan::bench
