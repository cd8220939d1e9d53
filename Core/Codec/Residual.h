// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_Residual_h
#define banyan_Codec_Residual_h

#include "Codec/Tans.h"

#include <cstdint>

/// Residuals (what a prediction lacks, in bins) as symbols, and their magnitudes as contexts.
namespace banyan::residual
{

/// Residuals up to +-20 are symbols by themselves (zigzag: 0, 1, -1, 2, ...); beyond, the symbol
/// says how many bits follow.
constexpr int DirectSymbols = 40;

inline std::uint32_t Zigzag(std::int32_t residual)
{
  return (static_cast<std::uint32_t>(residual) << 1) ^ static_cast<std::uint32_t>(residual >> 31);
}

inline std::int32_t Unzigzag(std::uint32_t code)
{
  return static_cast<std::int32_t>((code >> 1) ^ (0u - (code & 1u)));
}

/// Number of bits that follow a symbol, 0 to 31.
inline int ExtraBits(int symbol)
{
  return symbol < DirectSymbols ? 0 : symbol - DirectSymbols;
}

/// Symbol of a zigzag code and, for large ones, the bits that follow.
inline int SymbolOf(std::uint32_t code, std::uint32_t& extra)
{
  if (code < static_cast<std::uint32_t>(DirectSymbols))
  {
    extra = 0;
    return static_cast<int>(code);
  }
  const std::uint64_t rest = std::uint64_t{ code } - DirectSymbols + 1;
  const int bits = 63 - __builtin_clzll(rest);
  extra = static_cast<std::uint32_t>(rest - (std::uint64_t{ 1 } << bits));
  return DirectSymbols + bits;
}

/// Inverse of SymbolOf; any input is safe.
inline std::uint32_t CodeOf(int symbol, std::uint32_t extra)
{
  return symbol < DirectSymbols ? static_cast<std::uint32_t>(symbol)
                                : DirectSymbols - 1 + (1u << (symbol - DirectSymbols)) + extra;
}

/// About 2 log2(1 + |r|): sums of these say how active the neighbourhood is, over any scale. From
/// 15 on it grows no more.
inline std::uint8_t MagnitudeOf(std::int32_t residual)
{
  constexpr std::uint8_t of[16] = { 0, 2, 3, 4, 5, 5, 6, 6, 6, 7, 7, 7, 7, 8, 8, 8 };
  const std::uint32_t size =
    residual < 0 ? 0u - static_cast<std::uint32_t>(residual) : static_cast<std::uint32_t>(residual);
  return of[size < 15 ? size : 15];
}

/// A table entry as one word: number of bits to read (8 bits of the word, for shift instructions
/// take their counts from such a byte), then 8 bits: the residual, or EscapeSymbol and the number
/// of extra bits; and the next state, which nothing is above of.
constexpr int SymbolShift = 8;
constexpr int BaseShift = 16;
constexpr int EscapeSymbol = 64;
inline std::uint32_t Packed(const tans::DecodeEntry& entry)
{
  const std::uint32_t symbol =
    entry.Symbol >= DirectSymbols
      ? static_cast<std::uint32_t>(EscapeSymbol + ExtraBits(entry.Symbol))
      : static_cast<std::uint32_t>(Unzigzag(entry.Symbol));
  return entry.Bits | (symbol & 0xffu) << SymbolShift |
         static_cast<std::uint32_t>(entry.Base) << BaseShift;
}

/// Contexts: a band (kind of unit, stride, direction), one of 8 classes of activity, and whether
/// the residuals in the slices before hint at a sign; and contexts for the flag "this row is all
/// zero", by the weight of what is around a row.
constexpr int Bands = 11;
constexpr int Signed = 8; ///< added to the class where there is such a hint
constexpr int Classes = 16;
constexpr int RowClasses = 12; ///< of rows that begin with a flag
/// A row's class is how many of these its weight exceeds; beyond the last one it has no flag.
constexpr std::uint16_t RowLimits[RowClasses] = { 0, 8, 16, 28, 44, 64, 90, 125, 170, 230, 310,
  420 };
constexpr int FlagContext = Bands * Classes;
constexpr int ContextCount = FlagContext + Bands * RowClasses;

/// A symbol in its context, in 16 bits.
constexpr int TokenShift = 7;
constexpr int TokenMask = (1 << TokenShift) - 1;
constexpr std::uint16_t TokenOf(int context, int symbol)
{
  return static_cast<std::uint16_t>(context << TokenShift | symbol);
}

static_assert(DirectSymbols + 32 <= tans::SymbolCount, "every 32-bit code has a symbol");

} // namespace banyan::residual

#endif
