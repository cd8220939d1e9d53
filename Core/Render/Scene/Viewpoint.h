// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_Viewpoint_h
#define banyan_Render_Scene_Viewpoint_h

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace banyan
{

class RayCamera;

/// All that a visibility order needs of a camera, in the space of the things that are ordered
/// (index space for bricks and zones).
struct Viewpoint
{
  bool Parallel = false;            ///< parallel projection: only `Direction` counts
  glm::dvec3 Eye{ 0.0 };            ///< perspective: where all rays start; anything if parallel
  glm::dvec3 Direction{ 0, 0, -1 }; ///< parallel: along every ray, away from the viewer; not 0
};

/// The viewpoint of a camera of world space, in index space.
/// @param indexToWorld affine and invertible: sample index (i, j, k) -> world. Mirroring matrices
///        are allowed. Directions need not have unit length in index space.
Viewpoint InIndexSpace(const RayCamera& cameraInWorld, const glm::dmat4& indexToWorld);

} // namespace banyan

#endif
