// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Lorenzo_h
#define banyan_Series_Lorenzo_h

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>

namespace banyan
{

/// Brings numbers back from their 3-D Lorenzo residuals modulo 2^bits of C, which is unsigned:
/// first differences along x, then y, then z, with zeros outside. In place.
/// @param values `[z][y][x]`
template <class C>
void FromLorenzo(C* values, const glm::ivec3& samples)
{
  const std::size_t row = static_cast<std::size_t>(samples.x);
  const std::size_t plane = row * samples.y;
  const std::size_t count = plane * samples.z;
  for (std::size_t i = plane; i < count; ++i)
  {
    values[i] = static_cast<C>(values[i] + values[i - plane]);
  }
  for (std::size_t z = 0; z < count; z += plane)
  {
    for (std::size_t i = z + row; i < z + plane; ++i)
    {
      values[i] = static_cast<C>(values[i] + values[i - row]);
    }
  }
  for (std::size_t start = 0; start < count; start += row)
  {
    C sum = 0;
    for (std::size_t i = start; i < start + row; ++i)
    {
      sum = static_cast<C>(sum + values[i]);
      values[i] = sum;
    }
  }
}

/// 0, 1, 2, 3, ... stand for 0, -1, 1, -2, ...
template <class C>
C FromZigzag(C number)
{
  return static_cast<C>(
    static_cast<C>(number >> 1) ^ static_cast<C>(C{ 0 } - static_cast<C>(number & 1)));
}

} // namespace banyan

#endif
