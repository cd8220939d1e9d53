#include "Render/ScreenLevels.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace banyan
{
namespace
{

constexpr int BlocksPerAxis = 16;

using Corners = std::array<glm::dvec4, 8>; ///< in clip space

/// Whether all corners are beyond one of the planes that bound the picture, or behind the eye.
bool OffScreen(const Corners& corners)
{
  const auto all = [&corners](auto&& beyond)
  { return std::all_of(corners.begin(), corners.end(), beyond); };
  return all([](const glm::dvec4& p) { return p.x < -p.w; }) ||
         all([](const glm::dvec4& p) { return p.x > p.w; }) ||
         all([](const glm::dvec4& p) { return p.y < -p.w; }) ||
         all([](const glm::dvec4& p) { return p.y > p.w; }) ||
         all([](const glm::dvec4& p) { return !(p.w > 0.0); });
}

/// Per tile, the smallest w of what may be seen of the domain there; infinite where there is
/// nothing.
class NearestDepths
{
public:
  explicit NearestDepths(const RayScene& scene)
    : ImageSize(scene.Camera.ImageSize())
    , Tiles(TileSamplings::TilesOf(this->ImageSize))
    , Depths(static_cast<std::size_t>(this->Tiles.x) * this->Tiles.y,
        std::numeric_limits<double>::infinity())
  {
    const glm::dmat4 indexToClip =
      glm::inverse(scene.Camera.ClipToWorldMatrix()) * scene.IndexToWorld;
    const glm::dvec3 low(scene.DomainCells.Lo);
    const glm::dvec3 size(scene.DomainCells.Size());
    const glm::ivec3 counts = glm::min(glm::ivec3(scene.DomainCells.Size()), BlocksPerAxis);
    for (int z = 0; z < counts.z; ++z)
    {
      for (int y = 0; y < counts.y; ++y)
      {
        for (int x = 0; x < counts.x; ++x)
        {
          Corners corners;
          for (int corner = 0; corner < 8; ++corner)
          {
            const glm::dvec3 at(x + (corner & 1), y + ((corner >> 1) & 1), z + ((corner >> 2) & 1));
            corners[static_cast<std::size_t>(corner)] =
              indexToClip * glm::dvec4(low + size * at / glm::dvec3(counts), 1.0);
          }
          this->Add(corners);
        }
      }
    }
  }

  double At(const glm::ivec2& tile) const
  {
    return this->Depths[static_cast<std::size_t>(tile.y) * this->Tiles.x + tile.x];
  }

private:
  void Add(const Corners& corners)
  {
    if (OffScreen(corners))
    {
      return;
    }
    double nearest = std::numeric_limits<double>::infinity();
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high = -low;
    for (const glm::dvec4& corner : corners)
    {
      nearest = std::min(nearest, corner.w);
      const glm::dvec2 place = glm::dvec2(corner) / corner.w;
      low = glm::min(low, place);
      high = glm::max(high, place);
    }
    if (!(nearest > 0.0))
    {
      // The plane of the eye goes through it: it may be under any tile, and as near as can be.
      std::fill(this->Depths.begin(), this->Depths.end(), 0.0);
      return;
    }
    const glm::ivec2 first = this->TileUnder(low);
    const glm::ivec2 last = this->TileUnder(high);
    for (int y = first.y; y <= last.y; ++y)
    {
      for (int x = first.x; x <= last.x; ++x)
      {
        double& depth = this->Depths[static_cast<std::size_t>(y) * this->Tiles.x + x];
        depth = std::min(depth, nearest);
      }
    }
  }

  /// @param place in the picture from -1 to 1; beyond it, the tile at its edge
  glm::ivec2 TileUnder(const glm::dvec2& place) const
  {
    const glm::dvec2 inside = glm::clamp(place, -1.0, 1.0);
    const glm::dvec2 pixel = (0.5 * inside + 0.5) * glm::dvec2(this->ImageSize);
    return glm::min(glm::ivec2(pixel) / TileSamplings::Edge, this->Tiles - 1);
  }

  glm::ivec2 ImageSize;
  glm::ivec2 Tiles;
  std::vector<double> Depths;
};

/// World length of a pixel's shorter side where w is 1.
double PixelSide(const RayCamera& camera)
{
  const glm::dmat4 rows = glm::transpose(glm::inverse(camera.ClipToWorldMatrix()));
  // Clip space is 2 wide and high where w is 1.
  const glm::dvec2 pixel = 2.0 * camera.PerPixel();
  return std::min(
    pixel.x / glm::length(glm::dvec3(rows[0])), pixel.y / glm::length(glm::dvec3(rows[1])));
}

} // namespace

TileSamplings SamplingsByScreen(
  const RayScene& scene, double pixels, double distance, int coarsest, bool distanceGrows)
{
  double edge = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    edge = std::max(edge, glm::length(glm::dvec3(scene.IndexToWorld[axis])));
  }
  std::vector<RaySampling> levels;
  for (int level = 0; level <= coarsest; ++level)
  {
    levels.push_back({ level, distanceGrows ? std::ldexp(distance, level) : distance });
  }
  TileSamplings samplings(scene.Camera.ImageSize(), std::move(levels));
  const NearestDepths depths(scene);
  const double side = PixelSide(scene.Camera);
  const glm::ivec2 tiles = samplings.Tiles();
  for (int y = 0; y < tiles.y; ++y)
  {
    for (int x = 0; x < tiles.x; ++x)
    {
      int level = 0;
      while (level < coarsest && std::ldexp(edge, level + 1) <= pixels * side * depths.At({ x, y }))
      {
        ++level;
      }
      samplings.SetNumber({ x, y }, level);
    }
  }
  return samplings;
}

} // namespace banyan
