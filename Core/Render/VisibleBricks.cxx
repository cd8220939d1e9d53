#include "Render/VisibleBricks.h"

#include <glm/matrix.hpp>

#include <algorithm>

namespace banyan
{
namespace
{

/// Pixels around the viewport that pictures of fewer pixels may touch.
constexpr double MarginPixels = 64.0;

/// Whether boxes may be inside the viewport.
class Screen
{
public:
  explicit Screen(const RayScene& scene)
    : IndexToClip(glm::inverse(scene.Camera.ClipToWorldMatrix()) * scene.IndexToWorld)
  {
    const glm::dvec2 size(scene.Camera.ImageSize());
    this->Low = (glm::dvec2(scene.Viewport.Lo) - MarginPixels) / size * 2.0 - 1.0;
    this->High = (glm::dvec2(scene.Viewport.Hi) + MarginPixels) / size * 2.0 - 1.0;
  }

  /// A box is outside when all its corners are on the outer side of one edge of the viewport, seen
  /// from the eye.
  bool MayShow(const Box& box) const
  {
    bool outside[5] = { true, true, true, true, true };
    for (int i = 0; i < 8; ++i)
    {
      const glm::dvec4 clip =
        this->IndexToClip * glm::dvec4((i & 1) ? box.Hi.x : box.Lo.x, (i & 2) ? box.Hi.y : box.Lo.y,
                              (i & 4) ? box.Hi.z : box.Lo.z, 1.0);
      outside[0] = outside[0] && clip.x < this->Low.x * clip.w;
      outside[1] = outside[1] && clip.x > this->High.x * clip.w;
      outside[2] = outside[2] && clip.y < this->Low.y * clip.w;
      outside[3] = outside[3] && clip.y > this->High.y * clip.w;
      outside[4] = outside[4] && clip.w <= 0.0;
    }
    return std::none_of(outside, outside + 5, [](bool all) { return all; });
  }

private:
  glm::dmat4 IndexToClip;
  glm::dvec2 Low;
  glm::dvec2 High;
};

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
  return !range.Empty() && (!this->Composited || ((this->Source.MaskOf(brick) & this->Bins) != 0 &&
                                                   this->Visible.Any(range.Low, range.High)));
}

std::vector<std::int64_t> BricksToLoad(
  const RayScene& scene, const BrickSource& source, const Box& cells)
{
  const VisibleBricks visible(scene, source);
  const Screen screen(scene);
  const std::vector<glm::dvec4> planes = PlanesInIndexSpace(scene.ClipPlanes, scene.IndexToWorld);
  const bool sampled = scene.Shading.On || scene.Blend.Mode != BlendMode::Composite;
  const glm::ivec3 counts = source.Bricks();
  std::vector<std::int64_t> bricks;
  for (std::int64_t brick = 0; brick < std::int64_t{ counts.x } * counts.y * counts.z; ++brick)
  {
    const Box part = Intersection(source.CellsOf(brick), cells);
    if (!part.Empty() && visible.Contains(brick) && !IsCutAway(planes, part) &&
        screen.MayShow(part) && (sampled || !source.UniformValueOf(brick)))
    {
      bricks.push_back(brick);
    }
  }
  return bricks;
}

} // namespace banyan
