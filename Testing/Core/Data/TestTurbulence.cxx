// SPDX-License-Identifier: BSD-3-Clause
// Turbulence: the random start, and what must hold of any flow that has developed from it.
#include "FlowSimulation.h"
#include "RandomSpectrum.h"

#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

using banyan::FlowParameters;
using banyan::FlowSimulation;
using banyan::RandomSpectrum;
using banyan::ThreadPool;

namespace
{

constexpr double TwoPi = 6.283185307179586;

FlowParameters Parameters(float viscosity)
{
  FlowParameters parameters;
  parameters.Viscosity = viscosity;
  parameters.Buoyancy = 0.0f;
  parameters.WithTemperature = false;
  return parameters;
}

void Start(FlowSimulation& flow, const RandomSpectrum& spectrum)
{
  flow.SetVelocitySpectrum([&](int x, int y, int z) { return spectrum.Coefficient(x, y, z); });
}

struct Moments
{
  double Skewness, Flatness;
};

/// Of the differences of velocity between neighbours along its own direction.
Moments LongitudinalGradient(const FlowSimulation& flow)
{
  const auto velocity = flow.Velocity();
  const std::size_t n = flow.Size();
  const std::size_t strides[3] = { 1, n, n * n };
  double sums[5] = {};
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < n * n * n; ++i)
    {
      const bool last = i / strides[c] % n == n - 1;
      const std::size_t next = last ? i + strides[c] - n * strides[c] : i + strides[c];
      const double difference = velocity[c][next] - velocity[c][i];
      for (int power = 2; power <= 4; ++power)
      {
        sums[power] += std::pow(difference, power) / (3.0 * n * n * n);
      }
    }
  }
  return { sums[3] / std::pow(sums[2], 1.5), sums[4] / (sums[2] * sums[2]) };
}

} // namespace

TEST(RandomSpectrum, CoefficientsAreARealFieldWithoutDivergence)
{
  const RandomSpectrum spectrum(5, 3.0, 8.0), other(6, 3.0, 8.0);
  for (int kz = -4; kz <= 4; ++kz)
  {
    for (int ky = -4; ky <= 4; ++ky)
    {
      for (int kx = 0; kx <= 4; ++kx)
      {
        const auto u = spectrum.Coefficient(kx, ky, kz);
        const auto opposite = spectrum.Coefficient(-kx, -ky, -kz);
        const std::complex<float> along = static_cast<float>(kx) * u[0] +
                                          static_cast<float>(ky) * u[1] +
                                          static_cast<float>(kz) * u[2];
        EXPECT_LT(std::abs(along), 1e-6f);
        for (int c = 0; c < 3; ++c)
        {
          EXPECT_EQ(u[c], std::conj(opposite[c]));
        }
        if (kx != 0 || ky != 0 || kz != 0)
        {
          EXPECT_NE(u, other.Coefficient(kx, ky, kz)) << "seeds differ";
        }
        else
        {
          EXPECT_EQ(std::abs(u[0]) + std::abs(u[1]) + std::abs(u[2]), 0.0f);
        }
      }
    }
  }
}

TEST(RandomSpectrum, TheMeanEnergyIsThreeHalves)
{
  ThreadPool pool(1);
  FlowSimulation flow(24, Parameters(0.01f), pool);
  double energy = 0.0;
  const int draws = 40;
  for (int seed = 0; seed < draws; ++seed)
  {
    // Peak and cut-off such that the grid carries all but 1e-4 of the energy.
    Start(flow, RandomSpectrum(seed, 3.0, 2.5));
    energy += flow.KineticEnergy() / draws;
  }
  // About 50 modes at the peak make the energy of one draw vary by 10 %.
  EXPECT_NEAR(energy, 1.5, 0.08);
}

TEST(RandomSpectrum, GridsOfAnySizeCarryTheSameEddies)
{
  ThreadPool pool(1);
  const RandomSpectrum spectrum(9, 2.0, 1.5);
  FlowSimulation coarse(16, Parameters(0.01f), pool), fine(32, Parameters(0.01f), pool);
  Start(coarse, spectrum);
  Start(fine, spectrum);
  const auto u = coarse.Velocity()[1], same = fine.Velocity()[1];
  for (int z = 0; z < 16; ++z)
  {
    for (int x = 0; x < 16; ++x)
    {
      ASSERT_NEAR(u[(z * 16 + 3) * 16 + x], same[(2 * z * 32 + 6) * 32 + 2 * x], 2e-3f);
    }
  }
}

