// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CellSeries/CellsFile.h"
#include "Mesh/Series/MeshFile.h"
#include "Series/GoldenBuilders.h"
#include "Series/GoldenCells.h"
#include "Series/GoldenMesh.h"

namespace banyan::testing
{
namespace
{

using Pattern = GoldenPattern;

GoldenArray FlagsOf(ArrayFlags flags)
{
  GoldenArray array = Array(DescriptionOfFlags(flags).Name, ScalarType::UInt8, Pattern::Hidden);
  array.Flags = flags;
  array.Seed = static_cast<unsigned>(flags);
  array.Hold = 2;
  return array;
}

/// Hidden points and cells that move with the steps, below real and whole numbers.
GoldenCase Hidden()
{
  GoldenCase series{ "hidden", At({ 0, -2, 4 }, { 19, 6, 5 }),
    Within(1, ErrorBoundMode::Absolute, 16), 4, {} };
  series.Options.KeyframeInterval = 3;
  GoldenArray real = Array("real", ScalarType::Float32, Pattern::Bumps, 20, 1, -2);
  real.NonFiniteOneIn = 40;
  series.Arrays = { FlagsOf(ArrayFlags::OfPoints), FlagsOf(ArrayFlags::OfCells), real,
    Array("whole", ScalarType::Int16, Pattern::Bumps, -300, 2) };
  return series;
}

/// A mesh with values at points; with `cells`, also with values of cells.
GoldenCase OnMesh(const std::string& name, bool cells)
{
  GoldenCase series{ name, GridOfImages(*GoldenMesh().Mesh),
    Within(1.0 / 64, ErrorBoundMode::RelativeToSeriesRange, 16), 3, {} };
  series.OnMesh = true;
  series.Options.KeyframeInterval = 2;
  GoldenArray velocity = Array("velocity", ScalarType::Float32, Pattern::Bumps, -200, 1, -3);
  velocity.Components = { "x", "y", "z" };
  velocity.NonFiniteOneIn = 50;
  series.Arrays = { velocity };
  if (cells)
  {
    // A point array and a cell array of one name: the series needs two.
    GoldenArray ofCells = Array("velocity of cells", ScalarType::Int32, Pattern::Bumps, 7, 9);
    ofCells.CellArray = "velocity";
    series.Arrays.insert(series.Arrays.begin(), ofCells);
  }
  return series;
}

/// A grid with points of its own, which move once.
GoldenCase OnGrid(const std::string& name, GridKind kind)
{
  GoldenCase series{ name, At({ -3, 0, 2 }, { 19, 6, 5 }), Within(1, ErrorBoundMode::Absolute, 16),
    4, {} };
  const ScalarType type = ScalarType::Float64;
  series.Options.Points = PointsForm{ kind, { type, type, type } };
  series.Options.KeyframeInterval = 3;
  series.Domain.Origin = glm::dvec3(0.0);
  series.Domain.Spacing = glm::dvec3(1.0);
  series.Domain.Direction = glm::dmat3(1.0);
  series.Arrays = { Array("real", ScalarType::Float32, Pattern::Bumps, 20, 1, -2) };
  return series;
}

/// A mesh of cells of any type, whose points move once, with values at points and of cells.
GoldenCase OnCells()
{
  GoldenCase series = OnMesh("any_cells", true);
  series.Domain = GridOfImages(*GoldenCells().Mesh);
  series.OnMesh = false;
  series.OnCells = true;
  return series;
}

} // namespace

std::vector<GoldenCase> GoldenFeatureCases()
{
  return { Hidden(), OnMesh("mesh", false), OnMesh("cells", true),
    OnGrid("curvilinear", GridKind::Curvilinear), OnGrid("rectilinear", GridKind::Rectilinear),
    OnCells() };
}

} // namespace banyan::testing
