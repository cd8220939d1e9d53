// SPDX-License-Identifier: BSD-3-Clause
// Elastic waves against the exact solution of Stokes, arrival times, energy, and the free surface.
#include "BasinModel.h"
#include "ElasticWaveSimulation.h"
#include "StokesSolution.h"
#include "WaveSeries.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using banyan::BasinModel;
using banyan::ElasticGrid;
using banyan::ElasticMaterial;
using banyan::ElasticWaveSimulation;
using banyan::MomentSource;
using banyan::ThreadPool;

namespace
{

constexpr ElasticMaterial Stone = { 2500.0f, 4000.0f, 2300.0f };

ElasticMaterial StoneEverywhere(int, int, int)
{
  return Stone;
}

ElasticGrid FullSpace(int size)
{
  ElasticGrid grid;
  grid.Size = size;
  grid.FreeSurface = false;
  return grid;
}

MomentSource SourceAt(int x, int y, int z, const std::array<double, 6>& moment)
{
  MomentSource source;
  source.Cell = { x, y, z };
  source.Moment = moment;
  source.HalfDuration = 0.15;
  source.Delay = 0.5;
  return source;
}

/// Velocity at offset r (metres) in an endless solid.
std::array<double, 3> Exact(const MomentSource& source, const std::array<double, 3>& r, double time)
{
  return banyan::StokesVelocity(Stone, source, r, time);
}

/// Largest difference from the exact velocity at a cell up to the given time, as a share of the
/// largest exact velocity.
double Misfit(const ElasticGrid& grid, const MomentSource& source, const std::array<int, 3>& cell,
  double seconds)
{
  ThreadPool pool(2);
  ElasticWaveSimulation waves(grid, StoneEverywhere, source, pool);
  std::array<double, 3> offset;
  for (int c = 0; c < 3; ++c)
  {
    offset[c] = (cell[c] - source.Cell[c]) * grid.CellMetres;
  }
  double largest = 0.0, difference = 0.0;
  while (waves.Time() < seconds)
  {
    waves.AdvanceTo(waves.Time() + waves.TimeStepSeconds());
    const auto exact = Exact(source, offset, waves.Time() - 0.5 * waves.TimeStepSeconds());
    const auto found = waves.Velocity(cell[0], cell[1], cell[2]);
    for (int c = 0; c < 3; ++c)
    {
      largest = std::max(largest, std::abs(exact[c]));
      difference = std::max(difference, std::abs(exact[c] - found[c]));
    }
  }
  return difference / largest;
}

/// Time at which the displacement of one component is largest.
double PeakOfDisplacement(ElasticWaveSimulation& waves, const std::array<int, 3>& cell,
  const std::array<double, 3>& direction, double seconds)
{
  double displacement = 0.0, largest = 0.0, time = 0.0;
  while (waves.Time() < seconds)
  {
    waves.AdvanceTo(waves.Time() + waves.TimeStepSeconds());
    const auto v = waves.Velocity(cell[0], cell[1], cell[2]);
    for (int c = 0; c < 3; ++c)
    {
      displacement += direction[c] * v[c] * waves.TimeStepSeconds();
    }
    if (std::abs(displacement) > largest)
    {
      largest = std::abs(displacement);
      time = waves.Time();
    }
  }
  return time;
}

} // namespace

TEST(ElasticWave, AShearCrackRadiatesAsTheExactSolution)
{
  const MomentSource source = SourceAt(15, 16, 17, { 3e13, -1e14, 7e13, 5e13, -2e13, 1e14 });
  const std::array<int, 3> cell = { 25, 21, 10 };
  // Both waves have passed after 1.5 s; afterwards comes what the damped layers send back.
  EXPECT_LT(Misfit(FullSpace(32), source, cell, 1.5), 0.025);
  EXPECT_LT(Misfit(FullSpace(32), source, cell, 2.5), 0.05);
}

