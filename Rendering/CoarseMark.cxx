// SPDX-License-Identifier: BSD-3-Clause
#include "CoarseMark.h"

#include "RendererCamera.h"

#include "Parallel/Composite/Footprints.h"

#include "vtkRenderer.h"

namespace banyan
{

void CoarseMark::Write(vtkRenderer* renderer, const double* bounds)
{
  PixelRect part{ glm::ivec2(0), ViewOf(renderer).Size };
  if (bounds)
  {
    part = FootprintOf(CameraOf(renderer, glm::dvec3(0.0)), { bounds[0], bounds[2], bounds[4] },
      { bounds[1], bounds[3], bounds[5] }, part)
             .Rect;
  }
  const glm::ivec2 high = part.Hi - Margin;
  const PixelRect rect{ high - Side, high };
  if (rect.Lo.x < part.Lo.x || rect.Lo.y < part.Lo.y)
  {
    return;
  }
  constexpr OpaquePixel orange{ 0.0f, { 255, 150, 0, 255 } };
  const OpaquePixels pixels(static_cast<std::size_t>(rect.Count()), orange);
  this->Framebuffer.Write(renderer, rect, pixels, { rect }, /*blend=*/true);
}

} // namespace banyan
