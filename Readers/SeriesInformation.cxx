// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesInformation.h"

#include "GridOutput.h"
#include "SeriesRangeArray.h"
#include "StepRequest.h"

#include "vtkAlgorithm.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTypeTraits.h"

#include "Parallel/Communicate/Communicator.h"
#include "Series/Decode/BetweenSteps.h"
#include "Series/Decode/PieceRange.h"
#include "Series/Format/IndexText.h"
#include "Series/Grid/LevelGrid.h"
#include "Series/Points/GridPoints.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>
#include <vector>

using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace banyan
{

bool LooksAsSeries(const std::string& path)
{
  const auto endsWith = [&path](const std::string& suffix)
  {
    return path.size() > suffix.size() &&
           path.compare(path.size() - suffix.size(), suffix.size(), suffix) == 0;
  };
  return endsWith(".banyan") || endsWith(".banyan.d") || BeginsAsSeries(path);
}

int VtkTypeOf(ScalarType type)
{
  return Dispatch(
    type, [](auto tag) -> int { return vtkTypeTraits<typename decltype(tag)::Type>::VTK_TYPE_ID; });
}

namespace
{

/// As the user knows it.
const std::string& NameOf(const ArrayIndex& array)
{
  return array.CellArray.empty() ? array.Name : array.CellArray;
}

} // namespace

void ToExtent(const Box& box, int extent[6])
{
  for (int axis = 0; axis < 3; ++axis)
  {
    extent[2 * axis] = box.Lo[axis];
    extent[2 * axis + 1] = box.Hi[axis] - 1;
  }
}

Box FromExtent(const int extent[6])
{
  return { { extent[0], extent[2], extent[4] }, { extent[1] + 1, extent[3] + 1, extent[5] + 1 } };
}

namespace
{

void DescribeGrid(const SeriesIndex& index, int level, vtkInformation& information)
{
  information.Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  if (index.Points)
  {
    int whole[6];
    ToExtent(ExtentOfGrid(index, level), whole);
    information.Set(Pipeline::WHOLE_EXTENT(), whole, 6);
    return;
  }
  const Grid grid = GridOfLevel(index.Domain, level);
  int extent[6];
  ToExtent(grid.Extent, extent);
  information.Set(Pipeline::WHOLE_EXTENT(), extent, 6);
  information.Set(vtkDataObject::ORIGIN(), &grid.Origin[0], 3);
  information.Set(vtkDataObject::SPACING(), &grid.Spacing[0], 3);
  double direction[9];
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      direction[3 * row + column] = grid.Direction[column][row];
    }
  }
  information.Set(vtkDataObject::DIRECTION(), direction, 9);
}

} // namespace

int OutputTypeOf(const SeriesFile* series, bool trees)
{
  const SeriesIndex* const index = series ? &series->Index() : nullptr;
  if (index && index->Points)
  {
    return index->Points->Form.Kind == GridKind::Curvilinear ? VTK_STRUCTURED_GRID
                                                             : VTK_RECTILINEAR_GRID;
  }
  return !index || !index->Mesh ? VTK_IMAGE_DATA
         : trees                ? VTK_HYPER_TREE_GRID
                                : VTK_UNSTRUCTURED_GRID;
}

void DescribeSeries(const SeriesIndex& index, int level, vtkInformation& information)
{
  if (index.Mesh)
  {
    information.Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  }
  else
  {
    DescribeGrid(index, level, information);
  }
  const int steps = index.Steps();
  information.Set(Pipeline::TIME_STEPS(), index.Times.data(), steps);
  const double range[2] = { index.Times.front(), index.Times.back() };
  information.Set(Pipeline::TIME_RANGE(), range, 2);

  const int active = index.FindArray(index.ActiveScalars);
  if (active >= 0 && index.Arrays[active].CellArray.empty())
  {
    vtkDataObject::SetPointDataActiveScalarInfo(&information, VtkTypeOf(index.Arrays[active].Type),
      static_cast<int>(index.Arrays[active].Components.size()));
  }
}

void TakeTime(
  const SeriesIndex& index, vtkInformation& information, bool interpolate, StepRequest& request)
{
  const double asked = information.Has(Pipeline::UPDATE_TIME_STEP())
                         ? information.Get(Pipeline::UPDATE_TIME_STEP())
                         : index.Times.front();
  const StepAndFraction place = PlaceOfTime(index.Times, asked);
  request.Step = place.Step;
  request.Fraction = interpolate ? place.Fraction : 0.0;
  request.Time = request.Fraction > 0.0 ? asked : index.Times[static_cast<std::size_t>(place.Step)];
}

