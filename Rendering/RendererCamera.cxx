#include "RendererCamera.h"

#include "vtkCamera.h"
#include "vtkMatrix4x4.h"
#include "vtkRenderer.h"

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

RayCamera CameraOf(vtkRenderer* renderer, const glm::dvec3& anchor)
{
  glm::ivec2 size(0);
  glm::ivec2 origin(0);
  renderer->GetTiledSizeAndOrigin(&size.x, &size.y, &origin.x, &origin.y);
  return RayCamera(ToGlm(renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(
                     renderer->GetTiledAspectRatio(), -1, 1)),
    size, anchor);
}

} // namespace banyan
