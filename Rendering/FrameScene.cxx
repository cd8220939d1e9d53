// SPDX-License-Identifier: BSD-3-Clause
#include "FrameScene.h"

#include "RendererCamera.h"
#include "SceneOptions.h"
#include "TransferFunctionTable.h"

#include "vtkVolume.h"
#include "vtkVolumeMapper.h"
#include "vtkVolumeProperty.h"

#include "Base/PropertyNumber.h"
#include "Parallel/Fields/DistributedField.h"

#include <limits>

namespace banyan
{
namespace
{

/// Bounds in world space of a box of physical space.
void WorldBounds(
  const std::array<double, 6>& box, const glm::dmat4& toWorld, glm::dvec3& low, glm::dvec3& high)
{
  low = glm::dvec3(std::numeric_limits<double>::infinity());
  high = -low;
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec4 point(
      box[corner & 1], box[2 + ((corner >> 1) & 1)], box[4 + ((corner >> 2) & 1)], 1.0);
    const glm::dvec3 world(toWorld * point);
    low = glm::min(low, world);
    high = glm::max(high, world);
  }
}

} // namespace

RayScene MakeFrameScene(const ScreenView& view, vtkVolume* volume, vtkVolumeMapper* mapper,
  const DistributedField& field, double sampleDistanceVoxels, KeptTransferFunction& function)
{
  vtkVolumeProperty* const property = volume->GetProperty();
  const glm::dmat4 toWorld = ToGlm(volume->GetMatrix());
  RequireNumber("ScalarOpacityUnitDistance", property->GetScalarOpacityUnitDistance(0));
  for (int i = 0; i < 16; ++i)
  {
    RequireNumber(
      "A number of the volume's position, scale and orientation", toWorld[i / 4][i % 4], true);
  }
  const FieldPlace& place = field.Place();
  glm::dvec3 low;
  glm::dvec3 high;
  WorldBounds(place.Bounds, toWorld, low, high);
  const RayCamera camera(view.WorldToClip, view.Size, 0.5 * (low + high));
  RayScene scene{ camera.InSpace(toWorld), camera.Footprint(low, high), place.IndexToPhysical,
    place.Cells, {}, sampleDistanceVoxels * place.CellSize };
  scene.Shading = MakeShading(property);
  scene.Interpolation = MakeInterpolation(property, field.DrawsColours());
  scene.Transfer = function.Of(property, field.DrawsColours());
  scene.ClipPlanes = MakeClipPlanes(mapper, toWorld);
  scene.Blend = MakeBlend(mapper, field.Range());
  return scene;
}

} // namespace banyan
