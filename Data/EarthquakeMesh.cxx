// SPDX-License-Identifier: BSD-3-Clause
#include "EarthquakeMesh.h"

#include "OctreeMeshKeys.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>

namespace banyan
{

namespace
{

OctreeMeshShape ShapeOfBlock()
{
  OctreeMeshShape shape;
  shape.Roots = NorthridgeModel::Roots;
  shape.RootEdge = NorthridgeModel::RootMetres;
  shape.Origin = { 0.0, 0.0, -NorthridgeModel::DepthMetres };
  // Cells of 4.9 m; with this level coordinates are still exact in single precision.
  shape.MaxLevel = 11;
  return shape;
}

/// The lowest frequency that a cube is too large for.
double Limit(const OctreeMeshShape& shape, const NorthridgeModel& ground, const MeshOctant& octant)
{
  const double edge = std::ldexp(shape.RootEdge, -octant.Level);
  const double smallest = std::ldexp(shape.RootEdge, -shape.MaxLevel);
  std::array<double, 3> low;
  for (int axis = 0; axis < 3; ++axis)
  {
    low[axis] = shape.Origin[axis] + smallest * octant.Corner[axis];
  }
  return ground.SlowestIn(low, edge) / (edge * EarthquakeMesh::CellsPerWave);
}

/// Bins of frequencies, 0.2 % wide.
constexpr double LowestHertz = 0.001, BinsPerOctave = 350.0;
constexpr int Bins = 6000;

double HertzOfBin(int bin)
{
  return LowestHertz * std::exp2(bin / BinsPerOctave);
}

int BinOfHertz(double hertz)
{
  const double bin = std::floor(BinsPerOctave * std::log2(hertz / LowestHertz));
  return static_cast<int>(std::clamp(bin, 0.0, Bins - 1.0));
}

} // namespace

OctreeMesh EarthquakeMesh::ForFrequency(
  const NorthridgeModel& ground, double hertz, ThreadPool& pool)
{
  const OctreeMeshShape shape = ShapeOfBlock();
  return OctreeMesh(
    shape, [&](const MeshOctant& octant) { return hertz > Limit(shape, ground, octant); }, pool);
}

double EarthquakeMesh::FrequencyForCells(
  const NorthridgeModel& ground, double cells, ThreadPool& pool)
{
  const OctreeMeshShape shape = ShapeOfBlock();
  const double roots = 1.0 * shape.Roots[0] * shape.Roots[1] * shape.Roots[2];
  // Cells grow with about the third power of frequency. From below, so that no try is much larger
  // than what is wanted.
  double highest = 0.4 * std::cbrt(cells / 1e6);
  while (true)
  {
    // Each cube that is divided makes seven cells more; a few more, which balance needs, are left
    // out.
    std::vector<std::atomic<std::uint32_t>> divided(Bins);
    DivideCubes(
      shape,
      [&](const MeshOctant& octant)
      {
        const double limit = Limit(shape, ground, octant);
        if (limit < highest)
        {
          divided[BinOfHertz(limit)].fetch_add(1, std::memory_order_relaxed);
        }
        return limit < highest;
      },
      pool);
    double count = roots, best = LowestHertz, bestOff = HUGE_VAL;
    for (int bin = 0; bin < BinOfHertz(highest); ++bin)
    {
      count += 7.0 * divided[bin];
      const double off = std::abs(std::log(count / cells));
      if (off < bestOff)
      {
        best = HertzOfBin(bin + 1);
        bestOff = off;
      }
    }
    // All cells may be as small as there can be.
    if (count > cells || highest > HertzOfBin(Bins - 1))
    {
      return best;
    }
    highest *= 1.4;
  }
}

double EarthquakeMesh::HalfDuration(double hertz)
{
  // The spectrum is exp(-(pi hertz duration)^2).
  return std::sqrt(std::log(10.0)) / (3.141592653589793 * hertz);
}

double EarthquakeMesh::StrongestHertz(double halfDuration)
{
  // The spectrum of speed is that of the rate times the frequency.
  return 1.0 / (std::sqrt(2.0) * 3.141592653589793 * halfDuration);
}

} // namespace banyan