TEST(Turbulence, EnergyDecaysByTwiceViscosityTimesEnstrophy)
{
  ThreadPool pool(2);
  FlowSimulation flow(32, Parameters(0.02f), pool);
  Start(flow, RandomSpectrum(1, 2.0, 6.0));
  const double start = flow.KineticEnergy();
  // Simpson's rule over the dissipation on the way.
  double energy = start, lost = 0.0;
  const double interval = 0.04;
  for (int i = 0; i < 10; ++i)
  {
    const double first = flow.Enstrophy();
    flow.AdvanceTo((i + 0.5) * interval);
    const double middle = flow.Enstrophy();
    flow.AdvanceTo((i + 1.0) * interval);
    lost += 2.0 * 0.02 * interval * (first + 4.0 * middle + flow.Enstrophy()) / 6.0;
    energy = flow.KineticEnergy();
  }
  EXPECT_GT(lost, 0.1 * start) << "too little happened to tell";
  EXPECT_NEAR((start - energy) / lost, 1.0, 2e-3);
}

TEST(Turbulence, EnstrophyIsHalfTheMeanSquareOfVorticity)
{
  ThreadPool pool(1);
  FlowSimulation flow(16, Parameters(0.02f), pool);
  Start(flow, RandomSpectrum(1, 2.0, 4.0));
  double sum = 0.0;
  for (const auto& component : flow.Vorticity())
  {
    for (const float value : component)
    {
      sum += 0.5 * value * value / component.size();
    }
  }
  EXPECT_NEAR(flow.Enstrophy() / sum, 1.0, 1e-5);
}

TEST(Turbulence, DevelopedGradientsAreSkewedAndIntermittent)
{
  // Vortex stretching makes the skewness of du/dx negative, between -0.4 and -0.5 in every
  // experiment at moderate Reynolds numbers, and its flatness more than a Gaussian's 3.
  ThreadPool pool(2);
  FlowSimulation flow(48, Parameters(0.02f), pool);
  Start(flow, RandomSpectrum(1, 1.5, 6.0));
  const Moments start = LongitudinalGradient(flow);
  EXPECT_NEAR(start.Skewness, 0.0, 0.06);
  EXPECT_NEAR(start.Flatness, 3.0, 0.15);
  flow.AdvanceTo(1.5);
  const Moments developed = LongitudinalGradient(flow);
  EXPECT_LT(developed.Skewness, -0.35);
  EXPECT_GT(developed.Skewness, -0.6);
  EXPECT_GT(developed.Flatness, 3.3);
  EXPECT_LT(flow.LargestDivergence(), 1e-5);
}

TEST(Turbulence, FaceVelocitiesAreMeansOverFacesAndBalance)
{
  ThreadPool pool(2);
  const int n = 16;
  const double cell = TwoPi / n;
  FlowSimulation flow(n, Parameters(0.02f), pool);
  flow.SetState({ [](float x, float y, float) { return 0.5f + std::sin(x) * std::cos(2 * y); },
                  [](float x, float y, float) { return -0.5f * std::cos(x) * std::sin(2 * y); },
                  [](float, float, float) { return 0.0f; } },
    [](float, float, float) { return 0.0f; });
  const auto faces = flow.FaceVelocity();
  for (int y = 0; y < n; ++y)
  {
    for (int x = 0; x < n; ++x)
    {
      // The mean of cos(2 y) over a cell is sin(h) / h of it.
      const double exact =
        0.5 + std::sin((x - 0.5) * cell) * std::cos(2 * y * cell) * std::sin(cell) / cell;
      ASSERT_NEAR(faces[0][(5 * n + y) * n + x], exact, 1e-6);
    }
  }
  Start(flow, RandomSpectrum(4, 2.0, 4.0));
  const auto rough = flow.FaceVelocity();
  const auto at = [&](int c, int x, int y, int z)
  { return rough[c][((z % n) * n + y % n) * n + x % n]; };
  for (int i = 0; i < n * n * n; ++i)
  {
    const int x = i % n, y = i / n % n, z = i / n / n;
    ASSERT_NEAR(at(0, x + 1, y, z) - at(0, x, y, z) + at(1, x, y + 1, z) - at(1, x, y, z) +
                  at(2, x, y, z + 1) - at(2, x, y, z),
      0.0, 5e-6);
  }
}
