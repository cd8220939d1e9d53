// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/BoxOnScreen.h"

#include "Render/Scene/RayScene.h"

#include <glm/matrix.hpp>

namespace banyan
{

BoxOnScreen::BoxOnScreen(const RayScene& scene, double marginPixels)
  : IndexToClip(glm::inverse(scene.Camera.ClipToWorldMatrix()) * scene.IndexToWorld)
{
  const glm::dvec2 size(scene.Camera.ImageSize());
  this->Low = (glm::dvec2(scene.Viewport.Lo) - marginPixels) / size * 2.0 - 1.0;
  this->High = (glm::dvec2(scene.Viewport.Hi) + marginPixels) / size * 2.0 - 1.0;
}

int BoxOnScreen::OuterSides(const Box& samples, int corner) const
{
  const glm::dvec4 clip = this->IndexToClip * glm::dvec4((corner & 1) ? samples.Hi.x : samples.Lo.x,
                                                (corner & 2) ? samples.Hi.y : samples.Lo.y,
                                                (corner & 4) ? samples.Hi.z : samples.Lo.z, 1.0);
  return (clip.x < this->Low.x * clip.w ? 1 : 0) | (clip.x > this->High.x * clip.w ? 2 : 0) |
         (clip.y < this->Low.y * clip.w ? 4 : 0) | (clip.y > this->High.y * clip.w ? 8 : 0) |
         (clip.w <= 0.0 ? 16 : 0);
}

bool BoxOnScreen::MayShow(const Box& samples) const
{
  int common = 31;
  for (int corner = 0; corner < 8; ++corner)
  {
    common &= this->OuterSides(samples, corner);
  }
  return common == 0;
}

bool BoxOnScreen::ShowsAll(const Box& samples) const
{
  int any = 0;
  for (int corner = 0; corner < 8; ++corner)
  {
    any |= this->OuterSides(samples, corner);
  }
  return any == 0;
}

} // namespace banyan
