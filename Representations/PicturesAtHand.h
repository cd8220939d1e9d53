// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_PicturesAtHand_h
#define banyan_Representations_PicturesAtHand_h

#include "FramebufferExchange.h"
#include "RendererCamera.h"

#include "Render/Raycast/DepthOrder.h"
#include "Render/Scene/BytePicture.h"
#include "Render/Scene/DepthPicture.h"

#include <memory>
#include <string>
#include <vector>

class vtkRenderer;
class vtkVolume;
class vtkWindow;

namespace banyan
{

/// Pictures of a volume that others have drawn, and the window that shows the best of them at once:
/// the exact one of its view; else that of another view, if the eye is the same; else a coarse one
/// of the view; else the newest one, as if it were painted on a plane through the point that the
/// camera looks at. Pictures of several volumes are blended in the order of depth.
class PicturesAtHand
{
public:
  struct Picture
  {
    int Scene = 0;   ///< larger is newer
    int Content = 0; ///< differs where values or functions may do
    bool Exact = false;
    ScreenView View; ///< that it is the picture of
    BytePicture Bytes;
    PlacedBody Body; ///< where the volume is; none where nothing is shown
  };

  /// Takes the place of an older one of its kind.
  void Put(Picture picture);
  /// The last exact picture is that of another view, too: clipping planes may have moved, say.
  void PutSame(int scene, int content, const ScreenView& view);

  /// What is shown now.
  struct Shown
  {
    int Scene = 0;       ///< 0 for nothing
    bool Exact = false;  ///< of the exact picture of the view
    bool OfView = false; ///< the view's own picture, exact or coarse
  };
  /// @param renderer whose window gets the pictures over what is drawn
  /// @param all of its volumes; at least one
  /// @param props of these
  /// @return sentences for users, each once: TellNotInDepth
  static std::string Show(vtkRenderer* renderer, const std::vector<PicturesAtHand*>& all,
    const std::vector<vtkVolume*>& props);
  const Shown& LastShown() const { return this->Last; }
  /// Where other props were when the volume was shown last: rays of its view end there.
  DepthPicture OthersInView() const { return this->Others->Trimmed(); }
  /// Whether there may be some.
  bool HasOthersInView() const { return !this->Others->Rect.Empty(); }

  void ReleaseGraphicsResources(vtkWindow* window);

private:
  using Choice = std::shared_ptr<const BytePicture>; ///< null for none

  std::shared_ptr<const DepthPicture> ReadOthers(
    vtkRenderer* renderer, const std::vector<vtkVolume*>& props, const PixelRect& all);
  static bool IsSharpIn(const ScreenView& view, const Picture& picture);
  const Picture* Best(const ScreenView& view) const;
  Choice Choose(vtkRenderer* renderer, const ScreenView& view);
  void Write(vtkRenderer* renderer, const BytePicture& bytes);
  static std::string TellOnce(
    const std::vector<PicturesAtHand*>& volumes, const std::vector<unsigned char>& bits);

  std::shared_ptr<const Picture> Exact;
  std::shared_ptr<const Picture> Coarse;
  PlacedBody Body; ///< of the picture that is shown
  Shown Last;
  FramebufferExchange Framebuffer;
  std::shared_ptr<const DepthPicture> Others =
    std::make_shared<DepthPicture>(); ///< in the last view
  OpaquePixels Pixels;                ///< kept for its memory
  unsigned char Told = 0;             ///< bits of NotInDepth
};

/// Whether two views are of one picture, whatever its size.
bool IsSameView(const ScreenView& a, const ScreenView& b);

} // namespace banyan

#endif
