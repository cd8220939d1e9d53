// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/DrawnField.h"

#include "Series/Decode/CacheContext.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{

FieldPlace PlaceOfSamples(const Grid& grid, const Box& samples)
{
  FieldPlace place;
  place.Cells = { glm::ivec3(0), samples.Size() - 1 };
  glm::dmat4 matrix(1.0);
  place.CellSize = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis)
  {
    matrix[axis] = glm::dvec4(grid.Direction[axis] * grid.Spacing[axis], 0.0);
    place.CellSize = std::min(place.CellSize, std::abs(grid.Spacing[axis]));
  }
  const glm::dvec3 first = grid.Origin + grid.Direction * (grid.Spacing * glm::dvec3(samples.Lo));
  matrix[3] = glm::dvec4(first, 1.0);
  place.IndexToPhysical = matrix;

  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high = -low;
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec4 index((corner & 1) ? place.Cells.Hi.x : 0, (corner & 2) ? place.Cells.Hi.y : 0,
      (corner & 4) ? place.Cells.Hi.z : 0, 1.0);
    const glm::dvec3 point(matrix * index);
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  place.Bounds = { { low.x, high.x, low.y, high.y, low.z, high.z } };
  return place;
}

int DrawnField::CoarsestLevelOf(const glm::ivec3& cells)
{
  constexpr int least = 3;
  constexpr int most = 128; // cells
  const int longest = std::max({ cells.x, cells.y, cells.z });
  int level = least;
  while ((longest - 1) >> level >= most)
  {
    ++level;
  }
  return level;
}

const std::shared_ptr<CacheContext>& DrawnField::Caches()
{
  BrickSource* const source = this->Source();
  return source ? source->Kept().Caches() : CacheContext::Process();
}

ValueRange DrawnField::RangeHere()
{
  ValueRange range;
  if (const BrickSource* const source = this->Source())
  {
    const glm::ivec3 counts = source->Bricks();
    for (std::int64_t i = 0; i < std::int64_t{ counts.x } * counts.y * counts.z; ++i)
    {
      range.Include(source->RangeOf(i));
    }
  }
  return range;
}

} // namespace banyan
