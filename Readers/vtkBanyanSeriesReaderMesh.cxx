// SPDX-License-Identifier: BSD-3-Clause
// The reader treats series of meshes differently here.
#include "SeriesInformation.h"
#include "SeriesReaderInternals.h"

#include "vtkDataArray.h"
#include "vtkDataObjectTypes.h"
#include "vtkDataSetAttributes.h"
#include "vtkHyperTreeGrid.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <utility>
#include <vector>

using Pipeline = vtkStreamingDemandDrivenPipeline;

bool vtkBanyanSeriesReader::IsMesh() const
{
  return this->Self->Series && this->Self->Series->Index().Mesh;
}

int vtkBanyanSeriesReader::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject");
  return 1;
}

vtkTypeBool vtkBanyanSeriesReader::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (request->Has(Pipeline::REQUEST_DATA_OBJECT()))
  {
    return this->MakeOutput(outputs);
  }
  return this->Superclass::ProcessRequest(request, inputs, outputs);
}

/// An output of the type that the series is of; an image where it cannot be opened.
int vtkBanyanSeriesReader::MakeOutput(vtkInformationVector* outputs)
{
  const std::string wanted = this->FileName ? this->FileName : "";
  bool open = true;
  if (!this->Self->Series || this->Self->OpenName != wanted || this->Self->Reopen)
  {
    this->Clear();
    open = this->OpenOnAllRanks();
  }
  vtkInformation* const info = outputs->GetInformationObject(0);
  const int type = !this->IsMesh()             ? VTK_IMAGE_DATA
                   : this->MeshAsHyperTreeGrid ? VTK_HYPER_TREE_GRID
                                               : VTK_UNSTRUCTURED_GRID;
  vtkDataObject* const now = info->Get(vtkDataObject::DATA_OBJECT());
  if (!now || now->GetDataObjectType() != type)
  {
    vtkSmartPointer<vtkDataObject> output;
    output.TakeReference(vtkDataObjectTypes::NewDataObject(type));
    info->Set(vtkDataObject::DATA_OBJECT(), output);
  }
  return open ? 1 : 0;
}

void vtkBanyanSeriesReader::FillMesh(vtkInformation* outInfo)
{
  const banyan::SeriesIndex& index = this->Self->Series->Index();
  vtkDataObject* const output = outInfo->Get(vtkDataObject::DATA_OBJECT());
  vtkHyperTreeGrid* const trees = vtkHyperTreeGrid::SafeDownCast(output);
  banyan::MeshOutput& mesh = this->Self->Mesh;
  const bool told = outInfo->Has(Pipeline::UPDATE_NUMBER_OF_PIECES());
  const int piece = told ? outInfo->Get(Pipeline::UPDATE_PIECE_NUMBER()) : 0;
  const int pieces = told ? std::max(outInfo->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()), 1) : 1;
  if (trees)
  {
    mesh.FillTrees(this->Level, piece, pieces, trees);
  }
  else
  {
    mesh.FillGrid(this->Level, piece, pieces, vtkUnstructuredGrid::SafeDownCast(output));
  }
  vtkBanyanDeferred::Handle handle;
  handle.Series = this->Self->Series;
  handle.Step = banyan::StepAt(index, *outInfo);
  handle.Samples = { glm::ivec3{ 0 }, index.Domain.Samples() };
  output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), index.Times[handle.Step]);
  const int arrays = static_cast<int>(index.Arrays.size());
  banyan::MeshStepAhead& ahead = this->Self->Ahead;
  ahead.Reading(*handle.Series, handle.Step);
  std::vector<banyan::FieldBricks> bricks;
  for (handle.Array = 0; handle.Array < arrays; ++handle.Array)
  {
    this->UpdateProgress(static_cast<double>(handle.Array) / arrays);
    const banyan::ArrayIndex& array = index.Arrays[handle.Array];
    if (!this->Self->Wants(array))
    {
      continue;
    }
    for (int component = 0;
         this->ReadAhead && component < static_cast<int>(array.Components.size()); ++component)
    {
      bricks.push_back(
        { { handle.Step, handle.Array, component, handle.Level }, mesh.BricksOf(array, trees) });
    }
    vtkDataSetAttributes* const values = output->GetAttributes(
      trees || !array.CellArray.empty() ? vtkDataObject::CELL : vtkDataObject::POINT);
    const vtkSmartPointer<vtkDataArray> added =
      trees ? mesh.CellValues(handle) : mesh.Values(handle);
    values->AddArray(added);
    banyan::DescribeRange(*this->Self->Series, handle.Array, *added);
    if (array.Name == index.ActiveScalars)
    {
      values->SetActiveScalars(added->GetName());
    }
  }
  if (this->ReadAhead)
  {
    ahead.Read(handle.Series, std::move(bricks));
  }
  this->UpdateProgress(1.0);
}
