// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Raycast_SegmentsToWorld_h
#define banyan_Render_Raycast_SegmentsToWorld_h

#include "Render/Raycast/RaySegments.h"
#include "Render/Scene/RayCamera.h"

#include <glm/mat4x4.hpp>

namespace banyan
{

/// Takes places along the rays of a space of its own to the world's, where volumes of other spaces
/// can be compared: a length there is another one here, and so is t = 0 of parallel projections.
/// @param camera in that space, of the whole picture
/// @param toWorld affine: from that space
void SegmentsToWorld(
  std::vector<TileSegments>& tiles, const RayCamera& camera, const glm::dmat4& toWorld);

} // namespace banyan

#endif
