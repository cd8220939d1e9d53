// SPDX-License-Identifier: BSD-3-Clause
#include "EarthquakeSeries.h"

#include "EarthquakeMesh.h"
#include "HexWaveSimulation.h"
#include "NorthridgeModel.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace banyan
{

namespace
{

double SmallestEdge(const OctreeMesh& mesh)
{
  int deepest = 0;
  for (std::size_t i = 0; i < mesh.CellCount(); ++i)
  {
    deepest = std::max(deepest, mesh.Cell(i).Level);
  }
  return mesh.EdgeOfLevel(deepest);
}

void Generate(const GenerateOptions& options, ThreadPool& pool, const MeshSeriesSink& sink)
{
  const NorthridgeModel ground(options.Seed, options.Slowest);
  const double hertz =
    EarthquakeMesh::FrequencyForCells(ground, static_cast<double>(options.Cells), pool);
  const OctreeMesh mesh = EarthquakeMesh::ForFrequency(ground, hertz, pool);
  const double halfDuration = EarthquakeMesh::HalfDuration(hertz);
  HexWaveLosses losses;
  losses.DecayRate = [halfDuration](const ElasticMaterial& material)
  { return NorthridgeModel::DecayRate(material, EarthquakeMesh::StrongestHertz(halfDuration)); };
  HexWaveSimulation waves(
    mesh, [&](const std::array<double, 3>& point) { return ground.At(point); },
    ground.Fault(halfDuration), losses, pool);
  std::ostringstream about;
  about << std::setprecision(3) << "waves up to " << hertz << " Hz, strongest at "
        << EarthquakeMesh::StrongestHertz(halfDuration) << " Hz; cells of " << SmallestEdge(mesh)
        << " m and more; time steps of " << waves.TimeStepSeconds() << " s";
  for (int step = 0; step < options.Steps; ++step)
  {
    waves.AdvanceTo(TimeOfStep(options, step));
    std::vector<NodeArray> arrays;
    for (const std::string& name : options.Arrays)
    {
      arrays.push_back({ name, name == "velocity" ? &waves.Velocity() : &waves.Displacement() });
    }
    sink({ mesh, TimeOfStep(options, step), arrays, about.str() });
  }
}

} // namespace

SeriesKind EarthquakeSeries()
{
  SeriesKind kind;
  kind.Name = "earthquake";
  kind.FileName = "earthquake";
  kind.Description = "an earthquake like Northridge's, on a mesh of hexahedra";
  kind.Arrays = { "velocity", "ground_displacement" };
  kind.DefaultSteps = 81;
  kind.DefaultDuration = 40.0;
  kind.DefaultCells = 20000;
  kind.GenerateMesh = Generate;
  return kind;
}

} // namespace banyan
