// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Octree_RadixSort_h
#define banyan_Mesh_Octree_RadixSort_h

#include <cstdint>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Sorts keys, and the values that go with them, by key; equal keys stay in the order that they
/// had. Takes time in proportion to the number of keys and of bits, none if they are in order
/// already, and as much memory again as keys and values.
/// @param values as many as keys
/// @param bits that keys have at most, 1 to 64
void RadixSort(
  std::vector<std::uint64_t>& keys, std::vector<std::uint32_t>& values, int bits, ThreadPool& pool);

} // namespace banyan

#endif
