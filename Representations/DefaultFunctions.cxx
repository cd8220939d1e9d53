// SPDX-License-Identifier: BSD-3-Clause
#include "DefaultFunctions.h"

#include "vtkColorTransferFunction.h"
#include "vtkCommunicator.h"
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

} // namespace

void UseDefaultFunctions(vtkDataArray* array, vtkDataObject* data, bool colors, bool opacities,
  vtkVolumeProperty* property)
{
  double local[2] = { VTK_DOUBLE_MIN, VTK_DOUBLE_MIN }; // -minimum, maximum
  vtkCompositeDataSet* const blocks = vtkCompositeDataSet::SafeDownCast(data);
  Include(array, local);
  if (blocks && array && array->GetName())
  {
    IncludeBlocks(array->GetName(), blocks, local);
  }
  double all[2] = { local[0], local[1] };
  if (vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController())
  {
    controller->AllReduce(local, all, 2, vtkCommunicator::MAX_OP);
  }
  const double low = -all[0] <= all[1] ? -all[0] : 0.0;
  const double high = -all[0] <= all[1] ? all[1] : 1.0;
  if (colors)
  {
    vtkNew<vtkColorTransferFunction> function;
    function->SetVectorModeToMagnitude();
    function->SetColorSpaceToDiverging();
    function->AddRGBPoint(low, 0.23, 0.30, 0.75);
    function->AddRGBPoint(high, 0.71, 0.016, 0.15);
    property->SetColor(function);
  }
  if (opacities)
  {
    vtkNew<vtkPiecewiseFunction> function;
    function->AddPoint(low, 0.0);
    function->AddPoint(high, 1.0);
    property->SetScalarOpacity(function);
  }
}

} // namespace banyan
