// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_Morton_h
#define banyan_Base_Morton_h

#include "Base/Box.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cstdint>

namespace banyan
{

/// A Morton key interleaves the bits of a position: bit 0 of x, y, z, then bit 1, and so on. All
/// positions inside a cube of an octree follow one another: a cube of edge 2^level at `key` has the
/// keys [key, key + CubeKeys(level)).
using MortonKey = std::uint64_t;

/// Bits of a position along an axis.
constexpr int MortonBits = 21;
constexpr std::int64_t MortonEdge = std::int64_t{ 1 } << MortonBits;

inline MortonKey SpreadBits(std::uint64_t x)
{
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  x = (x | x << 2) & 0x1249249249249249;
  return x;
}

inline std::int32_t GatherBits(MortonKey x)
{
  x &= 0x1249249249249249;
  x = (x | x >> 2) & 0x10c30c30c30c30c3;
  x = (x | x >> 4) & 0x100f00f00f00f00f;
  x = (x | x >> 8) & 0x1f0000ff0000ff;
  x = (x | x >> 16) & 0x1f00000000ffff;
  x = (x | x >> 32) & 0x1fffff;
  return static_cast<std::int32_t>(x);
}

/// @param p components in [0, 2^21)
inline MortonKey KeyOf(const glm::ivec3& p)
{
  return SpreadBits(static_cast<std::uint64_t>(p.x)) |
         SpreadBits(static_cast<std::uint64_t>(p.y)) << 1 |
         SpreadBits(static_cast<std::uint64_t>(p.z)) << 2;
}

inline glm::ivec3 PositionOfKey(MortonKey key)
{
  return { GatherBits(key), GatherBits(key >> 1), GatherBits(key >> 2) };
}

/// @param level in [0, 21]
inline MortonKey CubeKeys(int level)
{
  return MortonKey{ 1 } << 3 * level;
}

/// The box around cubes. The bits of one axis compare as positions do, so that none is gathered
/// before the end.
class CubeExtent
{
public:
  /// @param level of a cube of 2^level at this key
  void Include(MortonKey key, int level)
  {
    const MortonKey last = key | (CubeKeys(level) - 1);
    for (int axis = 0; axis < 3; ++axis)
    {
      const MortonKey bits = SpreadBits(MortonEdge - 1) << axis;
      this->First[axis] = std::min(this->First[axis], key & bits);
      this->Last[axis] = std::max(this->Last[axis], last & bits);
    }
  }

  /// Empty as long as nothing is included.
  Box Around() const
  {
    return this->First[0] > this->Last[0]
             ? Box{}
             : Box{ PositionOfKey(this->First[0] | this->First[1] | this->First[2]),
                 PositionOfKey(this->Last[0] | this->Last[1] | this->Last[2]) + 1 };
  }

private:
  MortonKey First[3] = { ~MortonKey{ 0 }, ~MortonKey{ 0 }, ~MortonKey{ 0 } };
  MortonKey Last[3] = { 0, 0, 0 };
};

} // namespace banyan

#endif
