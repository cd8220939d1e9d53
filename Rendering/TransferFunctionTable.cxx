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

/// The function of greys of a property that has one in place of colours; else null.
vtkPiecewiseFunction* GreysOf(vtkVolumeProperty* property)
{
  return property->GetColorChannels(0) == 1 ? property->GetGrayTransferFunction(0) : nullptr;
}

} // namespace

TransferFunction MakeTransferFunction(vtkVolumeProperty* property, int entries)
{
  vtkPiecewiseFunction* const grey = GreysOf(property);
  vtkColorTransferFunction* const color = grey ? nullptr : property->GetRGBTransferFunction(0);
  vtkPiecewiseFunction* const opacity = property->GetScalarOpacity(0);
  if (color)
  {
    color->Build(); // what discretized colours are looked up in
  }
  TransferFunction function;
  CommonRange(color ? color->GetRange() : grey->GetRange(),
    (color ? color->GetSize() : grey->GetSize()) > 0, opacity->GetRange(), opacity->GetSize() > 0,
    function.Low, function.High);
  function.UnitDistance = property->GetScalarOpacityUnitDistance(0);
  function.Entries.resize(static_cast<std::size_t>(entries));
  for (int i = 0; i < entries; ++i)
  {
    const double value =
      function.Low + (function.High - function.Low) * i / static_cast<double>(entries - 1);
    double rgb[3];
    if (color)
    {
      color->GetColor(value, rgb);
    }
    else
    {
      std::fill(rgb, rgb + 3, grey->GetValue(value));
    }
    const double alpha = std::clamp(opacity->GetValue(value), 0.0, 1.0);
    function.Entries[static_cast<std::size_t>(i)] = glm::vec4(rgb[0], rgb[1], rgb[2], alpha);
  }
  return function;
}

const TransferFunction& KeptTransferFunction::Of(vtkVolumeProperty* property)
{
  vtkObject* color = GreysOf(property);
  color = color ? color : property->GetRGBTransferFunction(0);
  vtkPiecewiseFunction* const opacity = property->GetScalarOpacity(0);
  const std::uint64_t times[] = { color->GetMTime(), opacity->GetMTime() };
  if (this->Function.Entries.empty() || this->Made[0] != color || this->Made[1] != opacity ||
      !std::equal(times, times + 2, this->Times))
  {
    this->Function = MakeTransferFunction(property);
    this->Made[0] = color;
    this->Made[1] = opacity;
    std::copy(times, times + 2, this->Times);
  }
  this->Function.UnitDistance = property->GetScalarOpacityUnitDistance(0);
  return this->Function;
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
