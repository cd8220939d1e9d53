// SPDX-License-Identifier: BSD-3-Clause
#include "DefaultFunctions.h"

#include "CommunicatorOf.h"
#include "vtkBanyanVolumeMapper.h"

#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"
#include "Series/Quantize/ValueRange.h"

#include "vtkColorTransferFunction.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkSmartPointer.h"
#include "vtkVolumeProperty.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// @param local -minimum, maximum
void Include(vtkDataArray* array, double (&local)[2])
{
  if (array)
  {
    double range[2];
    array->GetFiniteRange(range, array->GetNumberOfComponents() > 1 ? -1 : 0);
    local[0] = std::max(local[0], -range[0]);
    local[1] = std::max(local[1], range[1]);
  }
}

void IncludeBlocks(const char* name, vtkCompositeDataSet* blocks, double (&local)[2])
{
  const auto visit = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  for (visit->InitTraversal(); !visit->IsDoneWithTraversal(); visit->GoToNextItem())
  {
    vtkDataObject* const block = visit->GetCurrentDataObject();
    for (const int where : { vtkDataObject::POINT, vtkDataObject::CELL })
    {
      vtkDataSetAttributes* const values = block->GetAttributes(where);
      Include(values ? values->GetArray(name) : nullptr, local);
    }
  }
}

/// Collective: the range of the values of all ranks; [0, 1] where there are none.
ValueRange RangeOf(Communicator& ranks, vtkDataArray* array, vtkDataObject* data, bool ofColours)
{
  double local[2] = { VTK_DOUBLE_MIN, VTK_DOUBLE_MIN }; // -minimum, maximum
  Collective(ranks,
    [&]
    {
      if (ofColours)
      {
        local[0] = 0.0;
        local[1] = 255.0;
        return;
      }
      vtkCompositeDataSet* const blocks = vtkCompositeDataSet::SafeDownCast(data);
      Include(array, local);
      if (blocks && array && array->GetName())
      {
        IncludeBlocks(array->GetName(), blocks, local);
      }
    });
  const ValueRange range{ -AllMax(ranks, local[0]), AllMax(ranks, local[1]) };
  return range.Low <= range.High ? range : ValueRange{ 0.0, 1.0 };
}

} // namespace

DefaultFunctions::DefaultFunctions() = default;
DefaultFunctions::~DefaultFunctions() = default;

void DefaultFunctions::Apply(vtkBanyanVolumeMapper* mapper, vtkDataObject* data, bool colors,
  bool opacities, vtkVolumeProperty* property)
{
  if (!colors && !opacities)
  {
    return;
  }
  ValueRange range;
  try
  {
    if (!this->Ranks)
    {
      this->Ranks = CommunicatorOf(vtkMultiProcessController::GetGlobalController());
    }
    const bool ofColours = property->GetIndependentComponents() == 0;
    range = RangeOf(*this->Ranks, mapper->GetArrayToDraw(data), data, ofColours);
  }
  catch (const std::exception& error)
  {
    vtkErrorWithObjectMacro(
      property, << "No colors and opacities could be chosen. " << error.what());
    return;
  }
  if (colors)
  {
    vtkNew<vtkColorTransferFunction> function;
    function->SetVectorModeToMagnitude();
    function->SetColorSpaceToDiverging();
    function->AddRGBPoint(range.Low, 0.23, 0.30, 0.75);
    function->AddRGBPoint(range.High, 0.71, 0.016, 0.15);
    property->SetColor(function);
  }
  if (opacities)
  {
    vtkNew<vtkPiecewiseFunction> function;
    function->AddPoint(range.Low, 0.0);
    function->AddPoint(range.High, 1.0);
    property->SetScalarOpacity(function);
  }
}

} // namespace banyan
