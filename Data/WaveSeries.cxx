// SPDX-License-Identifier: BSD-3-Clause
#include "WaveSeries.h"

#include "BasinModel.h"
#include "ElasticWaveSimulation.h"

#include <algorithm>
#include <utility>

namespace banyan
{

namespace
{

constexpr double ClippedShare = 0.9999;

std::vector<float> Velocity(const ElasticWaveSimulation& waves, int size)
{
  std::vector<float> values;
  values.reserve(3 * static_cast<std::size_t>(size) * size * size);
  for (int z = 0; z < size; ++z)
  {
    for (int y = 0; y < size; ++y)
    {
      for (int x = 0; x < size; ++x)
      {
        const std::array<float, 3> v = waves.Velocity(x, y, z);
        values.insert(values.end(), v.begin(), v.end());
      }
    }
  }
  return values;
}

void Generate(const GenerateOptions& options, ThreadPool& pool, const SeriesSink& sink)
{
  const BasinModel basin(options.Seed);
  ElasticGrid grid;
  grid.Size = options.Size;
  grid.CellMetres = BasinModel::EdgeMetres / options.Size;
  const auto ground = [&](int x, int y, int z)
  {
    // The free surface lies in the uppermost centres.
    return basin.At((x + 0.5) * grid.CellMetres, (y + 0.5) * grid.CellMetres,
      (options.Size - 1 - z) * grid.CellMetres);
  };
  ElasticWaveSimulation waves(grid, ground, basin.Source(options.Size), pool);
  for (int step = 0; step < options.Steps; ++step)
  {
    waves.AdvanceTo(TimeOfStep(options, step));
    std::vector<ImageArray> arrays;
    for (const std::string& name : options.Arrays)
    {
      const bool vectors = name == "velocity";
      arrays.push_back(
        { name, vectors ? 3 : 1, vectors ? Velocity(waves, options.Size) : waves.Speed() });
    }
    sink(TimeOfStep(options, step), arrays);
  }
}

void GenerateClipped(const GenerateOptions& options, ThreadPool& pool, const SeriesSink& sink)
{
  std::vector<double> times;
  std::vector<std::vector<float>> steps;
  Generate(options, pool,
    [&](double time, const std::vector<ImageArray>& arrays)
    {
      times.push_back(time);
      steps.push_back(arrays.at(0).Values);
    });
  const float largest = Percentile(steps, ClippedShare);
  for (std::size_t step = 0; step < steps.size(); ++step)
  {
    for (float& value : steps[step])
    {
      value = std::min(value, largest);
    }
    sink(times[step], { { options.Arrays.at(0), 1, std::move(steps[step]) } });
  }
}

} // namespace

float Percentile(const std::vector<std::vector<float>>& steps, double share)
{
  // Only the values from the percentile on are kept, as the smallest of them on top of a heap:
  // a copy of everything would double the memory.
  std::size_t count = 0;
  for (const auto& values : steps)
  {
    count += values.size();
  }
  const std::size_t kept = count - static_cast<std::size_t>(share * static_cast<double>(count));
  std::vector<float> largest;
  largest.reserve(kept);
  const auto smallestFirst = [](float a, float b) { return a > b; };
  for (const auto& values : steps)
  {
    for (const float value : values)
    {
      if (largest.size() < kept)
      {
        largest.push_back(value);
        std::push_heap(largest.begin(), largest.end(), smallestFirst);
      }
      else if (value > largest.front())
      {
        std::pop_heap(largest.begin(), largest.end(), smallestFirst);
        largest.back() = value;
        std::push_heap(largest.begin(), largest.end(), smallestFirst);
      }
    }
  }
  return largest.front();
}

SeriesKind WaveSeries()
{
  SeriesKind kind;
  kind.Name = "wave";
  kind.FileName = "wave";
  kind.Description = "an earthquake below a basin of soft sediments";
  kind.Arrays = { "speed", "velocity" };
  kind.DefaultDuration = 6.0;
  kind.Edge = BasinModel::EdgeMetres;
  kind.Generate = Generate;
  return kind;
}

SeriesKind ClippedWaveSeries()
{
  SeriesKind kind = WaveSeries();
  kind.Name = "wavep";
  kind.FileName = "wavep";
  kind.Description = "the same, its speed cut at the 99.99 percentile of the series";
  kind.Arrays = { "speed" };
  kind.Generate = GenerateClipped;
  return kind;
}

} // namespace banyan