void TakePiece(vtkInformation& information, StepRequest& request)
{
  if (information.Has(Pipeline::UPDATE_NUMBER_OF_PIECES()))
  {
    request.Piece = information.Get(Pipeline::UPDATE_PIECE_NUMBER());
    request.Pieces = std::max(information.Get(Pipeline::UPDATE_NUMBER_OF_PIECES()), 1);
  }
}

void HeldArrays::Warn(vtkObject& reader, const StepRequest& request, const Communicator& ranks)
{
  std::string names;
  for (const ArrayIndex& array : request.Series->Index().Arrays)
  {
    if (request.Wants(array) && !AreInterpolated(array.Type))
    {
      names += (names.empty() ? "" : ", ") + NameOf(array);
    }
  }
  if (names.empty() || request.Fraction == 0.0)
  {
    return;
  }
  const std::string sentence =
    "'Interpolate In Time' leaves arrays of integers at the step before, because they may be "
    "labels: " +
    names + " of " + request.Series->Path() +
    ". Encode them as floating-point numbers to interpolate them.";
  if (sentence != this->Told && ranks.Rank() == 0)
  {
    vtkWarningWithObjectMacro(&reader, << sentence);
  }
  this->Told = sentence;
}

void DescribeRange(
  const SeriesFile& series, int array, vtkUnsignedCharArray* ghosts, vtkDataArray& values)
{
  PieceRange range = RangeOfSeries(series, array);
  // VTK knows what to say of nothing but fill values and NaN.
  if (std::none_of(range.Components.begin(), range.Components.end(),
        [](const ValueRange& of) { return of.Empty(); }))
  {
    dynamic_cast<HasSeriesRange&>(values).SetSeriesRange(std::move(range), ghosts);
  }
}

namespace
{

/// Bytes in a unit that leaves one to three digits before the point.
void WriteBytes(std::ostream& text, double bytes)
{
  const char* unit = "bytes";
  for (const char* larger : { "kB", "MB", "GB", "TB" })
  {
    if (bytes < 1000)
    {
      break;
    }
    bytes /= 1000;
    unit = larger;
  }
  text << bytes << " " << unit;
}

void WriteErrors(std::ostream& text, const ArrayIndex& array)
{
  double bound = 0;
  double error = 0;
  double share = 0;
  std::int64_t changed = 0;
  for (const ComponentIndex& component : array.Components)
  {
    const ValueRange& range = component.ReferenceRange();
    bound = std::max(bound, component.ErrorBoundAbsolute);
    error = std::max(error, component.MeasuredMaxError);
    changed += component.ClampedCount + component.InvisibleCount;
    if (range.Width() > 0)
    {
      share = std::max(share, component.MeasuredMaxError / range.Width());
    }
  }
  text << "\n" << NameOf(array) << ": ";
  if (error == 0)
  {
    text << "bit-exact";
  }
  else
  {
    const bool isPlain = std::all_of(array.Components.begin(), array.Components.end(),
      [](const ComponentIndex& component) { return component.ValueTransform == Transform(); });
    text << "error at most " << error;
    if (share > 0 && share < 1)
    {
      text << " (1/" << std::floor(1 / share) << " of the range)";
    }
    text << "\n  bound " << bound << (isPlain ? "" : " of transformed values");
  }
  // The bound does not hold for these.
  if (changed > 0)
  {
    text << "\n  but for " << changed
         << " values outside the range or hidden by an opacity function";
  }
}

} // namespace

std::string SummaryOf(const SeriesIndex& index)
{
  std::ostringstream text;
  text << std::setprecision(4) << index.Steps()
       << (index.Steps() == 1 ? " step of " : " steps of ");
  if (index.Mesh)
  {
    text << index.Mesh->Points << " points and " << index.Mesh->Cells << " cells";
  }
  else
  {
    const glm::ivec3 samples = index.Domain.Samples();
    text << samples.x << " x " << samples.y << " x " << samples.z << " points";
  }
  double encoded = index.Mesh ? static_cast<double>(index.Mesh->Bytes) : 0.0;
  if (index.Points)
  {
    text << (index.Points->Form.Kind == GridKind::Curvilinear ? " of a curvilinear grid"
                                                              : " of a rectilinear grid");
  }
  encoded += static_cast<double>(BytesOfPoints(index));
  for (const SegmentIndex& segment : index.Segments)
  {
    encoded += static_cast<double>(segment.Bytes);
  }
  const auto raw = static_cast<double>(index.PayloadBytesIn);
  text << "\n";
  WriteBytes(text, encoded);
  text << ", 1/" << raw / encoded << " of the values' ";
  WriteBytes(text, raw);
  for (const ArrayIndex& array : index.Arrays)
  {
    if (array.Flags == ArrayFlags::None)
    {
      WriteErrors(text, array);
    }
  }
  return text.str();
}

} // namespace banyan
