// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/Viewpoint.h"

#include "Render/Scene/RayCamera.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace banyan
{

Viewpoint InIndexSpace(const RayCamera& cameraInWorld, const glm::dmat4& indexToWorld)
{
  const glm::dmat4 worldToIndex = glm::inverse(indexToWorld);
  Viewpoint view;
  view.Parallel = cameraInWorld.Parallel();
  view.Eye = glm::dvec3(worldToIndex * glm::dvec4(cameraInWorld.Eye(), 1.0));
  view.Direction = glm::dmat3(worldToIndex) * cameraInWorld.ViewDirection();
  return view;
}

} // namespace banyan
