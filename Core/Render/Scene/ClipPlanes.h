// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_ClipPlanes_h
#define banyan_Render_Scene_ClipPlanes_h

#include "Base/Box.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <vector>

namespace banyan
{

/// Cuts away what lies on its negative side: points p of world space with
/// dot(Normal, p) + Offset < 0. The normal may have any length but 0.
struct ClipPlane
{
  glm::dvec3 Normal{ 0.0 };
  double Offset = 0.0;
};

/// More than these on one volume are a mistake, not a wish.
constexpr std::size_t MostClipPlanes = 64;

/// Cuts away what lies outside a box; empty boxes leave nothing. Sides that are infinitely far away
/// cut nothing.
void AddCropBox(std::vector<ClipPlane>& planes, const glm::dvec3& low, const glm::dvec3& high);

/// Planes in index space, as unit normal and distance in cells.
/// Throws Error when a plane has no normal or is not finite, or when there are too many.
std::vector<glm::dvec4> PlanesInIndexSpace(
  const std::vector<ClipPlane>& planes, const glm::dmat4& indexToWorld);

/// Whether one plane cuts away all samples that positions in these cells may have. Conservative:
/// false when in doubt.
/// @param planes of index space, as PlanesInIndexSpace gives them
bool IsCutAway(const std::vector<glm::dvec4>& planes, const Box& cells);

} // namespace banyan

#endif
