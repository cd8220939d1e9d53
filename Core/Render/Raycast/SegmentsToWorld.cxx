// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/SegmentsToWorld.h"

#include "Render/Raycast/RayTile.h"

#include <glm/glm.hpp>

namespace banyan
{
namespace
{

/// t in the world is Factor * t + Offset.
struct Places
{
  double Factor = 0.0; ///< 0: not known yet
  double Offset = 0.0;
};

Places PlacesOf(const Ray& ray, const glm::dmat4& toWorld, const Ray& inWorld)
{
  const glm::dvec3 origin(toWorld * glm::dvec4(ray.Origin, 1.0));
  const glm::dvec3 direction(toWorld * glm::dvec4(ray.Direction, 0.0));
  return { glm::dot(direction, inWorld.Direction),
    glm::dot(origin - inWorld.Origin, inWorld.Direction) };
}

} // namespace

void SegmentsToWorld(
  std::vector<TileSegments>& tiles, const RayCamera& camera, const glm::dmat4& toWorld)
{
  const RayCamera world(
    camera.WorldToClipMatrix() * glm::inverse(toWorld), camera.ImageSize(), glm::dvec3(0.0));
  std::vector<Places> places;
  for (TileSegments& tile : tiles)
  {
    places.assign(RayTile::Slots, {});
    for (RaySegment& segment : tile.Segments)
    {
      Places& its = places[segment.Pixel];
      if (its.Factor == 0.0)
      {
        const int pixel = static_cast<int>(segment.Pixel);
        const glm::ivec2 at =
          tile.Position * RayTile::Edge + glm::ivec2(pixel % RayTile::Edge, pixel / RayTile::Edge);
        its = PlacesOf(camera.RayOf(at.x, at.y), toWorld, world.RayOf(at.x, at.y));
      }
      segment.Begin = its.Factor * segment.Begin + its.Offset;
      segment.Length = static_cast<float>(its.Factor * static_cast<double>(segment.Length));
    }
  }
}

} // namespace banyan
