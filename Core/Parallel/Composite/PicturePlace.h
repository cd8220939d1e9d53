// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_PicturePlace_h
#define banyan_Parallel_Composite_PicturePlace_h

#include "Render/Scene/RayCamera.h"

namespace banyan
{

/// Where pixels of a picture end: on the rank that shows them.
struct PicturePlace
{
  PixelRect Rect;   ///< of the whole picture
  int Root = 0;     ///< the rank
  PixelRect Behind; ///< pixels under which the root has something that it will blend them over
};

} // namespace banyan

#endif
