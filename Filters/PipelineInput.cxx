// SPDX-License-Identifier: BSD-3-Clause
#include "PipelineInput.h"

#include "SourceInspector.h"
#include "StepReport.h"
#include "UpstreamErrors.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <cmath>
#include <sstream>

using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace banyan
{
namespace
{

/// The grid that an information tells of; what it does not tell is empty, or the default.
Grid GridOf(vtkInformation* info)
{
  Grid grid;
  const bool told = info->Has(Pipeline::WHOLE_EXTENT()) && info->Has(vtkDataObject::ORIGIN()) &&
                    info->Has(vtkDataObject::SPACING());
  for (int axis = 0; told && axis < 3; ++axis)
  {
    const int* extent = info->Get(Pipeline::WHOLE_EXTENT());
    grid.Extent.Lo[axis] = extent[2 * axis];
    grid.Extent.Hi[axis] = extent[2 * axis + 1] + 1;
    grid.Origin[axis] = info->Get(vtkDataObject::ORIGIN())[axis];
    grid.Spacing[axis] = info->Get(vtkDataObject::SPACING())[axis];
  }
  return grid;
}

/// The VTK type of the active scalars that an information tells of, or -1.
int ScalarsOf(vtkInformation* info)
{
  vtkInformation* scalars = vtkDataObject::GetActiveFieldInformation(
    info, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
  return scalars && scalars->Has(vtkDataObject::FIELD_ARRAY_TYPE())
           ? scalars->Get(vtkDataObject::FIELD_ARRAY_TYPE())
           : -1;
}

void CollectSources(vtkAlgorithm* algorithm, std::vector<vtkAlgorithm*>& sources)
{
  bool isSource = true;
  for (int port = 0; port < algorithm->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < algorithm->GetNumberOfInputConnections(port); ++i)
    {
      isSource = false;
      CollectSources(algorithm->GetInputAlgorithm(port, i), sources);
    }
  }
  if (isSource)
  {
    sources.push_back(algorithm);
  }
}

/// Throws Error when a file is not as its source says that all of them are.
void CheckFiles(const std::vector<vtkAlgorithm*>& sources)
{
  const SourceInspector* inspector = SourceInspector::Get();
  for (vtkAlgorithm* source : sources)
  {
    const vtkSmartPointer<vtkInformation> file =
      inspector ? inspector->InformationOfFile(source) : nullptr;
    if (!file)
    {
      continue;
    }
    vtkInformation* told = source->GetOutputInformation(0);
    const Grid gridBefore = GridOf(told);
    const Grid gridNow = GridOf(file);
    const bool bothTold = !gridBefore.Extent.Empty() && !gridNow.Extent.Empty();
    const std::string change = bothTold ? ChangeBetween(gridBefore, gridNow) : "";
    if (!change.empty())
    {
      throw Error("The file does not fit the ones before: " + change + ".");
    }
    const int before = ScalarsOf(told);
    const int now = ScalarsOf(file);
    if (before != now && before >= 0 && now >= 0)
    {
      throw Error(std::string("The file does not fit the ones before: its values were of type ") +
                  vtkImageScalarTypeNameMacro(before) + " and are of type " +
                  vtkImageScalarTypeNameMacro(now) + ".");
    }
  }
}

/// " : what was said", or a full stop.
std::string Said(const UpstreamErrors& errors)
{
  const std::string text = errors.First();
  return text.empty() ? "." : ": " + text;
}

} // namespace

std::vector<vtkAlgorithm*> PipelineInput::Sources() const
{
  std::vector<vtkAlgorithm*> sources;
  CollectSources(this->Producer, sources);
  return sources;
}

std::vector<double> PipelineInput::Times(bool wanted) const
{
  if (!this->Producer)
  {
    throw Error("The writer has no input.");
  }
  this->Forget();
  const UpstreamErrors errors(this->Producer);
  auto* pipeline = Pipeline::SafeDownCast(this->Producer->GetExecutive());
  if (!pipeline || !pipeline->UpdateInformation() || !errors.First().empty())
  {
    throw Error("The input gives no information about its data" + Said(errors));
  }
  vtkInformation* info = this->Producer->GetOutputInformation(this->Port);
  if (!wanted || !info->Has(Pipeline::TIME_STEPS()))
  {
    return {};
  }
  const double* first = info->Get(Pipeline::TIME_STEPS());
  std::vector<double> times(first, first + info->Length(Pipeline::TIME_STEPS()));
  for (std::size_t i = 0; i < times.size(); ++i)
  {
    if (!std::isfinite(times[i]))
    {
      std::ostringstream text;
      text << "The time of step " << i << " of the input is " << times[i] << ", which is no time.";
      throw Error(text.str());
    }
    if (i > 0 && !(times[i] > times[i - 1]))
    {
      std::ostringstream text;
      text << "The times of the input do not increase: " << times[i] << " (step " << i
           << ") comes after " << times[i - 1] << ".";
      throw Error(text.str());
    }
  }
  return times;
}

void PipelineInput::Forget() const
{
  const SourceInspector* inspector = SourceInspector::Get();
  for (vtkAlgorithm* source : this->Sources())
  {
    if (inspector)
    {
      inspector->Forget(source);
    }
  }
}

vtkDataObject* PipelineInput::Pull(int piece, int pieces, const double* time, bool withFiles) const
{
  vtkInformation* info = this->Producer->GetOutputInformation(this->Port);
  vtkNew<vtkInformationVector> requests;
  requests->SetNumberOfInformationObjects(this->Port + 1);
  vtkInformation* request = requests->GetInformationObject(this->Port);
  request->Set(Pipeline::UPDATE_PIECE_NUMBER(), piece);
  request->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), pieces);
  request->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
  if (info->Has(Pipeline::WHOLE_EXTENT()))
  {
    request->Set(Pipeline::UPDATE_EXTENT(), info->Get(Pipeline::WHOLE_EXTENT()), 6);
  }
  if (time)
  {
    request->Set(Pipeline::UPDATE_TIME_STEP(), *time);
  }
  const UpstreamErrors errors(this->Producer);
  if (!this->Producer->Update(this->Port, requests) || !errors.First().empty())
  {
    throw Error("The input cannot be read" + Said(errors));
  }
  if (withFiles)
  {
    CheckFiles(this->Sources());
  }
  return this->Data();
}

vtkDataObject* PipelineInput::Data() const
{
  return this->Producer->GetOutputDataObject(this->Port);
}

} // namespace banyan
