// SPDX-License-Identifier: BSD-3-Clause
// The jet: its inflow, and the budget of the fluid that comes out of its nozzle.
#include "JetSimulation.h"

#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

using banyan::FlowParameters;
using banyan::FlowSimulation;
using banyan::JetInflow;
using banyan::JetParameters;
using banyan::JetSimulation;
using banyan::ThreadPool;

namespace
{

constexpr double Pi = 3.141592653589793;

/// Slows the flow down in proportion to its speed, everywhere or nowhere.
class Drag : public banyan::FlowForcing
{
public:
  Drag(float rate, bool acts)
    : Rate(rate)
    , Acts(acts)
  {
  }
  bool ActsOnPlane(int) const override { return this->Acts; }
  std::array<float, 3> Acceleration(
    int, int, int, double, const std::array<float, 3>& u) const override
  {
    return { -this->Rate * u[0], -this->Rate * u[1], -this->Rate * u[2] };
  }

private:
  float Rate;
  bool Acts;
};

/// Pushes layers to and fro: cos(t) sin(z) along x.
class Shaker : public banyan::FlowForcing
{
public:
  explicit Shaker(int size)
    : Cell(2.0 * Pi / size)
  {
  }
  bool ActsOnPlane(int) const override { return true; }
  std::array<float, 3> Acceleration(
    int, int, int z, double time, const std::array<float, 3>&) const override
  {
    return { static_cast<float>(std::cos(time) * std::sin(z * this->Cell)), 0.0f, 0.0f };
  }

private:
  double Cell;
};

/// A jet for small grids.
JetParameters Wide()
{
  JetParameters parameters;
  parameters.Diameter = 1.2;
  parameters.EdgeWidth = 0.25;
  return parameters;
}

double Total(const JetSimulation& jet)
{
  const double cell = 2.0 * Pi / jet.Flow().Size();
  return std::accumulate(jet.Concentration().begin(), jet.Concentration().end(), 0.0) * cell *
         cell * cell;
}

} // namespace

TEST(FlowForcing, DragAddsItsRateToTheDecayOfAVortex)
{
  ThreadPool pool(2);
  for (const bool acts : { true, false })
  {
    const Drag drag(0.7f, acts);
    FlowParameters parameters;
    parameters.Viscosity = 0.05f;
    parameters.Forcing = &drag;
    parameters.WithTemperature = false;
    FlowSimulation flow(16, parameters, pool);
    flow.SetState({ [](float x, float y, float) { return 0.3f + std::sin(x) * std::cos(y); },
                    [](float x, float y, float) { return -std::cos(x) * std::sin(y); },
                    [](float, float, float) { return 0.0f; } },
      [](float, float, float) { return 0.0f; });
    flow.AdvanceTo(1.0);
    const double decay = std::exp(-(2.0 * 0.05 + (acts ? 0.7 : 0.0)));
    // The mean keeps its energy: nothing accelerates it.
    EXPECT_NEAR(flow.KineticEnergy(), 0.5 * 0.09 + 0.25 * decay * decay, 1e-4);
  }
}

TEST(FlowForcing, IsAskedAtTheRightTimes)
{
  ThreadPool pool(1);
  const int size = 16;
  const Shaker shaker(size);
  FlowParameters parameters;
  parameters.Viscosity = 0.0f;
  parameters.Forcing = &shaker;
  parameters.WithTemperature = false;
  parameters.LongestTimeStep = 0.1f;
  FlowSimulation flow(size, parameters, pool);
  const auto zero = [](float, float, float) { return 0.0f; };
  flow.SetState({ zero, zero, zero }, zero);
  flow.AdvanceTo(1.0);
  // The integral of cos(t) is sin(t); of third order, so that steps of 0.1 leave next to nothing.
  const auto u = flow.Velocity()[0];
  for (int z = 0; z < size; ++z)
  {
    EXPECT_NEAR(u[z * size * size + 7], std::sin(1.0) * std::sin(2.0 * Pi / size * z), 1e-5);
  }
}

TEST(JetInflow, TheFringeDrawsTowardsTheNozzleAndOnlyThere)
{
  const int size = 32;
  const JetInflow inflow(1, size, Wide());
  const double cell = 2.0 * Pi / size;
  EXPECT_FALSE(inflow.ActsOnPlane(0)) << "the rate rises from zero";
  EXPECT_TRUE(inflow.ActsOnPlane(2));
  for (int z = 4; z < size; ++z)
  {
    EXPECT_FALSE(inflow.ActsOnPlane(z)) << z;
  }
  // Away from the nozzle the goal is the co-flow, exactly.
  const auto outside = inflow.Acceleration(1, 1, 2, 0.3, { 0.0f, 0.0f, 0.05f });
  EXPECT_NEAR(outside[0] + outside[1] + outside[2], 0.0f, 1e-6f);
  EXPECT_GT(inflow.Acceleration(1, 1, 2, 0.3, { 0.0f, 0.0f, -1.0f })[2], 1.0f);
  EXPECT_EQ(inflow.Concentration(1.0f, 1.0f), 0.0f);
  const float middle = static_cast<float>(Pi);
  EXPECT_NEAR(inflow.Concentration(middle, middle), 1.0f, 0.01f);
  EXPECT_NEAR(inflow.Concentration(middle + 0.6f, middle), 0.5f, 1e-3f);
  EXPECT_NEAR(inflow.MeanSpeed(middle, middle), 1.05f, 0.01f);
  EXPECT_EQ(inflow.NozzlePlanes(), static_cast<int>(std::ceil(0.35 / cell)));
}

