// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Hash.h"

#include "Base/Error.h"

#include <xxhash.h>

namespace banyan
{
namespace
{

std::uint64_t HexHalf(const std::string& text, std::size_t start)
{
  std::uint64_t half = 0;
  for (std::size_t i = start; i < start + 16; ++i)
  {
    const char c = text[i];
    const bool digit = c >= '0' && c <= '9';
    if (!digit && !(c >= 'a' && c <= 'f'))
    {
      throw Error("A hash is not made of lower-case hexadecimal digits");
    }
    half = half << 4 | static_cast<std::uint64_t>(digit ? c - '0' : c - 'a' + 10);
  }
  return half;
}

} // namespace

Hash128 HashOf(const void* data, std::size_t bytes, std::uint64_t seed)
{
  const XXH128_hash_t hash = XXH3_128bits_withSeed(data, bytes, seed);
  return { hash.low64, hash.high64 };
}

std::uint64_t ShortHashOf(const void* data, std::size_t bytes)
{
  return XXH3_64bits(data, bytes);
}

std::string ToHex(const Hash128& hash)
{
  static const char digits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint64_t half : { hash.High, hash.Low })
  {
    for (int shift = 60; shift >= 0; shift -= 4)
    {
      text += digits[half >> shift & 15];
    }
  }
  return text;
}

Hash128 FromHex(const std::string& text)
{
  if (text.size() != 32)
  {
    throw Error("A hash does not have 32 digits");
  }
  return { HexHalf(text, 16), HexHalf(text, 0) };
}

} // namespace banyan
