// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_VolumesPicture_h
#define banyan_Rendering_VolumesPicture_h

#include "Surfaces/SurfaceLayers.h"
#include "VolumeFrame.h"
#include "VolumesInDepth.h"

#include <functional>
#include <memory>
#include <set>
#include <vector>

class vtkBanyanVolumeMapper;
class vtkRenderer;
class vtkVolume;

namespace banyan
{

/// The order of depth of volumes for a camera.
DepthOrder OrderInDepth(const std::vector<VolumeOnScreen>& volumes, const ScreenView& view);

/// The picture of all volumes of a renderer that draw on the same ranks. Pictures of volumes are
/// blended by depth, and the background is behind all of them: the first volume that VTK renders
/// draws all, and the others are told that they are drawn.
class VolumesPicture
{
public:
  /// @param mapper of the volume that is rendered
  VolumesPicture(vtkRenderer* renderer, vtkBanyanVolumeMapper* mapper, vtkVolume* volume);

  bool HasSeveral() const { return this->Frames.size() > 1; }

  /// Collective, with the same calls on all ranks: volumes come in the order of the renderer's
  /// list. Throws nothing: a mapper reports what it cannot draw.
  void Draw();

  /// Forgets which volumes of a renderer are drawn. Of a frame that has ended those remain that VTK
  /// did not render, as they are off the screen.
  static void ForgetDrawn(vtkRenderer* renderer);

  /// Where volumes that are prepared stand in a picture.
  static std::vector<VolumeOnScreen> OnScreen(const std::vector<VolumeFrame*>& frames);

  /// Says what is not drawn in the order of depth, once.
  /// @param first of their mappers
  /// @param bits of NotInDepth, of each frame
  static void WarnNotInDepth(vtkBanyanVolumeMapper* first, const std::vector<VolumeFrame*>& frames,
    const std::vector<unsigned char>& bits);

private:
  using Pictures = std::vector<std::shared_ptr<const FloatImage>>; ///< null where there is none

  VolumeFrame& FrameAt(int number) { return this->Frames[static_cast<std::size_t>(number)]; }
  bool Look();
  void DrawPrepared(vtkBanyanVolumeMapper* first);
  void FindGroups(vtkBanyanVolumeMapper* first, const std::vector<VolumeFrame*>& frames,
    const std::vector<VolumeOnScreen>& volumes, const DepthOrder& order);
  void TakeSurfaces(vtkBanyanVolumeMapper* first, const PixelRect& rect);
  std::vector<PixelRect> PartsOf(const PixelRect& rect) const;
  VolumeFrame::Together TogetherWith(const VolumeFrame& frame) const;
  Pictures Cast(
    const Backdrop& backdrop, const PixelRect& part, bool isWhole, std::set<VolumeFrame*>& failed);
  bool Attempt(
    VolumeFrame& frame, const std::function<void()>& cast, std::set<VolumeFrame*>& failed) const;
  std::shared_ptr<const FloatImage> Mix(const std::vector<int>& group, const Backdrop& backdrop,
    const PixelRect& rect, std::set<VolumeFrame*>& failed);

  vtkRenderer* Renderer;
  vtkBanyanVolumeMapper* Called;
  vtkVolume* CalledVolume;
  PictureView View; ///< while it is drawn
  std::vector<VolumeFrame> Frames;
  Groups Mixed;               ///< of the frames
  bool MixesSurfaces = false; ///< translucent ones, with all volumes that can be mixed
  SurfaceLayers Surfaces;     ///< these
};

} // namespace banyan

#endif
