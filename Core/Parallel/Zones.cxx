#include "Parallel/Zones.h"

#include "Base/Error.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>

namespace banyan
{
namespace
{

int LongestAxis(const glm::ivec3& size)
{
  // Of equally long axes the last: values of a zone then lie closer together in files and memory.
  int axis = 2;
  for (int other = 1; other >= 0; --other)
  {
    axis = size[other] > size[axis] ? other : axis;
  }
  return axis;
}

std::int64_t CeilDivide(std::int64_t a, std::int64_t b)
{
  return (a + b - 1) / b;
}

/// Gives `zone` to the ranks from `first` on.
void Split(const Box& zone, int first, int ranks, std::vector<Box>& zones)
{
  if (ranks == 1)
  {
    zones[first] = zone;
    return;
  }
  const int axis = LongestAxis(zone.Size());
  const std::int64_t length = zone.Size()[axis];
  const std::int64_t slab = length > 0 ? zone.Count() / length : 0;

  // The plane stands where the bricks divide in the ratio of the ranks; of all ways to divide the
  // ranks the one whose fullest rank has the fewest bricks, then the most even one.
  using Quality = std::tuple<std::int64_t, int, int>;
  Quality best{ INT64_MAX, 0, 0 };
  int bestLeft = 1;
  std::int64_t bestPosition = 0;
  for (int left = 1; left < ranks; ++left)
  {
    const std::int64_t position = (2 * length * left + ranks) / (2 * ranks);
    const std::int64_t fullest = std::max(
      CeilDivide(position * slab, left), CeilDivide((length - position) * slab, ranks - left));
    const Quality quality{ fullest, std::abs(2 * left - ranks), left };
    if (quality < best)
    {
      best = quality;
      bestLeft = left;
      bestPosition = position;
    }
  }
  Box low = zone;
  Box high = zone;
  low.Hi[axis] = high.Lo[axis] = zone.Lo[axis] + static_cast<int>(bestPosition);
  Split(low, first, bestLeft, zones);
  Split(high, first + bestLeft, ranks - bestLeft, zones);
}

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
  if (ranks < 1)
  {
    throw Error("Zones need at least one rank, not " + std::to_string(ranks) + ".");
  }
  std::vector<Box> zones(static_cast<std::size_t>(ranks));
  Split({ glm::ivec3(0), glm::max(bricks, glm::ivec3(0)) }, 0, ranks, zones);
  return zones;
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
