// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/SubsamplingProbe.h"

#include "Render/Sampling/ProbeSpacing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

constexpr int Spacing = 4;
/// Where so much is allowed, a quarter of the probes will do.
constexpr double MuchAllowed = 12.0;
/// Probes this close leave less to chance than those of samples do.
constexpr double Safety = 3.0;
constexpr double TilesAround = 1.5;
/// At most so many times smaller are errors taken to be at half the stride. Smooth pictures have 4,
/// but may have an edge that is too faint to be seen beside how they bend.
constexpr double MostGain = 2.0;
/// Of the largest error anywhere, what each tile is taken to have at least.
constexpr double ShareOfLargest = 1.0 / 16.0;

/// How far each pixel is from what lies between those that are `every` apart, along both axes.
/// @param part of the image that the picture is
ProbeErrors ErrorsBetween(const ProbeImage& picture, const PixelRect& part, int every)
{
  const glm::ivec2 size = part.Size();
  // Around the volume is nothing; at the edge of the picture its last pixels go on.
  const auto inside = [&](int position, int axis)
  { return std::clamp(position, part.Lo[axis], part.Hi[axis] - 1) - part.Lo[axis]; };
  const auto rowAt = [&](int y)
  { return picture.Pixels.data() + static_cast<std::ptrdiff_t>(inside(y, 1)) * size.x; };
  const int first = part.Lo.x / every;
  std::vector<glm::vec4> columns(static_cast<std::size_t>((part.Hi.x - 1) / every - first + 2));
  ProbeErrors errors;
  errors.Pixels.resize(picture.Pixels.size());
  for (int y = part.Lo.y; y < part.Hi.y; ++y)
  {
    const int below = y / every * every;
    const float up = static_cast<float>(y - below) / static_cast<float>(every);
    const glm::vec4* const low = rowAt(below);
    const glm::vec4* const high = rowAt(below + every);
    for (std::size_t i = 0; i < columns.size(); ++i)
    {
      const int x = inside((first + static_cast<int>(i)) * every, 0);
      columns[i] = glm::mix(low[x], high[x], up);
    }
    const glm::vec4* const row = rowAt(y) - part.Lo.x;
    float* const error = errors.Pixels.data() + static_cast<std::ptrdiff_t>(y - part.Lo.y) * size.x;
    for (std::size_t i = 0; i + 1 < columns.size(); ++i)
    {
      const int left = (first + static_cast<int>(i)) * every;
      const glm::vec4 slope = (columns[i + 1] - columns[i]) / static_cast<float>(every);
      for (int x = std::max(left, part.Lo.x); x < std::min(left + every, part.Hi.x); ++x)
      {
        const glm::vec4 between = columns[i] + slope * static_cast<float>(x - left);
        error[x - part.Lo.x] = ProbeErrors::Between(row[x], between);
      }
    }
  }
  return errors;
}

} // namespace

SubsamplingProbe::SubsamplingProbe(
  const RayScene& scene, std::function<FloatImage(const RayScene& probe)> draw, double allowed)
  : Scene(scene)
  , Pictures(scene, std::move(draw), allowed < MuchAllowed ? Spacing : 2 * Spacing, TilesAround)
{
}

bool SubsamplingProbe::MaySay(const RayScene& scene, int pixelsApart)
{
  return pixelsApart >= Spacing && scene.Blend.Mode == BlendMode::Composite;
}

bool SubsamplingProbe::MayPay(const ProbeImages& samples, double allowed)
{
  const double apart = samples.PixelsApart();
  const double near = ErrorsBetween(samples.Last(), samples.Part(), 2).Largest();
  const double far = ErrorsBetween(samples.Last(), samples.Part(), 4).Largest();
  // Smooth pictures have 4.
  const double gain = near > 0.0 ? std::clamp(far / near, 1.0, 4.0) : 1.0;
  const double eight = near * std::pow(gain, std::log2(RaySampling::LargestStride / (2.0 * apart)));
  const double least = Safety * ShareOfLargest * eight / (MostGain * MostGain);
  return least <= allowed;
}

void SubsamplingProbe::Draw(const RaySampling& sampling)
{
  const ProbeImage picture = this->Pictures.Draw(sampling);
  this->Near =
    this->Pictures.ErrorsOf(ErrorsBetween(picture, this->Pictures.Part(), 2), 1.0, ShareOfLargest);
  this->Far =
    this->Pictures.ErrorsOf(ErrorsBetween(picture, this->Pictures.Part(), 4), 1.0, ShareOfLargest);
  this->Whole = this->MakeWholeTiles();
}

TileErrors SubsamplingProbe::ErrorsAt(int stride) const
{
  TileErrors errors = this->Near;
  for (std::size_t tile = 0; tile < errors.Tiles.size(); ++tile)
  {
    double& error = errors.Tiles[tile];
    const double larger = this->Far.Of(tile);
    const double gain = error > 0.0 ? std::clamp(larger / error, 1.0, MostGain) : 1.0;
    error *= Safety;
    for (int i = 2 * this->Pictures.PixelsApart(); i > stride; i /= 2)
    {
      error /= gain;
    }
    if (!this->Whole[tile])
    {
      error = std::numeric_limits<double>::infinity();
    }
  }
  return errors;
}

/// InterpolateSkippedPixels needs a tile's first pixels, and the first behind it, along both axes:
/// they must be inside the viewport, or outside of the volume. At the edge of a picture nothing
/// lies behind.
std::vector<bool> SubsamplingProbe::MakeWholeTiles() const
{
  const PixelRect& view = this->Scene.Viewport;
  const PixelRect volume = VolumeOnScreen(this->Scene);
  const glm::ivec2 tiles = TileSamplings::TilesOf(this->Pictures.ImageSize());
  std::vector<bool> whole;
  for (int y = 0; y < tiles.y; ++y)
  {
    for (int x = 0; x < tiles.x; ++x)
    {
      const glm::ivec2 low = glm::ivec2(x, y) * TileSamplings::Edge;
      const glm::ivec2 high = low + TileSamplings::Edge;
      bool inside = true;
      for (int axis = 0; axis < 2; ++axis)
      {
        // What is wanted of the volume ends where the viewport does, or before.
        inside = inside && (low[axis] >= view.Lo[axis] || volume.Lo[axis] > view.Lo[axis]) &&
                 (high[axis] < view.Hi[axis] || volume.Hi[axis] < view.Hi[axis]);
      }
      whole.push_back(inside && !this->HasGeometry({ low, high + 1 }));
    }
  }
  return whole;
}

bool SubsamplingProbe::HasGeometry(const PixelRect& pixels) const
{
  const PixelRect& view = this->Scene.Viewport;
  const PixelRect part = Intersection(pixels, view);
  bool found = false;
  for (int y = part.Lo.y; y < part.Hi.y && !this->Scene.Depth.empty() && !found; ++y)
  {
    const float* const row = this->Scene.Depth.data() +
                             static_cast<std::ptrdiff_t>(y - view.Lo.y) * view.Size().x - view.Lo.x;
    found = std::any_of(row + part.Lo.x, row + part.Hi.x, [](float depth) { return depth < 1.0f; });
  }
  return found;
}

} // namespace banyan
