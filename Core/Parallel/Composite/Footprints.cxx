// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/Footprints.h"

#include <glm/matrix.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace banyan
{
namespace
{

/// Room for rounding around a hull, in pixels; as in RayCamera::Footprint.
constexpr double Slack = 0.01;

/// Corners of a box behind the near plane and points where edges meet it, in pixels; none when a
/// point cannot be projected.
std::optional<std::vector<glm::dvec2>> ProjectedPoints(const glm::dmat4& worldToClip,
  const glm::ivec2& imageSize, const glm::dvec3& low, const glm::dvec3& high)
{
  std::array<glm::dvec4, 8> corner;
  std::array<double, 8> behindNear;
  for (int i = 0; i < 8; ++i)
  {
    const glm::dvec3 p(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    corner[i] = worldToClip * glm::dvec4(p, 1.0);
    behindNear[i] = corner[i].z + corner[i].w;
  }
  std::vector<glm::dvec2> points;
  bool projected = true;
  const auto add = [&](const glm::dvec4& clip)
  {
    const glm::dvec2 pixel = (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(imageSize);
    projected = projected && clip.w > 0.0 && std::isfinite(pixel.x) && std::isfinite(pixel.y);
    points.push_back(pixel);
  };
  for (int i = 0; i < 8; ++i)
  {
    if (behindNear[i] >= 0.0)
    {
      add(corner[i]);
    }
    for (int axis = 1; axis < 8; axis <<= 1)
    {
      const int j = i | axis;
      if (j != i && (behindNear[i] < 0.0) != (behindNear[j] < 0.0))
      {
        add(
          corner[i] + (corner[j] - corner[i]) * (behindNear[i] / (behindNear[i] - behindNear[j])));
      }
    }
  }
  return projected ? std::make_optional(points) : std::nullopt;
}

double Cross(const glm::dvec2& o, const glm::dvec2& a, const glm::dvec2& b)
{
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/// Andrew's monotone chain: half of the hull, by increasing y when `points` are.
template <typename Iterator>
std::vector<glm::dvec2> HalfHull(Iterator begin, Iterator end, double side)
{
  std::vector<glm::dvec2> chain;
  for (Iterator point = begin; point != end; ++point)
  {
    while (chain.size() > 1 && side * Cross(chain[chain.size() - 2], chain.back(), *point) <= 0.0)
    {
      chain.pop_back();
    }
    chain.push_back(*point);
  }
  return chain;
}

/// x of a chain at the height y, which lies between its ends.
double At(const std::vector<glm::dvec2>& chain, double y)
{
  const auto above = std::upper_bound(chain.begin(), chain.end(), y,
    [](double height, const glm::dvec2& point) { return height < point.y; });
  if (above == chain.begin() || above == chain.end())
  {
    return above == chain.begin() ? chain.front().x : chain.back().x;
  }
  const glm::dvec2& a = *(above - 1);
  const glm::dvec2& b = *above;
  return a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
}

int Clamped(double value, int low, int high)
{
  return static_cast<int>(std::clamp(value, static_cast<double>(low), static_cast<double>(high)));
}

/// Outermost x of a chain over the heights [low, high]: at its ends or at a point between them.
double Outermost(const std::vector<glm::dvec2>& chain, double low, double high, double side)
{
  const double bottom = chain.front().y;
  const double top = chain.back().y;
  double most = side * At(chain, std::clamp(low, bottom, top));
  most = std::max(most, side * At(chain, std::clamp(high, bottom, top)));
  for (const glm::dvec2& point : chain)
  {
    most = point.y >= low && point.y <= high ? std::max(most, side * point.x) : most;
  }
  return side * most;
}

Footprint Rasterised(std::vector<glm::dvec2> points, const PixelRect& viewport)
{
  std::sort(points.begin(), points.end(),
    [](const glm::dvec2& a, const glm::dvec2& b)
    { return a.y < b.y || (a.y == b.y && a.x < b.x); });
  const std::vector<glm::dvec2> right = HalfHull(points.begin(), points.end(), 1.0);
  const std::vector<glm::dvec2> left = HalfHull(points.begin(), points.end(), -1.0);

  Footprint footprint;
  footprint.Rect.Lo.y =
    Clamped(std::ceil(points.front().y - 0.5 - Slack), viewport.Lo.y, viewport.Hi.y);
  footprint.Rect.Hi.y =
    Clamped(std::floor(points.back().y - 0.5 + Slack) + 1.0, viewport.Lo.y, viewport.Hi.y);
  footprint.Rect.Lo.x = viewport.Hi.x;
  footprint.Rect.Hi.x = viewport.Lo.x;
  for (int y = footprint.Rect.Lo.y; y < footprint.Rect.Hi.y; ++y)
  {
    const double low = y + 0.5 - Slack;
    const double high = y + 0.5 + Slack;
    const double first = Outermost(left, low, high, -1.0);
    const double last = Outermost(right, low, high, 1.0);
    Footprint::Interval row;
    row.Lo = Clamped(std::ceil(first - 0.5 - Slack), viewport.Lo.x, viewport.Hi.x);
    row.Hi = Clamped(std::floor(last - 0.5 + Slack) + 1.0, viewport.Lo.x, viewport.Hi.x);
    footprint.Rows.push_back(row);
    if (row.Lo < row.Hi)
    {
      footprint.Rect.Lo.x = std::min(footprint.Rect.Lo.x, row.Lo);
      footprint.Rect.Hi.x = std::max(footprint.Rect.Hi.x, row.Hi);
    }
  }
  return footprint.Rect.Empty() ? Footprint{} : footprint;
}

} // namespace

Footprint FootprintOf(
  const RayCamera& camera, const glm::dvec3& low, const glm::dvec3& high, const PixelRect& viewport)
{
  const glm::dmat4 worldToClip = glm::inverse(camera.ClipToWorldMatrix());
  const auto points = ProjectedPoints(worldToClip, camera.ImageSize(), low, high);
  if (!points)
  {
    return FootprintOf(viewport, viewport);
  }
  return points->empty() ? Footprint{} : Rasterised(*points, viewport);
}

Footprint FootprintOf(const PixelRect& rect, const PixelRect& viewport)
{
  Footprint footprint;
  footprint.Rect = Intersection(rect, viewport);
  footprint.Rows.assign(static_cast<std::size_t>(footprint.Rect.Size().y),
    { footprint.Rect.Lo.x, footprint.Rect.Hi.x });
  return footprint;
}

std::vector<Footprint> FootprintsOfZones(const RayCamera& camera, const glm::dmat4& indexToWorld,
  const std::vector<Box>& zones, const PixelRect& viewport)
{
  const RayCamera inIndexSpace = camera.InSpace(indexToWorld);
  std::vector<Footprint> footprints;
  footprints.reserve(zones.size());
  for (const Box& zone : zones)
  {
    footprints.push_back(
      zone.Empty() ? Footprint{}
                   : FootprintOf(inIndexSpace, glm::dvec3(zone.Lo), glm::dvec3(zone.Hi), viewport));
  }
  return footprints;
}

} // namespace banyan
