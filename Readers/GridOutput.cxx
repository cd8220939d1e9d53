// SPDX-License-Identifier: BSD-3-Clause
#include "GridOutput.h"

#include "HiddenFlags.h"
#include "LargeArrays.h"
#include "SeriesInformation.h"
#include "vtkBanyanDeferred.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkRectilinearGrid.h"
#include "vtkStructuredGrid.h"
#include "vtkUnsignedCharArray.h"

#include "Base/ThreadPool.h"
#include "Series/Decode/BetweenSteps.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Points/PointsReader.h"

#include <vector>

namespace banyan
{
namespace
{

/// Moves points some way to those of the next step.
void Approach(const std::array<vtkSmartPointer<vtkDataArray>, 3>& later, double fraction,
  std::array<vtkSmartPointer<vtkDataArray>, 3>& points, const PointsForm& form)
{
  BetweenSteps between;
  between.Fraction = fraction;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    if (points[axis] && AreInterpolated(form.Types[axis]))
    {
      between.Interpolate(form.Types[axis], points[axis]->GetVoidPointer(0), 1,
        later[axis]->GetVoidPointer(0), points[axis]->GetNumberOfValues());
    }
  }
}

} // namespace

Box ExtentOfGrid(const SeriesIndex& index, int level)
{
  return level == 0 ? index.Domain.Extent
                    : Box{ glm::ivec3(0),
                        BrickLayout(index.Domain.Samples(), index.BrickCells, level).Samples() };
}

void GridOutput::Forget()
{
  this->Kept = {};
  this->KeptFiles[0] = -1;
}

void GridOutput::Fill(const StepRequest& request, const Box& wanted, vtkDataSet* output)
{
  const Box whole = ExtentOfGrid(request.Series->Index(), request.Level);
  Box piece = Intersection(wanted, whole);
  piece = piece.Empty() ? Box{} : piece;
  const Box samples = piece.Empty() ? Box{} : Box{ piece.Lo - whole.Lo, piece.Hi - whole.Lo };
  this->TakePoints(request, samples);
  this->SetPoints(piece, output);
  output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), request.Time);
  this->AddArrays(request, samples, output);
}

/// Reads points of a step, in arrays like those that were written.
GridOutput::Points GridOutput::Read(const StepRequest& request, int step, const Box& samples) const
{
  const SeriesIndex& index = request.Series->Index();
  const PointsForm& form = index.Points->Form;
  const bool curvilinear = form.Kind == GridKind::Curvilinear;
  Points points;
  std::array<void*, 3> values{};
  for (int axis = 0; axis < (curvilinear ? 1 : 3); ++axis)
  {
    const auto a = static_cast<std::size_t>(axis);
    points[a].TakeReference(vtkDataArray::CreateDataArray(VtkTypeOf(form.Types[a])));
    points[a]->SetNumberOfComponents(curvilinear ? 3 : 1);
    SetTuples(points[a], curvilinear ? samples.Count() : samples.Size()[axis]);
    values[a] = points[a]->GetVoidPointer(0);
  }
  if (!samples.Empty())
  {
    ReadPoints(
      request.Series->Folder(), index, step, request.Level, samples, values, ThreadPool::Process());
  }
  return points;
}

void GridOutput::TakePoints(const StepRequest& request, const Box& samples)
{
  const PointsIndex& index = *request.Series->Index().Points;
  const int first = index.FileOf(request.Step).FirstStep;
  const int next = request.Fraction > 0.0 ? index.FileOf(request.Step + 1).FirstStep : first;
  // Points that rest stay as they are, bit by bit.
  const double fraction = next == first ? 0.0 : request.Fraction;
  if (this->KeptFiles[0] == first && this->KeptFiles[1] == next && this->KeptFraction == fraction &&
      this->KeptLevel == request.Level && this->KeptSamples == samples)
  {
    return;
  }
  this->Forget();
  Points points = this->Read(request, first, samples);
  if (fraction > 0.0)
  {
    Approach(this->Read(request, next, samples), fraction, points, index.Form);
  }
  this->Kept = points;
  this->KeptFiles[0] = first;
  this->KeptFiles[1] = next;
  this->KeptFraction = fraction;
  this->KeptLevel = request.Level;
  this->KeptSamples = samples;
}

void GridOutput::SetPoints(const Box& piece, vtkDataSet* output) const
{
  int extent[6] = { 0, -1, 0, -1, 0, -1 };
  if (!piece.Empty())
  {
    ToExtent(piece, extent);
  }
  if (auto* const rectilinear = vtkRectilinearGrid::SafeDownCast(output))
  {
    rectilinear->SetExtent(extent);
    rectilinear->SetXCoordinates(this->Kept[0]);
    rectilinear->SetYCoordinates(this->Kept[1]);
    rectilinear->SetZCoordinates(this->Kept[2]);
    return;
  }
  auto* const curvilinear = vtkStructuredGrid::SafeDownCast(output);
  vtkNew<vtkPoints> points;
  points->SetData(this->Kept[0]);
  curvilinear->SetExtent(extent);
  curvilinear->SetPoints(points);
}

void GridOutput::AddArrays(const StepRequest& request, const Box& samples, vtkDataSet* output) const
{
  const SeriesIndex& index = request.Series->Index();
  vtkBanyanDeferred::Handle handle;
  handle.Series = request.Series;
  handle.Step = request.Step;
  handle.Fraction = request.Fraction;
  handle.Level = request.Level;
  handle.Samples = samples;
  if (!samples.Empty())
  {
    AddHiddenFlags(output, handle);
  }
  vtkPointData* const values = output->GetPointData();
  const int arrays = static_cast<int>(index.Arrays.size());
  for (handle.Array = 0; handle.Array < arrays; ++handle.Array)
  {
    request.Progress(static_cast<double>(handle.Array) / arrays);
    const ArrayIndex& array = index.Arrays[static_cast<std::size_t>(handle.Array)];
    if (request.Wants(array))
    {
      handle.Fraction = AreInterpolated(array.Type) ? request.Fraction : 0.0;
      const vtkSmartPointer<vtkDataArray> plain = vtkBanyanDeferred::NewPlain(handle);
      DescribeRange(*request.Series, handle.Array, handle.Flags, *plain);
      values->AddArray(plain);
    }
  }
  if (values->HasArray(index.ActiveScalars.c_str()))
  {
    values->SetActiveScalars(index.ActiveScalars.c_str());
  }
  request.Progress(1.0);
}

} // namespace banyan
