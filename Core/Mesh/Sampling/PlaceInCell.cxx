// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Sampling/PlaceInCell.h"

#include <limits>

namespace banyan
{
namespace
{

/// Cells are larger by this part of their size, so that points on faces belong to both sides,
/// whatever rounding says.
constexpr double Margin = 1e-6;

bool IsInUnitCube(const glm::dvec3& part)
{
  const glm::dvec3 off = glm::abs(part - 0.5);
  return off.x <= 0.5 + Margin && off.y <= 0.5 + Margin && off.z <= 0.5 + Margin;
}

/// Says which of two equally near cells counts. The answer does not depend on the order of cells.
bool IsBefore(const TrilinearCell& a, const TrilinearCell& b)
{
  const glm::dvec3 middles[2] = { a.At(glm::dvec3(0.5)), b.At(glm::dvec3(0.5)) };
  for (int axis = 0; axis < 3; ++axis)
  {
    if (middles[0][axis] != middles[1][axis])
    {
      return middles[0][axis] < middles[1][axis];
    }
  }
  return false;
}

} // namespace

PlaceInCell FindInside(const CellShapes& shapes, const CellList& cells, const glm::dvec3& point)
{
  PlaceInCell place;
  for (const std::uint32_t* cell = cells.Begin; cell != cells.End; ++cell)
  {
    if (!shapes.MayTouch(*cell, point, 0.0))
    {
      continue;
    }
    glm::dvec3 part = shapes.LinearPlace(*cell, point);
    // Newton's method takes longest where there is nothing to find.
    if (!IsInUnitCube(part) && !shapes.MayHold(*cell, point))
    {
      continue;
    }
    if (shapes.Shape(*cell).Find(point, part) && IsInUnitCube(part))
    {
      place.Cell = *cell;
      place.Part = glm::clamp(part, glm::dvec3(0.0), glm::dvec3(1.0));
      place.Inside = true;
      return place;
    }
  }
  return place;
}

PlaceInCell FindNearest(const CellShapes& shapes, const CellList& cells, const glm::dvec3& point)
{
  PlaceInCell place;
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::uint32_t* cell = cells.Begin; cell != cells.End; ++cell)
  {
    const glm::dvec3 part =
      glm::clamp(shapes.LinearPlace(*cell, point), glm::dvec3(0.0), glm::dvec3(1.0));
    const glm::dvec3 away = shapes.Shape(*cell).At(part) - point;
    const double distance = glm::dot(away, away);
    if (distance < nearest ||
        (distance == nearest && IsBefore(shapes.Shape(*cell), shapes.Shape(place.Cell))))
    {
      nearest = distance;
      place.Cell = *cell;
      place.Part = part;
    }
  }
  if (place.Cell >= 0)
  {
    shapes.Shape(place.Cell).Find(point, place.Part);
    place.Part = glm::clamp(place.Part, glm::dvec3(0.0), glm::dvec3(1.0));
  }
  return place;
}

PlaceInCell FindPlace(const CellShapes& shapes, const CellList& cells, const glm::dvec3& point)
{
  const PlaceInCell place = FindInside(shapes, cells, point);
  return place.Inside ? place : FindNearest(shapes, cells, point);
}

} // namespace banyan
