// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_RayCaster_h
#define banyan_Render_RayCaster_h

#include "Render/BrickSource.h"
#include "Render/ClipPlanes.h"
#include "Render/FloatImage.h"
#include "Render/RayBlend.h"
#include "Render/RayCamera.h"
#include "Render/RaySampling.h"
#include "Render/TransferFunction.h"
#include "Render/Viewpoint.h"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <functional>
#include <memory>
#include <vector>

namespace banyan
{

struct BrickWork;
class ThreadPool;

/// Light from the viewer, along each ray. With c = |normal . ray|, the colour of a sample becomes
/// colour * (Ambient + Diffuse * c) + Specular * c^SpecularPower, before it is weighted with its
/// opacity. Normals are those of the gradient; where that is 0 only the ambient part is left.
///
/// The gradient is interpolated between samples, where it is the difference of the neighbours on
/// both sides (of the one that there is at the edge of the volume, or beside values that are not
/// finite).
struct RayShading
{
  bool On = false;
  float Ambient = 0.3f;
  float Diffuse = 0.7f;
  float Specular = 0.0f;
  float SpecularPower = 10.0f; ///< the power of the nearest of 4096 values of c is taken
};

/// All that decides the picture, except the values.
struct RayScene
{
  RayCamera Camera;               ///< in world space, of the whole picture
  PixelRect Viewport;             ///< the pixels wanted, inside the picture
  glm::dmat4 IndexToWorld{ 1.0 }; ///< affine: sample index (i, j, k) from 0 -> world
  Box DomainCells; ///< all cells of the whole grid (of all ranks): where rays begin and end
  TransferFunction Transfer;
  double SampleDistance = 1.0; ///< world length between samples; > 0
  float OpacityLimit = 0.999f; ///< a ray ends when its opacity reaches this
  /// Depth in [0, 1] per pixel of Viewport at which rays end, `[y][x]`; empty means no geometry.
  std::vector<float> Depth{};
  RayShading Shading{};                ///< without effect unless samples are composited
  std::vector<ClipPlane> ClipPlanes{}; ///< at most MostClipPlanes
  SampleInterpolation Interpolation = SampleInterpolation::Linear;
  RayBlend Blend{};
  /// In place of SampleDistance; of the whole picture. Null samples the finest level everywhere.
  std::shared_ptr<const TileSamplings> Samplings{};
  /// Whether all levels are counted in cells of the finest one (BrickSource::CellLevel): zones are
  /// the same at all levels then.
  bool LevelsShareCells = false;
  /// Whether the picture only helps to make another one: packed bricks are kept for that one.
  bool Pilot = false;
  /// Where the ray caster adds what bricks took to draw; null for nowhere. No part of the picture.
  BrickWork* Work = nullptr;
};

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

/// The finest level of which all that can be seen, as loaded and as packed for drawing, takes at
/// most `bytes`; `coarsest` if there is none. Nothing is loaded to find out.
/// @param coarsest a level that the source has
int FinestLevelWithin(const RayScene& scene, BrickSource& source, const Box& cells, int coarsest,
  std::uint64_t bytes, ThreadPool& pool);

/// Cells of a level that begin in cells of the finest one: of disjoint boxes they are disjoint.
Box CellsAtLevel(const Box& cells, int level);

/// Bricks of `source` with cells in `cells` in front-to-back order. Exact for bricks that are cut
/// from a grid by whole planes; the eye may be inside.
/// @param view in index space
std::vector<std::int64_t> VisibilityOrder(
  const Viewpoint& view, const BrickSource& source, const Box& cells);

/// The slow, obvious reference: double precision, one ray after the other, every sample through
/// all eight corners, no skipping, no early end, no table (`function` gives colour and opacity per
/// UnitDistance of the scene's transfer function for any value). Shares the lattice's definition
/// with CastRays, but of its code only the camera.
/// Draws all that a scene may ask for but shading.
/// @param value gives the sample at an index position (0-based) or NaN
/// @param hidden says which cells are not drawn; empty for none
/// @return the whole viewport
FloatImage ReferenceImage(const RayScene& scene,
  const std::function<double(const glm::ivec3&)>& value,
  const std::function<glm::dvec4(double)>& function,
  const std::function<bool(const glm::ivec3&)>& hidden = {});

} // namespace banyan

#endif
