// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_StepNeighbours_h
#define banyan_Series_Format_StepNeighbours_h

#include "Series/Format/GroupFormat.h"

#include <algorithm>
#include <cstdint>
#include <vector>

/// The neighbours from which the entries of a step's table are predicted.
namespace banyan::group
{

/// The entries of a grid and those before them along each axis.
template <class Entry>
class Neighbours
{
public:
  Neighbours(const std::vector<Entry>& entries, const glm::ivec3& size)
    : Entries(entries)
    , Size(size)
  {
  }

  /// The (up to three) entries that touch entry `index` and come before it, along x, y, z.
  template <class Body>
  void ForEach(std::size_t index, Body&& body) const
  {
    const std::size_t row = static_cast<std::size_t>(this->Size.x);
    const std::size_t slice = row * static_cast<std::size_t>(this->Size.y);
    if (index % row != 0)
    {
      body(this->Entries[index - 1]);
    }
    if (index % slice >= row)
    {
      body(this->Entries[index - row]);
    }
    if (index >= slice)
    {
      body(this->Entries[index - slice]);
    }
  }

private:
  const std::vector<Entry>& Entries;
  glm::ivec3 Size;
};

/// Least and greatest lattice number of some nodes; Known when all of them have them.
struct Extremes
{
  bool Known = false;
  std::int32_t Low = 0, High = 0;
};

inline bool HasNumbers(const NodeEntry& node)
{
  return !node.Explicit && !node.NothingFinite;
}

/// Returns the extremes of the bricks of the level below that a brick holds.
inline Extremes ChildrenOf(
  const StepTable& table, const TableShape& shape, std::size_t level, std::size_t index)
{
  Extremes all;
  if (level == 0)
  {
    return all;
  }
  const glm::ivec3 size = shape.Bricks[level];
  const glm::ivec3 finer = shape.Bricks[level - 1];
  const std::int64_t at = static_cast<std::int64_t>(index);
  const glm::ivec3 first =
    2 * glm::ivec3{ at % size.x, at / size.x % size.y, at / size.x / size.y };
  const glm::ivec3 end = glm::min(first + 2, finer);
  all.Low = INT32_MAX;
  all.High = INT32_MIN;
  for (int z = first.z; z < end.z; ++z)
  {
    for (int y = first.y; y < end.y; ++y)
    {
      for (int x = first.x; x < end.x; ++x)
      {
        const NodeEntry& child =
          table.Levels[level - 1][(static_cast<std::size_t>(z) * finer.y + y) * finer.x + x];
        if (!HasNumbers(child))
        {
          return {};
        }
        all.Low = std::min(all.Low, child.Low);
        all.High = std::max(all.High, child.High);
        all.Known = true;
      }
    }
  }
  return all;
}

} // namespace banyan::group

#endif
