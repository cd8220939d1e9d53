// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/ScreenLevels.h"

#include "Render/Raycast/TileDepths.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace banyan
{
TileSamplings SamplingsByScreen(
  const RayScene& scene, double pixels, double distance, int coarsest, bool distanceGrows)
{
  const auto longestEdge = [&](int level)
  {
    const glm::dvec3 edges(scene.Levels.At(level));
    double longest = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      longest = std::max(longest, edges[axis] * glm::length(glm::dvec3(scene.IndexToWorld[axis])));
    }
    return longest;
  };
  std::vector<RaySampling> levels;
  for (int level = 0; level <= coarsest; ++level)
  {
    levels.push_back({ level, distanceGrows ? std::ldexp(distance, level) : distance });
  }
  TileSamplings samplings(scene.Camera.ImageSize(), std::move(levels));
  const TileDepths depths(scene);
  const glm::dvec2 sides = PixelSides(scene.Camera);
  const double side = std::min(sides.x, sides.y);
  const glm::ivec2 tiles = samplings.Tiles();
  for (int y = 0; y < tiles.y; ++y)
  {
    for (int x = 0; x < tiles.x; ++x)
    {
      int level = 0;
      while (level < coarsest && longestEdge(level + 1) <= pixels * side * depths.At({ x, y }))
      {
        ++level;
      }
      samplings.SetNumber({ x, y }, level);
    }
  }
  return samplings;
}

} // namespace banyan
