#include "IgnoredOptions.h"

#include "vtkVolumeMapper.h"
#include "vtkVolumeProperty.h"

namespace banyan
{

std::string IgnoredOptions(vtkVolumeMapper* mapper, vtkVolumeProperty* property, int components)
{
  std::string names;
  const auto name = [&names](bool isSet, const char* option)
  {
    if (isSet)
    {
      names += names.empty() ? option : std::string(", ") + option;
    }
  };
  name(property->HasGradientOpacity(0) && property->GetDisableGradientOpacity(0) == 0,
    "GradientOpacity (opacity follows the value alone)");
  name(property->GetTransferFunctionMode() == vtkVolumeProperty::TF_2D,
    "TransferFunctionMode 2D (the one-dimensional functions are drawn)");
  name(property->GetIndependentComponents() == 0 && components > 1,
    "IndependentComponents or Map Scalars off (one component or the magnitude is coloured)");
  name(property->GetComponentWeight(0) != 1.0, "ComponentWeight");
  name(property->GetNumberOfLabels() > 0, "functions of labels");
  name(property->GetScatteringAnisotropy() != 0.0f, "ScatteringAnisotropy");
  name(property->GetUseClippedVoxelIntensity() != 0, "ClippedVoxelIntensity");
  name(
    mapper->GetComputeNormalFromOpacity(), "ComputeNormalFromOpacity (normals follow the value)");
  return names.empty() ? names : "Without effect on this picture: " + names + ".";
}

} // namespace banyan
