// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/VisibleBricks.h"

#include "Render/Scene/BoxOnScreen.h"
#include "Render/Scene/FunctionTables.h"

namespace banyan
{
namespace
{

/// Pixels around the viewport that pictures of fewer pixels may touch.
constexpr double MarginPixels = 64.0;

} // namespace

VisibleBricks::VisibleBricks(const RayScene& scene, const BrickSource& source)
  : Source(source)
  , Visible(FunctionTables::Process().VisibleOf(scene.Transfer))
  , VisibleBins(this->Visible->Bins(source.MasksAreOver()))
  , Composited(scene.Blend.Mode == BlendMode::Composite)
{
}

bool VisibleBricks::Contains(std::int64_t brick) const
{
  const ValueRange range = this->Source.RangeOf(brick);
  return !range.Empty() && !this->Source.AllHidden(brick) &&
         (!this->Composited || ((this->Source.MaskOf(brick) & this->VisibleBins) != 0 &&
                                 this->Visible->Any(range.Low, range.High)));
}

bool VisibleBricks::MayContain(const SummaryNode& node) const
{
  return !node.Range.Empty() &&
         (!this->Composited || ((node.Mask & this->VisibleBins) != 0 &&
                                 this->Visible->Any(node.Range.Low, node.Range.High)));
}

/// Where all bins that occur can be seen, so can those of each brick.
bool VisibleBricks::ContainsAll(const SummaryNode& node) const
{
  return node.Full && !this->Source.Hidden() &&
         (!this->Composited || ((node.Mask & ~this->VisibleBins) == 0 &&
                                 this->Visible->All(node.Range.Low, node.Range.High)));
}

VisibleSigns SignsOf(const RayScene& scene, const BrickSource& source)
{
  const VisibleBricks visible(scene, source);
  const glm::ivec3 counts = source.Bricks();
  VisibleSigns signs;
  visible.ForEach([](const Box&, bool& all) { return all = true; },
    [&](const Box& bricks, const Box&)
    {
      signs.Bricks += bricks.Count();
      if (signs.Bins != visible.Bins())
      {
        ForPositions(bricks, [&](const glm::ivec3& at)
          { signs.Bins |= source.MaskOf(BrickSource::NumberOf(at, counts)) & visible.Bins(); });
      }
    });
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
  // A bit per brick sorts them.
  std::vector<bool> loaded(static_cast<std::size_t>(Box{ glm::ivec3(0), counts }.Count()));
  visible.ForEach(
    [&](const Box& box, bool& all)
    {
      const Box part = Intersection(box, cells);
      all = planes.empty() && part == box && screen.ShowsAll(part);
      return all || (!part.Empty() && !IsCutAway(planes, part) && screen.MayShow(part));
    },
    [&](const Box& bricks, const Box&)
    {
      ForPositions(bricks,
        [&](const glm::ivec3& at)
        {
          const std::int64_t brick = BrickSource::NumberOf(at, counts);
          loaded[static_cast<std::size_t>(brick)] = sampled || !source.IsMacroVoxel(brick);
        });
    });
  std::vector<std::int64_t> bricks;
  for (std::size_t brick = 0; brick < loaded.size(); ++brick)
  {
    if (loaded[brick])
    {
      bricks.push_back(static_cast<std::int64_t>(brick));
    }
  }
  return bricks;
}

} // namespace banyan
