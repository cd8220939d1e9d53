// SPDX-License-Identifier: BSD-3-Clause
#include "JetSeries.h"

#include "FlowArrays.h"
#include "JetSimulation.h"

#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>

namespace banyan
{

namespace
{

constexpr double BoxEdge = 6.283185307179586;

/// Until the front of the jet has left through the top and the flow no longer knows its start.
constexpr double DevelopmentTime = 14.0;

void Generate(const GenerateOptions& options, ThreadPool& pool, const SeriesSink& sink)
{
  JetParameters parameters;
  // An edge has to be wider than the grid's cells.
  parameters.EdgeWidth = std::max(parameters.EdgeWidth, 1.2 * BoxEdge / options.Size);
  // As for the hot blobs: the finer the grid, the finer the eddies that it carries.
  const double viscosity = 0.0008 * std::pow(options.Size / 128.0, -4.0 / 3.0);
  JetSimulation jet(options.Seed, options.Size, parameters, viscosity, pool);
  for (int step = 0; step < options.Steps; ++step)
  {
    jet.AdvanceTo(DevelopmentTime + TimeOfStep(options, step));
    std::vector<ImageArray> arrays;
    for (const std::string& name : options.Arrays)
    {
      if (name == "concentration")
      {
        arrays.push_back({ name, 1, jet.Concentration() });
      }
      else
      {
        arrays.push_back(FlowArray(jet.Flow(), name));
      }
    }
    sink(TimeOfStep(options, step), arrays);
  }
}

} // namespace

SeriesKind JetSeries()
{
  SeriesKind kind;
  kind.Name = "jet";
  kind.FileName = "jet";
  kind.Description = "nozzle fluid in a turbulent jet, in still surroundings";
  kind.Arrays = { "concentration", "velocity", "vorticity" };
  kind.DefaultDuration = 5.0;
  kind.Edge = BoxEdge;
  kind.Generate = Generate;
  return kind;
}

} // namespace banyan
