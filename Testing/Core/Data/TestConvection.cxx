// SPDX-License-Identifier: BSD-3-Clause
// The side-heated box against exact solutions, balances, symmetries and published heat fluxes.
#include "BoxPoisson.h"
#include "ConvectionSimulation.h"
#include "SeriesCatalog.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using banyan::BoxPoisson;
using banyan::ConvectionParameters;
using banyan::ConvectionSimulation;
using banyan::ThreadPool;

namespace
{

std::size_t At(int size, int x, int y, int z)
{
  return (static_cast<std::size_t>(z) * size + y) * size + x;
}

/// N^3 values of a function of the cell centres, in units of the edge.
template <typename Function>
std::vector<float> Sampled(int size, const Function& function)
{
  std::vector<float> values;
  for (int z = 0; z < size; ++z)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        values.push_back(
          static_cast<float>(function((x + 0.5) / size, (y + 0.5) / size, (z + 0.5) / size)));
  return values;
}

ConvectionParameters WithRayleigh(double rayleigh)
{
  ConvectionParameters parameters;
  parameters.Rayleigh = rayleigh;
  return parameters;
}

/// A disturbance that no symmetry of the box leaves as it is.
double Bump(double x, double y, double z)
{
  return 0.1 * std::sin(3 * x) * std::cos(4 * y + 1) * std::cos(5 * z - 2) * (1 - x);
}

} // namespace

TEST(Convection, ThePoissonSolverLeavesNoResidual)
{
  for (const int size : { 2, 7, 10, 16 })
  {
    ThreadPool pool(2);
    std::mt19937 random(size);
    std::vector<float> wanted(static_cast<std::size_t>(size) * size * size);
    double mean = 0.0;
    for (float& value : wanted)
    {
      value = static_cast<float>(random() % 2001) / 1000.0f - 1.0f;
      mean += value / static_cast<double>(wanted.size());
    }
    std::vector<float> p = wanted;
    BoxPoisson(size).Solve(p, pool);
    float largest = 0.0f;
    for (const float value : p)
    {
      largest = std::max(largest, std::abs(value));
    }
    for (int z = 0; z < size; ++z)
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
        {
          const double here = p[At(size, x, y, z)];
          double sum = 0.0;
          sum += x > 0 ? p[At(size, x - 1, y, z)] - here : 0.0;
          sum += x + 1 < size ? p[At(size, x + 1, y, z)] - here : 0.0;
          sum += y > 0 ? p[At(size, x, y - 1, z)] - here : 0.0;
          sum += y + 1 < size ? p[At(size, x, y + 1, z)] - here : 0.0;
          sum += z > 0 ? p[At(size, x, y, z - 1)] - here : 0.0;
          sum += z + 1 < size ? p[At(size, x, y, z + 1)] - here : 0.0;
          ASSERT_NEAR(sum, wanted[At(size, x, y, z)] - mean, 3e-6 * (1.0f + largest)) << size;
        }
  }
}

TEST(Convection, HeatConductsAsTheErrorFunctionFirst)
{
  ThreadPool pool(2);
  const double time = 0.01, width = 2.0 * std::sqrt(time);
  double errors[2] = {};
  for (const int size : { 16, 32 })
  {
    ConvectionSimulation box(size, WithRayleigh(0.0), pool);
    box.AdvanceTo(time);
    const auto values = box.Temperature();
    double& error = errors[size / 32];
    for (int x = 0; x < size; ++x)
    {
      const double place = (x + 0.5) / size;
      const double exact = 0.5 * std::erfc(place / width) - 0.5 * std::erfc((1.0 - place) / width);
      error = std::max(error, std::abs(values[At(size, x, 3, 10)] - exact));
      EXPECT_EQ(values[At(size, x, 3, 10)], values[At(size, x, 14, 1)]);
    }
    EXPECT_EQ(box.FaceVelocity(2), std::vector<float>(values.size(), 0.0f));
  }
  EXPECT_LT(errors[1], 2e-3);
  // Second order: half the cell, a quarter of the error.
  EXPECT_GT(errors[0] / errors[1], 3.3);
}

TEST(Convection, ConductionEndsAsAStraightLine)
{
  ThreadPool pool(1);
  const int size = 12;
  ConvectionSimulation box(size, WithRayleigh(0.0), pool);
  box.SetTemperature(Sampled(size, Bump));
  // The slowest difference from the line decays as exp(-pi^2 t).
  box.AdvanceTo(1.5);
  const auto values = box.Temperature();
  for (int z = 0; z < size; ++z)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        ASSERT_NEAR(values[At(size, x, y, z)], 0.5 - (x + 0.5) / size, 2e-6);
  EXPECT_NEAR(box.HeatThroughHotWall(), 1.0, 1e-5);
  EXPECT_NEAR(box.HeatThroughColdWall(), 1.0, 1e-5);
}

