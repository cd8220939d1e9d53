// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cells_PlaceHash_h
#define banyan_Cells_PlaceHash_h

#include <glm/vec3.hpp>

#include <cstdint>
#include <cstring>

namespace banyan
{

/// Spreads the bits of a number over all others; no two numbers become one (MurmurHash3).
inline std::uint64_t MixBits(std::uint64_t x)
{
  x = (x ^ x >> 33) * 0xff51afd7ed558ccd;
  x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53;
  return x ^ x >> 33;
}

/// The hash of a place, the same for float32 and float64 coordinates, and for both zeros. Hashes
/// are added up to name a set of places, whatever their order: that needs all of their bits to be
/// mixed.
inline std::uint64_t HashOfPlace(const glm::dvec3& place)
{
  std::uint64_t hash = 0x9e3779b97f4a7c15;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double positive = place[axis] + 0.0; // of -0, too
    std::uint64_t bits = 0;
    std::memcpy(&bits, &positive, sizeof(bits));
    hash = MixBits(hash + bits);
  }
  return hash;
}

} // namespace banyan

#endif
