// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesInformation.h"

#include "vtkAlgorithm.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkInformationInformationVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTypeTraits.h"

#include "Series/Decode/PieceRange.h"
#include "Series/Grid/LevelGrid.h"

#include <algorithm>
#include <vector>

using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace banyan
{
namespace
{

int VtkTypeOf(ScalarType type)
{
  return Dispatch(
    type, [](auto tag) -> int { return vtkTypeTraits<typename decltype(tag)::Type>::VTK_TYPE_ID; });
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
  information.Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
}

} // namespace

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

int StepAt(const SeriesIndex& index, vtkInformation& information)
{
  const std::vector<double>& times = index.Times;
  if (!information.Has(Pipeline::UPDATE_TIME_STEP()))
  {
    return 0;
  }
  const double time = information.Get(Pipeline::UPDATE_TIME_STEP());
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  return std::max(0, static_cast<int>(after - times.begin()) - 1);
}

void DescribeRange(const SeriesFile& series, int array, vtkDataArray& values)
{
  const PieceRange range = RangeOfSeries(series, array);
  const auto count = static_cast<int>(range.Components.size());
  vtkNew<vtkInformationVector> components;
  components->SetNumberOfInformationObjects(count);
  for (int c = 0; c < count; ++c)
  {
    const ValueRange& of = range.Components[static_cast<std::size_t>(c)];
    if (of.Empty())
    {
      return; // nothing but fill values and NaN, somewhere: VTK knows what to say of that
    }
    const double ends[2] = { of.Low, of.High };
    components->GetInformationObject(c)->Set(vtkDataArray::COMPONENT_RANGE(), ends, 2);
  }
  vtkInformation* const information = values.GetInformation();
  information->Set(vtkAbstractArray::PER_FINITE_COMPONENT(), components);
  if (count > 1 && !range.Magnitude.Empty())
  {
    const double ends[2] = { range.Magnitude.Low, range.Magnitude.High };
    information->Set(vtkDataArray::L2_NORM_FINITE_RANGE(), ends, 2);
  }
}

} // namespace banyan
