// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_VolumesOnWall_h
#define banyan_Rendering_VolumesOnWall_h

#include "RendererCamera.h"
#include "VolumeFrame.h"

#include "Parallel/Composite/PicturePlace.h"
#include "Render/Scene/DepthPicture.h"

#include <set>
#include <vector>

class vtkBanyanVolumeMapper;
class vtkRenderer;
class vtkVolume;

namespace banyan
{

/// A picture that ranks show on their own displays: all tiles of a wall show parts of one, each
/// display of a CAVE shows one of its own.
struct WallPicture
{
  ScreenView View;
  std::vector<PicturePlace> Places; ///< at most one on a rank
};

/// Volumes on the displays of ranks, over what these show. All ranks draw together, whatever they
/// show themselves; pixels stay on the rank that shows them.
///
///     all ranks     the nearest depths of other data in all places -> cast and composited, place
///                   by place
///     each display  its place, all volumes blended, written over its own framebuffer
class VolumesOnWall
{
public:
  /// @param mapper of the volume that is rendered; the other visible ones are drawn with it
  VolumesOnWall(vtkRenderer* renderer, vtkBanyanVolumeMapper* mapper, vtkVolume* volume);

  /// Collective, with the same calls on all ranks.
  /// @param pictures the same on all ranks
  /// @param own for each picture, at which depths other data are in it, as far as this rank knows;
  /// the nearest of all ranks counts, and Size does not
  /// Throws nothing: a mapper reports what it cannot draw.
  void Draw(const std::vector<WallPicture>& pictures, const std::vector<DepthPicture>& own);

private:
  void DrawPicture(const WallPicture& picture, const VolumeFrame::OnWall& wall,
    const DepthPicture& own, std::set<VolumeFrame*>& drawn, std::set<VolumeFrame*>& failed);

  std::shared_ptr<const FloatImage> Cast(const std::vector<VolumeFrame*>& group,
    const VolumeFrame::OnWall& wall, const DepthPicture& depths, std::set<VolumeFrame*>& drawn,
    std::set<VolumeFrame*>& failed);

  vtkRenderer* Renderer;
  vtkBanyanVolumeMapper* Called;
  std::vector<VolumeFrame> Frames;
};

} // namespace banyan

#endif
