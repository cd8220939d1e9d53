// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_ReduceNearest_h
#define banyan_Parallel_Composite_ReduceNearest_h

#include "Base/RecycledMemory.h"
#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Composite/CompositeStatistics.h"
#include "Render/Scene/FloatImage.h"

#include <cstdint>
#include <vector>

namespace banyan
{

/// Opaque geometry as one rank sees it: nearest depth in [0, 1] and 8-bit colour per pixel.
struct OpaquePixel
{
  float Depth;
  std::uint8_t Color[4]; ///< RGBA, premultiplied
};

/// Pixels in memory of the picture before: as the camera moves, each picture has another size.
using OpaquePixels = std::vector<OpaquePixel, RecycledMemory<OpaquePixel>>;

/// Collective: every rank gets, per pixel, the nearest of all ranks (the lower rank wins a tie).
void ReduceNearest(Communicator& communicator, OpaquePixels& pixels);

/// ReduceNearest where some rank has geometry (a depth below 1); elsewhere nothing is sent, and
/// every rank keeps its own pixels. Collective.
/// @param pixels of `rect`, `[y][x]`
/// @return the rectangle around the geometry of all ranks, in which pixels were sent; may be empty
PixelRect ReduceNearestGeometry(Communicator& communicator, const PixelRect& rect,
  OpaquePixels& pixels, CompositeStatistics& statistics);

/// Smallest rectangle around the pixels of `rect` for which `wanted` holds.
template <typename Wanted>
PixelRect RectAround(const PixelRect& rect, const OpaquePixels& pixels, const Wanted& wanted)
{
  PixelRect around;
  std::size_t next = 0;
  for (int y = rect.Lo.y; y < rect.Hi.y; ++y)
  {
    for (int x = rect.Lo.x; x < rect.Hi.x; ++x)
    {
      if (wanted(pixels[next++]))
      {
        around = Union(around, { { x, y }, { x + 1, y + 1 } });
      }
    }
  }
  return around;
}

} // namespace banyan

#endif
