// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/TileDepths.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace banyan
{
namespace
{

constexpr int BlocksPerAxis = 16;

using Corners = std::array<glm::dvec4, 8>; ///< in clip space, x fastest
using Polygon = std::vector<glm::dvec4>;

/// What bounds the picture: the products with points inside are not negative.
constexpr std::array<glm::dvec4, 4> Edges = { glm::dvec4(1.0, 0.0, 0.0, 1.0),
  glm::dvec4(-1.0, 0.0, 0.0, 1.0), glm::dvec4(0.0, 1.0, 0.0, 1.0),
  glm::dvec4(0.0, -1.0, 0.0, 1.0) };

/// Whether all corners are beyond one of the planes that bound the picture, or behind the eye.
bool OffScreen(const Corners& corners)
{
  const auto all = [&corners](auto&& beyond)
  { return std::all_of(corners.begin(), corners.end(), beyond); };
  return std::any_of(Edges.begin(), Edges.end(),
           [&](const glm::dvec4& edge)
           { return all([&](const glm::dvec4& p) { return glm::dot(p, edge) < 0.0; }); }) ||
         all([](const glm::dvec4& p) { return !(p.w > 0.0); });
}

/// The part of a convex polygon whose products with a plane are at least so large.
Polygon Clipped(const Polygon& polygon, const glm::dvec4& plane, double least)
{
  Polygon inside;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const glm::dvec4& a = polygon[i];
    const glm::dvec4& b = polygon[(i + 1) % polygon.size()];
    const double da = glm::dot(a, plane) - least;
    const double db = glm::dot(b, plane) - least;
    if (da >= 0.0)
    {
      inside.push_back(a);
    }
    if ((da >= 0.0) != (db >= 0.0))
    {
      inside.push_back(a + da / (da - db) * (b - a));
    }
  }
  return inside;
}

/// Corners of what may be seen of the faces of a block, in front of the eye.
Polygon SeenOfFaces(const Corners& corners)
{
  double deepest = 0.0;
  for (const glm::dvec4& corner : corners)
  {
    deepest = std::max(deepest, corner.w);
  }
  Polygon seen;
  for (int face = 0; face < 6; ++face)
  {
    const int across = 1 << (face / 2);
    const int u = across == 1 ? 2 : 1;
    const int v = across == 4 ? 2 : 4;
    const int first = face % 2 == 0 ? 0 : across;
    Polygon polygon;
    for (const int corner : { first, first + u, first + u + v, first + v })
    {
      polygon.push_back(corners[static_cast<std::size_t>(corner)]);
    }
    // A little before the eye, so that places in the picture are finite.
    constexpr double before = 1e-6;
    polygon = Clipped(polygon, { 0.0, 0.0, 0.0, 1.0 }, before * deepest);
    for (const glm::dvec4& edge : Edges)
    {
      polygon = Clipped(polygon, edge, 0.0);
    }
    seen.insert(seen.end(), polygon.begin(), polygon.end());
  }
  return seen;
}

bool EyeInside(const RayScene& scene)
{
  if (scene.Camera.Parallel())
  {
    return false;
  }
  const glm::dvec3 eye = glm::inverse(scene.IndexToWorld) * glm::dvec4(scene.Camera.Eye(), 1.0);
  const Box& cells = scene.DomainCells;
  return glm::all(glm::lessThanEqual(glm::dvec3(cells.Lo), eye)) &&
         glm::all(glm::lessThanEqual(eye, glm::dvec3(cells.Hi)));
}

} // namespace

TileDepths::TileDepths(const RayScene& scene)
  : ImageSize(scene.Camera.ImageSize())
  , TileCounts(TileSamplings::TilesOf(this->ImageSize))
  , Depths(static_cast<std::size_t>(this->TileCounts.x) * this->TileCounts.y,
      std::numeric_limits<double>::infinity())
{
  const glm::dmat4 indexToClip =
    glm::inverse(scene.Camera.ClipToWorldMatrix()) * scene.IndexToWorld;
  const glm::dvec3 low(scene.DomainCells.Lo);
  const glm::dvec3 size(scene.DomainCells.Size());
  if (EyeInside(scene))
  {
    std::fill(this->Depths.begin(), this->Depths.end(), 0.0);
    return;
  }
  const glm::ivec3 counts = glm::min(glm::ivec3(scene.DomainCells.Size()), BlocksPerAxis);
  for (int i = 0; i < counts.x * counts.y * counts.z; ++i)
  {
    const glm::ivec3 block(i % counts.x, i / counts.x % counts.y, i / counts.x / counts.y);
    Corners corners;
    bool cut = false;
    for (int corner = 0; corner < 8; ++corner)
    {
      const glm::dvec3 at =
        glm::dvec3(block) + glm::dvec3(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
      const glm::dvec4 point = indexToClip * glm::dvec4(low + size * at / glm::dvec3(counts), 1.0);
      corners[static_cast<std::size_t>(corner)] = point;
      cut = cut || !(point.w > 0.0);
    }
    if (!OffScreen(corners))
    {
      this->Add(cut ? SeenOfFaces(corners) : Polygon(corners.begin(), corners.end()));
    }
  }
}

void TileDepths::Add(const std::vector<glm::dvec4>& points)
{
  if (points.empty())
  {
    return;
  }
  double nearest = std::numeric_limits<double>::infinity();
  glm::dvec2 low(std::numeric_limits<double>::infinity());
  glm::dvec2 high = -low;
  for (const glm::dvec4& point : points)
  {
    nearest = std::min(nearest, point.w);
    const glm::dvec2 place = glm::dvec2(point) / point.w;
    low = glm::min(low, place);
    high = glm::max(high, place);
  }
  const glm::ivec2 first = this->TileUnder(low);
  const glm::ivec2 last = this->TileUnder(high);
  for (int y = first.y; y <= last.y; ++y)
  {
    for (int x = first.x; x <= last.x; ++x)
    {
      double& depth = this->Depths[static_cast<std::size_t>(y) * this->TileCounts.x + x];
      depth = std::min(depth, nearest);
    }
  }
}

/// @param place in the picture from -1 to 1; beyond it, the tile at its edge
glm::ivec2 TileDepths::TileUnder(const glm::dvec2& place) const
{
  const glm::dvec2 inside = glm::clamp(place, -1.0, 1.0);
  const glm::dvec2 pixel = (0.5 * inside + 0.5) * glm::dvec2(this->ImageSize);
  return glm::min(glm::ivec2(pixel) / TileSamplings::Edge, this->TileCounts - 1);
}

glm::dvec2 PixelSides(const RayCamera& camera)
{
  const glm::dmat4 rows = glm::transpose(glm::inverse(camera.ClipToWorldMatrix()));
  // Clip space is 2 wide and high where w is 1.
  return 2.0 * camera.PerPixel() /
         glm::dvec2(glm::length(glm::dvec3(rows[0])), glm::length(glm::dvec3(rows[1])));
}

} // namespace banyan
