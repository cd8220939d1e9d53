// SPDX-License-Identifier: BSD-3-Clause
#include "SceneOptions.h"

#include "TransferFunctionTable.h"

#include "Base/Error.h"

#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkVolumeMapper.h"
#include "vtkVolumeProperty.h"

#include <string>

namespace banyan
{
namespace
{

std::string NameOf(int blendMode)
{
  switch (blendMode)
  {
    case vtkVolumeMapper::ADDITIVE_BLEND:
      return "'additive'";
    case vtkVolumeMapper::ISOSURFACE_BLEND:
      return "'isosurface'";
    case vtkVolumeMapper::SLICE_BLEND:
      return "'slice'";
    default:
      return "of number " + std::to_string(blendMode);
  }
}

} // namespace

std::vector<ClipPlane> MakeClipPlanes(vtkVolumeMapper* mapper, const glm::dmat4& toWorld)
{
  std::vector<ClipPlane> planes;
  vtkPlaneCollection* given = mapper->GetClippingPlanes();
  const int count = given ? given->GetNumberOfItems() : 0;
  for (int i = 0; i < count; ++i)
  {
    vtkPlane* plane = given->GetItem(i);
    const double* normal = plane->GetNormal();
    const double* origin = plane->GetOrigin();
    const glm::dvec3 n(normal[0], normal[1], normal[2]);
    const double offset = -glm::dot(n, glm::dvec3(origin[0], origin[1], origin[2]));
    const glm::dvec4 inData = glm::dvec4(n, offset) * toWorld;
    planes.push_back({ glm::dvec3(inData), inData.w });
  }
  if (mapper->GetCropping())
  {
    if (mapper->GetCroppingRegionFlags() != VTK_CROP_SUBVOLUME)
    {
      throw Error("Only the inside of the box that crops a volume can be drawn: call "
                  "SetCroppingRegionFlagsToSubVolume");
    }
    const double* box = mapper->GetCroppingRegionPlanes();
    AddCropBox(planes, { box[0], box[2], box[4] }, { box[1], box[3], box[5] });
  }
  return planes;
}

RayBlend MakeBlend(vtkVolumeMapper* mapper, const ValueRange& data)
{
  RayBlend blend;
  switch (mapper->GetBlendMode())
  {
    case vtkVolumeMapper::COMPOSITE_BLEND:
      blend.Mode = BlendMode::Composite;
      break;
    case vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND:
      blend.Mode = BlendMode::Maximum;
      break;
    case vtkVolumeMapper::MINIMUM_INTENSITY_BLEND:
      blend.Mode = BlendMode::Minimum;
      break;
    case vtkVolumeMapper::AVERAGE_INTENSITY_BLEND:
      blend.Mode = BlendMode::Average;
      break;
    default:
      throw Error("The blend mode " + NameOf(mapper->GetBlendMode()) +
                  " is not drawn: composite, maximum, minimum and average intensity are");
  }
  const double* averaged = mapper->GetAverageIPScalarRange();
  // VTK's default stands for all values.
  blend.AveragedLow = averaged[0] == VTK_FLOAT_MIN ? blend.AveragedLow : averaged[0];
  blend.AveragedHigh = averaged[1] == VTK_FLOAT_MAX ? blend.AveragedHigh : averaged[1];
  if (!data.Empty())
  {
    blend.Black = data.Low;
    blend.White = data.High;
  }
  return blend;
}

SampleInterpolation MakeInterpolation(vtkVolumeProperty* property, bool colours)
{
  const bool nearest = property->GetInterpolationType() == VTK_NEAREST_INTERPOLATION;
  return nearest || (!colours && ShowsCategories(property)) ? SampleInterpolation::Nearest
                                                            : SampleInterpolation::Linear;
}

bool CanKeepTolerance(vtkVolumeMapper* mapper, vtkVolumeProperty* property, bool colours)
{
  return mapper->GetBlendMode() == vtkVolumeMapper::COMPOSITE_BLEND &&
         MakeInterpolation(property, colours) == SampleInterpolation::Linear;
}

} // namespace banyan
