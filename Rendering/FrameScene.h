// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_FrameScene_h
#define banyan_Rendering_FrameScene_h

#include "Render/Scene/RayScene.h"

class vtkVolume;
class vtkVolumeMapper;

namespace banyan
{

class DistributedField;
class KeptTransferFunction;
struct ScreenView;

/// What VTK's objects say about one picture, in the space of the data; the Viewport is empty when
/// nothing is on the screen. Lengths are those of the data, before the prop is scaled, as in VTK's
/// own volume mappers. Depths and samplings are left empty.
/// @param view of the renderer that shows it
/// @param field not Empty
/// @param sampleDistanceVoxels in edges of the smallest cell; > 0
/// @param function of the pictures before
/// Throws Error when an option cannot be drawn.
RayScene MakeFrameScene(const ScreenView& view, vtkVolume* volume, vtkVolumeMapper* mapper,
  const DistributedField& field, double sampleDistanceVoxels, KeptTransferFunction& function);

} // namespace banyan

#endif
