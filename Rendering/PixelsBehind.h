// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_PixelsBehind_h
#define banyan_Rendering_PixelsBehind_h

#include "Parallel/Composite/ReduceNearest.h"

#include <vector>

namespace banyan
{

/// Turns what each rank has drawn into what lies behind the volume: depths (on all ranks) are the
/// nearest of all ranks; colours (right on rank 0) are those of the nearest, or, when `rankOrder`
/// is not empty, all ranks' blended front to back in that order. Pixels travel only where there is
/// something. Collective.
/// @param statistics is added to
/// @return on all ranks, the rectangle around what rank 0 will blend the volume over; may be empty
PixelRect CombineBehind(Communicator& communicator, const std::vector<int>& rankOrder,
  const PixelRect& rect, OpaquePixels& pixels, CompositeStatistics& statistics);

/// Depths of the pixels; none when nothing was drawn there.
std::vector<float> DepthsOf(const OpaquePixels& pixels);

/// Makes pixels transparent where there is no opaque geometry.
void ClearWithoutGeometry(OpaquePixels& pixels);

/// Blends a part of a premultiplied picture over the pixels of a rectangle that holds it: in float,
/// rounded to 8 bit once. Covered pixels get a depth below 1, so that a compositor that compares
/// depths prefers them to blank ones.
void BlendOver(
  const FloatImage& picture, const PixelRect& part, const PixelRect& rect, OpaquePixels& pixels);

} // namespace banyan

#endif
