// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_Exceptions_h
#define banyan_Series_Format_Exceptions_h

#include "Base/Bytes.h"
#include "Series/Grid/PlaneRegion.h"

#include <cstdint>
#include <vector>

namespace banyan
{

/// Samples of a block that its lattice cannot hold within the bound (NaN, infinities, fill values,
/// outliers; or all of them): kept bit-exact beside it.
/// Positions count the block's samples with x fastest, the block as if it were whole.
template <class T>
struct ExceptionList
{
  std::vector<std::uint32_t> Positions; ///< increasing
  std::vector<T> Values;                ///< of the same number
};

/// Throws nothing; the payload is the smaller of what list and mask give.
template <class T>
Bytes PackExceptions(const ExceptionList<T>& list, std::uint32_t samples, int compressionLevel);

/// @param samples of the whole block
/// Throws Error when the payload is damaged; any input is safe.
template <class T>
ExceptionList<T> UnpackExceptions(
  const std::uint8_t* payload, std::size_t bytes, std::uint32_t samples);

/// Replaces samples of a region by what its exceptions say.
/// @param block position of the block that the list belongs to
/// @param values `[z][y][x]` of the region
template <class T>
void PlaceExceptions(const PlaneRegion& region, int edge, const glm::ivec3& block,
  const ExceptionList<T>& list, T* values);

} // namespace banyan

#endif
