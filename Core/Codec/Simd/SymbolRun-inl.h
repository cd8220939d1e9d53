// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_SymbolRun_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_SymbolRun_inl_h
#undef banyan_Codec_SymbolRun_inl_h
#else
#define banyan_Codec_SymbolRun_inl_h
#endif

#include "Codec/DecodeStages.h"
#include "Codec/Simd/Pack-inl.h"
#include "Codec/SymbolReader.h"

#if HWY_ARCH_X86
#include <immintrin.h>
#endif

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// The lowest bits of a word, as many as the lowest byte of an entry says.
HWY_INLINE std::uint64_t LowBits(std::uint64_t word, std::uint32_t entry)
{
#if HWY_ARCH_X86_64 && HWY_TARGET <= HWY_AVX2
  return _bzhi_u64(word, entry);
#else
  return word & ((std::uint64_t{ 1 } << (entry & 63u)) - 1);
#endif
}

/// The bits at hand while a run is read. New ones are put behind those that are left, so that
/// states need not wait until they are loaded: where they lie is known one filling before.
class RunBits
{
public:
  HWY_INLINE RunBits(const SymbolReader& reader)
    : Reader(reader)
    , Word(reader.Word(reader.Position))
    , Next8((reader.Position >> 3) + 7)
    , Left(56 - static_cast<std::uint32_t>(reader.Position & 7))
  {
  }

  /// From now on there are enough bits for four symbols; as there are at the beginning.
  HWY_INLINE void Fill()
  {
    const std::uint32_t left = this->Left & 63u; // what is above is of no meaning
    this->Word |= this->Reader.Byte(this->Next8) << left;
    this->Next8 += (63u - left) >> 3;
    this->Left = left | 56u;
  }

  /// A symbol's entry; moves the lane's state.
  HWY_INLINE std::uint32_t Next(
    const std::uint32_t* tables, std::uint16_t place, std::uint64_t& state)
  {
    const std::uint32_t entry = tables[std::uint64_t{ place } + state];
    state = std::uint64_t{ entry >> residual::BaseShift } + LowBits(this->Word, entry);
    this->Word >>= entry & 63u;
    this->Left -= entry; // whose lowest bits are the symbol's
    return entry;
  }

  /// Position of the first bit that was not taken.
  HWY_INLINE std::uint64_t Position() const { return 8 * this->Next8 - (this->Left & 63u); }

private:
  const SymbolReader& Reader;
  std::uint64_t
    Word; ///< the next bits, lowest first; those behind the ones that are left are right, too
  std::uint64_t Next8; ///< byte that comes behind those that are left
  std::uint32_t Left;  ///< bits of the word, in its lowest six
};

/// The last 1 to 7 symbols of a run. Most runs of smooth blocks have no more.
template <int Lanes>
HWY_INLINE void ReadFew(RunBits& bits, const std::uint32_t* HWY_RESTRICT tables,
  const std::uint16_t* HWY_RESTRICT places, int count, std::uint64_t (&states)[Lanes],
  std::uint32_t* HWY_RESTRICT entries)
{
  entries[0] = bits.Next(tables, places[0], states[0]);
  if (count > 1)
  {
    entries[1] = bits.Next(tables, places[1], states[1 % Lanes]);
  }
  if (count > 2)
  {
    entries[2] = bits.Next(tables, places[2], states[2 % Lanes]);
  }
  if (count > 3)
  {
    entries[3] = bits.Next(tables, places[3], states[3 % Lanes]);
    bits.Fill();
  }
  if (count > 4)
  {
    entries[4] = bits.Next(tables, places[4], states[4 % Lanes]);
  }
  if (count > 5)
  {
    entries[5] = bits.Next(tables, places[5], states[5 % Lanes]);
  }
  if (count > 6)
  {
    entries[6] = bits.Next(tables, places[6], states[6 % Lanes]);
  }
}

/// The symbols of entries: residuals or escapes.
/// @param symbols room for a multiple of 16
HWY_INLINE void TakeSymbols(
  const std::uint32_t* HWY_RESTRICT entries, int count, std::int8_t* HWY_RESTRICT symbols)
{
  using Entries = Pack<std::int32_t, 16>;
  for (int k = 0; k < count; k += 16)
  {
    const auto some = Entries::Load(reinterpret_cast<const std::int32_t*>(entries) + k);
    // Signed numbers, which bytes hold.
    constexpr int above = 24 - residual::SymbolShift;
    Narrow<std::int8_t>(ShiftRight<24>(ShiftLeft<above>(some))).Store(symbols + k);
  }
}

