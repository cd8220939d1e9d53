// SPDX-License-Identifier: BSD-3-Clause
// Elastic waves on octree meshes against the exact solution of Stokes: arrivals, polarity, width of
// cells, borders between sizes of cells.
#include "HexWaveSimulation.h"
#include "StokesSolution.h"
#include "WaveMesh.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using banyan::HexWaveSimulation;
using banyan::MeshOctant;
using banyan::MomentPoint;
using banyan::OctreeMesh;
using banyan::OctreeMeshShape;
using banyan::ThreadPool;
using banyan::WaveMesh;

namespace
{

using Point = std::array<double, 3>;
using Trace = std::vector<std::array<double, 3>>;

std::array<double, 3> VelocityAt(const HexWaveSimulation& waves, std::int64_t node)
{
  const float* v = &waves.Velocity()[3 * static_cast<std::size_t>(node)];
  return { v[0], v[1], v[2] };
}

/// Velocities at points (nodes of the mesh) for all steps until a time; and the time step.
std::vector<Trace> Record(const OctreeMesh& mesh, const MomentPoint& source,
  const std::vector<Point>& points, double seconds, double* step)
{
  ThreadPool pool(2);
  HexWaveSimulation waves(mesh, WaveMesh::StoneEverywhere, { source }, WaveMesh::AllOpen(), pool);
  std::vector<std::int64_t> nodes;
  for (const Point& point : points)
  {
    nodes.push_back(WaveMesh::NodeAt(mesh, point));
    EXPECT_GE(nodes.back(), 0);
  }
  std::vector<Trace> traces(points.size());
  *step = waves.TimeStepSeconds();
  while (waves.Time() < seconds)
  {
    waves.AdvanceTo(waves.Time() + *step);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      traces[i].push_back(VelocityAt(waves, nodes[i]));
    }
  }
  return traces;
}

Trace ExactTrace(const MomentPoint& source, const Point& point, std::size_t steps, double step)
{
  Trace trace;
  for (std::size_t i = 0; i < steps; ++i)
  {
    const Point offset = { point[0] - source.Place[0], point[1] - source.Place[1],
      point[2] - source.Place[2] };
    trace.push_back(banyan::StokesVelocity(
      WaveMesh::Stone, source, offset, (static_cast<double>(i) + 0.5) * step));
  }
  return trace;
}

double Largest(const Trace& a)
{
  double largest = 0.0;
  for (const auto& v : a)
  {
    for (const double component : v)
    {
      largest = std::max(largest, std::abs(component));
    }
  }
  return largest;
}

/// Largest difference as a share of the largest value of the second.
double Misfit(Trace a, const Trace& b)
{
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      a[i][c] -= b[i][c];
    }
  }
  return Largest(a) / Largest(b);
}

/// Time at which the speed in a direction is largest, and the speed then.
std::pair<double, double> Peak(const Trace& trace, const Point& direction, double step)
{
  double largest = 0.0, time = 0.0;
  for (std::size_t i = 0; i < trace.size(); ++i)
  {
    const double v =
      trace[i][0] * direction[0] + trace[i][1] * direction[1] + trace[i][2] * direction[2];
    if (std::abs(v) > std::abs(largest))
    {
      largest = v;
      time = (static_cast<double>(i) + 0.5) * step;
    }
  }
  return { time, largest };
}

/// Misfit of a shear crack in a cube of 3.2 km, 1.1 km away, up to the time at which the borders
/// would be seen.
double MisfitOfCrack(int cells)
{
  ThreadPool pool(2);
  const OctreeMesh mesh = WaveMesh::Uniform({ cells, cells, cells }, 3200.0 / cells, pool);
  const double middle = 1600.0 / cells;
  const MomentPoint source = WaveMesh::Source({ 1200.0 + middle, 1400.0 + middle, 1700.0 + middle },
    { 3e13, -1e14, 7e13, 5e13, -2e13, 1e14 });
  const Point point = { 2000.0, 2000.0, 1200.0 };
  double step;
  const Trace found = Record(mesh, source, { point }, 1.3, &step)[0];
  return Misfit(found, ExactTrace(source, point, found.size(), step));
}

} // namespace

TEST(HexWave, AShearCrackRadiatesAsTheExactSolution)
{
  // Second order: half the width, a quarter of the error.
  const double coarse = MisfitOfCrack(24), fine = MisfitOfCrack(48);
  EXPECT_LT(fine, 0.09);
  EXPECT_GT(coarse / fine, 3.5);
}

