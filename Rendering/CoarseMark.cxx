// SPDX-License-Identifier: BSD-3-Clause
#include "CoarseMark.h"

#include "RendererCamera.h"

#include "vtkRenderer.h"

namespace banyan
{

void CoarseMark::Write(vtkRenderer* renderer)
{
  const glm::ivec2 high = ViewOf(renderer).Size - Margin;
  const PixelRect rect{ high - Side, high };
  if (rect.Lo.x < 0 || rect.Lo.y < 0)
  {
    return;
  }
  constexpr OpaquePixel orange{ 0.0f, { 255, 150, 0, 255 } };
  const OpaquePixels pixels(static_cast<std::size_t>(rect.Count()), orange);
  this->Framebuffer.Write(renderer, rect, pixels, { rect }, /*blend=*/true);
}

} // namespace banyan
