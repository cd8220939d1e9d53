// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_SceneOptions_h
#define banyan_Rendering_SceneOptions_h

#include "Render/Levels/RayCaster.h"
#include "Series/Quantize/ValueRange.h"

class vtkVolumeMapper;
class vtkVolumeProperty;

namespace banyan
{

/// Clipping planes and, if cropping is on, the crop box of a mapper, in the space of its data.
/// Throws Error for regions of cropping other than the inside of the box.
/// @param toWorld the volume's matrix
std::vector<ClipPlane> MakeClipPlanes(vtkVolumeMapper* mapper, const glm::dmat4& toWorld);

/// The blend mode of a mapper. Throws Error for those that are not drawn, with its name.
/// @param data the range of the values: what averages show from black to white
RayBlend MakeBlend(vtkVolumeMapper* mapper, const ValueRange& data);

/// @param colours whether samples have colours of their own, which are no categories
SampleInterpolation MakeInterpolation(vtkVolumeProperty* property, bool colours);

/// Whether the samples of a picture can be chosen by its error: composited ones of linear
/// interpolation. Nearest values jump, and projections show single samples.
/// @param colours see MakeInterpolation
bool CanKeepTolerance(vtkVolumeMapper* mapper, vtkVolumeProperty* property, bool colours);

} // namespace banyan

#endif
