#include "EarthquakeMesh.h"

#include "OctreeMeshKeys.h"

#include <cmath>

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
  shape.MaxLevel = 10;
  return shape;
}

OctreeMesh::TooLarge WiderThanWaves(
  const OctreeMeshShape& shape, const NorthridgeModel& ground, double hertz)
{
  return [&shape, &ground, hertz](const MeshOctant& octant)
  {
    const double edge = std::ldexp(shape.RootEdge, -octant.Level);
    const double smallest = std::ldexp(shape.RootEdge, -shape.MaxLevel);
    std::array<double, 3> low;
    for (int axis = 0; axis < 3; ++axis)
    {
      low[axis] = shape.Origin[axis] + smallest * octant.Corner[axis];
    }
    return edge * hertz * EarthquakeMesh::CellsPerWave > ground.SlowestIn(low, edge);
  };
}

} // namespace

OctreeMesh EarthquakeMesh::ForFrequency(
  const NorthridgeModel& ground, double hertz, ThreadPool& pool)
{
  const OctreeMeshShape shape = ShapeOfBlock();
  return OctreeMesh(shape, WiderThanWaves(shape, ground, hertz), pool);
}

double EarthquakeMesh::FrequencyForCells(
  const NorthridgeModel& ground, double cells, ThreadPool& pool)
{
  const OctreeMeshShape shape = ShapeOfBlock();
  const auto count = [&](double hertz)
  {
    DividedCubes divided = DivideCubes(shape, WiderThanWaves(shape, ground, hertz), pool);
    BalanceCubes(shape, divided);
    return static_cast<double>(CountLeaves(shape, divided));
  };
  // Cells grow with about the third power of frequency; from below, so that no try is much larger
  // than what is wanted.
  double low = 0.01, high = HUGE_VAL, best = low, bestOff = HUGE_VAL;
  double hertz = 0.4 * std::cbrt(cells / 1e6);
  for (int round = 0; round < 14 && high / low > 1.01; ++round)
  {
    const double found = count(hertz), off = std::abs(std::log(found / cells));
    (found < cells ? low : high) = hertz;
    if (off < bestOff)
    {
      best = hertz;
      bestOff = off;
    }
    if (off < 0.02)
    {
      break;
    }
    hertz *= std::cbrt(cells / found);
    if (!(hertz > low && hertz < high))
    {
      hertz = std::isfinite(high) ? std::sqrt(low * high) : 1.3 * low;
    }
  }
  return best;
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