TEST(JetInflow, TheNozzleIsUnsteadyAsAskedAndSeeded)
{
  const int size = 32;
  JetParameters parameters = Wide();
  parameters.Unsteadiness = 0.1;
  const JetInflow inflow(1, size, parameters), same(1, size, parameters),
    other(2, size, parameters);
  // The acceleration of fluid at rest is the rate times the goal.
  const double rate = 20.0 * std::pow(std::sin(Pi * 2 * (2.0 * Pi / size) / 0.7), 2);
  double squares[3] = {};
  bool differs = false;
  const int samples = 4000;
  for (int i = 0; i < samples; ++i)
  {
    const double time = 0.05 * i;
    const std::array<float, 3> rest = { 0.0f, 0.0f, 0.0f };
    const auto a = inflow.Acceleration(16, 16, 2, time, rest);
    EXPECT_EQ(a, same.Acceleration(16, 16, 2, time, rest));
    differs = differs || a != other.Acceleration(16, 16, 2, time, rest);
    for (int c = 0; c < 3; ++c)
    {
      const double velocity = a[c] / rate - (c == 2 ? inflow.MeanSpeed(float(Pi), float(Pi)) : 0.0);
      squares[c] += velocity * velocity / samples;
    }
  }
  EXPECT_TRUE(differs);
  // 48 waves decide how the energy falls on the axes, their sum is exact but for chance in time.
  EXPECT_NEAR(std::sqrt((squares[0] + squares[1] + squares[2]) / 3.0), 0.1, 0.01);
  for (const double square : squares)
  {
    EXPECT_NEAR(std::sqrt(square), 0.1, 0.04);
  }
}

TEST(Jet, NozzleFluidIsAccountedForAndBounded)
{
  ThreadPool pool(2);
  const int size = 32;
  JetSimulation jet(1, size, Wide(), 0.01, pool);
  const double start = Total(jet);
  for (const double time : { 1.0, 3.0, 9.0 })
  {
    jet.AdvanceTo(time);
    EXPECT_NEAR(Total(jet) - start, jet.NetInflow(), 1e-4 * Total(jet)) << "at " << time;
    const auto range = std::minmax_element(jet.Concentration().begin(), jet.Concentration().end());
    EXPECT_GE(*range.first, -1e-6f);
    EXPECT_LE(*range.second, 1.0f + 2e-5f);
    EXPECT_LT(jet.Flow().LargestDivergence(), 1e-5);
  }
}

TEST(Jet, TheNozzleDeliversItsSpeedTimesItsArea)
{
  ThreadPool pool(2);
  const int size = 32;
  JetSimulation jet(1, size, Wide(), 0.01, pool);
  jet.AdvanceTo(1.0);
  const double before = jet.NetInflow();
  // The front is still far from the top.
  jet.AdvanceTo(3.0);
  double flux = 0.0;
  for (int i = 0; i < size * size; ++i)
  {
    const float x = static_cast<float>(2.0 * Pi / size * (i % size));
    const float y = static_cast<float>(2.0 * Pi / size * (i / size));
    flux += jet.Inflow().Concentration(x, y) * jet.Inflow().MeanSpeed(x, y) *
            std::pow(2.0 * Pi / size, 2);
  }
  // The nozzle pulsates, and the fringe is not rigid.
  EXPECT_NEAR((jet.NetInflow() - before) / 2.0 / flux, 1.0, 0.1);
  // Where the jet has not been there is none of it.
  const auto& c = jet.Concentration();
  EXPECT_LT(c[((size / 2) * size + 2) * size + 2], 1e-6f);
  EXPECT_GT(c[((size / 4) * size + size / 2) * size + size / 2], 0.8f);
}

TEST(Jet, TheNumberOfThreadsDoesNotChangeABit)
{
  std::vector<float> results[2];
  for (const int threads : { 1, 3 })
  {
    ThreadPool pool(threads);
    JetSimulation jet(1, 20, Wide(), 0.02, pool);
    jet.AdvanceTo(1.5);
    results[threads > 1] = jet.Concentration();
  }
  EXPECT_EQ(results[0], results[1]);
}
