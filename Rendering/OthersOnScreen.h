// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_OthersOnScreen_h
#define banyan_Rendering_OthersOnScreen_h

#include "Render/Scene/RayCamera.h"

#include <vector>

class vtkRenderer;
class vtkVolume;

namespace banyan
{

/// Where other visible props of this rank may have drawn something: the smallest rectangle around
/// their bounds on the screen, and some pixels for the widths of lines and points. Only of actors
/// with plain polygons and of volumes are bounds known to hold all that they draw: where anything
/// else is visible (axes, splats, geometry fixed to the window), it is all of `rect`. Texts, scalar
/// bars and other 2-D actors of VTK do not count: they are drawn over volumes, after them.
/// @param own do not count
PixelRect OthersOnScreen(
  vtkRenderer* renderer, const std::vector<vtkVolume*>& own, const PixelRect& rect);

} // namespace banyan

#endif
