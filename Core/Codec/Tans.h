// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_Tans_h
#define banyan_Codec_Tans_h

#include <cstddef>
#include <cstdint>
#include <vector>

/// Table-based asymmetric numeral systems (tANS): an entropy coder that decodes one symbol with one
/// table look-up. All tables have one size, so that every symbol of a stream may come from another
/// table: that is how contexts cost nothing.
///
/// @par Source: J. Duda, "Asymmetric numeral systems", 2013, section on tANS.
namespace banyan::tans
{

constexpr int TableBits = 9;
constexpr int TableSize = 1 << TableBits;

/// A payload has 1, 2, 4 or 8 states that take turns, so that look-ups of successive symbols
/// overlap: few where each of their first values weighs much.
constexpr int MostLanes = 8;

/// Symbols are numbered 0 to SymbolCount - 1.
constexpr int SymbolCount = 72;

/// How often each symbol of a context comes, of TableSize; all 0 when the context never comes.
struct Frequencies
{
  std::uint16_t Count[SymbolCount] = {};
};

/// Scales counts so that they sum up to TableSize, and no symbol that comes gets 0.
/// Integer arithmetic: the same on every machine.
Frequencies Normalize(const std::uint32_t* counts);

/// Whether the frequencies sum up to TableSize (or are all 0).
bool Valid(const Frequencies& frequencies);

struct DecodeEntry
{
  std::uint16_t Base = 0; ///< next state, before the bits that are read are added
  std::uint8_t Bits = 0;  ///< how many bits to read
  std::uint8_t Symbol = 0;
};

/// Fills TableSize entries. All entries decode to symbol 0 with no bits when the context never
/// comes.
void BuildDecodeTable(const Frequencies& frequencies, DecodeEntry* table);

/// Encoding: from a state in [TableSize, 2 TableSize).
struct EncodeTable
{
  explicit EncodeTable(const Frequencies& frequencies);

  /// Whether the symbol can be coded.
  bool Has(int symbol) const { return this->Used[symbol] != 0; }

  std::uint16_t Used[SymbolCount] = {};  ///< frequency
  std::uint16_t First[SymbolCount] = {}; ///< into Next
  std::vector<std::uint16_t> Next;       ///< states, by symbol and then by rank

  /// Codes a symbol: returns the new state and the bits to write.
  std::uint32_t Put(std::uint32_t state, int symbol, std::uint32_t& bits, int& bitCount) const
  {
    const std::uint32_t frequency = this->Used[symbol];
    int shift = 0;
    while ((state >> shift) >= 2 * frequency)
    {
      ++shift;
    }
    bits = state & ((1u << shift) - 1u);
    bitCount = shift;
    return this->Next[this->First[symbol] + (state >> shift) - frequency];
  }
};

} // namespace banyan::tans

#endif
