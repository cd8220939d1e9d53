// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_FrameScene_h
#define banyan_Rendering_FrameScene_h

#include "Render/Levels/RayCaster.h"

#include <string>

class vtkRenderer;
class vtkVolume;
class vtkVolumeMapper;

namespace banyan
{

class DistributedField;
class KeptTransferFunction;

/// What VTK's objects say about one picture.
struct FrameScene
{
  RayScene Scene; ///< in the space of the data; its Viewport is empty when nothing is on the screen
  std::string Problem; ///< why this rank cannot draw it; empty if it can
};

/// Lengths are those of the data, before the prop is scaled, as in VTK's own volume mappers. Depths
/// and samplings are left empty.
/// @param field not Empty
/// @param sampleDistanceVoxels in edges of the smallest cell; > 0
/// @param function of the pictures before
FrameScene MakeFrameScene(vtkRenderer* renderer, vtkVolume* volume, vtkVolumeMapper* mapper,
  const DistributedField& field, double sampleDistanceVoxels, KeptTransferFunction& function);

} // namespace banyan

#endif
