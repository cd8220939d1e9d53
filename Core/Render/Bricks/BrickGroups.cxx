// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/BrickGroups.h"

#include "Render/Bricks/BrickSource.h"

#include <algorithm>

namespace banyan
{

BrickGroups::BrickGroups(const BrickSource& source, int cells)
  : Bricks(source.Bricks())
{
  if (cells > 0 && this->Bricks.x > 0 && this->Bricks.y > 0 && this->Bricks.z > 0)
  {
    // The first and the last ones may be cut off.
    const glm::ivec3 size = source.CellsOf(this->BrickAt(this->Bricks / 2)).Size();
    const int longest = std::max({ size.x, size.y, size.z });
    // Of tiny bricks a group would have too many.
    while (2 * this->Edge * longest <= cells && this->Edge < 4 && longest > 8)
    {
      this->Edge *= 2;
    }
  }
  this->Counts = (this->Bricks + this->Edge - 1) / this->Edge;
}

std::int64_t BrickGroups::BrickAt(const glm::ivec3& position) const
{
  return BrickSource::NumberOf(position, this->Bricks);
}

std::int64_t BrickGroups::Count() const
{
  return Box{ glm::ivec3(0), this->Counts }.Count();
}

std::int64_t BrickGroups::NumberOf(const Box& bricks) const
{
  return BrickSource::NumberOf(bricks.Lo / this->Edge, this->Counts);
}

std::uint64_t BrickGroups::PlacesOf(const Box& bricks) const
{
  const std::uint64_t row = (std::uint64_t{ 1 } << bricks.Size().x) - 1;
  std::uint64_t places = 0;
  for (int z = bricks.Lo.z; z < bricks.Hi.z; ++z)
  {
    for (int y = bricks.Lo.y; y < bricks.Hi.y; ++y)
    {
      places |= row << this->PlaceOf({ bricks.Lo.x, y, z });
    }
  }
  return places;
}

Box BrickGroups::BricksOf(std::int64_t group) const
{
  const glm::ivec3 position(static_cast<int>(group % this->Counts.x),
    static_cast<int>(group / this->Counts.x % this->Counts.y),
    static_cast<int>(group / this->Counts.x / this->Counts.y));
  return { position * this->Edge, glm::min((position + 1) * this->Edge, this->Bricks) };
}

} // namespace banyan
