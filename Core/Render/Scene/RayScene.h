// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_RayScene_h
#define banyan_Render_Scene_RayScene_h

#include "Base/Box.h"
#include "Render/Scene/ClipPlanes.h"
#include "Render/Scene/LevelEdges.h"
#include "Render/Scene/RayBlend.h"
#include "Render/Scene/RayCamera.h"
#include "Render/Scene/RaySampling.h"
#include "Render/Scene/TransferFunction.h"

#include <glm/mat4x4.hpp>

#include <memory>
#include <vector>

namespace banyan
{

struct BrickWork;
class SegmentPicture;
class SharedPlans;
class StopFlag;
struct ReusedRays;

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
  LevelEdges Levels{}; ///< of what is drawn: BrickSource::CellEdges
  /// Whether the picture only helps to make another one: packed bricks are kept for that one.
  bool Probe = false;
  /// Whether the picture goes on with the one before, as a further part of it: what is kept of
  /// bricks becomes no older.
  bool GoesOn = false;
  /// Whether the picture is a coarse one, after which another will come: what others kept of bricks
  /// becomes no older.
  bool Passing = false;
  /// Rays that are not cast, as an earlier picture has them; null for none. No part of the picture.
  std::shared_ptr<const ReusedRays> Reused{};
  /// The plan of bricks for pictures that have the same one; null: each makes its own. No part of
  /// the picture.
  std::shared_ptr<SharedPlans> Plans{};
  /// When it asks, casting ends by an Interruption; null for never. No part of the picture.
  const StopFlag* Stop = nullptr;
  /// Where the ray caster adds what bricks took to draw; null for nowhere. No part of the picture.
  BrickWork* Work = nullptr;
  /// Where the ray caster puts what it blends, sample by sample; null for nowhere. What it meets is
  /// composited later, with what other volumes have there. No part of the picture.
  SegmentPicture* Segments = nullptr;
};

} // namespace banyan

#endif
