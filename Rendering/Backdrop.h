#ifndef banyan_Rendering_Backdrop_h
#define banyan_Rendering_Backdrop_h

#include "FramebufferExchange.h"

#include "Parallel/DirectSend.h"
#include "Render/FloatImage.h"

#include <vector>

class vtkProp;
class vtkRenderer;
class vtkWindow;

namespace banyan
{

/// What other props have drawn where a volume is to be drawn: on all ranks, nearest first. Where no
/// rank has anything else to show it costs nothing: no pixel is read, none travels, and none is
/// written but the volume's own.
class Backdrop
{
public:
  /// Collective.
  /// @param self the volume's prop
  /// @param rankOrder see CombineBehind
  /// @param statistics is added to
  void Read(Communicator& communicator, vtkRenderer* renderer, vtkProp* self, const PixelRect& rect,
    const std::vector<int>& rankOrder, CompositeStatistics& statistics);

  /// The rectangle around what rank 0 blends the volume over; the same on all ranks.
  const PixelRect& Behind() const { return this->BehindRect; }
  /// At which rays end; empty where nothing is.
  std::vector<float> Depths() const;

  /// Writes the finished volume over it.
  /// @param picture of the rectangle that was read; only rank 0 has one
  void Write(const Communicator& communicator, vtkRenderer* renderer, const FloatImage& picture);

  void ReleaseGraphicsResources(vtkWindow* window);

private:
  FramebufferExchange Framebuffer;
  PixelRect Rect;
  PixelRect BehindRect;
  bool Shows = false; ///< whether any rank shows something else; the same on all
  std::vector<OpaquePixel> Pixels;
};

/// Whether the renderer has something to show but the prop: any other prop that is visible, or,
/// where several ranks draw, a background that is there already.
bool ShowsOthers(vtkRenderer* renderer, vtkProp* self);

} // namespace banyan

#endif
