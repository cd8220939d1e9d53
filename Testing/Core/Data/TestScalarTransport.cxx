// SPDX-License-Identifier: BSD-3-Clause
// The transport of a scalar against exact solutions and against what it promises: bounds, totals.
#include "FlowSimulation.h"
#include "RandomSpectrum.h"
#include "ScalarTransport.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

using banyan::ScalarTransport;
using banyan::ThreadPool;

namespace
{

constexpr double TwoPi = 6.283185307179586;

ScalarTransport::FaceVelocity Wind(int size, float u, float v, float w)
{
  const std::size_t count = static_cast<std::size_t>(size) * size * size;
  return { std::vector<float>(count, u), std::vector<float>(count, v),
    std::vector<float>(count, w) };
}

/// A rough flow without divergence.
ScalarTransport::FaceVelocity RoughFlow(int size, ThreadPool& pool)
{
  banyan::FlowSimulation flow(size, banyan::FlowParameters(), pool);
  const banyan::RandomSpectrum spectrum(3, 2.0, 5.0);
  flow.SetVelocitySpectrum([&](int x, int y, int z) { return spectrum.Coefficient(x, y, z); });
  return flow.FaceVelocity();
}

using Field = std::function<double(double x, double y, double z)>;

void Set(ScalarTransport& transport, int size, const Field& field)
{
  const double cell = TwoPi / size;
  for (int z = 0, i = 0; z < size; ++z)
  {
    for (int y = 0; y < size; ++y)
    {
      for (int x = 0; x < size; ++x, ++i)
      {
        transport.Values()[i] = static_cast<float>(field(x * cell, y * cell, z * cell));
      }
    }
  }
}

double MeanError(const ScalarTransport& transport, int size, const Field& exact)
{
  ThreadPool pool(1);
  ScalarTransport other(size, TwoPi / size, 0.0, pool);
  Set(other, size, exact);
  double sum = 0.0;
  for (std::size_t i = 0; i < other.Values().size(); ++i)
  {
    sum += std::abs(other.Values()[i] - transport.Values()[i]);
  }
  return sum / other.Values().size();
}

double Total(const ScalarTransport& transport)
{
  return std::accumulate(transport.Values().begin(), transport.Values().end(), 0.0);
}

/// A ball of ones with a sharp surface in zeros.
double Ball(double x, double y, double z)
{
  return std::hypot(std::hypot(x - 3.0, y - 2.5), z - 3.5) < 1.2 ? 1.0 : 0.0;
}

} // namespace

TEST(ScalarTransport, AWindCarriesASmoothBumpWithSecondOrder)
{
  ThreadPool pool(2);
  const auto errorOn = [&](int size)
  {
    ScalarTransport transport(size, TwoPi / size, 0.0, pool);
    const auto bump = [](double x, double y, double z)
    { return std::exp(std::cos(x) + std::cos(y) + std::cos(z) - 3.0); };
    Set(transport, size, bump);
    // Each way through faces once: u > 0, v < 0; the time is that of a quarter of the box.
    const auto wind = Wind(size, 1.0f, -0.5f, 0.25f);
    for (int i = 0; i < size / 4; ++i)
    {
      transport.Advance(wind, wind, TwoPi / size);
    }
    const double t = TwoPi / 4.0;
    return MeanError(transport, size,
      [&](double x, double y, double z) { return bump(x - t, y + 0.5 * t, z - 0.25 * t); });
  };
  const double coarse = errorOn(16), fine = errorOn(32);
  EXPECT_LT(fine, 2e-3);
  EXPECT_GT(coarse / fine, 3.0) << "first order would be 2, second is 4";
}

TEST(ScalarTransport, AWindThatRisesCarriesByItsMean)
{
  ThreadPool pool(1);
  const int size = 32;
  ScalarTransport transport(size, TwoPi / size, 0.0, pool);
  const auto wave = [](double x, double, double) { return 0.5 + 0.5 * std::cos(x); };
  Set(transport, size, wave);
  transport.Advance(Wind(size, 0.0f, 0.0f, 0.0f), Wind(size, 2.0f, 0.0f, 0.0f), 1.0);
  EXPECT_LT(
    MeanError(transport, size, [&](double x, double y, double z) { return wave(x - 1.0, y, z); }),
    1e-2);
}