TEST(HexWave, FirstMotionsAreThoseOfADoubleCouple)
{
  ThreadPool pool(2);
  const OctreeMesh mesh = WaveMesh::Uniform({ 36, 36, 36 }, 100.0, pool);
  // Slip along x and z: P waves push along x = z, pull along x = -z, and have a node along x, where
  // S waves are strongest and move the ground along z: up where the slip is upwards.
  const Point place = { 1750.0, 1750.0, 1750.0 };
  const MomentPoint source = WaveMesh::Source(place, { 0, 0, 0, 0, 1e14, 0 });
  const auto at = [&](double x, double z) -> Point {
    return { place[0] + x, place[1] + 50.0, place[2] + z };
  };
  const double r = std::sqrt(0.5);
  const struct
  {
    Point Place, Direction;
    double Sign;
  } places[] = {
    { at(850.0, 850.0), { r, 0, r }, 1.0 },
    { at(-850.0, 850.0), { -r, 0, r }, -1.0 },
    { at(-850.0, -850.0), { -r, 0, -r }, 1.0 },
    { at(1250.0, 50.0), { 0, 0, 1 }, 1.0 },
    { at(-1250.0, 50.0), { 0, 0, 1 }, -1.0 },
  };
  std::vector<Point> points;
  for (const auto& p : places)
  {
    points.push_back(p.Place);
  }
  double step;
  const auto traces = Record(mesh, source, points, 1.25, &step);
  std::vector<double> peaks;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const auto found = Peak(traces[i], places[i].Direction, step);
    const auto exact =
      Peak(ExactTrace(source, points[i], traces[i].size(), step), places[i].Direction, step);
    EXPECT_GT(found.second * places[i].Sign, 0.0) << i;
    EXPECT_NEAR(found.second / exact.second, 1.0, 0.09) << i;
    EXPECT_NEAR(found.first, exact.first, 1.01 * step) << i;
    peaks.push_back(std::abs(found.second));
  }
  EXPECT_NEAR(peaks[1] / peaks[0], 1.0, 0.01);
  EXPECT_NEAR(peaks[4] / peaks[3], 1.0, 0.01);
  EXPECT_LT(std::abs(Peak(traces[3], { 1, 0, 0 }, step).second), 0.15 * peaks[0]);
}

TEST(HexWave, WavesArriveAtDistanceOverSpeed)
{
  ThreadPool pool(2);
  const OctreeMesh mesh = WaveMesh::Uniform({ 36, 20, 20 }, 100.0, pool);
  const std::vector<Point> points = { { 2000.0, 1000.0, 1000.0 }, { 3200.0, 1000.0, 1000.0 } };
  for (const bool shear : { false, true })
  {
    // An explosion makes P waves only; a slip along x and z makes S waves along x.
    const double m = 1e14;
    const MomentPoint source =
      WaveMesh::Source({ 750.0, 950.0, 950.0 }, shear ? std::array<double, 6>{ 0, 0, 0, 0, m, 0 }
                                                      : std::array<double, 6>{ m, m, m, 0, 0, 0 });
    const Point direction = { shear ? 0.0 : 1.0, 0.0, shear ? 1.0 : 0.0 };
    const double speed = shear ? WaveMesh::Stone.ShearSpeed : WaveMesh::Stone.PressureSpeed;
    double step;
    const auto traces = Record(mesh, source, points, shear ? 1.6 : 1.2, &step);
    const double first = Peak(traces[0], direction, step).first;
    const double second = Peak(traces[1], direction, step).first;
    // The ground moves fastest when the moment's rate grows fastest; what is not waves adds to it
    // near the source, and makes that later.
    const double start = source.Delay - source.HalfDuration * std::sqrt(0.5);
    EXPECT_NEAR(first, start + 1250.0 / speed, 0.05);
    EXPECT_NEAR(second, start + 2450.0 / speed, 0.05);
    EXPECT_NEAR((second - first) * speed, 1200.0, 0.05 * 1200.0);
  }
}

