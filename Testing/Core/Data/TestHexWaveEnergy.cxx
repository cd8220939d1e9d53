// SPDX-License-Identifier: BSD-3-Clause
// Energy of elastic waves on octree meshes, what open sides take out of it, threads, and errors.
#include "HexWaveSimulation.h"
#include "WaveMesh.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <cmath>

using banyan::ElasticMaterial;
using banyan::HexWaveEnergy;
using banyan::HexWaveSimulation;
using banyan::MomentPoint;
using banyan::OctreeMesh;
using banyan::ThreadPool;
using banyan::WaveMesh;

namespace
{

/// Soft over hard with a border that no mesh knows of.
ElasticMaterial SoftOverHard(const std::array<double, 3>& p)
{
  return p[2] + 0.3 * p[0] > 1000.0 ? ElasticMaterial{ 2000.0f, 2000.0f, 700.0f } : WaveMesh::Stone;
}

MomentPoint Crack()
{
  return WaveMesh::Source({ 610.0, 580.0, 333.0 }, { 3e13, -1e14, 7e13, 5e13, -2e13, 1e14 });
}

} // namespace

TEST(HexWaveEnergy, AClosedBoxKeepsWhatTheSourceHasGiven)
{
  ThreadPool pool(2);
  const OctreeMesh mesh = WaveMesh::Random({ 4, 3, 3 }, 6, pool);
  ASSERT_GT(mesh.Hanging().size(), 100u);
  HexWaveSimulation waves(mesh, SoftOverHard, { Crack() }, WaveMesh::Closed(), pool);
  double largest = 0.0, kinetic = 0.0;
  for (int round = 1; round <= 60; ++round)
  {
    waves.AdvanceTo(0.1 * round);
    const HexWaveEnergy energy = waves.Energy();
    largest = std::max(largest, energy.Work);
    kinetic = std::max(kinetic, energy.Kinetic);
    EXPECT_EQ(energy.Absorbed, 0.0);
    ASSERT_NEAR(energy.Kinetic + energy.Strain, energy.Work, 4e-6 * largest) << waves.Time();
  }
  // Most of the energy is strain around the source that stays. Waves are a thousandth of it, and
  // their energy is kept within half a percent for many steps after the source has ended.
  EXPECT_GT(kinetic, 1e-3 * largest);
  EXPECT_GT(waves.StepsTaken(), 600);
}

TEST(HexWaveEnergy, WithOpenSidesWhatIsGoneHasBeenAbsorbed)
{
  ThreadPool pool(2);
  const OctreeMesh mesh = WaveMesh::Random({ 4, 3, 3 }, 6, pool);
  HexWaveSimulation waves(mesh, SoftOverHard, { Crack() }, {}, pool);
  double last = 0.0, largest = 0.0;
  for (int round = 1; round <= 40; ++round)
  {
    waves.AdvanceTo(0.1 * round);
    const HexWaveEnergy energy = waves.Energy();
    EXPECT_GE(energy.Absorbed, last);
    largest = std::max(largest, energy.Work);
    last = energy.Absorbed;
    ASSERT_NEAR(energy.Kinetic + energy.Strain + energy.Absorbed, energy.Work, 4e-6 * largest)
      << waves.Time();
  }
  EXPECT_GT(last, 1e-3 * largest);
}

TEST(HexWaveEnergy, OpenSidesTakeOutMostOfWhatArrives)
{
  ThreadPool pool(2);
  const OctreeMesh mesh = WaveMesh::Uniform({ 20, 20, 20 }, 100.0, pool);
  const MomentPoint source =
    WaveMesh::Source({ 1050.0, 950.0, 1050.0 }, { 3e13, -1e14, 7e13, 5e13, -2e13, 1e14 });
  double kinetic[2];
  for (const bool open : { false, true })
  {
    HexWaveSimulation waves(mesh, WaveMesh::StoneEverywhere, { source },
      open ? WaveMesh::AllOpen() : WaveMesh::Closed(), pool);
    // S waves have passed even the corners, 1.73 km away.
    waves.AdvanceTo(1.8);
    kinetic[open] = waves.Energy().Kinetic;
  }
  EXPECT_LT(kinetic[1], 0.05 * kinetic[0]);
}

TEST(HexWaveEnergy, AnyNumberOfThreadsGivesTheSameBits)
{
  std::vector<float> results[2];
  for (const int threads : { 1, 3 })
  {
    ThreadPool pool(threads);
    const OctreeMesh mesh = WaveMesh::Random({ 6, 5, 5 }, 6, pool);
    HexWaveSimulation waves(mesh, SoftOverHard, { Crack() }, {}, pool);
    waves.AdvanceTo(0.6);
    results[threads > 1] = waves.Displacement();
    results[threads > 1].insert(
      results[threads > 1].end(), waves.Velocity().begin(), waves.Velocity().end());
  }
  EXPECT_TRUE(results[0] == results[1]);
  EXPECT_NE(results[0][results[0].size() / 3], 0.0f);
}

TEST(HexWaveEnergy, ImpossibleGroundsAndSourcesAreErrors)
{
  ThreadPool pool(1);
  const OctreeMesh mesh = WaveMesh::Uniform({ 4, 4, 4 }, 100.0, pool);
  const auto build = [&](const ElasticMaterial& material, const std::array<double, 3>& place)
  {
    HexWaveSimulation(
      mesh, [&](const std::array<double, 3>&) { return material; },
      { WaveMesh::Source(place, { 1, 1, 1, 0, 0, 0 }) }, {}, pool);
  };
  EXPECT_NO_THROW(build(WaveMesh::Stone, { 200.0, 200.0, 400.0 }));
  EXPECT_THROW(build(WaveMesh::Stone, { 200.0, 200.0, 400.1 }), banyan::Error);
  EXPECT_THROW(build(WaveMesh::Stone, { 200.0, NAN, 200.0 }), banyan::Error);
  EXPECT_THROW(build({ 1000.0f, 1500.0f, 0.0f }, { 200.0, 200.0, 200.0 }), banyan::Error);
  EXPECT_THROW(build({ 2000.0f, 2000.0f, 1900.0f }, { 200.0, 200.0, 200.0 }), banyan::Error);
  EXPECT_THROW(build({ 2000.0f, NAN, 1900.0f }, { 200.0, 200.0, 200.0 }), banyan::Error);
  EXPECT_THROW(build({ -1.0f, 4000.0f, 2000.0f }, { 200.0, 200.0, 200.0 }), banyan::Error);
  HexWaveSimulation waves(mesh, WaveMesh::StoneEverywhere,
    { WaveMesh::Source({ 200.0, 200.0, 200.0 }, { 1e48, 1, 1, 0, 0, 0 }) }, {}, pool);
  EXPECT_THROW(waves.AdvanceTo(1.0), banyan::Error);
}
