// SPDX-License-Identifier: BSD-3-Clause
#include "TurbulenceSeries.h"

#include "FlowArrays.h"
#include "FlowSimulation.h"
#include "RandomSpectrum.h"

#include "Base/ThreadPool.h"

#include <cmath>

namespace banyan
{

namespace
{

constexpr double BoxEdge = 6.283185307179586;

/// The random start is no turbulence yet: its eddies know nothing of each other. After this time,
/// about one turnover of the largest ones, the spectrum is full and vortices have become tubes.
constexpr double DevelopmentTime = 2.0;

/// Eddies as large as the box allows, so that there is room for smaller ones.
constexpr double SpectrumPeak = 1.2;
constexpr double SpectrumCutOff = 8.0;

FlowParameters ParametersFor(int size)
{
  FlowParameters parameters;
  // The finest eddies go with viscosity^(3/4) (Kolmogorov). With this factor the largest wave
  // number that a grid carries, times their size, is 1.2 at the start of the series.
  parameters.Viscosity = static_cast<float>(0.006 * std::pow(size / 128.0, -4.0 / 3.0));
  parameters.Buoyancy = 0.0f;
  parameters.Courant = 0.75f;
  parameters.WithTemperature = false;
  return parameters;
}

void Generate(const GenerateOptions& options, ThreadPool& pool, const SeriesSink& sink)
{
  FlowSimulation flow(options.Size, ParametersFor(options.Size), pool);
  const RandomSpectrum spectrum(options.Seed, SpectrumPeak, SpectrumCutOff);
  flow.SetVelocitySpectrum([&](int x, int y, int z) { return spectrum.Coefficient(x, y, z); });
  for (int step = 0; step < options.Steps; ++step)
  {
    flow.AdvanceTo(DevelopmentTime + TimeOfStep(options, step));
    std::vector<ImageArray> arrays;
    for (const std::string& name : options.Arrays)
    {
      arrays.push_back(FlowArray(flow, name));
    }
    sink(TimeOfStep(options, step), arrays);
  }
}

} // namespace

SeriesKind TurbulenceSeries()
{
  SeriesKind kind;
  kind.Name = "turbulence";
  kind.FileName = "turbulence";
  kind.Description = "decaying isotropic turbulence";
  kind.Arrays = { "vorticity", "velocity" };
  kind.DefaultDuration = 1.2;
  kind.Edge = BoxEdge;
  kind.Generate = Generate;
  return kind;
}

} // namespace banyan
