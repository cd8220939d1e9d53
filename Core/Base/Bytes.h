// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_Bytes_h
#define banyan_Base_Bytes_h

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

// The format is little-endian and numbers are copied as they lie in memory.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "Banyan needs a little-endian machine");

namespace banyan
{

using Bytes = std::vector<std::uint8_t>;

/// A number at any alignment; the caller has checked that it lies inside.
template <class T>
T LoadNumber(const std::uint8_t* from)
{
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

template <class T>
void StoreNumber(std::uint8_t* to, T value)
{
  std::memcpy(to, &value, sizeof(T));
}

/// The bits of one type as another of the same size.
template <class To, class From>
To BitCast(From from)
{
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::memcpy(&to, &from, sizeof(To));
  return to;
}

/// Byte p of number i goes to `planes[p * count + i]`: bytes of equal weight lie together.
template <class T>
void ToPlanes(const T* numbers, std::size_t count, std::uint8_t* planes)
{
  const std::uint8_t* bytes = reinterpret_cast<const std::uint8_t*>(numbers);
  for (std::size_t p = 0; p < sizeof(T); ++p)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      planes[p * count + i] = bytes[i * sizeof(T) + p];
    }
  }
}

/// Inverse of `ToPlanes`.
template <class T>
void FromPlanes(const std::uint8_t* planes, std::size_t count, T* numbers)
{
  std::uint8_t* bytes = reinterpret_cast<std::uint8_t*>(numbers);
  for (std::size_t p = 0; p < sizeof(T); ++p)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      bytes[i * sizeof(T) + p] = planes[p * count + i];
    }
  }
}

} // namespace banyan

#endif
