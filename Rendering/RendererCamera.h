#ifndef banyan_Rendering_RendererCamera_h
#define banyan_Rendering_RendererCamera_h

#include "Render/RayCamera.h"

#include <glm/mat4x4.hpp>

class vtkMatrix4x4;
class vtkRenderer;

namespace banyan
{

glm::dmat4 ToGlm(vtkMatrix4x4* matrix);

/// The camera of a renderer, for all of its picture where that is drawn in tiles.
/// @param anchor in world space: see RayCamera
RayCamera CameraOf(vtkRenderer* renderer, const glm::dvec3& anchor);

} // namespace banyan

#endif
