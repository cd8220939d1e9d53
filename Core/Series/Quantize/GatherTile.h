// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_GatherTile_h
#define banyan_Series_Quantize_GatherTile_h

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <utility>

namespace banyan
{

/// The axes of values in the order in which they lie in memory.
struct MemoryOrder
{
  int Axes[3] = { 0, 1, 2 }; ///< nearest in memory first

  /// @param stride of the values along x, y, z
  explicit MemoryOrder(const glm::i64vec3& stride)
  {
    const auto sort = [&](int a, int b)
    {
      if (stride[this->Axes[b]] < stride[this->Axes[a]])
      {
        std::swap(this->Axes[a], this->Axes[b]);
      }
    };
    sort(0, 1);
    sort(1, 2);
    sort(0, 1);
  }

  /// Where a sample of a tile lies that has its axes in this order.
  std::ptrdiff_t PlaceOf(int edge, const glm::ivec3& sample) const
  {
    return (std::ptrdiff_t{ sample[this->Axes[2]] } * edge + sample[this->Axes[1]]) * edge +
           sample[this->Axes[0]];
  }
};

/// Copies a small box of values whose axes are in any order in memory: along the axis that is
/// contiguous there, or nearest to it. Reading across it instead would touch a page per value.
/// @param stride of the values along x, y, z; @param count how many
/// @param to strides of the tile, which receives the values in that order
template <class T>
void GatherTile(const T* values, const glm::i64vec3& stride, const glm::ivec3& count,
  const glm::i64vec3& to, T* tile)
{
  const auto [u, v, w] = MemoryOrder(stride).Axes;
  for (int k = 0; k < count[w]; ++k)
  {
    for (int j = 0; j < count[v]; ++j)
    {
      const T* from = values + k * stride[w] + j * stride[v];
      __builtin_prefetch(from + stride[w]); // a row is a line of the cache or two: ask in time
      T* at = tile + k * to[w] + j * to[v];
      for (int i = 0; i < count[u]; ++i)
      {
        at[i * to[u]] = from[i * stride[u]];
      }
    }
  }
}

} // namespace banyan

#endif
