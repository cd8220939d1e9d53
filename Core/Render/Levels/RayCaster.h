// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Levels_RayCaster_h
#define banyan_Render_Levels_RayCaster_h

#include "Render/Bricks/BrickSource.h"
#include "Render/Scene/FloatImage.h"
#include "Render/Scene/RayScene.h"

#include <glm/vec4.hpp>

#include <functional>
#include <set>
#include <vector>

namespace banyan
{

class ThreadPool;

struct RayStatistics
{
  std::int64_t SamplesTaken = 0;  ///< without those left out where nothing can be seen
  std::int64_t BricksDrawn = 0;   ///< bricks whose values were loaded, or kept from before
  std::int64_t BricksUniform = 0; ///< of one value: drawn without loading them or taking samples
  std::int64_t BricksSkipped = 0; ///< not loaded: cannot be seen, off screen, or hidden
};

/// Draws all bricks of `source` whose cells lie in `cells`.
///
/// Samples lie at t = (k + 1/2) * SampleDistance on one lattice per ray (see Ray). Each stands for
/// its interval [k, k + 1) * SampleDistance clipped to DomainCells, ClipPlanes and the depth;
/// the sample of an interval that is clipped lies in the middle of what is left of it. Each sample
/// belongs to exactly one cell, whatever the bricks: so pictures of disjoint sets of cells, blended
/// in visibility order, give the picture of their union within 1e-5 in float (rays that end early
/// apart: 1 - OpacityLimit), and the size of bricks, the budget and the threads change no bit.
///
/// Brick by brick, front to back; a batch of bricks, as loaded and as packed for drawing, never
/// takes more than `budgetBytes`, unless one brick alone does. Up to half the budget are packed
/// bricks that the source keeps for the next picture. Bricks that cannot be seen are not loaded: by
/// their range and mask under the transfer function, off screen, or behind pixels that have all
/// reached the opacity limit.
///
/// @param statistics is added to
/// @return pixels that the visible bricks may touch (inside Viewport); may be empty. Unless samples
/// are composited, FinishPicture makes colours of them.
/// Throws Error when the scene is not usable or a brick cannot be read.
FloatImage CastRays(const RayScene& scene, BrickSource& source, const Box& cells,
  std::uint64_t budgetBytes, ThreadPool& pool, RayStatistics& statistics);
/// The same, as the whole viewport: 0 where no brick is.
FloatImage CastViewport(const RayScene& scene, BrickSource& source, const Box& cells,
  std::uint64_t budgetBytes, ThreadPool& pool, RayStatistics& statistics);

/// The levels that tiles of a picture are sampled at.
/// Throws Error when they are those of a picture of another size.
std::set<int> SampledLevels(const RayScene& scene);

/// The finest level of which all that can be seen, as loaded and as packed for drawing, takes at
/// most `bytes`; `coarsest` if there is none. Nothing is loaded to find out.
/// @param coarsest a level that the source has
int FinestLevelWithin(
  const RayScene& scene, BrickSource& source, const Box& cells, int coarsest, std::uint64_t bytes);

/// The slow, obvious reference: double precision, one ray after the other, every sample through
/// all eight corners, no skipping, no early end, no table (`function` gives colour and opacity per
/// UnitDistance of the scene's transfer function for any value). Shares the lattice's definition
/// with CastRays, but of its code only the camera.
/// Draws all that a scene may ask for but shading.
/// @param value gives the sample at an index position (0-based) or NaN
/// @param hidden says which cells are not drawn; empty for none
/// @param colour gives the colour of the sample, 0 to 1, which that of `function` is multiplied by;
/// empty for none
/// @return the whole viewport
FloatImage ReferenceImage(const RayScene& scene,
  const std::function<double(const glm::ivec3&)>& value,
  const std::function<glm::dvec4(double)>& function,
  const std::function<bool(const glm::ivec3&)>& hidden = {},
  const std::function<glm::dvec3(const glm::ivec3&)>& colour = {});

} // namespace banyan

#endif
