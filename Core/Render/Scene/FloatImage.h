// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_FloatImage_h
#define banyan_Render_Scene_FloatImage_h

#include "Base/RecycledMemory.h"
#include "Render/Scene/RayCamera.h"

#include <glm/vec4.hpp>

#include <vector>

namespace banyan
{

/// The next picture finds the memory of the one before.
using PixelVector = std::vector<glm::vec4, RecycledMemory<glm::vec4>>;

/// A part of a picture: premultiplied RGBA in float, or what FinishPicture makes that of.
struct FloatImage
{
  PixelRect Rect;
  PixelVector Pixels; ///< `[y][x]`, y up; Rect.Count() of them

  glm::vec4& At(int x, int y)
  {
    const auto row = static_cast<std::size_t>(y - this->Rect.Lo.y);
    return this->Pixels[row * this->Rect.Size().x + (x - this->Rect.Lo.x)];
  }
  const glm::vec4& At(int x, int y) const { return const_cast<FloatImage*>(this)->At(x, y); }
};

} // namespace banyan

#endif
