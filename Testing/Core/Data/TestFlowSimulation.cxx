// SPDX-License-Identifier: BSD-3-Clause
// The flow against exact solutions of the equations it claims to solve. Single precision carries
// about seven digits; tolerances below are a few hundred roundings of it, unless said otherwise.
#include "FlowSimulation.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

using banyan::FlowParameters;
using banyan::FlowSimulation;
using banyan::ThreadPool;

namespace
{

constexpr double TwoPi = 6.283185307179586;

float Zero(float, float, float)
{
  return 0.0f;
}

/// The largest |values - exact(x, y, z)| over the grid.
template <typename Exact>
double LargestError(const std::vector<float>& values, int size, const Exact& exact)
{
  double largest = 0.0;
  for (int z = 0, i = 0; z < size; ++z)
  {
    for (int y = 0; y < size; ++y)
    {
      for (int x = 0; x < size; ++x, ++i)
      {
        const double cell = TwoPi / size;
        largest = std::max(largest, std::abs(values[i] - exact(x * cell, y * cell, z * cell)));
      }
    }
  }
  return largest;
}

double Mean(const std::vector<float>& values)
{
  return std::accumulate(values.begin(), values.end(), 0.0) / values.size();
}

/// A three-dimensional flow with every term of the equations at work.
void SetRoughState(FlowSimulation& flow)
{
  flow.SetState(
    { [](float x, float y, float z) { return std::sin(2 * y + z) + std::cos(x) * std::sin(3 * z); },
      [](float x, float y, float z) { return std::cos(2 * x - z) + std::sin(y + z); },
      [](float x, float y, float) { return std::sin(x + 2 * y); } },
    [](float x, float y, float z)
    { return 0.25f + std::exp(-(std::cos(x) + std::cos(y) + std::cos(z))); });
}

} // namespace

TEST(FlowSimulation, TaylorGreenVortexDecaysAsViscousTheorySays)
{
  ThreadPool pool(2);
  FlowParameters parameters;
  parameters.Viscosity = 0.1f;
  parameters.Buoyancy = 0.0f;
  FlowSimulation flow(24, parameters, pool);
  flow.SetState({ [](float x, float y, float) { return std::sin(x) * std::cos(y); },
                  [](float x, float y, float) { return -std::cos(x) * std::sin(y); }, Zero },
    Zero);
  EXPECT_NEAR(flow.KineticEnergy(), 0.25, 1e-6);
  for (const double time : { 0.7, 2.0 })
  {
    flow.AdvanceTo(time);
    const double decay = std::exp(-2.0 * 0.1 * time);
    EXPECT_NEAR(flow.KineticEnergy() / (0.25 * decay * decay), 1.0, 3e-5) << "at " << time;
    const auto velocity = flow.Velocity();
    EXPECT_LT(LargestError(velocity[0], 24,
                [&](double x, double y, double) { return decay * std::sin(x) * std::cos(y); }),
      3e-5);
    EXPECT_LT(LargestError(velocity[1], 24,
                [&](double x, double y, double) { return -decay * std::cos(x) * std::sin(y); }),
      3e-5);
  }
  EXPECT_NEAR(flow.Time(), 2.0, 1e-9);
}

TEST(FlowSimulation, AVortexCarriedByAWindIsTheVortexElsewhere)
{
  // Galilean invariance: unlike the vortex at rest, this needs u x curl(u) to be right in space
  // and time. The error left is the time scheme's.
  ThreadPool pool(2);
  FlowParameters parameters;
  parameters.Viscosity = 0.05f;
  parameters.Buoyancy = 0.0f;
  const double time = 1.5, wind[2] = { 0.8, -0.5 };
  const auto errorWithCourant = [&](float courant)
  {
    parameters.Courant = courant;
    FlowSimulation flow(24, parameters, pool);
    flow.SetState({ [&](float x, float y, float)
                    { return static_cast<float>(wind[0]) + std::sin(x) * std::cos(y); },
                    [&](float x, float y, float)
                    { return static_cast<float>(wind[1]) - std::cos(x) * std::sin(y); },
                    Zero },
      Zero);
    flow.AdvanceTo(time);
    const double decay = std::exp(-2.0 * 0.05 * time);
    return LargestError(flow.Velocity()[0], 24,
      [&](double x, double y, double)
      { return wind[0] + decay * std::sin(x - wind[0] * time) * std::cos(y - wind[1] * time); });
  };
  parameters.LongestTimeStep = 1.0f;
  const double coarse = errorWithCourant(0.8f), fine = errorWithCourant(0.4f);
  EXPECT_LT(fine, 2e-4);
  // Third order: half the step, an eighth of the error.
  EXPECT_GT(coarse / fine, 6.0);
  EXPECT_LT(coarse / fine, 11.0);
}

