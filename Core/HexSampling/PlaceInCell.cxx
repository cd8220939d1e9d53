#include "HexSampling/PlaceInCell.h"

#include <limits>

namespace banyan
{
namespace
{

/// Of a cell: points on faces belong to both sides, whatever rounding says.
constexpr double Margin = 1e-6;

bool IsInBox(const glm::dvec3& point, const glm::dvec3& low, const glm::dvec3& high)
{
  const glm::dvec3 margin = Margin * (high - low);
  for (int axis = 0; axis < 3; ++axis)
  {
    if (point[axis] < low[axis] - margin[axis] || point[axis] > high[axis] + margin[axis])
    {
      return false;
    }
  }
  return true;
}

bool IsInUnitCube(const glm::dvec3& part)
{
  return IsInBox(part, glm::dvec3(0.0), glm::dvec3(1.0));
}

} // namespace

PlaceInCell FindPlace(const CellShapes& shapes, const CellList& cells, const glm::dvec3& point)
{
  PlaceInCell place;
  for (const std::uint32_t* cell = cells.Begin; cell != cells.End; ++cell)
  {
    if (!IsInBox(point, shapes.Low(*cell), shapes.High(*cell)))
    {
      continue;
    }
    glm::dvec3 part(0.5);
    if (shapes.Shape(*cell).Find(point, part) && IsInUnitCube(part))
    {
      place.Cell = *cell;
      place.Part = glm::clamp(part, glm::dvec3(0.0), glm::dvec3(1.0));
      place.Inside = true;
      return place;
    }
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::uint32_t* cell = cells.Begin; cell != cells.End; ++cell)
  {
    const TrilinearCell& shape = shapes.Shape(*cell);
    glm::dvec3 part(0.5);
    shape.Find(point, part);
    part = glm::clamp(part, glm::dvec3(0.0), glm::dvec3(1.0));
    const glm::dvec3 away = shape.At(part) - point;
    if (glm::dot(away, away) < nearest)
    {
      nearest = glm::dot(away, away);
      place.Cell = *cell;
      place.Part = part;
    }
  }
  return place;
}

} // namespace banyan
