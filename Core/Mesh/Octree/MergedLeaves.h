// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Octree_MergedLeaves_h
#define banyan_Mesh_Octree_MergedLeaves_h

#include "Base/Morton.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace banyan
{

/// An element of a coarser mesh: a leaf that stays, or a cube that smaller leaves fill.
struct MergedLeaf
{
  MortonKey Key = 0;
  int Level = 0;
  std::size_t First = 0; ///< the leaves in it are [First, End): one for a leaf that stays
  std::size_t End = 0;
};

/// Merges the leaves of an octree into cubes of 2^level finest cells where they fill them. Cubes
/// with holes become elements of smaller cubes, as large as can be; leaves that are larger stay.
class LeafMerging
{
public:
  /// @param keys in ascending order, and levels: of leaves that do not overlap. Both must stay
  template <class KeyArray, class LevelArray>
  LeafMerging(const KeyArray& keys, const LevelArray& levels)
    : Keys(keys.data())
    , Levels(levels.data())
    , Count(keys.size())
  {
  }

  /// Calls function(MergedLeaf) for the elements in the order of their keys.
  /// @param level at least 1; above MortonBits it counts as that
  template <class Function>
  void ForEach(int level, Function&& function) const
  {
    level = std::min(level, MortonBits);
    for (std::size_t leaf = 0; leaf < this->Count;)
    {
      if (this->Levels[leaf] >= level)
      {
        function(this->Staying(leaf));
        ++leaf;
        continue;
      }
      const MortonKey cube = this->Keys[leaf] / CubeKeys(level) * CubeKeys(level);
      const std::size_t end = this->LeafFrom(cube + CubeKeys(level), leaf);
      this->InCube(level, cube, leaf, end, function);
      leaf = end;
    }
  }

  /// The leaf whose own corner lies at a corner of an element.
  std::size_t LeafAtCorner(const MergedLeaf& element, int corner) const
  {
    // The last finest cell of the octant touches the corner of the cube.
    const glm::ivec3 cell = PositionOfKey(element.Key) + glm::ivec3{ corner & 1, corner >> 1 & 1,
      corner >> 2 } * ((1 << element.Level) - 1);
    return element.End - element.First == 1 ? element.First
                                            : this->LeafFrom(KeyOf(cell) + 1, element.First) - 1;
  }

private:
  MergedLeaf Staying(std::size_t leaf) const
  {
    return { this->Keys[leaf], this->Levels[leaf], leaf, leaf + 1 };
  }

  /// The first one from `begin` on with a key that is not below this one: near there, mostly.
  std::size_t LeafFrom(MortonKey key, std::size_t begin) const
  {
    std::size_t step = 8;
    while (begin + step < this->Count && this->Keys[begin + step] < key)
    {
      begin += step;
      step *= 2;
    }
    const MortonKey* const last = this->Keys + std::min(begin + step, this->Count);
    return static_cast<std::size_t>(std::lower_bound(this->Keys + begin, last, key) - this->Keys);
  }

  /// The leaves [begin, end) lie in a cube, and all are smaller than that or it is the only one.
  template <class Function>
  void InCube(
    int level, MortonKey cube, std::size_t begin, std::size_t end, Function& function) const
  {
    if (end - begin <= 1)
    {
      if (begin < end)
      {
        function(this->Staying(begin));
      }
      return;
    }
    MortonKey filled = 0;
    for (std::size_t leaf = begin; leaf < end; ++leaf)
    {
      filled += CubeKeys(this->Levels[leaf]);
    }
    if (filled == CubeKeys(level))
    {
      function(MergedLeaf{ cube, level, begin, end });
      return;
    }
    const MortonKey keys = CubeKeys(level - 1);
    for (MortonKey part = 0; part < 8; ++part)
    {
      const MortonKey first = cube + part * keys;
      const std::size_t next = part == 7 ? end : std::min(end, this->LeafFrom(first + keys, begin));
      this->InCube(level - 1, first, begin, next, function);
      begin = next;
    }
  }

  const MortonKey* Keys;
  const std::uint8_t* Levels;
  std::size_t Count;
};

} // namespace banyan

#endif
