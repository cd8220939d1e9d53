// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_OrderedBits_h
#define banyan_Base_OrderedBits_h

#include "Base/Bytes.h"

#include <type_traits>

namespace banyan
{

/// The unsigned number of a type's size.
template <class T>
using BitsOf = std::conditional_t<sizeof(T) == 1, std::uint8_t,
  std::conditional_t<sizeof(T) == 2, std::uint16_t,
    std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;

/// Bits of a value such that neighbouring values have neighbouring bits.
template <class T>
BitsOf<T> Ordered(T value)
{
  using U = BitsOf<T>;
  U bits = BitCast<U>(value);
  if constexpr (std::is_floating_point_v<T>)
  {
    const U sign = static_cast<U>(U{ 1 } << (8 * sizeof(U) - 1));
    bits = (bits & sign) != 0 ? static_cast<U>(~bits) : static_cast<U>(bits | sign);
  }
  return bits;
}

/// Inverse of `Ordered`, for any bits.
template <class T>
T FromOrdered(BitsOf<T> bits)
{
  using U = BitsOf<T>;
  if constexpr (std::is_floating_point_v<T>)
  {
    const U sign = static_cast<U>(U{ 1 } << (8 * sizeof(U) - 1));
    bits = (bits & sign) != 0 ? static_cast<U>(bits & ~sign) : static_cast<U>(~bits);
  }
  return BitCast<T>(bits);
}

/// A signed number (as two's complement) so that numbers near 0 have few bits, and its inverse.
template <class U>
U Zigzag(U number)
{
  const U sign = (number >> (8 * sizeof(U) - 1)) != 0 ? static_cast<U>(~U{ 0 }) : U{ 0 };
  return static_cast<U>(static_cast<U>(number << 1) ^ sign);
}
template <class U>
U FromZigzag(U code)
{
  return static_cast<U>(
    static_cast<U>(code >> 1) ^ static_cast<U>(U{ 0 } - static_cast<U>(code & 1)));
}

} // namespace banyan

#endif
