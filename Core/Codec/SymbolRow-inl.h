// Included once per SIMD target: see BlockDecoder.cxx.
#if defined(banyan_Codec_SymbolRow_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_SymbolRow_inl_h
#undef banyan_Codec_SymbolRow_inl_h
#else
#define banyan_Codec_SymbolRow_inl_h
#endif

#include "Codec/SymbolReader.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// ReadRow for a number of lanes. By itself, so that all it works with stays in registers: loops are
/// unrolled by hand, as lanes are registers only where their numbers are constants.
template <int Lanes, int Step>
HWY_NOINLINE bool ReadRowOf(SymbolReader& symbols, const std::uint32_t* HWY_RESTRICT tables,
  const std::uint8_t* HWY_RESTRICT classes, int count, std::uint32_t* HWY_RESTRICT entries)
{
  std::uint32_t states[Lanes];
  std::copy(symbols.States, symbols.States + Lanes, states);
  std::uint64_t position = symbols.Position;
  std::uint32_t any = 0;
  std::uint64_t word = 0;
  std::uint32_t used = 0;
  const auto fill = [&]() HWY_ATTR
  {
    position += used;
    used = 0;
    word = symbols.Word(position);
  };
  const auto next = [&](int k, int lane) HWY_ATTR
  {
    const std::uint32_t entry =
      tables[(std::uint32_t{ classes[k * Step] } << tans::TableBits) + states[lane]];
    entries[k * Step] = entry;
    any |= entry;
    const std::uint32_t bits = entry & 0xffu;
    states[lane] = (entry >> residual::BaseShift & (tans::TableSize - 1)) +
                   static_cast<std::uint32_t>(word & ((std::uint64_t{ 1 } << bits) - 1));
    word >>= bits;
    used += bits;
  };
  int k = 0;
  for (; k + 8 <= count; k += 8)
  {
    fill(); // four symbols take at most 40 bits
    next(k, 0);
    next(k + 1, 1 % Lanes);
    next(k + 2, 2 % Lanes);
    next(k + 3, 3 % Lanes);
    fill();
    next(k + 4, 4 % Lanes);
    next(k + 5, 5 % Lanes);
    next(k + 6, 6 % Lanes);
    next(k + 7, 7 % Lanes);
  }
  const auto rest = [&]() HWY_ATTR
  {
    fill();
    if (k == count)
      return;
    next(k, 0);
    if (k + 1 == count)
      return;
    next(k + 1, 1 % Lanes);
    if (k + 2 == count)
      return;
    next(k + 2, 2 % Lanes);
    if (k + 3 == count)
      return;
    next(k + 3, 3 % Lanes);
    fill();
    if (k + 4 == count)
      return;
    next(k + 4, 4 % Lanes);
    if (k + 5 == count)
      return;
    next(k + 5, 5 % Lanes);
    if (k + 6 == count)
      return;
    next(k + 6, 6 % Lanes);
  };
  rest();
  std::copy(states, states + Lanes, symbols.States);
  symbols.Position = position + used;
  symbols.Check();
  return (any & residual::EscapeFlag) != 0;
}

/// Reads a row: entries of symbols in contexts `context + classes[x]` for x = 0, Step, 2 Step, ...
/// @param count of symbols, at most SymbolReader::LongestRow
/// @return whether some entries have extra bits; these must be taken then, with `Long`
template <int Step>
HWY_INLINE bool ReadRow(SymbolReader& symbols, int context, const std::uint8_t* classes, int count,
  std::uint32_t* entries)
{
  const std::uint32_t* tables = symbols.Context(context);
  switch (symbols.LanesLog)
  {
    case 0:
      return ReadRowOf<1, Step>(symbols, tables, classes, count, entries);
    case 1:
      return ReadRowOf<2, Step>(symbols, tables, classes, count, entries);
    case 2:
      return ReadRowOf<4, Step>(symbols, tables, classes, count, entries);
    default:
      return ReadRowOf<8, Step>(symbols, tables, classes, count, entries);
  }
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