TEST(HexWave, ABorderBetweenSizesOfCellsReflectsLittle)
{
  ThreadPool pool(2);
  OctreeMeshShape shape;
  shape.Roots = { 30, 24, 24 };
  shape.RootEdge = 100.0;
  shape.MaxLevel = 1;
  std::vector<Trace> traces;
  std::vector<double> steps;
  for (const bool divided : { false, true })
  {
    const OctreeMesh mesh(
      shape, [&](const MeshOctant& octant) { return divided && octant.Corner[0] >= 2 * 15; }, pool);
    double step;
    traces.push_back(Record(mesh,
      WaveMesh::Source({ 650.0, 1150.0, 1150.0 }, { 1e14, -1e14, 3e13, 5e13, 2e13, 0 }),
      { { 1000.0, 1200.0, 1300.0 } }, 1.5, &step)[0]);
    steps.push_back(step);
  }
  // At times of the longer steps.
  Trace same;
  for (std::size_t i = 0; i < traces[0].size(); ++i)
  {
    const double place = (static_cast<double>(i) + 0.5) * steps[0] / steps[1] - 0.5;
    const std::size_t k =
      std::min(static_cast<std::size_t>(std::max(place, 0.0)), traces[1].size() - 2);
    const double share = place - static_cast<double>(k);
    same.push_back(traces[1][k]);
    for (int c = 0; c < 3; ++c)
    {
      same.back()[c] += share * (traces[1][k + 1][c] - traces[1][k][c]);
    }
  }
  const double reflected = Misfit(same, traces[0]);
  EXPECT_LT(reflected, 0.005);
  EXPECT_GT(reflected, 0.0);
}

TEST(HexWave, TheFreeSurfaceDoublesTheMotion)
{
  ThreadPool pool(2);
  const double m = 1e14, depth = 1850.0;
  const OctreeMesh mesh = WaveMesh::Uniform({ 33, 33, 32 }, 100.0, pool);
  const MomentPoint source =
    WaveMesh::Source({ 1650.0, 1650.0, 3200.0 - depth }, { m, m, m, 0, 0, 0 });
  HexWaveSimulation waves(mesh, WaveMesh::StoneEverywhere, { source }, {}, pool);
  const auto node = WaveMesh::NodeAt(mesh, { 1600.0, 1600.0, 3200.0 });
  double exact = 0.0, found = 0.0;
  while (waves.Time() < 1.3)
  {
    waves.AdvanceTo(waves.Time() + waves.TimeStepSeconds());
    found = std::max(found, VelocityAt(waves, node)[2]);
    exact = std::max(exact, banyan::StokesVelocity(WaveMesh::Stone, source, { -50.0, -50.0, depth },
                              waves.Time() - waves.TimeStepSeconds() / 2)[2]);
  }
  // Exactly twice for a plane wave, and 4 (1 - Poisson's ratio), about three times, for what is at
  // rest (Mogi, 1958). At this depth waves make five sixths of the largest speed.
  EXPECT_NEAR(found / exact, 2.16, 0.08);
}

TEST(HexWave, LossesLetAmplitudesDecayAtTheirRate)
{
  ThreadPool pool(2);
  const double rate = 0.8;
  const OctreeMesh mesh = WaveMesh::Uniform({ 36, 20, 20 }, 100.0, pool);
  const MomentPoint source = WaveMesh::Source({ 750.0, 950.0, 950.0 }, { 0, 0, 0, 0, 1e14, 0 });
  const std::int64_t nodes[2] = { WaveMesh::NodeAt(mesh, { 2000.0, 1000.0, 1000.0 }),
    WaveMesh::NodeAt(mesh, { 3200.0, 1000.0, 1000.0 }) };
  double largest[2][2] = {};
  for (const bool lossy : { false, true })
  {
    banyan::HexWaveLosses losses = WaveMesh::AllOpen();
    if (lossy)
    {
      losses.DecayRate = [&](const banyan::ElasticMaterial&) { return rate; };
    }
    HexWaveSimulation waves(mesh, WaveMesh::StoneEverywhere, { source }, losses, pool);
    while (waves.Time() < 1.9)
    {
      waves.AdvanceTo(waves.Time() + waves.TimeStepSeconds());
      for (int i = 0; i < 2; ++i)
      {
        largest[lossy][i] = std::max(largest[lossy][i], VelocityAt(waves, nodes[i])[2]);
      }
    }
  }
  // What decays more on the longer way; close to the source are other parts than waves.
  const double found = largest[1][1] / largest[0][1] / (largest[1][0] / largest[0][0]);
  const double expected = std::exp(-rate * 1200.0 / WaveMesh::Stone.ShearSpeed);
  EXPECT_NEAR(found, expected, 0.05 * expected);
}
