// SPDX-License-Identifier: BSD-3-Clause
#include "GridSource.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkRectilinearGrid.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStructuredGrid.h"

#include <gtest/gtest.h>

#include <cmath>

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(GridSource);

GridSource::GridSource()
{
  this->SetNumberOfInputPorts(0);
}

vtkTypeBool GridSource::ProcessRequest(
  vtkInformation* request, vtkInformationVector**, vtkInformationVector* outputs)
{
  vtkInformation* const info = outputs->GetInformationObject(0);
  if (request->Has(Pipeline::REQUEST_DATA_OBJECT()))
  {
    vtkSmartPointer<vtkDataObject> data;
    if (this->Rectilinear)
    {
      data = vtkSmartPointer<vtkRectilinearGrid>::New();
    }
    else
    {
      data = vtkSmartPointer<vtkStructuredGrid>::New();
    }
    info->Set(vtkDataObject::DATA_OBJECT(), data);
  }
  else if (request->Has(Pipeline::REQUEST_INFORMATION()))
  {
    this->Inform(info);
  }
  else if (request->Has(Pipeline::REQUEST_DATA()))
  {
    this->Make(info);
  }
  return 1;
}

void GridSource::Inform(vtkInformation* info) const
{
  const banyan::Box& e = this->Extent;
  const int extent[6] = { e.Lo.x, e.Hi.x - 1, e.Lo.y, e.Hi.y - 1, e.Lo.z, e.Hi.z - 1 };
  info->Set(Pipeline::WHOLE_EXTENT(), extent, 6);
  info->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  info->Set(Pipeline::TIME_STEPS(), this->Times.data(), static_cast<int>(this->Times.size()));
  const double range[2] = { this->Times.front(), this->Times.back() };
  info->Set(Pipeline::TIME_RANGE(), range, 2);
}

void GridSource::Make(vtkInformation* info) const
{
  const double time =
    info->Has(Pipeline::UPDATE_TIME_STEP()) ? info->Get(Pipeline::UPDATE_TIME_STEP()) : 0.0;
  vtkDataSet* const output = vtkDataSet::SafeDownCast(info->Get(vtkDataObject::DATA_OBJECT()));
  output->Initialize();
  int extent[6];
  info->Get(Pipeline::UPDATE_EXTENT(), extent);
  if (auto* const grid = vtkRectilinearGrid::SafeDownCast(output))
  {
    grid->SetExtent(extent);
    for (int axis = 0; axis < 3; ++axis)
    {
      const int type = axis == 1 ? this->TypeOfPoints : axis == 0 ? VTK_FLOAT : VTK_DOUBLE;
      const auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
      array->SetNumberOfTuples(extent[2 * axis + 1] - extent[2 * axis] + 1);
      for (int i = extent[2 * axis]; i <= extent[2 * axis + 1]; ++i)
      {
        array->SetTuple1(i - extent[2 * axis], this->Place(glm::ivec3(i), time)[axis]);
      }
      axis == 0   ? grid->SetXCoordinates(array)
      : axis == 1 ? grid->SetYCoordinates(array)
                  : grid->SetZCoordinates(array);
    }
  }
  else
  {
    vtkNew<vtkPoints> points;
    points->SetDataType(this->TypeOfPoints);
    banyan::ForPositions(
      { { extent[0], extent[2], extent[4] }, { extent[1] + 1, extent[3] + 1, extent[5] + 1 } },
      [&](const glm::ivec3& sample) { points->InsertNextPoint(&this->Place(sample, time)[0]); });
    vtkStructuredGrid::SafeDownCast(output)->SetExtent(extent);
    vtkStructuredGrid::SafeDownCast(output)->SetPoints(points);
  }
  output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
  output->GetPointData()->SetScalars(
    WaveArray(banyan::ScalarType::Float32, "wave", 1, extent, time, 1.0, 0.0));
  if (this->Change)
  {
    this->Change(output, time);
  }
}

vtkSmartPointer<GridSource> GridsAtRest(bool rectilinear)
{
  const auto source = vtkSmartPointer<GridSource>::New();
  source->Rectilinear = rectilinear;
  source->Place = [rectilinear](const glm::ivec3& s, double)
  {
    const glm::dvec3 even = glm::dvec3(s) * glm::dvec3(0.1, 0.2, 0.3);
    return rectilinear
             ? glm::exp(even)
             : glm::dvec3((2.0 + even.x) * std::cos(even.y), (2.0 + even.x) * std::sin(even.y),
                 even.z + 0.01 * std::sin(5.0 * even.x));
  };
  return source;
}

vtkSmartPointer<vtkDataSet> GridAt(vtkAlgorithm* source, double time)
{
  source->UpdateTimeStep(time);
  vtkDataSet* const data = vtkDataSet::SafeDownCast(source->GetOutputDataObject(0));
  const auto copy = vtkSmartPointer<vtkDataSet>::Take(data->NewInstance());
  copy->DeepCopy(data);
  return copy;
}

void ExpectSamePoints(vtkDataSet* a, vtkDataSet* b)
{
  ASSERT_STREQ(a->GetClassName(), b->GetClassName());
  if (auto* const one = vtkRectilinearGrid::SafeDownCast(a))
  {
    auto* const other = vtkRectilinearGrid::SafeDownCast(b);
    for (int i = 0; i < 6; ++i)
    {
      EXPECT_EQ(one->GetExtent()[i], other->GetExtent()[i]);
    }
    EXPECT_TRUE(SameBits(one->GetXCoordinates(), other->GetXCoordinates()));
    EXPECT_TRUE(SameBits(one->GetYCoordinates(), other->GetYCoordinates()));
    EXPECT_TRUE(SameBits(one->GetZCoordinates(), other->GetZCoordinates()));
    return;
  }
  auto* const one = vtkStructuredGrid::SafeDownCast(a);
  auto* const other = vtkStructuredGrid::SafeDownCast(b);
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_EQ(one->GetExtent()[i], other->GetExtent()[i]);
  }
  EXPECT_TRUE(SameBits(one->GetPoints()->GetData(), other->GetPoints()->GetData()));
}
