// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_OctreeMeshKeys_h
#define banyan_Data_OctreeMeshKeys_h

#include "OctreeMesh.h"

namespace banyan
{

/// Morton keys of `OctreeMesh`: the bits of three coordinates below 2^20 interleaved, x lowest.
struct OctreeMeshKeys
{
  static constexpr int LevelBits = 4;
  static constexpr int CoordinateBits = 20;

  static std::uint64_t Spread(std::uint64_t v)
  {
    v = (v | v << 32) & 0x1f00000000ffffu;
    v = (v | v << 16) & 0x1f0000ff0000ffu;
    v = (v | v << 8) & 0x100f00f00f00f00fu;
    v = (v | v << 4) & 0x10c30c30c30c30c3u;
    return (v | v << 2) & 0x1249249249249249u;
  }
  static std::uint32_t Gather(std::uint64_t v)
  {
    v &= 0x1249249249249249u;
    v = (v | v >> 2) & 0x10c30c30c30c30c3u;
    v = (v | v >> 4) & 0x100f00f00f00f00fu;
    v = (v | v >> 8) & 0x1f0000ff0000ffu;
    v = (v | v >> 16) & 0x1f00000000ffffu;
    return static_cast<std::uint32_t>(v | v >> 32) & 0x1fffffu;
  }
  static std::uint64_t Morton(const std::array<std::uint32_t, 3>& p)
  {
    return Spread(p[0]) | Spread(p[1]) << 1 | Spread(p[2]) << 2;
  }
  static std::array<std::uint32_t, 3> Place(std::uint64_t morton)
  {
    return { Gather(morton), Gather(morton >> 1), Gather(morton >> 2) };
  }
  static std::uint64_t Cell(std::uint64_t morton, int level)
  {
    return morton << LevelBits | static_cast<std::uint64_t>(level);
  }
};

/// The cubes of an octree that have children, level by level: what the octree is.
using DividedCubes = std::vector<std::vector<std::uint64_t>>;

/// All cubes that are too large, from the roots on; Morton keys, sorted on each level from 0 to
/// MaxLevel - 1.
DividedCubes DivideCubes(
  const OctreeMeshShape& shape, const OctreeMesh::TooLarge& tooLarge, ThreadPool& pool);

/// Divides as few more cubes as possible until leaves that share a face or an edge differ by at
/// most one level.
void BalanceCubes(const OctreeMeshShape& shape, DividedCubes& divided);

/// Keys (`OctreeMeshKeys::Cell`) of the leaves, sorted.
std::vector<std::uint64_t> LeavesOf(const OctreeMeshShape& shape, const DividedCubes& divided);

/// Number of leaves.
std::size_t CountLeaves(const OctreeMeshShape& shape, const DividedCubes& divided);

} // namespace banyan

#endif
