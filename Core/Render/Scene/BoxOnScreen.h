// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_BoxOnScreen_h
#define banyan_Render_Scene_BoxOnScreen_h

#include "Base/Box.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

namespace banyan
{

struct RayScene;

/// Whether boxes of samples lie in the viewport of a scene.
class BoxOnScreen
{
public:
  /// @param marginPixels around the viewport that count as inside
  BoxOnScreen(const RayScene& scene, double marginPixels);

  /// False when the box is surely outside: all its corners are on the outer side of one edge of the
  /// viewport, seen from the eye, or behind the eye.
  bool MayShow(const Box& samples) const;
  /// Whether all of it is inside.
  bool ShowsAll(const Box& samples) const;

private:
  /// Bit k: outside of edge k. Left, right, lower, upper, behind the eye.
  int OuterSides(const Box& samples, int corner) const;

  glm::dmat4 IndexToClip;
  glm::dvec2 Low;
  glm::dvec2 High;
};

} // namespace banyan

#endif
