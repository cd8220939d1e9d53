#include "Render/ElementsPerPixel.h"

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
  const glm::dmat4 rows = glm::transpose(worldToClip);
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
  // Clip space is 2 wide and high where w is 1.
  const glm::dvec2 pixel = 2.0 * nearest * scene.Camera.PerPixel();
  return pixel.x / glm::length(glm::dvec3(rows[0])) * pixel.y / glm::length(glm::dvec3(rows[1]));
}

} // namespace

int FinestLevelFor(const RayScene& scene, double most, int coarsest)
{
  if (!(most > 0.0))
  {
    return 0;
  }
  double edge = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis)
  {
    edge = std::min(edge, glm::length(glm::dvec3(scene.IndexToWorld[axis])));
  }
  const double area = SmallestPixelArea(scene);
  int level = 0;
  while (level < coarsest && area > most * std::ldexp(edge * edge, 2 * level))
  {
    ++level;
  }
  return level;
}

} // namespace banyan
