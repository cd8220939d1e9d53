// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_Backdrop_h
#define banyan_Rendering_Backdrop_h

#include "FramebufferExchange.h"

#include "Parallel/Composite/ReduceNearest.h"
#include "Render/Scene/FloatImage.h"

#include <vector>

class vtkRenderer;
class vtkVolume;
class vtkWindow;

namespace banyan
{

/// The picture of other props where volumes are to be drawn: on all ranks, nearest first. Pixels
/// are read and travel only in the rectangle where some rank has other props on the screen
/// (OthersOnScreen): where none has any, it costs nothing. Elsewhere it takes 8 bytes a pixel.
class Backdrop
{
public:
  /// Where the renderer's first pixel is in pictures, which has rectangles count from another one.
  void SetCorner(const glm::ivec2& corner) { this->Corner = corner; }

  /// Collective.
  /// @param own the volumes' props
  /// @param rect that volumes are drawn in
  /// @param rankOrder see CombineBehind
  /// @param statistics is added to
  void Read(Communicator& communicator, vtkRenderer* renderer, const std::vector<vtkVolume*>& own,
    const PixelRect& rect, const std::vector<int>& rankOrder, CompositeStatistics& statistics);

  /// The rectangle around what rank 0 blends volumes over; the same on all ranks.
  const PixelRect& Behind() const { return this->BehindRect; }
  /// At which rays end in a part of the picture; empty where nothing is.
  std::vector<float> Depths(const PixelRect& part) const;

  /// How many pixels this rank has read.
  long long PixelsRead() const { return this->Inner.Count(); }

  /// Writes a finished part of the picture over it, and over a background that is there already.
  /// @param part of the rectangle: each pixel is in one part
  /// @param picture of the part, or of less of it; only rank 0 has one
  void Write(const Communicator& communicator, vtkRenderer* renderer, const PixelRect& part,
    const FloatImage& picture);

  /// Writes a picture over what is there, in 8 bit: of a rank that shows it alone.
  void WriteOver(vtkRenderer* renderer, const FloatImage& picture);

  /// Gives back the memory of what was read.
  void Forget();

  void ReleaseGraphicsResources(vtkWindow* window);

private:
  void WriteOverBackground(
    vtkRenderer* renderer, const PixelRect& rows, const FloatImage& picture, bool alone);
  void Put(
    vtkRenderer* renderer, const PixelRect& rect, const std::vector<PixelRect>& parts, bool blend);
  PixelRect InRenderer(const PixelRect& rect) const;

  FramebufferExchange Framebuffer;
  glm::ivec2 Corner{ 0 };
  PixelRect Rect;
  PixelRect Inner; ///< where some rank shows something else; the same on all ranks
  PixelRect BehindRect;
  OpaquePixels InnerPixels; ///< of Inner
  OpaquePixels Pixels;      ///< kept for its memory, as pictures come one after the other
};

} // namespace banyan

#endif
