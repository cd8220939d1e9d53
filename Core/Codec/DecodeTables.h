// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_DecodeTables_h
#define banyan_Codec_DecodeTables_h

#include "Codec/Residual.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace banyan
{

/// Decode tables of all contexts, as SymbolReader takes them. Contexts that have the same
/// frequencies have one table: what is decoded with should fit into a near cache.
struct DecodeTables
{
  struct Band
  {
    std::size_t First = 0;        ///< entry of the first table that it may have
    std::uint8_t Tables[16] = {}; ///< which table from there on each of its classes has
  };
  static_assert(residual::Classes <= 16 && residual::RowClasses <= 16, "a vector of bytes");

  /// Entries of so many tables are numbered by 16 bits.
  static constexpr std::size_t MostOfBand = (std::size_t{ 1 } << 16) / tans::TableSize;

  std::vector<std::uint32_t> Entries; ///< tans::TableSize for each table
  std::vector<Band> Bands;            ///< those of symbols, and then those of flags

  std::size_t Bytes() const
  {
    return this->Entries.size() * sizeof(std::uint32_t) + this->Bands.size() * sizeof(Band);
  }
};

} // namespace banyan

#endif