TEST(Convection, TheFlowHasNoDivergenceAndTemperatureNoNewExtremes)
{
  ThreadPool pool(2);
  ConvectionSimulation box(24, WithRayleigh(1e6), pool);
  box.SetTemperature(Sampled(24, Bump));
  for (int step = 1; step <= 8; ++step)
  {
    box.AdvanceTo(step);
    float fastest = 0.0f;
    for (int c = 0; c < 3; ++c)
    {
      for (const float v : box.FaceVelocity(c))
      {
        fastest = std::max(fastest, std::abs(v));
      }
    }
    ASSERT_GT(fastest, 0.05f);
    // Differences over a cell carry the roundings of single precision, some 24 of them.
    EXPECT_LT(box.LargestDivergence(), 24 * 1.2e-7 * 24 * fastest);
    const auto values = box.Temperature();
    const auto range = std::minmax_element(values.begin(), values.end());
    EXPECT_GT(*range.first, -0.5f);
    EXPECT_LT(*range.second, 0.5f);
  }
}

TEST(Convection, TheMeanTemperatureChangesByTheHeatThroughTheWalls)
{
  ThreadPool pool(2);
  const int size = 16;
  ConvectionSimulation box(size, WithRayleigh(1e5), pool);
  box.SetTemperature(Sampled(size, [](double, double, double z) { return 0.3 - 0.2 * z; }));
  const double before = box.MeanTemperature();
  double heat = 0.0;
  const int steps = 400;
  double last = box.HeatThroughHotWall() - box.HeatThroughColdWall();
  for (int step = 1; step <= steps; ++step)
  {
    box.AdvanceTo(2.0 * step / steps);
    const double now = box.HeatThroughHotWall() - box.HeatThroughColdWall();
    heat += 0.5 * (last + now) * 2.0 / steps;
    last = now;
  }
  ASSERT_GT(std::abs(heat), 0.02);
  EXPECT_NEAR(box.MeanTemperature() - before, heat, 2e-4 * std::abs(heat) + 1e-6);
}

TEST(Convection, TheBoxTurnedUpsideDownIsTheSame)
{
  ThreadPool pool(2);
  const int size = 20;
  ConvectionSimulation box(size, WithRayleigh(3e5), pool);
  box.AdvanceTo(5.0);
  const auto t = box.Temperature();
  const auto v = box.Velocity();
  for (int z = 0; z < size; ++z)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
      {
        const std::size_t here = At(size, x, y, z);
        const std::size_t turned = At(size, size - 1 - x, y, size - 1 - z);
        const std::size_t mirrored = At(size, x, size - 1 - y, z);
        ASSERT_NEAR(t[here], -t[turned], 2e-6);
        ASSERT_NEAR(t[here], t[mirrored], 2e-6);
        ASSERT_NEAR(v[3 * here], -v[3 * turned], 2e-6);
        ASSERT_NEAR(v[3 * here + 1], v[3 * turned + 1], 2e-6);
        ASSERT_NEAR(v[3 * here + 2], -v[3 * turned + 2], 2e-6);
        ASSERT_NEAR(v[3 * here + 1], -v[3 * mirrored + 1], 2e-6);
      }
}

TEST(Convection, HotRisesAlongTheHotWall)
{
  ThreadPool pool(2);
  const int size = 16;
  ConvectionSimulation box(size, WithRayleigh(1e5), pool);
  box.AdvanceTo(3.0);
  const auto v = box.Velocity();
  EXPECT_GT(v[3 * At(size, 2, 8, 8) + 2], 0.05f);
  EXPECT_LT(v[3 * At(size, 13, 8, 8) + 2], -0.05f);
}

TEST(Convection, TheSteadyHeatFluxIsThePublishedOne)
{
  // Tric, Labrosse, Betrouni, A first incursion into the 3D structure of natural convection of air
  // in a differentially heated cubic cavity (2000): Nusselt number 2.054 at Rayleigh 1e4.
  ThreadPool pool(2);
  double nusselt[2] = {};
  for (const int size : { 12, 20 })
  {
    ConvectionSimulation box(size, WithRayleigh(1e4), pool);
    box.AdvanceTo(30.0);
    const double hot = box.HeatThroughHotWall() / box.Diffusivity();
    const double cold = box.HeatThroughColdWall() / box.Diffusivity();
    EXPECT_NEAR(hot, cold, 1e-3);
    nusselt[size / 20] = hot;
  }
  // Errors go with the square of the cell: both grids together tell the value without cells.
  const double limit = nusselt[1] + (nusselt[1] - nusselt[0]) / (400.0 / 144.0 - 1.0);
  EXPECT_NEAR(limit, 2.054, 0.01);
}

TEST(Convection, AnUnstableTimeStepAndAWrongSizeAreErrors)
{
  ThreadPool pool(1);
  ConvectionParameters hasty = WithRayleigh(1e6);
  hasty.Courant = 8.0;
  ConvectionSimulation box(12, hasty, pool);
  EXPECT_THROW(box.AdvanceTo(100.0), banyan::Error);
  EXPECT_THROW(box.SetTemperature(std::vector<float>(5)), banyan::Error);
}
