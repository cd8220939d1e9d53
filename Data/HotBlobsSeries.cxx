// SPDX-License-Identifier: BSD-3-Clause
#include "HotBlobsSeries.h"

#include "FlowArrays.h"
#include "FlowSimulation.h"
#include "HotBlobs.h"

#include "Base/ThreadPool.h"

#include <cmath>

namespace banyan
{

namespace
{

constexpr double BoxEdge = 6.283185307179586;

FlowParameters ParametersFor(int size)
{
  FlowParameters parameters;
  // The finest eddies must not be finer than the grid. They shrink as Reynolds^(-3/4)
  // (Kolmogorov), so the viscosity that a grid carries goes with size^(-4/3).
  parameters.Viscosity = static_cast<float>(0.0045 * std::pow(size / 64.0, -4.0 / 3.0));
  parameters.Diffusivity = parameters.Viscosity;
  return parameters;
}

void Generate(const GenerateOptions& options, ThreadPool& pool, const SeriesSink& sink)
{
  FlowSimulation flow(options.Size, ParametersFor(options.Size), pool);
  const HotBlobs blobs(options.Seed, static_cast<float>(2.0 * BoxEdge / options.Size));
  const auto still = [](float, float, float) { return 0.0f; };
  flow.SetState(
    { still, still, still }, [&](float x, float y, float z) { return blobs.Temperature(x, y, z); });
  for (int step = 0; step < options.Steps; ++step)
  {
    flow.AdvanceTo(TimeOfStep(options, step));
    std::vector<ImageArray> arrays;
    for (const std::string& name : options.Arrays)
    {
      arrays.push_back(FlowArray(flow, name));
    }
    sink(TimeOfStep(options, step), arrays);
  }
}

} // namespace

SeriesKind HotBlobsSeries()
{
  SeriesKind kind;
  kind.Name = "hot-blobs";
  kind.FileName = "flow";
  kind.Description = "hot blobs that rise and roll up into vortex rings";
  kind.Arrays = { "temperature", "velocity", "vorticity" };
  kind.DefaultSize = 64;
  kind.DefaultSteps = 24;
  kind.DefaultDuration = 6.0;
  kind.Edge = BoxEdge;
  kind.Generate = Generate;
  return kind;
}

} // namespace banyan
