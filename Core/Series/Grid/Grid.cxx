// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Grid/Grid.h"

#include "Base/Error.h"

#include <algorithm>

namespace banyan
{
namespace
{

int CellsAtLevel(int fineSamples, int level)
{
  const std::int64_t cell = std::int64_t{ 1 } << level;
  return static_cast<int>((std::int64_t{ fineSamples } - 1 + cell - 1) / cell);
}

int BricksFor(int cells, int brickCells)
{
  return std::max(1, cells / brickCells + (cells % brickCells != 0 ? 1 : 0));
}

} // namespace

BrickLayout::BrickLayout(const glm::ivec3& fineSamples, int brickCells, int level)
  : FineSamples(fineSamples)
  , Cells(brickCells)
  , LevelNumber(level)
{
  if (glm::any(glm::lessThan(fineSamples, glm::ivec3(1))))
  {
    throw Error("A grid needs at least one sample along each axis");
  }
  if (brickCells < 4 || brickCells > 128 || (brickCells & (brickCells - 1)) != 0)
  {
    throw Error("The number of cells of a brick must be a power of two from 4 to 128, not " +
                std::to_string(brickCells));
  }
  if (level < 0 || level > 31)
  {
    throw Error("There is no level " + std::to_string(level));
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const int cells = CellsAtLevel(fineSamples[axis], level);
    this->LevelSamples[axis] = cells + 1;
    this->BrickCounts[axis] = BricksFor(cells, brickCells);
  }
}

std::int64_t BrickLayout::BrickCount() const
{
  return std::int64_t{ this->BrickCounts.x } * this->BrickCounts.y * this->BrickCounts.z;
}

std::int64_t BrickLayout::IndexOf(const glm::ivec3& brick) const
{
  return (std::int64_t{ brick.z } * this->BrickCounts.y + brick.y) * this->BrickCounts.x + brick.x;
}

glm::ivec3 BrickLayout::PositionOf(std::int64_t index) const
{
  if (index >= 0 && index <= INT32_MAX) // division of short numbers takes a third of the time
  {
    const int small = static_cast<int>(index);
    const int row = small / this->BrickCounts.x;
    return { small % this->BrickCounts.x, row % this->BrickCounts.y, row / this->BrickCounts.y };
  }
  const std::int64_t row = index / this->BrickCounts.x;
  return { static_cast<int>(index % this->BrickCounts.x),
    static_cast<int>(row % this->BrickCounts.y), static_cast<int>(row / this->BrickCounts.y) };
}

Box BrickLayout::SamplesOf(std::int64_t index) const
{
  Box box = this->CellsOf(index);
  box.Hi += 1;
  return box;
}

Box BrickLayout::CellsOf(std::int64_t index) const
{
  const glm::ivec3 position = this->PositionOf(index);
  Box box;
  for (int axis = 0; axis < 3; ++axis)
  {
    // The last brick of an axis is cut by comparing lengths: its uncut end may not fit an int.
    const int lo = position[axis] * this->Cells;
    box.Lo[axis] = lo;
    box.Hi[axis] = lo + std::min(this->Cells, this->LevelSamples[axis] - 1 - lo);
  }
  return box;
}

glm::ivec3 BrickLayout::FineSample(const glm::ivec3& sample) const
{
  glm::ivec3 fine;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::int64_t position = std::int64_t{ sample[axis] } << this->LevelNumber;
    fine[axis] = static_cast<int>(std::min<std::int64_t>(position, this->FineSamples[axis] - 1));
  }
  return fine;
}

Box BrickLayout::BricksCovering(const Box& samples) const
{
  if (samples.Empty())
  {
    return {};
  }
  Box bricks;
  for (int axis = 0; axis < 3; ++axis)
  {
    // A sample between two bricks lies in both: the last brick is taken as low as possible, and the
    // first as high as possible, but never beyond the last.
    const int lastSample = samples.Hi[axis] - 1;
    const int last = std::max(0, BricksFor(lastSample, this->Cells) - 1);
    bricks.Lo[axis] = std::min(samples.Lo[axis] / this->Cells, last);
    bricks.Hi[axis] = last + 1;
  }
  return bricks;
}

int BrickLayout::LevelCount(const glm::ivec3& fineSamples, int brickCells)
{
  int level = 0;
  while (
    CellsAtLevel(std::max({ fineSamples.x, fineSamples.y, fineSamples.z }), level) > brickCells)
  {
    ++level;
  }
  return level + 1;
}

} // namespace banyan
