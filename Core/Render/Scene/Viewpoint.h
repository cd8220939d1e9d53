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

/// The octant around a place that a viewer is in, or looks from: bit k for the upper side of axis
/// k. Octants that have n bits other than it come after those with fewer: `nearest ^ steps` goes
/// through them front to back, with steps from 0 to 7.
/// @param view, middle in the same space
inline int NearestOctant(const Viewpoint& view, const glm::dvec3& middle)
{
  int nearest = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool high = view.Parallel ? view.Direction[axis] < 0.0 : view.Eye[axis] >= middle[axis];
    nearest |= high ? 1 << axis : 0;
  }
  return nearest;
}

/// The viewpoint of a camera of world space, in index space.
/// @param indexToWorld affine and invertible: sample index (i, j, k) -> world. Mirroring matrices
///        are allowed. Directions need not have unit length in index space.
Viewpoint InIndexSpace(const RayCamera& cameraInWorld, const glm::dmat4& indexToWorld);

} // namespace banyan

#endif
