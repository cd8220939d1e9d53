// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_RendererCamera_h
#define banyan_Rendering_RendererCamera_h

#include "Render/Scene/RayCamera.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

class vtkMatrix4x4;
class vtkRenderer;

namespace banyan
{

glm::dmat4 ToGlm(vtkMatrix4x4* matrix);

/// All that a picture takes from the renderer that shows it.
struct ScreenView
{
  glm::dmat4 WorldToClip{ 1.0 };
  glm::ivec2 Size{ 0 }; ///< of the whole picture, in pixels
  double Far = 0.0;     ///< distance of the far clipping plane
};

/// The view of a renderer, for all of its picture where that is drawn in tiles: the one that
/// surfaces are drawn with, of the eye that is drawn now, where there are two.
ScreenView ViewOf(vtkRenderer* renderer);

/// A picture, and the part of it that a renderer shows. Windows draw screenshots that are larger
/// than they are part by part.
struct PictureView
{
  ScreenView View; ///< of the picture
  PixelRect Shown;

  bool ShowsAll() const { return this->Shown == PixelRect{ glm::ivec2(0), this->View.Size }; }
};

/// The part of a large picture that a window draws now. Plain numbers: the first rank's is told to
/// the others, whose windows may not know.
struct WindowTile
{
  glm::ivec2 Scale{ 1 };    ///< how many parts there are
  glm::dvec2 Corner{ 0.0 }; ///< of the part, in the picture, from 0 to 1
};

/// While somebody moves the camera, and in a viewport that does not fill the window, there are no
/// parts.
WindowTile TileOf(vtkRenderer* renderer);

/// The picture that a renderer shows, or shows a part of: windows that draw a part move and scale
/// the cameras of surfaces, and this undoes it.
/// @param last WorldToClip of the picture before. A window shows a small picture first: all parts
/// of the large one get its view, to the bit.
PictureView PictureOf(vtkRenderer* renderer, const WindowTile& tile, const glm::dmat4& last);

/// Whether somebody moves the camera. The same on all ranks.
bool IsInteracting(vtkRenderer* renderer);

/// Its camera.
/// @param anchor in world space: see RayCamera
RayCamera CameraOf(vtkRenderer* renderer, const glm::dvec3& anchor);

/// Which of a frame's pictures is drawn: 1 for the second one where both eyes get one, otherwise 0.
int EyeOf(vtkRenderer* renderer);

} // namespace banyan

#endif
