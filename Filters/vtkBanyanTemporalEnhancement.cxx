// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBanyanTemporalEnhancement.h"

#include "EnhancedArray.h"
#include "LeafParts.h"
#include "SetNumber.h"
#include "vtkBanyanDeferred.h"

#include "Series/Decode/SeriesFile.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkErrorCode.h"
#include "vtkHyperTreeGrid.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

vtkStandardNewMacro(vtkBanyanTemporalEnhancement);
banyanSetNumberMacro(vtkBanyanTemporalEnhancement, Strength, 0.0, 1.0);
banyanSetNumberMacro(vtkBanyanTemporalEnhancement, Sensitivity, 1e-6, 1e6);
banyanSetNumberMacro(vtkBanyanTemporalEnhancement, Scale, 0.0, VTK_DOUBLE_MAX);
banyanSetNumberMacro(vtkBanyanTemporalEnhancement, NoiseFloor, 0.0, VTK_DOUBLE_MAX);

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

/// Returns what lies at the same place of another step; null where there is nothing.
vtkDataObject* Counterpart(vtkDataObject* step, vtkCompositeDataIterator* place)
{
  vtkCompositeDataSet* const blocks = vtkCompositeDataSet::SafeDownCast(step);
  return blocks && place ? blocks->GetDataSet(place) : step;
}

bool HasValues(vtkDataObject* data)
{
  vtkDataSet* const set = vtkDataSet::SafeDownCast(data);
  vtkHyperTreeGrid* const trees = vtkHyperTreeGrid::SafeDownCast(data);
  return (set && set->GetNumberOfPoints() > 0) || (trees && trees->GetNumberOfCells() > 0);
}

} // namespace

vtkBanyanTemporalEnhancement::vtkBanyanTemporalEnhancement()
{
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

int vtkBanyanTemporalEnhancement::FillInputPortInformation(int, vtkInformation* info)
{
  // Blocks are walked here: the pipeline's own loop over them does not go with several steps.
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkHyperTreeGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

int vtkBanyanTemporalEnhancement::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  vtkInformation* const output = outputs->GetInformationObject(0);
  std::optional<double> time;
  if (output->Has(Pipeline::UPDATE_TIME_STEP()))
  {
    time = output->Get(Pipeline::UPDATE_TIME_STEP());
  }
  this->Window.Request(this, time,
    { (this->CompareWith & PREVIOUS) != 0, (this->CompareWith & NEXT) != 0, this->StepDistance });
  return 1;
}

int vtkBanyanTemporalEnhancement::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  vtkDataObject* const output = vtkDataObject::GetData(outputs);
  try
  {
    this->Window.Take(this);
    output->ShallowCopy(banyan::CopyOfLeaves(this->Window.Now()));
    this->EnhanceAll(output);
  }
  catch (const std::exception& error)
  {
    this->SetErrorCode(vtkErrorCode::UserError);
    vtkErrorMacro(<< "The array cannot be enhanced: " << error.what());
    output->Initialize();
    return 0;
  }
  return 1;
}

void vtkBanyanTemporalEnhancement::EnhanceAll(vtkDataObject* output)
{
  PlainArrays plain;
  plain.swap(this->Decoded);
  bool values = false;
  bool found = false;
  const auto enhance = [&](vtkDataObject* data, vtkCompositeDataIterator* place)
  {
    if (HasValues(data))
    {
      values = true;
      found = this->Enhance(data, place, plain) || found;
    }
  };
  if (vtkCompositeDataSet* const blocks = vtkCompositeDataSet::SafeDownCast(output))
  {
    const auto visit = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
    for (visit->InitTraversal(); !visit->IsDoneWithTraversal(); visit->GoToNextItem())
    {
      enhance(visit->GetCurrentDataObject(), visit);
    }
  }
  else
  {
    enhance(output, nullptr);
  }
  if (values && !found)
  {
    throw std::runtime_error(
      "there is no array of the chosen name at these points or cells. Choose another 'Array'.");
  }
}

/// Throws where an array has another number of values in another step.
/// @param kind "point" or "cell"
/// @param which the other step
static void CompareShapes(
  vtkDataArray* array, vtkDataArray* there, const std::string& kind, const std::string& which)
{
  if (there->GetNumberOfTuples() == array->GetNumberOfTuples() &&
      there->GetNumberOfComponents() == array->GetNumberOfComponents())
  {
    return;
  }
  const auto shape = [&](vtkDataArray* of)
  {
    return std::to_string(of->GetNumberOfTuples()) + " " + kind + "s with " +
           std::to_string(of->GetNumberOfComponents()) + " components";
  };
  throw std::runtime_error("\"" + std::string(array->GetName()) + "\" has " + shape(there) +
                           " in " + which + ", and " + shape(array) +
                           " now. Only meshes that stay the same can be compared.");
}