TEST(ScalarTransport, DiffusionDampsWavesAsTheDifferenceQuotientSays)
{
  ThreadPool pool(1);
  const int size = 16;
  const double cell = TwoPi / size, diffusivity = 0.05, time = 2.0;
  ScalarTransport transport(size, cell, diffusivity, pool);
  const auto wave = [](double x, double y, double) { return 0.5 + 0.25 * std::cos(2 * x - y); };
  Set(transport, size, wave);
  const auto still = Wind(size, 0.0f, 0.0f, 0.0f);
  for (int i = 0; i < 100; ++i)
  {
    transport.Advance(still, still, time / 100);
  }
  // The second difference of cos(k x) is -(2 sin(k h / 2) / h)^2 of it.
  const auto squared = [&](double k) { return std::pow(2.0 / cell * std::sin(k * cell / 2), 2); };
  const double decay = std::exp(-diffusivity * (squared(2) + squared(1)) * time);
  EXPECT_LT(MeanError(transport, size,
              [&](double x, double y, double z) { return 0.5 + decay * (wave(x, y, z) - 0.5); }),
    2e-5);
}

TEST(ScalarTransport, ARoughFlowKeepsBoundsAndTotal)
{
  ThreadPool pool(2);
  const int size = 32;
  const auto flow = RoughFlow(size, pool);
  ScalarTransport transport(size, TwoPi / size, 0.002, pool);
  Set(transport, size, Ball);
  const double total = Total(transport);
  // Long steps too: they are divided as the bounds demand.
  for (const double seconds : { 0.01, 0.05, 0.2, 0.5 })
  {
    transport.Advance(flow, flow, seconds);
    const auto range = std::minmax_element(transport.Values().begin(), transport.Values().end());
    EXPECT_GE(*range.first, -1e-6f) << "after " << seconds;
    EXPECT_LE(*range.second, 1.0f + 2e-5f) << "after " << seconds;
    EXPECT_NEAR(Total(transport) / total, 1.0, 1e-5) << "after " << seconds;
  }
  EXPECT_GT(MeanError(transport, size, Ball), 0.02) << "nothing moved";
}

TEST(ScalarTransport, AUniformScalarStaysUniform)
{
  ThreadPool pool(2);
  const int size = 24;
  const auto flow = RoughFlow(size, pool);
  ScalarTransport transport(size, TwoPi / size, 0.01, pool);
  Set(transport, size, [](double, double, double) { return 0.7; });
  for (int i = 0; i < 20; ++i)
  {
    transport.Advance(flow, flow, 0.05);
  }
  for (const float value : transport.Values())
  {
    ASSERT_NEAR(value, 0.7f, 1e-5f);
  }
}

TEST(ScalarTransport, WhereNothingArrivesThereIsExactlyNothing)
{
  ThreadPool pool(1);
  const int size = 32;
  ScalarTransport transport(size, TwoPi / size, 0.0, pool);
  Set(transport, size, [](double x, double, double) { return x < 1.0 ? 1.0 : 0.0; });
  const auto wind = Wind(size, 1.0f, 0.0f, 0.0f);
  for (int i = 0; i < 4; ++i)
  {
    transport.Advance(wind, wind, 0.02);
  }
  // Four steps of two stages reach at most two cells per stage; the far half has seen none.
  for (std::size_t i = 0; i < transport.Values().size(); ++i)
  {
    const std::size_t x = i % size;
    if (x >= 6 + 16 && x < 30)
    {
      ASSERT_EQ(transport.Values()[i], 0.0f) << "at " << x;
    }
  }
}

TEST(ScalarTransport, TheNumberOfThreadsDoesNotChangeABit)
{
  std::vector<float> results[2];
  for (const int threads : { 1, 3 })
  {
    ThreadPool pool(threads);
    const auto flow = RoughFlow(20, pool);
    ScalarTransport transport(20, TwoPi / 20, 0.01, pool);
    Set(transport, 20, Ball);
    transport.Advance(flow, Wind(20, 0.5f, 0.1f, 0.0f), 0.3);
    results[threads > 1] = transport.Values();
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST(ScalarTransport, TinyGridsAreRefused)
{
  ThreadPool pool(1);
  EXPECT_THROW(ScalarTransport(3, 1.0, 0.0, pool), banyan::Error);
}
