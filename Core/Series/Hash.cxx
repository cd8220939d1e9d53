#include "Series/Hash.h"

#include <xxhash.h>

namespace banyan
{

Hash128 HashOf(const void* data, std::size_t bytes, std::uint64_t seed)
{
  const XXH128_hash_t hash = XXH3_128bits_withSeed(data, bytes, seed);
  return { hash.low64, hash.high64 };
}

std::uint64_t ShortHashOf(const void* data, std::size_t bytes)
{
  return XXH3_64bits(data, bytes);
}

} // namespace banyan
