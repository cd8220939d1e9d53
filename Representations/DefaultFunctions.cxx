#include "DefaultFunctions.h"

#include "vtkColorTransferFunction.h"
#include "vtkCommunicator.h"
#include "vtkDataArray.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolumeProperty.h"

namespace banyan
{

void UseDefaultFunctions(
  vtkDataArray* array, bool colors, bool opacities, vtkVolumeProperty* property)
{
  double local[2] = { VTK_DOUBLE_MIN, VTK_DOUBLE_MIN }; // -minimum, maximum
  if (array)
  {
    double range[2];
    array->GetFiniteRange(range, array->GetNumberOfComponents() > 1 ? -1 : 0);
    local[0] = -range[0];
    local[1] = range[1];
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
