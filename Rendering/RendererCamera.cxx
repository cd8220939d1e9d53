// SPDX-License-Identifier: BSD-3-Clause
#include "RendererCamera.h"

#include "vtkMatrix4x4.h"
#include "vtkOpenGLCamera.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// Whether two matrices are one but for rounding: windows have angles of views in float.
bool IsSame(const glm::dmat4& a, const glm::dmat4& b)
{
  constexpr double rounding = 1e-6;
  double largest = 0.0;
  double difference = 0.0;
  for (int i = 0; i < 16; ++i)
  {
    largest = std::max(largest, std::abs(a[i / 4][i % 4]));
    difference = std::max(difference, std::abs(a[i / 4][i % 4] - b[i / 4][i % 4]));
  }
  return difference <= rounding * largest;
}

} // namespace

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

WindowTile TileOf(vtkRenderer* renderer)
{
  const double* const own = renderer->GetViewport();
  const bool fills = own[0] == 0.0 && own[1] == 0.0 && own[2] == 1.0 && own[3] == 1.0;
  if (IsInteracting(renderer) || !fills)
  {
    return {};
  }
  vtkRenderWindow* const window = renderer->GetRenderWindow();
  const int* const scale = window->GetTileScale();
  const double* const tile = window->GetTileViewport();
  return { { scale[0], scale[1] }, { tile[0], tile[1] } };
}

PictureView PictureOf(vtkRenderer* renderer, const WindowTile& tile, const glm::dmat4& last)
{
  const ScreenView shown = ViewOf(renderer);
  if (tile.Scale == glm::ivec2(1))
  {
    return { shown, { glm::ivec2(0), shown.Size } };
  }
  ScreenView whole = shown;
  whole.Size = shown.Size * tile.Scale;
  const glm::ivec2 corner(glm::round(tile.Corner * glm::dvec2(whole.Size)));
  // The part's coordinates are x' = s x + t w of the picture's.
  for (int column = 0; column < 4; ++column)
  {
    for (int axis = 0; axis < 2; ++axis)
    {
      const double first = static_cast<double>(corner[axis]) / whole.Size[axis];
      const double moved = 2.0 * first + 1.0 / tile.Scale[axis] - 1.0;
      whole.WorldToClip[column][axis] =
        shown.WorldToClip[column][axis] / tile.Scale[axis] + moved * shown.WorldToClip[column][3];
    }
  }
  if (IsSame(whole.WorldToClip, last))
  {
    whole.WorldToClip = last;
  }
  return { whole, { corner, corner + shown.Size } };
}

bool IsInteracting(vtkRenderer* renderer)
{
  // More than one frame per second. All ranks are told the same rate.
  return renderer->GetRenderWindow()->GetDesiredUpdateRate() > 1.0;
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
