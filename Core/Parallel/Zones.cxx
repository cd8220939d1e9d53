// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Zones.h"

#include "Parallel/ZoneTree.h"

#include <algorithm>

namespace banyan
{

std::vector<Box> StaticZones(const glm::ivec3& bricks, int ranks)
{
  return ZonesOf(EqualZoneTree(bricks, ranks));
}

Box CellsOfBricks(const Box& bricks, int brickCells, const glm::ivec3& allCells)
{
  return { glm::min(bricks.Lo * brickCells, allCells), glm::min(bricks.Hi * brickCells, allCells) };
}

} // namespace banyan