/// ReadRun for a number of lanes, of at most SymbolReader::MostUnchecked symbols. By itself, so
/// that all it works with stays in registers: loops are unrolled by hand, as lanes are registers
/// only where their numbers are constants. Whole entries are kept, which takes an instruction less
/// than their symbols.
template <int Lanes>
HWY_NOINLINE void ReadRunOf(SymbolReader& reader, const std::uint32_t* HWY_RESTRICT tables,
  const std::uint16_t* HWY_RESTRICT places, const int count, std::int8_t* HWY_RESTRICT symbols)
{
  std::uint32_t entries[SymbolReader::MostUnchecked];
  std::uint64_t states[Lanes];
  std::memcpy(states, reader.States, sizeof(states));
  RunBits bits(reader);
  int k = 0;
  for (; k + 8 <= count; k += 8)
  {
    entries[k] = bits.Next(tables, places[k], states[0]);
    entries[k + 1] = bits.Next(tables, places[k + 1], states[1 % Lanes]);
    entries[k + 2] = bits.Next(tables, places[k + 2], states[2 % Lanes]);
    entries[k + 3] = bits.Next(tables, places[k + 3], states[3 % Lanes]);
    bits.Fill(); // four symbols take at most 36 bits
    entries[k + 4] = bits.Next(tables, places[k + 4], states[4 % Lanes]);
    entries[k + 5] = bits.Next(tables, places[k + 5], states[5 % Lanes]);
    entries[k + 6] = bits.Next(tables, places[k + 6], states[6 % Lanes]);
    entries[k + 7] = bits.Next(tables, places[k + 7], states[7 % Lanes]);
    bits.Fill();
  }
  if (k < count)
  {
    ReadFew<Lanes>(bits, tables, places + k, count - k, states, entries + k);
  }
  std::memcpy(reader.States, states, sizeof(states));
  reader.Position = bits.Position();
  reader.Check();
  TakeSymbols(entries, count, symbols);
}

/// ReadFlags for a number of lanes. All numbers are known, so that nothing is jumped over, and no
/// flag goes through memory.
template <int Lanes, int Count>
HWY_NOINLINE unsigned ReadFlagsOf(SymbolReader& reader, const std::uint32_t* HWY_RESTRICT tables,
  const std::uint16_t* HWY_RESTRICT places)
{
  constexpr std::uint32_t symbol = 0xffu << residual::SymbolShift;
  std::uint64_t states[Lanes];
  std::memcpy(states, reader.States, sizeof(states));
  RunBits bits(reader);
  unsigned set = 0;
#pragma GCC unroll 32
  for (int k = 0; k < Count; ++k)
  {
    const std::uint32_t entry = bits.Next(tables, places[k], states[k % Lanes]);
    set |= ((entry & symbol) != 0 ? 1u : 0u) << k;
    if (k % 4 == 3 && k + 1 < Count)
    {
      bits.Fill(); // four symbols take at most 36 bits
    }
  }
  std::memcpy(reader.States, states, sizeof(states));
  reader.Position = bits.Position();
  reader.Check();
  return set;
}

/// Reads a run of symbols of which only matters whether they are 0. @return bit k: symbol k is not
/// @param tables, places as ReadRun has them
template <int Count>
HWY_INLINE unsigned ReadFlags(
  SymbolReader& reader, const std::uint32_t* tables, const std::uint16_t* places)
{
  static_assert(Count <= 32, "a word of bits");
  const stages::In stage(stages::Symbols);
  stages::CountSymbols(Count);
  switch (reader.LanesLog)
  {
    case 0:
      return ReadFlagsOf<1, Count>(reader, tables, places);
    case 1:
      return ReadFlagsOf<2, Count>(reader, tables, places);
    case 2:
      return ReadFlagsOf<4, Count>(reader, tables, places);
    default:
      return ReadFlagsOf<8, Count>(reader, tables, places);
  }
}

/// Reads a run of symbols.
/// @param tables of a band; see SymbolReader::TablesOf
/// @param places of the symbols' tables among them: DecodeTables::Band::Tables, times
/// tans::TableSize
/// @param symbols receives the residuals, or residual::EscapeSymbol and more where extra bits
/// follow, which must be taken then, with SymbolReader::Long. Room for a multiple of 16
HWY_INLINE void ReadRun(SymbolReader& reader, const std::uint32_t* tables,
  const std::uint16_t* places, int count, std::int8_t* symbols)
{
  const stages::In stage(stages::Symbols);
  stages::CountSymbols(count);
  for (; count > 0; count -= SymbolReader::MostUnchecked)
  {
    const int some = std::min(count, SymbolReader::MostUnchecked);
    switch (reader.LanesLog)
    {
      case 0:
        ReadRunOf<1>(reader, tables, places, some, symbols);
        break;
      case 1:
        ReadRunOf<2>(reader, tables, places, some, symbols);
        break;
      case 2:
        ReadRunOf<4>(reader, tables, places, some, symbols);
        break;
      default:
        ReadRunOf<8>(reader, tables, places, some, symbols);
    }
    places += SymbolReader::MostUnchecked;
    symbols += SymbolReader::MostUnchecked;
  }
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
