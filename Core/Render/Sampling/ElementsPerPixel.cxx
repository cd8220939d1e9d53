// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/ElementsPerPixel.h"

#include "Render/Raycast/TileDepths.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// World area that a pixel covers where the domain is nearest; 0 where that is not before the eye.
double SmallestPixelArea(const RayScene& scene)
{
  const glm::dmat4 worldToClip = glm::inverse(scene.Camera.ClipToWorldMatrix());
  double nearest = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner)
  {
    const Box& cells = scene.DomainCells;
    const glm::dvec4 index((corner & 1) != 0 ? cells.Hi.x : cells.Lo.x,
      (corner & 2) != 0 ? cells.Hi.y : cells.Lo.y, (corner & 4) != 0 ? cells.Hi.z : cells.Lo.z,
      1.0);
    nearest = std::min(nearest, (worldToClip * (scene.IndexToWorld * index)).w);
  }
  if (!(nearest > 0.0))
  {
    return 0.0;
  }
  const glm::dvec2 pixel = nearest * PixelSides(scene.Camera);
  return pixel.x * pixel.y;
}

double ShortestEdge(const RayScene& scene)
{
  double edge = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis)
  {
    edge = std::min(edge, glm::length(glm::dvec3(scene.IndexToWorld[axis])));
  }
  return edge;
}

/// The first level of which at most so many elements show in an area.
int LevelFor(double area, double edge, double most, int coarsest)
{
  int level = 0;
  while (level < coarsest && area > most * std::ldexp(edge * edge, 2 * level))
  {
    ++level;
  }
  return level;
}

} // namespace

int FinestLevelFor(const RayScene& scene, double most, int coarsest)
{
  if (!(most > 0.0))
  {
    return 0;
  }
  return LevelFor(SmallestPixelArea(scene), ShortestEdge(scene), most, coarsest);
}

std::vector<int> FinestLevelsOfTiles(const RayScene& scene, double most, int coarsest)
{
  const glm::ivec2 tiles = TileSamplings::TilesOf(scene.Camera.ImageSize());
  std::vector<int> levels(static_cast<std::size_t>(tiles.x) * tiles.y, 0);
  if (!(most > 0.0))
  {
    return levels;
  }
  const TileDepths depths(scene);
  const glm::dvec2 sides = PixelSides(scene.Camera);
  const double edge = ShortestEdge(scene);
  for (std::size_t i = 0; i < levels.size(); ++i)
  {
    const int tile = static_cast<int>(i);
    const double depth = depths.At({ tile % tiles.x, tile / tiles.x });
    levels[i] = LevelFor(depth * depth * sides.x * sides.y, edge, most, coarsest);
  }
  return levels;
}

} // namespace banyan