TEST(ElasticWave, PWavesArriveAtDistanceOverSpeed)
{
  // An explosion makes P waves only, pushing outwards.
  const double m = 1e14;
  const MomentSource source = SourceAt(3, 16, 16, { m, m, m, 0, 0, 0 });
  std::vector<double> times;
  for (const int away : { 18, 27 })
  {
    ThreadPool pool(2);
    ElasticWaveSimulation waves(FullSpace(32), StoneEverywhere, source, pool);
    times.push_back(PeakOfDisplacement(waves, { 3 + away, 16, 16 }, { 1, 0, 0 }, 1.5));
    // Far from the source the displacement follows the moment rate. The share of other parts, which
    // decays faster with distance, makes the peak late by less than a tenth of the pulse.
    EXPECT_NEAR(times.back(), source.Delay + away * 100.0 / Stone.PressureSpeed, 0.04);
  }
  EXPECT_NEAR(times[1] - times[0], 9 * 100.0 / Stone.PressureSpeed, 0.03);
}

TEST(ElasticWave, SWavesArriveAtDistanceOverSpeed)
{
  // Slip along x and z: on the x axis the P wave has its node and the S wave its maximum, along z.
  const MomentSource source = SourceAt(3, 16, 16, { 0, 0, 0, 0, 1e14, 0 });
  std::vector<double> times;
  for (const int away : { 18, 27 })
  {
    ThreadPool pool(2);
    ElasticWaveSimulation waves(FullSpace(32), StoneEverywhere, source, pool);
    times.push_back(PeakOfDisplacement(waves, { 3 + away, 16, 16 }, { 0, 0, 1 }, 2.0));
    EXPECT_NEAR(times.back(), source.Delay + away * 100.0 / Stone.ShearSpeed, 0.04);
  }
  EXPECT_NEAR(times[1] - times[0], 9 * 100.0 / Stone.ShearSpeed, 0.03);
}

TEST(ElasticWave, EnergyDoesNotGrowAfterTheSourceEnds)
{
  for (const bool surface : { true, false })
  {
    ThreadPool pool(2);
    const BasinModel basin(3);
    ElasticGrid grid;
    grid.Size = 32;
    grid.CellMetres = BasinModel::EdgeMetres / grid.Size;
    grid.DampedCells = 8;
    grid.FreeSurface = surface;
    const auto ground = [&](int x, int y, int z)
    { return basin.At(x * grid.CellMetres, y * grid.CellMetres, (31 - z) * grid.CellMetres); };
    const MomentSource source = basin.Source(grid.Size);
    ElasticWaveSimulation waves(grid, ground, source, pool);
    waves.AdvanceTo(source.Delay + 4.0 * source.HalfDuration);
    double last = waves.Energy();
    const double start = last;
    ASSERT_GT(start, 0.0);
    while (waves.Time() < 15.0)
    {
      waves.AdvanceTo(waves.Time() + 3.0 * waves.TimeStepSeconds());
      const double now = waves.Energy();
      ASSERT_LT(now, last + 1e-3 * start) << waves.Time();
      ASSERT_LT(now, 1.001 * start) << waves.Time();
      last = now;
    }
    EXPECT_LT(last, start);
  }
}

TEST(ElasticWave, WithoutDampingEnergyStays)
{
  ThreadPool pool(2);
  ElasticGrid grid = FullSpace(20);
  grid.DampedCells = 0;
  const MomentSource source = SourceAt(9, 10, 11, { 1e14, 2e13, 0, 3e13, 5e13, -4e13 });
  ElasticWaveSimulation waves(grid, StoneEverywhere, source, pool);
  waves.AdvanceTo(source.Delay + 5.0 * source.HalfDuration);
  const double start = waves.Energy();
  for (int step = 0; step < 100; ++step)
  {
    waves.AdvanceTo(waves.Time() + waves.TimeStepSeconds());
    ASSERT_NEAR(waves.Energy(), start, 0.02 * start);
  }
}

TEST(ElasticWave, TheFreeSurfaceDoublesTheMotion)
{
  const double m = 1e14;
  const int size = 32, depth = 18;
  const MomentSource source = SourceAt(16, 16, size - 1 - depth, { m, m, m, 0, 0, 0 });
  double exact = 0.0, found = 0.0;
  ThreadPool pool(2);
  ElasticGrid grid = FullSpace(size);
  grid.FreeSurface = true;
  ElasticWaveSimulation waves(grid, StoneEverywhere, source, pool);
  while (waves.Time() < 1.3)
  {
    waves.AdvanceTo(waves.Time() + waves.TimeStepSeconds());
    found = std::max(found, std::abs(static_cast<double>(waves.Velocity(16, 16, size - 1)[2])));
    exact = std::max(exact, std::abs(Exact(source, { 0, 0, depth * 100.0 }, waves.Time())[2]));
  }
  // Exactly twice for a plane wave; this one is a sphere of four wavelengths' radius.
  EXPECT_NEAR(found / exact, 2.0, 0.15);
}

