// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_RendererCamera_h
#define banyan_Rendering_RendererCamera_h

#include "Render/Scene/RayCamera.h"

#include <glm/mat4x4.hpp>

class vtkMatrix4x4;
class vtkRenderer;

namespace banyan
{

glm::dmat4 ToGlm(vtkMatrix4x4* matrix);

/// The camera of a renderer, for all of its picture where that is drawn in tiles: the one that
/// surfaces are drawn with, of the eye that is drawn now, where there are two.
/// @param anchor in world space: see RayCamera
RayCamera CameraOf(vtkRenderer* renderer, const glm::dvec3& anchor);

/// Which of a frame's pictures is drawn: 1 for the second one where both eyes get one, otherwise 0.
int EyeOf(vtkRenderer* renderer);

} // namespace banyan

#endif
