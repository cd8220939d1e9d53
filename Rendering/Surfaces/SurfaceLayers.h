// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_Surfaces_SurfaceLayers_h
#define banyan_Rendering_Surfaces_SurfaceLayers_h

#include "Render/Raycast/RaySegments.h"
#include "Render/Scene/RayCamera.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <map>
#include <utility>
#include <vector>

class vtkProp;
class vtkRenderer;
class vtkVolume;

namespace banyan
{

class Backdrop;
struct PictureView;

/// Whether a prop is a translucent surface that SurfaceLayers takes apart.
bool IsTranslucentSurface(vtkProp* prop);

/// Whether what a renderer shows can be drawn once more without translucent surfaces. Not where its
/// background was drawn by others, and not where volumes of others are.
bool CanHideSurfaces(vtkRenderer* renderer, const std::vector<vtkVolume*>& own);

/// A translucent surface at a pixel.
struct SurfaceFragment
{
  glm::ivec2 Pixel{ 0 }; ///< of the renderer
  float Depth = 1.0f;
  glm::vec4 Color{ 0.0f }; ///< not premultiplied
};

/// The translucent surfaces in a picture of volumes, which are mixed with these: what is on this
/// rank of them, layer by layer.
class SurfaceLayers
{
public:
  /// Takes them off the screen: draws a part of the renderer's picture again, up to the moment in
  /// which a volume is drawn, but without them.
  /// @param rect of the picture
  /// @param volume that is drawn next
  /// @return whether that is all of them
  bool Take(
    vtkRenderer* renderer, const PictureView& view, const PixelRect& rect, vtkVolume* volume);

  /// Finds where they are along rays, and leaves out what is behind opaque geometry of any rank.
  void Place(const PictureView& view, const PixelRect& rect, const Backdrop& backdrop);

  /// Adds what is in a block of the picture, which consists of whole tiles.
  void AddTo(SegmentPicture& segments, const PixelRect& block) const;

private:
  std::vector<SurfaceFragment> Fragments;
  std::map<std::pair<int, int>, TileSegments> Tiles; ///< by y and x
};

} // namespace banyan

#endif