TEST(ElasticWave, ImpossibleGroundsAndSourcesAreErrors)
{
  ThreadPool pool(1);
  const MomentSource source = SourceAt(4, 4, 4, { 1, 1, 1, 0, 0, 0 });
  const auto build = [&](const ElasticMaterial& material, const MomentSource& where)
  {
    ElasticWaveSimulation(
      FullSpace(8), [&](int, int, int) { return material; }, where, pool);
  };
  EXPECT_NO_THROW(build(Stone, source));
  EXPECT_THROW(build({ 1000.0f, 1500.0f, 0.0f }, source), banyan::Error);
  EXPECT_THROW(build({ 2000.0f, 2000.0f, 1900.0f }, source), banyan::Error);
  EXPECT_THROW(build({ 2000.0f, NAN, 1900.0f }, source), banyan::Error);
  EXPECT_THROW(build({ -1.0f, 4000.0f, 2000.0f }, source), banyan::Error);
  EXPECT_THROW(build(Stone, SourceAt(8, 4, 4, source.Moment)), banyan::Error);
  EXPECT_THROW(build(Stone, SourceAt(4, -1, 4, source.Moment)), banyan::Error);
  MomentSource strong = source;
  strong.Moment[0] = 1e44; // its stress fits, the square of its velocity does not
  ElasticWaveSimulation waves(FullSpace(8), StoneEverywhere, strong, pool);
  waves.AdvanceTo(1.0);
  EXPECT_THROW(waves.Speed(), banyan::Error);
}

TEST(ElasticWave, TheBasinIsSoftOverHard)
{
  const BasinModel basin(1), same(1), other(2);
  const double middle = BasinModel::EdgeMetres / 2;
  float last = 0.0f;
  bool differs = false;
  for (double depth = 0.0; depth < BasinModel::EdgeMetres; depth += 50.0)
  {
    const ElasticMaterial m = basin.At(middle, middle, depth);
    EXPECT_GE(m.ShearSpeed, last) << depth;
    last = m.ShearSpeed;
    EXPECT_EQ(m.ShearSpeed, same.At(middle, middle, depth).ShearSpeed);
    differs = differs || m.ShearSpeed != other.At(middle, middle, depth).ShearSpeed;
  }
  EXPECT_TRUE(differs);
  EXPECT_EQ(basin.At(middle, middle, 0.0).ShearSpeed, 1200.0f);
  EXPECT_EQ(basin.At(0.0, 0.0, 0.0).ShearSpeed, 2900.0f);
  // A double couple: no explosion (trace) and no axis without force (determinant).
  const auto m = basin.Source(64).Moment;
  EXPECT_NEAR(m[0] + m[1] + m[2], 0.0, 1e4);
  const double determinant = m[0] * (m[1] * m[2] - m[5] * m[5]) -
                             m[3] * (m[3] * m[2] - m[5] * m[4]) +
                             m[4] * (m[3] * m[5] - m[1] * m[4]);
  EXPECT_NEAR(determinant / 1e48, 0.0, 1e-9);
}

TEST(ElasticWave, ThePercentileIsThatOfTheSortedValues)
{
  std::mt19937 random(4);
  for (const std::size_t count : { 1u, 2u, 99u, 10000u, 12345u })
  {
    std::vector<float> all;
    std::vector<std::vector<float>> steps(3);
    for (std::size_t i = 0; i < count; ++i)
    {
      all.push_back(static_cast<float>(random() % 5000));
      steps[i % 3].push_back(all.back());
    }
    std::sort(all.begin(), all.end());
    for (const double share : { 0.0, 0.5, 0.99, 0.9999 })
    {
      EXPECT_EQ(banyan::Percentile(steps, share),
        all[static_cast<std::size_t>(share * static_cast<double>(count))]);
    }
  }
}
