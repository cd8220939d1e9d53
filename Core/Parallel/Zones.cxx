#include "Parallel/Zones.h"

#include "Base/Error.h"
#include "Parallel/ZoneTree.h"

#include <algorithm>
#include <string>

namespace banyan
{
namespace
{

/// Appends the (at most six) boxes that are left of `box` without `taken`.
void Subtract(Box box, const Box& taken, std::vector<Box>& rest)
{
  const Box common = Intersection(box, taken);
  if (common.Empty())
  {
    rest.push_back(box);
    return;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    if (box.Lo[axis] < common.Lo[axis])
    {
      Box below = box;
      below.Hi[axis] = common.Lo[axis];
      rest.push_back(below);
    }
    if (common.Hi[axis] < box.Hi[axis])
    {
      Box above = box;
      above.Lo[axis] = common.Hi[axis];
      rest.push_back(above);
    }
    box.Lo[axis] = common.Lo[axis];
    box.Hi[axis] = common.Hi[axis];
  }
}

} // namespace

std::vector<Box> StaticZones(const glm::ivec3& bricks, int ranks)
{
  return ZonesOf(EqualZoneTree(bricks, ranks));
}

Box CellsOfBricks(const Box& bricks, int brickCells, const glm::ivec3& allCells)
{
  return { glm::min(bricks.Lo * brickCells, allCells), glm::min(bricks.Hi * brickCells, allCells) };
}

std::vector<Box> MakeDisjoint(std::vector<Box> boxes)
{
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    if (boxes[i].Empty())
    {
      boxes[i] = Box{};
      continue;
    }
    // All lower ranks at once: at the corner of ghost layers each of them takes a notch, and only
    // together they leave a box.
    std::vector<Box> rest{ boxes[i] };
    for (std::size_t lower = 0; lower < i; ++lower)
    {
      std::vector<Box> next;
      for (const Box& part : rest)
      {
        Subtract(part, boxes[lower], next);
      }
      rest = std::move(next);
    }
    Box left;
    std::int64_t cells = 0;
    for (const Box& part : rest)
    {
      left = Union(left, part);
      cells += part.Count();
    }
    if (cells != left.Count())
    {
      throw Error(
        "The data of rank " + std::to_string(i) +
        " overlap those of lower ranks in another way than by ghost layers, so they cannot be "
        "drawn in visibility order; redistribute the data into boxes.");
    }
    boxes[i] = left;
  }
  return boxes;
}

} // namespace banyan
