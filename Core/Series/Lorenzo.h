#ifndef banyan_Series_Lorenzo_h
#define banyan_Series_Lorenzo_h

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace banyan
{

/// 3-D Lorenzo residuals modulo 2^bits of C, which is unsigned: first differences along x, then y,
/// then z, with zeros outside. In place would not vectorise, hence the second array.
/// @param codes `[z][y][x]`, left unchanged
template <class C>
void ToLorenzo(const C* codes, const glm::ivec3& samples, C* residuals)
{
  const std::size_t row = static_cast<std::size_t>(samples.x);
  const std::size_t plane = row * samples.y;
  const std::size_t count = plane * samples.z;
  for (std::size_t start = 0; start < count; start += row)
  {
    residuals[start] = codes[start];
    for (std::size_t i = start + 1; i < start + row; ++i)
    {
      residuals[i] = static_cast<C>(codes[i] - codes[i - 1]);
    }
  }
  // From the end to the front, because each row needs the one before as it was.
  for (std::size_t z = 0; z < count; z += plane)
  {
    for (std::size_t y = plane - row; y > 0; y -= row)
    {
      C* to = residuals + z + y;
      const C* before = to - row;
      for (std::size_t i = 0; i < row; ++i)
      {
        to[i] = static_cast<C>(to[i] - before[i]);
      }
    }
  }
  for (std::size_t z = count - plane; z > 0; z -= plane)
  {
    C* to = residuals + z;
    const C* before = to - plane;
    for (std::size_t i = 0; i < plane; ++i)
    {
      to[i] = static_cast<C>(to[i] - before[i]);
    }
  }
}

/// Inverse of `ToLorenzo`, in place.
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

/// Small residuals of either sign become small numbers: 0, -1, 1, -2, ...
template <class C>
C ToZigzag(C residual)
{
  using S = std::make_signed_t<C>;
  const C sign = static_cast<S>(residual) < 0 ? static_cast<C>(~C{ 0 }) : C{ 0 };
  return static_cast<C>(static_cast<C>(residual << 1) ^ sign);
}

template <class C>
C FromZigzag(C number)
{
  return static_cast<C>(
    static_cast<C>(number >> 1) ^ static_cast<C>(C{ 0 } - static_cast<C>(number & 1)));
}

} // namespace banyan

#endif
