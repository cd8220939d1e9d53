// SPDX-License-Identifier: BSD-3-Clause
#include "IgnoredOptions.h"

#include "vtkPiecewiseFunction.h"
#include "vtkVolumeMapper.h"
#include "vtkVolumeProperty.h"

namespace banyan
{

namespace
{

/// Copies of properties have a function that is 1 everywhere.
bool HasGradientOpacity(vtkVolumeProperty* property)
{
  if (property->GetTransferFunctionMode() == vtkVolumeProperty::TF_2D ||
      !property->HasGradientOpacity(0) || property->GetDisableGradientOpacity(0) != 0)
  {
    return false;
  }
  vtkPiecewiseFunction* const function = property->GetGradientOpacity(0);
  for (int i = 0; i < function->GetSize(); ++i)
  {
    double node[4];
    function->GetNodeValue(i, node);
    if (node[1] != 1.0)
    {
      return true;
    }
  }
  return false;
}

} // namespace

std::string IgnoredOptions(vtkVolumeMapper* mapper, vtkVolumeProperty* property, bool mapped)
{
  std::string names;
  const auto name = [&names](bool isSet, const char* option)
  {
    if (isSet)
    {
      names += names.empty() ? option : std::string(", ") + option;
    }
  };
  name(HasGradientOpacity(property), "GradientOpacity (opacity follows the value alone)");
  name(property->GetTransferFunctionMode() == vtkVolumeProperty::TF_2D,
    "TransferFunctionMode 2D (the one-dimensional functions are drawn)");
  name(property->GetIndependentComponents() == 0 && mapped,
    "IndependentComponents off (three or four components of image data are drawn as colours, and "
    "composited: here the function colours one component, or the magnitude)");
  name(property->GetComponentWeight(0) != 1.0, "ComponentWeight");
  name(property->GetNumberOfLabels() > 0, "functions of labels");
  name(property->GetScatteringAnisotropy() != 0.0f, "ScatteringAnisotropy");
  name(property->GetUseClippedVoxelIntensity() != 0, "ClippedVoxelIntensity");
  name(
    mapper->GetComputeNormalFromOpacity(), "ComputeNormalFromOpacity (normals follow the value)");
  return names.empty() ? names : "Without effect on this picture: " + names + ".";
}

} // namespace banyan
