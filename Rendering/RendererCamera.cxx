// SPDX-License-Identifier: BSD-3-Clause
#include "RendererCamera.h"

#include "vtkMatrix4x4.h"
#include "vtkOpenGLCamera.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"

#include <glm/matrix.hpp>

namespace banyan
{

glm::dmat4 ToGlm(vtkMatrix4x4* matrix)
{
  glm::dmat4 result;
  for (int row = 0; row < 4; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      result[column][row] = matrix->GetElement(row, column);
    }
  }
  return result;
}

ScreenView ViewOf(vtkRenderer* renderer)
{
  ScreenView view;
  glm::ivec2 origin(0);
  renderer->GetTiledSizeAndOrigin(&view.Size.x, &view.Size.y, &origin.x, &origin.y);
  // Surfaces are drawn with these. GetCompositeProjectionTransformMatrix leaves out the eyes.
  auto* const camera = static_cast<vtkOpenGLCamera*>(renderer->GetActiveCamera());
  vtkMatrix4x4* worldToView = nullptr;
  vtkMatrix3x3* normals = nullptr;
  vtkMatrix4x4* viewToClip = nullptr;
  vtkMatrix4x4* worldToClip = nullptr;
  camera->GetKeyMatrices(renderer, worldToView, normals, viewToClip, worldToClip);
  view.WorldToClip = glm::transpose(ToGlm(worldToClip));
  view.Far = camera->GetClippingRange()[1];
  return view;
}

RayCamera CameraOf(vtkRenderer* renderer, const glm::dvec3& anchor)
{
  const ScreenView view = ViewOf(renderer);
  return RayCamera(view.WorldToClip, view.Size, anchor);
}

int EyeOf(vtkRenderer* renderer)
{
  vtkRenderWindow* const window = renderer->GetRenderWindow();
  const bool both = window->GetStereoRender() && window->GetStereoType() != VTK_STEREO_LEFT &&
                    window->GetStereoType() != VTK_STEREO_RIGHT;
  return both && !renderer->GetActiveCamera()->GetLeftEye() ? 1 : 0;
}

} // namespace banyan
