#include "TransferFunctionTable.h"

#include "vtkColorTransferFunction.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// Smallest range that covers the nodes of both functions, so that outside it both are constant.
void CommonRange(const double* color, bool hasColor, const double* opacity, bool hasOpacity,
  double& low, double& high)
{
  low = std::numeric_limits<double>::infinity();
  high = -low;
  if (hasColor)
  {
    low = color[0];
    high = color[1];
  }
  if (hasOpacity)
  {
    low = std::min(low, opacity[0]);
    high = std::max(high, opacity[1]);
  }
  if (!(low < high))
  {
    // No nodes, or one: any range of positive width gives the same constant.
    low = hasColor || hasOpacity ? low : 0.0;
    high = low + std::max(1.0, std::abs(low)) * 1e-6;
  }
}

} // namespace

TransferFunction MakeTransferFunction(vtkVolumeProperty* property, int entries)
{
  vtkColorTransferFunction* color = property->GetRGBTransferFunction(0);
  vtkPiecewiseFunction* opacity = property->GetScalarOpacity(0);
  TransferFunction function;
  CommonRange(color->GetRange(), color->GetSize() > 0, opacity->GetRange(), opacity->GetSize() > 0,
    function.Low, function.High);
  function.UnitDistance = property->GetScalarOpacityUnitDistance(0);
  function.Entries.resize(static_cast<std::size_t>(entries));
  for (int i = 0; i < entries; ++i)
  {
    const double value =
      function.Low + (function.High - function.Low) * i / static_cast<double>(entries - 1);
    double rgb[3];
    color->GetColor(value, rgb);
    const double alpha = std::clamp(opacity->GetValue(value), 0.0, 1.0);
    function.Entries[static_cast<std::size_t>(i)] = glm::vec4(rgb[0], rgb[1], rgb[2], alpha);
  }
  return function;
}

RayShading MakeShading(vtkVolumeProperty* property)
{
  RayShading shading;
  shading.On = property->GetShade(0) != 0;
  shading.Ambient = static_cast<float>(property->GetAmbient(0));
  shading.Diffuse = static_cast<float>(property->GetDiffuse(0));
  shading.Specular = static_cast<float>(property->GetSpecular(0));
  shading.SpecularPower = static_cast<float>(property->GetSpecularPower(0));
  return shading;
}

} // namespace banyan
