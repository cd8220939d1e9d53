// Included once per SIMD target: see BlockDecoder.cxx.
#if defined(banyan_Codec_SymbolRun_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_SymbolRun_inl_h
#undef banyan_Codec_SymbolRun_inl_h
#else
#define banyan_Codec_SymbolRun_inl_h
#endif

#include "Codec/SymbolReader.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// The bits at hand while a run is read.
struct RunBits
{
  const SymbolReader& Symbols;
  std::uint64_t Position;
  std::uint64_t Word = 0;
  std::uint32_t Used = 0;

  HWY_INLINE void Fill()
  {
    this->Position += this->Used;
    this->Used = 0;
    this->Word = this->Symbols.Word(this->Position);
  }

  /// A symbol: its entry's top; moves the lane's state.
  HWY_INLINE std::int8_t Next(
    const std::uint32_t* tables, std::uint16_t place, std::uint64_t& state)
  {
    const std::uint32_t entry = tables[std::uint64_t{ place } + state];
    const std::uint32_t bits = entry & 0xffu;
    state = static_cast<std::uint16_t>(entry >> residual::BaseShift) +
            (this->Word & ((std::uint64_t{ 1 } << bits) - 1));
    this->Word >>= bits;
    this->Used += bits;
    return static_cast<std::int8_t>(entry >> residual::TopShift);
  }
};

/// The last 1 to 7 symbols of a run. Most runs of smooth blocks have no more.
template <int Lanes>
HWY_INLINE void ReadFew(RunBits& bits, const std::uint32_t* HWY_RESTRICT tables,
  const std::uint16_t* HWY_RESTRICT places, int count, std::uint64_t (&states)[Lanes],
  std::int8_t* HWY_RESTRICT tops)
{
  bits.Fill();
  tops[0] = bits.Next(tables, places[0], states[0]);
  if (count > 1)
  {
    tops[1] = bits.Next(tables, places[1], states[1 % Lanes]);
  }
  if (count > 2)
  {
    tops[2] = bits.Next(tables, places[2], states[2 % Lanes]);
  }
  if (count > 3)
  {
    tops[3] = bits.Next(tables, places[3], states[3 % Lanes]);
    bits.Fill();
  }
  if (count > 4)
  {
    tops[4] = bits.Next(tables, places[4], states[4 % Lanes]);
  }
  if (count > 5)
  {
    tops[5] = bits.Next(tables, places[5], states[5 % Lanes]);
  }
  if (count > 6)
  {
    tops[6] = bits.Next(tables, places[6], states[6 % Lanes]);
  }
}

/// ReadRun for a number of lanes. By itself, so that all it works with stays in registers: loops are
/// unrolled by hand, as lanes are registers only where their numbers are constants.
template <int Lanes>
HWY_NOINLINE void ReadRunOf(SymbolReader& symbols, const std::uint32_t* HWY_RESTRICT tables,
  const std::uint16_t* HWY_RESTRICT places, int count, std::int8_t* HWY_RESTRICT tops)
{
  std::uint64_t states[Lanes];
  std::copy(symbols.States, symbols.States + Lanes, states);
  RunBits bits{ symbols, symbols.Position };
  for (; count >= 8; count -= 8, places += 8, tops += 8)
  {
    bits.Fill(); // four symbols take at most 40 bits
    tops[0] = bits.Next(tables, places[0], states[0]);
    tops[1] = bits.Next(tables, places[1], states[1 % Lanes]);
    tops[2] = bits.Next(tables, places[2], states[2 % Lanes]);
    tops[3] = bits.Next(tables, places[3], states[3 % Lanes]);
    bits.Fill();
    tops[4] = bits.Next(tables, places[4], states[4 % Lanes]);
    tops[5] = bits.Next(tables, places[5], states[5 % Lanes]);
    tops[6] = bits.Next(tables, places[6], states[6 % Lanes]);
    tops[7] = bits.Next(tables, places[7], states[7 % Lanes]);
  }
  if (count > 0)
  {
    ReadFew<Lanes>(bits, tables, places, count, states, tops);
  }
  std::copy(states, states + Lanes, symbols.States);
  symbols.Position = bits.Position + bits.Used;
  symbols.Check();
}

/// Reads a run of symbols.
/// @param tables of a band; see SymbolReader::TablesOf
/// @param places of the symbols' tables among them: DecodeTables::Band::Tables, times tans::TableSize
/// @param tops receives the residuals, or residual::EscapeTop and more where extra bits follow, which
/// must be taken then, with SymbolReader::Long
HWY_INLINE void ReadRun(SymbolReader& symbols, const std::uint32_t* tables,
  const std::uint16_t* places, int count, std::int8_t* tops)
{
  switch (symbols.LanesLog)
  {
    case 0:
      return ReadRunOf<1>(symbols, tables, places, count, tops);
    case 1:
      return ReadRunOf<2>(symbols, tables, places, count, tops);
    case 2:
      return ReadRunOf<4>(symbols, tables, places, count, tops);
    default:
      return ReadRunOf<8>(symbols, tables, places, count, tops);
  }
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