TEST(FlowSimulation, HeatDriftsAndDiffusesExactly)
{
  ThreadPool pool(1);
  FlowParameters parameters;
  parameters.Diffusivity = 0.03f;
  parameters.Buoyancy = 0.0f;
  parameters.Courant = 0.2f;
  FlowSimulation flow(16, parameters, pool);
  flow.SetState({ [](float, float, float) { return 0.5f; }, Zero, Zero },
    [](float x, float y, float z) { return 2.0f + std::cos(2 * x + y - z); });
  flow.AdvanceTo(1.0);
  const double decay = std::exp(-0.03 * 6.0);
  EXPECT_LT(
    LargestError(flow.Temperature(), 16,
      [&](double x, double y, double z) { return 2.0 + decay * std::cos(2 * (x - 0.5) + y - z); }),
    2e-5);
}

TEST(FlowSimulation, BuoyancyAcceleratesWarmColumns)
{
  // T = sin(x) and w = w(x) carry neither themselves nor each other, so that with equal viscosity
  // and diffusivity w = buoyancy t sin(x) exp(-viscosity t).
  ThreadPool pool(1);
  FlowParameters parameters;
  parameters.Viscosity = parameters.Diffusivity = 0.2f;
  parameters.Buoyancy = 3.0f;
  FlowSimulation flow(12, parameters, pool);
  flow.SetState({ Zero, Zero, Zero }, [](float x, float, float) { return 7.0f + std::sin(x); });
  flow.AdvanceTo(0.9);
  const double decay = std::exp(-0.2 * 0.9);
  EXPECT_LT(LargestError(flow.Velocity()[2], 12,
              [&](double x, double, double) { return 3.0 * 0.9 * decay * std::sin(x); }),
    1e-4);
  EXPECT_LT(LargestError(flow.Vorticity()[1], 12,
              [&](double x, double, double) { return -3.0 * 0.9 * decay * std::cos(x); }),
    1e-4);
}

TEST(FlowSimulation, VelocityStaysFreeOfDivergenceAndMeanTemperatureStays)
{
  ThreadPool pool(2);
  FlowSimulation flow(32, FlowParameters(), pool);
  SetRoughState(flow);
  const double mean = Mean(flow.Temperature());
  const double energy = flow.KineticEnergy();
  EXPECT_LT(flow.LargestDivergence(), 1e-6);
  flow.AdvanceTo(1.0);
  EXPECT_GT(flow.StepsTaken(), 10);
  EXPECT_LT(flow.LargestDivergence(), 1e-5);
  EXPECT_NEAR(Mean(flow.Temperature()), mean, 1e-6 * mean);
  EXPECT_GT(std::abs(flow.KineticEnergy() - energy), 0.01 * energy) << "nothing happened";
}

TEST(FlowSimulation, WithoutViscosityAndBuoyancyEnergyIsKept)
{
  ThreadPool pool(2);
  FlowParameters parameters;
  parameters.Viscosity = 0.0f;
  parameters.Buoyancy = 0.0f;
  parameters.Courant = 0.2f;
  FlowSimulation flow(24, parameters, pool);
  SetRoughState(flow);
  const double energy = flow.KineticEnergy();
  flow.AdvanceTo(0.5);
  EXPECT_NEAR(flow.KineticEnergy() / energy, 1.0, 1e-4);
}

TEST(FlowSimulation, TheNumberOfThreadsDoesNotChangeABit)
{
  std::vector<float> results[2];
  for (const int threads : { 1, 3 })
  {
    ThreadPool pool(threads);
    FlowSimulation flow(20, FlowParameters(), pool);
    SetRoughState(flow);
    flow.AdvanceTo(0.4);
    results[threads > 1] = flow.Temperature();
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST(FlowSimulation, AnUnstableFlowIsReported)
{
  ThreadPool pool(2);
  FlowParameters parameters;
  parameters.Viscosity = 0.0f;
  parameters.Courant = 40.0f;
  parameters.LongestTimeStep = 100.0f;
  FlowSimulation flow(16, parameters, pool);
  SetRoughState(flow);
  EXPECT_THROW(flow.AdvanceTo(1e6), banyan::Error);
}

TEST(FlowSimulation, OddAndTinyGridsAreRefused)
{
  ThreadPool pool(1);
  EXPECT_THROW(FlowSimulation(15, FlowParameters(), pool), banyan::Error);
  EXPECT_THROW(FlowSimulation(0, FlowParameters(), pool), banyan::Error);
  EXPECT_THROW(FlowSimulation(-8, FlowParameters(), pool), banyan::Error);
}
