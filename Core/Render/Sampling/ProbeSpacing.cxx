// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/ProbeSpacing.h"

#include "Render/Levels/RayCaster.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace banyan
{
namespace
{

/// Small pictures must not cost much more than themselves.
constexpr int ClosestOfWideVolumes = 8;
constexpr int Widest = 16;
/// Probes side by side across a narrow volume, where rays get ever shorter towards its edges.
constexpr double ProbesAcross = 5.0;
/// Rays per axis that find out how many pixels meet the volume.
constexpr int Probes = 64;

/// Whether a ray, in index space, meets a box of it between the clipping planes.
bool Meets(const Ray& ray, const Box& cells)
{
  double from = ray.Near;
  double to = ray.Far;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double low = cells.Lo[axis] - ray.Origin[axis];
    const double high = cells.Hi[axis] - ray.Origin[axis];
    const double along = ray.Direction[axis];
    if (along == 0.0)
    {
      if (low > 0.0 || high < 0.0)
      {
        return false;
      }
      continue;
    }
    from = std::max(from, std::min(low / along, high / along));
    to = std::min(to, std::max(low / along, high / along));
  }
  return from < to;
}

} // namespace

PixelRect VolumeOnScreen(const RayScene& scene)
{
  const RayCamera camera = scene.Camera.InSpace(scene.IndexToWorld);
  PixelRect rect =
    camera.Footprint(glm::dvec3(scene.DomainCells.Lo), glm::dvec3(scene.DomainCells.Hi));
  if (!rect.Empty())
  {
    rect = Intersection({ rect.Lo - 1, rect.Hi + 1 }, scene.Viewport);
  }
  return rect.Empty() ? scene.Viewport : rect;
}

int ProbeSpacing(const RayScene& scene)
{
  const glm::ivec2 image = scene.Camera.ImageSize();
  const double edge = std::sqrt(static_cast<double>(image.x) * image.y);
  const int most = std::clamp(static_cast<int>(edge / 64.0 + 0.5), ClosestOfWideVolumes, Widest);

  const RayCamera camera = scene.Camera.InSpace(scene.IndexToWorld);
  const PixelRect rect = VolumeOnScreen(scene);
  const glm::ivec2 size = rect.Size();
  const int step = std::max(1, std::max(size.x, size.y) / Probes);
  double met = 0.0;
  for (int y = rect.Lo.y + step / 2; y < rect.Hi.y; y += step)
  {
    for (int x = rect.Lo.x + step / 2; x < rect.Hi.x; x += step)
    {
      met += Meets(camera.RayOf(x, y), scene.DomainCells) ? 1.0 : 0.0;
    }
  }
  const double pixels = met * step * step;
  const double width = pixels / std::max(1.0, glm::length(glm::dvec2(size)));
  const int wanted =
    static_cast<int>(std::min(std::sqrt(pixels / EnoughProbes), width / ProbesAcross));
  return std::clamp(wanted, 1, most);
}

int ProbeSpacingAfter(int spacing, int seen)
{
  // A few less than enough are no reason to begin again.
  if (spacing == 1 || seen >= EnoughProbes / 4)
  {
    return spacing;
  }
  const double nearer = spacing * std::sqrt(static_cast<double>(seen) / EnoughProbes);
  return std::max(1, static_cast<int>(nearer));
}

} // namespace banyan
