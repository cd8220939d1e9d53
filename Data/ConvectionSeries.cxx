// SPDX-License-Identifier: BSD-3-Clause
#include "ConvectionSeries.h"

#include "ConvectionSimulation.h"

#include <array>
#include <cmath>
#include <random>
#include <utility>

namespace banyan
{

namespace
{

constexpr double Pi = 3.141592653589793;
constexpr int WaveCount = 24;
constexpr double Disturbance = 0.002; ///< of the difference between the walls: half an 8-bit step

/// A sum of standing waves that leave the hot and cold wall as they are and do not cross the
/// others.
std::vector<float> StartTemperature(int size, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  // In [0, 1). The standard's own distributions may differ between libraries; this does not.
  const auto uniform = [&]() { return static_cast<double>(random() >> 11) / 9007199254740992.0; };

  std::vector<float> sum(static_cast<std::size_t>(size) * size * size, 0.0f);
  std::array<std::vector<double>, 3> factor;
  for (int wave = 0; wave < WaveCount; ++wave)
  {
    const double amplitude = Disturbance * (2.0 * uniform() - 1.0) / std::sqrt(WaveCount / 3.0);
    for (int axis = 0; axis < 3; ++axis)
    {
      const int halfWaves = 1 + static_cast<int>(uniform() * 6.0);
      factor[axis].resize(size);
      for (int i = 0; i < size; ++i)
      {
        const double phase = Pi * halfWaves * (i + 0.5) / size;
        factor[axis][i] = axis == 0 ? std::sin(phase) : std::cos(phase);
      }
    }
    std::size_t cell = 0;
    for (int z = 0; z < size; ++z)
    {
      for (int y = 0; y < size; ++y)
      {
        const double across = amplitude * factor[2][z] * factor[1][y];
        for (int x = 0; x < size; ++x, ++cell)
        {
          sum[cell] += static_cast<float>(across * factor[0][x]);
        }
      }
    }
  }
  return sum;
}

void Generate(const GenerateOptions& options, ThreadPool& pool, const SeriesSink& sink)
{
  ConvectionParameters parameters;
  // The layers along the walls are about Rayleigh^(-1/4) thick: so many cells at any size.
  parameters.Rayleigh = 1e8 * std::pow(options.Size / 128.0, 4.0);
  ConvectionSimulation box(options.Size, parameters, pool);
  box.SetTemperature(StartTemperature(options.Size, options.Seed));
  for (int step = 0; step < options.Steps; ++step)
  {
    box.AdvanceTo(TimeOfStep(options, step));
    std::vector<ImageArray> arrays;
    for (const std::string& name : options.Arrays)
    {
      const bool velocity = name == "velocity";
      arrays.push_back({ name, velocity ? 3 : 1, velocity ? box.Velocity() : box.Temperature() });
    }
    sink(TimeOfStep(options, step), arrays);
  }
}

} // namespace

SeriesKind ConvectionSeries()
{
  SeriesKind kind;
  kind.Name = "convection";
  kind.FileName = "convection";
  kind.Description = "a closed box of air, hot on one side and cold on the other";
  kind.Arrays = { "temperature", "velocity" };
  kind.DefaultDuration = 9.0;
  kind.Edge = 1.0;
  kind.Generate = Generate;
  return kind;
}

} // namespace banyan
