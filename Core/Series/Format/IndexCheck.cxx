// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/IndexText.h"

#include "Base/Error.h"

#include <cmath>
#include <map>
#include <set>

namespace banyan
{
namespace
{

constexpr std::int64_t GreatestAxis = std::int64_t{ 1 } << 30;
constexpr std::int64_t GreatestVolume = std::int64_t{ 1 } << 46;
constexpr std::int64_t GreatestBricks = std::int64_t{ 1 } << 31;
constexpr std::size_t GreatestSteps = std::size_t{ 1 } << 24;
constexpr std::size_t GreatestComponents = 65536;

void Require(bool good, const std::string& sentence)
{
  if (!good)
  {
    throw Error(sentence);
  }
}

void CheckRange(const ValueRange& range)
{
  Require(range.Empty() || (std::isfinite(range.Low) && std::isfinite(range.High)),
    "A range of values is not finite");
}

void CheckComponent(const ComponentIndex& component, std::size_t steps)
{
  CheckRange(component.Range);
  CheckRange(component.PromisedRange);
  Require(std::isfinite(component.ErrorBoundAbsolute) && component.ErrorBoundAbsolute >= 0,
    "An error bound is negative or not finite");
  Require(std::isfinite(component.MeasuredMaxError) && component.MeasuredMaxError >= 0 &&
            component.SumSquaredError >= 0,
    "A measured error is negative or not finite");
  Require(component.SumWeightedError >= 0, "A measured error is negative");
  Require(component.StepRmse.empty() || component.StepRmse.size() == steps,
    "There are not as many errors of steps as steps");
  for (const double rmse : component.StepRmse)
  {
    Require(rmse >= 0, "A measured error is negative");
  }
  Require(
    component.FiniteCount >= 0 && component.NonFiniteCount >= 0, "A count of voxels is negative");
}

void CheckArrays(const SeriesIndex& index)
{
  std::set<std::string> names;
  std::size_t components = 0;
  Require(!index.Arrays.empty(), "A series needs at least one array");
  for (const ArrayIndex& array : index.Arrays)
  {
    Require(!array.Name.empty(), "An array needs a name");
    Require(names.insert(array.Name).second, "Two arrays have the name '" + array.Name + "'");
    Require(!array.Components.empty(), "The array '" + array.Name + "' has no component");
    components += array.Components.size();
    Require(components <= GreatestComponents, "The arrays have too many components in all");
    for (const ComponentIndex& component : array.Components)
    {
      CheckComponent(component, index.Times.size());
    }
    Require(array.Magnitudes.size() == (array.Components.size() > 1 ? index.Times.size() : 0),
      "The array '" + array.Name + "' does not have a range of magnitudes for each step");
    for (const ValueRange& magnitude : array.Magnitudes)
    {
      CheckRange(magnitude);
    }
  }
  Require(index.ActiveScalars.empty() || names.count(index.ActiveScalars) == 1,
    "The active array '" + index.ActiveScalars + "' is not among the arrays");
}

void CheckTimes(const std::vector<double>& times)
{
  Require(times.size() <= GreatestSteps, "The series has too many steps");
  for (std::size_t i = 0; i < times.size(); ++i)
  {
    Require(std::isfinite(times[i]), "A time value is not finite");
    Require(i == 0 || times[i] > times[i - 1], "Time values must increase from step to step");
  }
}

bool SameContent(const SegmentIndex& a, const SegmentIndex& b)
{
  return a.Steps == b.Steps && a.Bytes == b.Bytes && a.HashLow == b.HashLow &&
         a.HashHigh == b.HashHigh;
}

bool IsPlainName(const std::string& file)
{
  return !file.empty() && file[0] != '.' && file.find('/') == std::string::npos &&
         file.find('\0') == std::string::npos;
}

void CheckFilesOfPoints(const std::vector<PointsFile>& files, int steps)
{
  std::map<std::string, const PointsFile*> named;
  for (std::size_t i = 0; i < files.size(); ++i)
  {
    Require(IsPlainName(files[i].File), "The name of a file of points is not a plain file name");
    Require(i == 0 || files[i].FirstStep > files[i - 1].FirstStep,
      "The files of points do not follow one another");
    const PointsFile& first = *named.emplace(files[i].File, &files[i]).first->second;
    Require(first.Bytes == files[i].Bytes && first.HashLow == files[i].HashLow &&
              first.HashHigh == files[i].HashHigh,
      "Two files of points are the same, and have not the same content");
  }
  Require(files.empty() || files.back().FirstStep < steps,
    "There are points of a step that does not exist");
}

void CheckMesh(const SeriesIndex& index)
{
  std::set<std::string> cellArrays;
  for (const ArrayIndex& array : index.Arrays)
  {
    Require(array.CellArray.empty() || cellArrays.insert(array.CellArray).second,
      "Two cell arrays have the name '" + array.CellArray + "'");
  }
  Require(index.Mesh || cellArrays.empty(), "A series without a mesh has cell arrays");
  if (!index.Mesh)
  {
    return;
  }
  Require(IsPlainName(index.Mesh->File), "The name of the mesh is not a plain file name");
  const bool any = index.Mesh->OfCells;
  // Of cells of any type, only what has values has samples.
  const bool samplesOfCells = !any || !cellArrays.empty();
  const bool samplesOfPoints = !any || cellArrays.size() < index.Arrays.size();
  const std::int64_t samples = index.Domain.Extent.Count();
  Require(index.Mesh->Points >= (any ? 0 : 8) && index.Mesh->Cells >= 1 &&
            (!samplesOfPoints || index.Mesh->Points <= samples) &&
            (!samplesOfCells || index.Mesh->Cells <= samples),
    "The mesh has an impossible number of points or cells");
  CheckFilesOfPoints(index.Mesh->Moved, index.Steps());
  Require(index.Mesh->Moved.empty() || index.Mesh->Moved.front().FirstStep > 0,
    "Points of the first step are said to have moved");
}

void CheckPoints(const SeriesIndex& index)
{
  if (!index.Points)
  {
    return;
  }
  Require(!index.Mesh, "A series of a mesh has points of another grid");
  Grid plain;
  plain.Extent = index.Domain.Extent;
  Require(index.Domain == plain, "A grid with points of its own has an origin or a spacing");
  const auto& types = index.Points->Form.Types;
  Require(index.Points->Form.Kind == GridKind::Rectilinear ||
            (types[0] == types[1] && types[1] == types[2]),
    "The coordinates of the points have several types");
  const std::vector<PointsFile>& files = index.Points->Files;
  Require(files.empty() == index.Times.empty(), "The points of some steps are missing");
  Require(
    files.empty() || files.front().FirstStep == 0, "The files of points do not follow one another");
  CheckFilesOfPoints(files, index.Steps());
}

void CheckFlags(const SeriesIndex& index)
{
  int count[3] = {};
  bool values = false;
  for (const ArrayIndex& array : index.Arrays)
  {
    ++count[static_cast<int>(array.Flags)];
    Require(array.Flags == ArrayFlags::None ||
              (!values && array.Type == ScalarType::UInt8 && array.Components.size() == 1 &&
                array.Components[0].ErrorBoundAbsolute == 0),
      "Flags of points or cells must be exact bytes, and come before other arrays");
    values = values || array.Flags == ArrayFlags::None;
  }
  Require(count[1] <= 1 && count[2] <= 1, "There are several arrays of flags");
  Require(values, "A series needs at least one array");
  Require(!index.Mesh || count[1] + count[2] == 0, "A series of a mesh has hidden points or cells");
}

void CheckSegments(const SeriesIndex& index)
{
  std::map<std::string, const SegmentIndex*> files;
  std::int64_t next = 0;
  for (const SegmentIndex& segment : index.Segments)
  {
    Require(IsPlainName(segment.File), "The name of a segment is not a plain file name");
    const SegmentIndex& first = *files.emplace(segment.File, &segment).first->second;
    Require(&first == &segment || SameContent(first, segment),
      "Two segments have the same file, and not the same content");
    Require(
      segment.FirstStep == next && segment.Steps >= 1 && segment.Steps <= index.KeyframeInterval,
      "The segments do not follow one another");
    next += segment.Steps;
  }
  Require(next == static_cast<std::int64_t>(index.Times.size()),
    "The segments do not hold as many steps as there are time values");
}

} // namespace

void CheckGrid(const Grid& grid, int brickCells)
{
  std::int64_t volume = 1;
  std::int64_t bricks = 1;
  Require(brickCells == 16 || brickCells == 32, "A brick must have 16 or 32 cells per axis");
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::int64_t lo = grid.Extent.Lo[axis];
    const std::int64_t hi = grid.Extent.Hi[axis];
    Require(hi > lo, "The grid has no samples");
    Require(hi - lo <= GreatestAxis && lo >= -GreatestAxis && hi <= 2 * GreatestAxis - 1,
      "The grid is longer than 2^30 samples along an axis");
    volume *= hi - lo;
    Require(volume <= GreatestVolume, "The grid has more than 2^46 samples");
    bricks *= (hi - lo - 1) / brickCells + 1;
    Require(bricks <= GreatestBricks, "The grid has more than 2^31 bricks");
    Require(std::isfinite(grid.Origin[axis]), "The origin of the grid is not finite");
    Require(std::isfinite(grid.Spacing[axis]) && grid.Spacing[axis] != 0,
      "The spacing of the grid is zero or not finite");
    for (int row = 0; row < 3; ++row)
    {
      Require(std::isfinite(grid.Direction[axis][row]), "The direction of the grid is not finite");
    }
  }
}

void CheckIndex(const SeriesIndex& index)
{
  CheckGrid(index.Domain, index.BrickCells);
  Require(index.Levels == BrickLayout::LevelCount(index.Domain.Samples(), index.BrickCells),
    "The number of levels does not fit the grid");
  Require(index.KeyframeInterval >= 1 && index.KeyframeInterval <= 1024,
    "The key-frame interval must be from 1 to 1024 steps");
  Require(std::isfinite(index.ErrorBound) && index.ErrorBound >= 0,
    "The error bound must be finite and not negative");
  CheckMesh(index);
  CheckPoints(index);
  CheckArrays(index);
  CheckFlags(index);
  CheckTimes(index.Times);
  CheckSegments(index);
}

} // namespace banyan
