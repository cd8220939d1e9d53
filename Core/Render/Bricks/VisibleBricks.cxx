// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/VisibleBricks.h"

#include "Render/Scene/BoxOnScreen.h"

namespace banyan
{
namespace
{

/// Pixels around the viewport that pictures of fewer pixels may touch.
constexpr double MarginPixels = 64.0;

} // namespace

VisibleBricks::VisibleBricks(const RayScene& scene, const BrickSource& source)
  : Source(source)
  , Visible(scene.Transfer)
  , Bins(scene.Transfer.VisibleBins(source.MasksAreOver()))
  , Composited(scene.Blend.Mode == BlendMode::Composite)
{
}

bool VisibleBricks::Contains(std::int64_t brick) const
{
  const ValueRange range = this->Source.RangeOf(brick);
  return !range.Empty() && !this->Source.AllHidden(brick) &&
         (!this->Composited || ((this->Source.MaskOf(brick) & this->Bins) != 0 &&
                                 this->Visible.Any(range.Low, range.High)));
}

VisibleSigns SignsOf(const RayScene& scene, const BrickSource& source)
{
  const VisibleBricks visible(scene, source);
  const ValueMask bins = scene.Transfer.VisibleBins(source.MasksAreOver());
  const glm::ivec3 counts = source.Bricks();
  VisibleSigns signs;
  for (std::int64_t brick = 0; brick < std::int64_t{ counts.x } * counts.y * counts.z; ++brick)
  {
    if (visible.Contains(brick))
    {
      ++signs.Bricks;
      signs.Bins |= source.MaskOf(brick) & bins;
    }
  }
  return signs;
}

std::vector<std::int64_t> BricksToLoad(
  const RayScene& scene, const BrickSource& source, const Box& cells)
{
  const VisibleBricks visible(scene, source);
  const BoxOnScreen screen(scene, MarginPixels);
  const std::vector<glm::dvec4> planes = PlanesInIndexSpace(scene.ClipPlanes, scene.IndexToWorld);
  const bool sampled = scene.Shading.On || scene.Blend.Mode != BlendMode::Composite;
  const glm::ivec3 counts = source.Bricks();
  std::vector<std::int64_t> bricks;
  for (std::int64_t brick = 0; brick < std::int64_t{ counts.x } * counts.y * counts.z; ++brick)
  {
    const Box part = Intersection(source.CellsOf(brick), cells);
    if (!part.Empty() && visible.Contains(brick) && !IsCutAway(planes, part) &&
        screen.MayShow(part) && (sampled || !source.IsMacroVoxel(brick)))
    {
      bricks.push_back(brick);
    }
  }
  return bricks;
}

} // namespace banyan