/// False where there is no such array.
bool vtkBanyanTemporalEnhancement::Enhance(
  vtkDataObject* data, vtkCompositeDataIterator* place, PlainArrays& plain)
{
  int association = 0;
  vtkDataArray* const array = this->GetInputArrayToProcess(0, data, association);
  if (!array || (association != vtkDataObject::FIELD_ASSOCIATION_POINTS &&
                  association != vtkDataObject::FIELD_ASSOCIATION_CELLS))
  {
    return false;
  }
  // Hyper trees have cells only, and VTK finds these when it is asked for points.
  const bool ofCells =
    association == vtkDataObject::FIELD_ASSOCIATION_CELLS || vtkHyperTreeGrid::SafeDownCast(data);
  const int where = ofCells ? vtkDataObject::CELL : vtkDataObject::POINT;
  const std::string kind = ofCells ? "cell" : "point";
  vtkDataArray* neighbours[2] = { nullptr, nullptr };
  vtkDataObject* const steps[2] = { this->Window.Previous(), this->Window.Next() };
  for (int i = 0; i < 2; ++i)
  {
    if (!steps[i])
    {
      continue;
    }
    const std::string which = i == 0 ? "the step before" : "the step after";
    vtkDataObject* const other = Counterpart(steps[i], place);
    vtkDataSetAttributes* const values = other ? other->GetAttributes(where) : nullptr;
    vtkDataArray* const there = values ? values->GetArray(array->GetName()) : nullptr;
    if (!there)
    {
      throw std::runtime_error(which + " has no " + kind + " array \"" + array->GetName() + "\".");
    }
    if (vtkHyperTreeGrid::SafeDownCast(data) && !banyan::HaveSameLeaves(data, other))
    {
      throw std::runtime_error(which +
                               " has other hyper trees. Only those that stay the same can be "
                               "compared.");
    }
    CompareShapes(array, there, kind, which);
    if (!banyan::HaveSameCells(data, other))
    {
      throw std::runtime_error(which + " has other cells. Only meshes that stay the same can be "
                                       "compared.");
    }
    neighbours[i] = this->PlainOf(there, plain);
  }
  const auto enhanced = banyan::EnhancedArray(
    this->HowFor(array), this->PlainOf(array, plain), neighbours[0], neighbours[1]);
  data->GetAttributes(where)->AddArray(enhanced);
  return true;
}

/// In ordinary memory; decoded once as long as its step is kept.
/// @param before what was decoded for the step before
vtkDataArray* vtkBanyanTemporalEnhancement::PlainOf(vtkDataArray* array, const PlainArrays& before)
{
  if (!vtkBanyanDeferred::IsDeferred(array))
  {
    return array;
  }
  vtkSmartPointer<vtkDataArray>& plain = this->Decoded[array];
  if (!plain)
  {
    const auto found = before.find(array);
    plain = found != before.end() ? found->second : vtkBanyanDeferred::Plain(array);
  }
  if (!plain)
  {
    throw std::runtime_error(
      std::string("the values of \"") + array->GetName() + "\" cannot be decoded.");
  }
  return plain;
}

/// The series knows what the user left open.
banyan::TemporalEnhancement vtkBanyanTemporalEnhancement::HowFor(vtkDataArray* array) const
{
  banyan::TemporalEnhancement how{ this->Strength, this->Scale, this->NoiseFloor,
    this->Sensitivity };
  if (const vtkBanyanDeferred::Handle* const handle = vtkBanyanDeferred::From(array))
  {
    const auto& index = handle->Series->Index().Arrays.at(static_cast<std::size_t>(handle->Array));
    const banyan::TemporalEnhancement known = banyan::EnhancementFor(index, this->Strength, -1);
    how.Scale = how.Scale > 0.0 ? how.Scale : known.Scale;
    how.NoiseFloor = how.NoiseFloor > 0.0 ? how.NoiseFloor : known.NoiseFloor;
  }
  how.Scale = how.Scale > 0.0 ? how.Scale : 1.0;
  return how;
}

void vtkBanyanTemporalEnhancement::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "CompareWith: " << this->CompareWith << "\n";
  os << indent << "StepDistance: " << this->StepDistance << "\n";
  os << indent << "Strength: " << this->Strength << "\n";
  os << indent << "Sensitivity: " << this->Sensitivity << "\n";
  os << indent << "Scale: " << this->Scale << "\n";
  os << indent << "NoiseFloor: " << this->NoiseFloor << "\n";
}
